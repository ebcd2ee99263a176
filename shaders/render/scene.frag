// One visible surface per pixel: its linear colour and its inverse depth 1/z.
//
// A pass that wants other than the nearest surface names a file in the define REJECT, which declares
//     bool reject(float inverse_depth, ivec2 pixel)
// and says which fragments to leave out. One that wants surfaces instead of light, to shade them later, defines SURFACES:
// the colour is then the base colour, and normal, roughness, emission, metalness and occlusion follow the depth. One that
// wants nothing but depth, to find out first which fragments need be shaded at all, defines DEPTH_ONLY.
//
// A surface that is seen through is drawn by BLENDED with its opacity in alpha, to be laid over what is there. Where it
// is the last thing there is, it counts as a surface of its own: AT_INFINITY finds the pixels that have no other.
in Vertex
{
    vec3 position;
    vec3 normal;
    vec4 color;
    vec4 texcoord;
} vertex;

#include "include/surface.glsl"
#if !defined(UNLIT) && !defined(SURFACES) && !defined(DEPTH_ONLY)
#include "include/shading.glsl"
#endif
#include <REJECT>

uniform vec3 eye;  // lens centre or lens sample, local space
#ifdef LOG_DEPTH
uniform vec2 log_depth;  // log2 of the nearest depth, 1 / log2 of the farthest over it
#endif

#ifdef WINDOW_DEPTH
layout(location = 0) out vec2 depths;
#elif defined(DEPTH_ONLY)
layout(location = 0) out float inverse_depth;
#else
layout(location = 0) out vec4 color;
layout(location = 1) out float inverse_depth;
#endif
#ifdef SURFACES
layout(location = 2) out vec4 normal_roughness;
layout(location = 3) out vec4 emissive_metallic;
layout(location = 4) out float occlusion;
#endif

// Far above any display, far below what fp16 or a sum of 4096 views can hold; NaN becomes 0.
const float BRIGHTEST = 1e4;

vec4 light(vec3 radiance)
{
    return vec4(mix(vec3(0.0), min(radiance, BRIGHTEST), greaterThan(radiance, vec3(0.0))), 1.0);
}

void main()
{
    // gl_FragCoord.w is 1/w of the clip position, and w is the view depth: exact, with no depth buffer in between.
#ifdef LOG_DEPTH
    gl_FragDepth = clamp((-log2(gl_FragCoord.w) - log_depth.x) * log_depth.y, 0.0, 1.0);
#endif
#ifdef WINDOW_DEPTH
    float inverse_depth = gl_FragCoord.w;
#ifdef LOG_DEPTH
    depths = vec2(inverse_depth, -gl_FragDepth);
#else
    depths = vec2(inverse_depth, -gl_FragCoord.z);
#endif
#else
    inverse_depth = gl_FragCoord.w;
#endif
#ifdef HAS_REJECT
    if (reject(inverse_depth, ivec2(gl_FragCoord.xy))) discard;
#endif
#if !defined(DEPTH_ONLY) || defined(ALPHA_TEST)
    Surface surface = read_surface();
#endif
#ifdef ALPHA_TEST
#if defined(AT_INFINITY)
    if (surface.alpha < 1.0 / 255.0) discard;
    gl_FragDepth = 1.0;
#elif !defined(BLENDED)
    if (surface.alpha < material.alpha_cutoff) discard;
#endif
#endif
#if defined(DEPTH_ONLY)
    return;
#elif defined(SURFACES) && defined(UNLIT)
    // Without a normal and with everything occluded, shading leaves the emission alone.
    color = vec4(0.0, 0.0, 0.0, 1.0);
    normal_roughness = vec4(0.0, 0.0, 0.0, 1.0);
    emissive_metallic = vec4(light(surface.base_color).rgb, 0.0);
    occlusion = 0.0;
#elif defined(SURFACES)
    color = light(surface.base_color);
    normal_roughness = vec4(surface.normal, surface.roughness);
    emissive_metallic = vec4(light(surface.emissive).rgb, surface.metallic);
    occlusion = surface.occlusion;
#elif defined(UNLIT)
    color = light(surface.base_color);
#else
    color = light(shade(surface, normalize(eye - vertex.position)));
#endif
#ifdef BLENDED
    color.a = clamp(surface.alpha, 0.0, 1.0);
#endif
}
