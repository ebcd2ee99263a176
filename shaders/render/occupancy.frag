// Bits of the depths that occur in blocks of BLOCK x BLOCK, 128 equal parts of 1/z from `farthest` on. The first level
// reads an inverse depth image (FIRST), the others the level before. Empty pixels set no bit.
uniform float farthest;
uniform float scale;  // parts per unit of 1/z

#ifdef FIRST
uniform sampler2D source;
#else
uniform usampler2D source;
#endif

out uvec4 bits;

void main()
{
    ivec2 size = textureSize(source, 0);
    ivec2 from = ivec2(gl_FragCoord.xy) * BLOCK;
    ivec2 to = min(from + BLOCK, size);
    bits = uvec4(0u);
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) {
#ifdef FIRST
            float inverse_depth = texelFetch(source, ivec2(x, y), 0).r;
            if (inverse_depth <= 0.0) continue;
            int part = clamp(int((inverse_depth - farthest) * scale), 0, 127);
            bits |= uvec4(equal(ivec4(part >> 5), ivec4(0, 1, 2, 3))) << uint(part & 31);
#else
            bits |= texelFetch(source, ivec2(x, y), 0);
#endif
        }
}
