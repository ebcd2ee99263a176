// One bit per layer: set where the layer holds a surface in any of a square of SIDE by SIDE texels.
#include <Slabs>

uniform sampler2DArray layer_inverse_depth;

out uint occupied;

void main()
{
    ivec2 from = ivec2(gl_FragCoord.xy) * SIDE, size = textureSize(layer_inverse_depth, 0).xy;
    occupied = 0u;
    for (int k = 0; k < slabs.count; ++k) {
        float nearest = 0.0;
#if SIDE % 2 == 0 && __VERSION__ >= 400
        // Four texels at once; beyond the border it reads those at the border again.
        vec4 four = vec4(0.0);
        for (int y = 1; y < SIDE; y += 2)
            for (int x = 1; x < SIDE; x += 2)
                four = max(four, textureGather(layer_inverse_depth, vec3(vec2(from + ivec2(x, y)) / vec2(size), k)));
        nearest = max(max(four.x, four.y), max(four.z, four.w));
#else
        for (int i = 0; i < SIDE * SIDE; ++i) {
            ivec2 texel = min(from + ivec2(i % SIDE, i / SIDE), size - 1);
            nearest = max(nearest, texelFetch(layer_inverse_depth, ivec3(texel, k), 0).r);
        }
#endif
        if (nearest > 0.0) occupied |= 1u << k;
    }
}
