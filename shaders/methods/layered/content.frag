// Where the surfaces of a cell of CELL x CELL pixels are in depth: 128 slices, a bit each, evenly in 1/z from the nearest
// surface of the picture to the farthest. Of the cell's own first and last slice, which often hold one thin surface alone,
// the extremes are known instead, and their bits are not set.
uniform sampler2D depths_first;
#if PEELS > 4
uniform sampler2D depths_last;
#endif
uniform float nearest;
uniform float slices_per_depth;
uniform bool background_counts;

layout(location = 0) out uvec4 bits;
layout(location = 1) out vec4 extremes;  // greatest and least 1/z of the first slice, greatest and least of the last
layout(location = 2) out float sky;  // 1 where background can be seen

uint slice_of(float inverse_depth)
{
    return uint(clamp((nearest - inverse_depth) * slices_per_depth, 0.0, 127.0));
}

uvec4 bit_of(uint slice)
{
    uint bit = 1u << (slice & 31u), word = slice >> 5;
    return uvec4(word == 0u ? bit : 0u, word == 1u ? bit : 0u, word == 2u ? bit : 0u, word == 3u ? bit : 0u);
}

void surfaces(ivec2 pixel, out float inverse_depths[PEELS])
{
    vec4 depths = texelFetch(depths_first, pixel, 0);
    for (int m = 0; m < min(PEELS, 4); ++m) inverse_depths[m] = depths[m];
#if PEELS > 4
    depths = texelFetch(depths_last, pixel, 0);
    for (int m = 4; m < PEELS; ++m) inverse_depths[m] = depths[m - 4];
#endif
}

void main()
{
    ivec2 from = ivec2(gl_FragCoord.xy) * CELL, to = min(from + CELL, textureSize(depths_first, 0));
    float inverse_depths[PEELS], least = background_counts ? 0.0 : 1e-37;
    bits = uvec4(0u);
    sky = 0.0;
    extremes = vec4(-1.0, 3e38, -1.0, 3e38);
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) {
            surfaces(ivec2(x, y), inverse_depths);
            if (inverse_depths[0] <= 0.0) sky = 1.0;
            for (int m = 0; m < PEELS; ++m) {
                float z = inverse_depths[m];
                if (z < least) continue;
                bits |= bit_of(slice_of(z));
                extremes.x = max(extremes.x, z);
                extremes.w = min(extremes.w, z);
            }
        }
    uint first = slice_of(extremes.x), last = slice_of(extremes.w);
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) {
            surfaces(ivec2(x, y), inverse_depths);
            for (int m = 0; m < PEELS; ++m) {
                float z = inverse_depths[m];
                if (z < least) continue;
                if (slice_of(z) == first) extremes.y = min(extremes.y, z);
                if (slice_of(z) == last) extremes.z = max(extremes.z, z);
            }
        }
    bits &= ~(bit_of(first) | bit_of(last));
}
