// Along one axis, the layers that a ray starting in this tile can meet: each layer's bits spread over `reach` tiles.
// Squares are separable, so two such passes spread over the plane.
uniform usampler2D tiles;
uniform ivec2 axis;
uniform int reach[32];
uniform int count;
uniform int farthest;  // the greatest reach

out uint bits;

void main()
{
    ivec2 tile = ivec2(gl_FragCoord.xy), size = textureSize(tiles, 0);
    int most = min(farthest, size.x * axis.x + size.y * axis.y - 1);
    bits = 0u;
    for (int distance = 0; distance <= most; ++distance) {
        uint within = 0u;
        for (int k = 0; k < count; ++k) if (reach[k] >= distance) within |= 1u << k;
        ivec2 before = tile - distance * axis, after = tile + distance * axis;
        if (all(greaterThanEqual(before, ivec2(0)))) bits |= texelFetch(tiles, before, 0).r & within;
        if (all(lessThan(after, size))) bits |= texelFetch(tiles, after, 0).r & within;
    }
}
