// Along one axis, the layers that a ray starting in this tile can meet: each layer's bits spread as far as its largest
// circle of confusion reaches. Squares are separable, so two such passes spread over the plane.
#include "methods/multiview/reach.glsl"

uniform usampler2D tiles;
uniform ivec2 axis;

out uint bits;

void main()
{
    ivec2 tile = ivec2(gl_FragCoord.xy), size = textureSize(tiles, 0);
    int farthest = 0, extent = size.x * axis.x + size.y * axis.y;
    for (int k = 0; k < slabs.count; ++k) farthest = max(farthest, reach_tiles(k));
    farthest = min(farthest, extent - 1);
    bits = 0u;
    for (int distance = 0; distance <= farthest; ++distance) {
        uint within = 0u;
        for (int k = 0; k < slabs.count; ++k) if (reach_tiles(k) >= distance) within |= 1u << k;
        ivec2 before = tile - distance * axis, after = tile + distance * axis;
        if (all(greaterThanEqual(before, ivec2(0)))) bits |= texelFetch(tiles, before, 0).r & within;
        if (all(lessThan(after, size))) bits |= texelFetch(tiles, after, 0).r & within;
    }
}
