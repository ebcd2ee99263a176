// How far a pixel of each tile must look for points whose sprites reach it: x among the visible ones, y among the hidden
// ones, px; -1 where it need not look at all. z is 1 where the tile is its own picture.
//
// In a tile in focus the pixels are opaque by themselves, so only what is in front of them can show.
#include "methods/splatting/point.glsl"
#include "methods/splatting/sprite.glsl"

uniform sampler2D largest;
uniform int farthest;  // tiles

out vec4 reach;

void main()
{
    ivec2 tile = ivec2(gl_FragCoord.xy), size = textureSize(largest, 0);
    vec4 own = texelFetch(largest, tile, 0);
    bool sharp = SKIP == 1 && max(own.x, own.y) < SHARP;
    vec2 found = vec2(-1.0);
    ivec2 from = max(tile - farthest, ivec2(0)), to = min(tile + farthest, size - 1);
    for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) {
            // Distance between the nearest pixel centres of the two tiles, and half a pixel for a sprite's rim.
            vec2 apart = max(abs(vec2(x, y) - vec2(tile)) * float(TILE) - float(TILE - 1), vec2(0.0));
            float distance = length(apart);
            vec4 there = texelFetch(largest, ivec2(x, y), 0);
            float visible = sharp ? there.x : max(there.x, there.y);
            if (visible * EXTENT + 1.0 > distance) found.x = max(found.x, visible);
            if (!sharp && there.z * EXTENT + 1.0 > distance) found.y = max(found.y, there.z);
        }
    bool copied = sharp && found.x < SHARP;
    reach = copied ? vec4(-1.0, -1.0, 1.0, 0.0) : vec4(found * EXTENT, 0.0, 0.0);
}
