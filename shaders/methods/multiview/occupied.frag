// One bit per layer: set where the layer holds a surface in any of the pixel's DETAIL by DETAIL texels.
#include <Slabs>

uniform sampler2DArray layer_inverse_depth;

out uint occupied;

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy) * DETAIL;
    occupied = 0u;
    for (int k = 0; k < slabs.count; ++k) {
#if DETAIL == 2 && __VERSION__ >= 400
        vec4 depths = textureGather(layer_inverse_depth, vec3(vec2(texel + 1) / vec2(textureSize(layer_inverse_depth, 0).xy), k));
        bool any_ = any(greaterThan(depths, vec4(0.0)));
#else
        bool any_ = false;
        for (int i = 0; i < DETAIL * DETAIL; ++i)
            any_ = any_ || texelFetch(layer_inverse_depth, ivec3(texel + ivec2(i % DETAIL, i / DETAIL), k), 0).r > 0.0;
#endif
        if (any_) occupied |= 1u << k;
    }
}
