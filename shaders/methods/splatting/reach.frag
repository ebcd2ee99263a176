// How far the pixels of a tile must look for points of each level whose sprites reach them, px: x among the visible ones,
// y among the hidden ones, z among the second ones; -1 where they need not look at all.
//
// In a tile in focus every pixel is opaque by itself, so only what is in front can show, or what is so little behind the
// focus that it shares the pixel's layer; where nothing is, the tile is copied. The map has the tiles of one level after
// the other, from the bottom.
#include "methods/splatting/point.glsl"
#include "methods/splatting/sprite.glsl"

uniform sampler2D largest;
uniform int farthest;  // tiles

out vec4 reach;

// CoC radius of a point behind the focus that shares a layer with one in focus: that of one that is sharp, and a
// tolerance of twice it.
const float MOST_SHARED = 1.1;

bool is_sharp(ivec2 tile, int rows)
{
    vec4 own = texelFetch(largest, tile, 0);
    bool sharp = SKIP == 1 && max(own.x, max(own.y, own.w)) < sharp_radius();
    for (int level = 1; level <= LEVELS; ++level) {
        own = texelFetch(largest, tile + ivec2(0, level * rows), 0);
        sharp = sharp && max(own.x, own.y) < 0.0;
    }
    return sharp;
}

void main()
{
    ivec2 size = textureSize(largest, 0) / ivec2(1, LEVELS + 1), here = ivec2(gl_FragCoord.xy);
    int level = here.y / size.y, row = level * size.y;
    ivec2 tile = here - ivec2(0, row);
    bool sharp = is_sharp(tile, size.y);
    // Half a texel of a block's width at either end.
    float rim = float(1 << level);
    reach = vec4(-1.0, -1.0, -1.0, 0.0);
    ivec2 from = max(tile - farthest, ivec2(0)), to = min(tile + farthest, size - 1);
    for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) {
            vec2 apart = max(abs(vec2(x, y) - vec2(tile)) * float(TILE) - float(TILE - 1), vec2(0.0));
            float distance = length(apart) - rim;
            vec4 there = texelFetch(largest, ivec2(x, y + row), 0);
            if (sharp) there.yz = vec2(min(there.y, MOST_SHARED), -1.0);
            vec3 radius = vec3(max(there.x, there.y), there.z, there.w);
            bvec3 reaches = greaterThan(radius * max(extent, 1.0), vec3(max(distance, -0.5)));
            reach.xyz = max(reach.xyz, mix(vec3(-1.0), radius, reaches));
        }
    if (sharp && level == 0 && reach.x < sharp_radius()) reach.x = -1.0;
}
