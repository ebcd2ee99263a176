// The second pass of the paper's layering (Lee 2009 section 4.2): of all texels that lie at this pixel and belong to layer
// `layer`, the nearest, whichever layer their triangle was drawn into. Texels within the overlap belong to both layers.
#include "methods/multiview/slabs.glsl"

uniform sampler2DArray layer_color;
uniform sampler2DArray layer_inverse_depth;
#ifdef SURFACES
uniform sampler2DArray layer_normal;
uniform sampler2DArray layer_emissive;
uniform sampler2DArray layer_occlusion;
#endif
uniform int layer;

layout(location = 0) out vec4 color;
layout(location = 1) out float inverse_depth;
#ifdef SURFACES
layout(location = 2) out vec4 normal_roughness;
layout(location = 3) out vec4 emissive_metallic;
layout(location = 4) out float occlusion;
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int from = 0;
    inverse_depth = 0.0;
    for (int k = 0; k < slabs.count; ++k) {
        float there = texelFetch(layer_inverse_depth, ivec3(pixel, k), 0).r;
        if (there > inverse_depth && slab_holds(layer, there)) inverse_depth = there, from = k;
    }
    bool empty = inverse_depth == 0.0;
    color = empty ? vec4(0.0) : texelFetch(layer_color, ivec3(pixel, from), 0);
#ifdef SURFACES
    normal_roughness = empty ? vec4(0.0) : texelFetch(layer_normal, ivec3(pixel, from), 0);
    emissive_metallic = empty ? vec4(0.0) : texelFetch(layer_emissive, ivec3(pixel, from), 0);
    occlusion = empty ? 0.0 : texelFetch(layer_occlusion, ivec3(pixel, from), 0).r;
#endif
}
