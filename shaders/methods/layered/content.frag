// Where the surfaces of a cell of CELL x CELL pixels are in depth: 128 slices, a bit each, evenly in 1/z from the nearest
// surface of the picture to the farthest. Of the cell's own first and last slice, which often hold one thin surface alone,
// the extremes are known instead, and their bits are not set. Of the peels those from FIRST on count.
#include "include/texel.glsl"

uniform sampler2D depths_first;
#if PEELS > 4
uniform sampler2D depths_last;
#endif
uniform float nearest;
uniform float slices_per_depth;
uniform bool background_counts;

layout(location = 0) out uvec4 bits;
layout(location = 1) out vec4 extremes;  // greatest and least 1/z of the first slice, greatest and least of the last
layout(location = 2) out float farthest;  // least 1/z of what is visible, 0 where it is background

uint slice_of(float inverse_depth)
{
    return uint(clamp((nearest - inverse_depth) * slices_per_depth, 0.0, 127.0));
}

uvec4 bit_of(uint slice)
{
    uint bit = 1u << (slice & 31u), word = slice >> 5;
    return uvec4(word == 0u ? bit : 0u, word == 1u ? bit : 0u, word == 2u ? bit : 0u, word == 3u ? bit : 0u);
}

void main()
{
    ivec2 from = ivec2(gl_FragCoord.xy) * CELL, to = min(from + CELL, textureSize(depths_first, 0));
    float inverse_depths[8], least = background_counts ? 0.0 : 1e-37;
    uint first = 128u, last = 0u;
    bits = uvec4(0u);
    farthest = 3e38;
    extremes = vec4(-1.0, 3e38, -1.0, 3e38);
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) {
            vec4 depths = texel_of(depths_first, ivec2(x, y));
            farthest = min(farthest, max(depths.x, 0.0));
            for (int m = 0; m < 4; ++m) inverse_depths[m] = depths[m];
#if PEELS > 4
            depths = texel_of(depths_last, ivec2(x, y));
            for (int m = 0; m < 4; ++m) inverse_depths[4 + m] = depths[m];
#endif
            for (int m = FIRST; m < PEELS; ++m) {
                float z = inverse_depths[m];
                if (z < least) continue;
                uint slice = slice_of(z);
                bits |= bit_of(slice);
                extremes.x = max(extremes.x, z);
                extremes.y = slice < first ? z : slice == first ? min(extremes.y, z) : extremes.y;
                extremes.z = slice > last ? z : slice == last ? max(extremes.z, z) : extremes.z;
                extremes.w = min(extremes.w, z);
                first = min(first, slice);
                last = max(last, slice);
            }
        }
    if (first < 128u) bits &= ~(bit_of(first) | bit_of(last));
}
