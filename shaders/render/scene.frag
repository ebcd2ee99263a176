// One visible surface per pixel: its linear colour and its inverse depth 1/z.
//
// A pass that wants other than the nearest surface names a file in the define REJECT, which declares
//     bool reject(float inverse_depth, ivec2 pixel)
// and says which fragments to leave out.
in Vertex
{
    vec3 position;
    vec3 normal;
    vec4 color;
    vec4 texcoord;
} vertex;

#include "include/surface.glsl"
#ifndef UNLIT
#include "include/shading.glsl"
#endif
#include <REJECT>

uniform vec3 eye;  // lens centre or lens sample, local space

layout(location = 0) out vec4 color;
layout(location = 1) out float inverse_depth;

// Far above any display, far below what fp16 or a sum of 4096 views can hold; NaN becomes 0.
const float BRIGHTEST = 1e4;

void main()
{
    // gl_FragCoord.w is 1/w of the clip position, and w is the view depth: exact, with no depth buffer in between.
    inverse_depth = gl_FragCoord.w;
#ifdef HAS_REJECT
    if (reject(inverse_depth, ivec2(gl_FragCoord.xy))) discard;
#endif
    Surface surface = read_surface();
#ifdef ALPHA_TEST
    if (surface.alpha < material.alpha_cutoff) discard;
#endif
#ifdef UNLIT
    vec3 radiance = surface.base_color;
#else
    vec3 radiance = shade(surface, normalize(eye - vertex.position));
#endif
    color = vec4(mix(vec3(0.0), min(radiance, BRIGHTEST), greaterThan(radiance, vec3(0.0))), 1.0);
}
