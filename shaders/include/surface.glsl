// What a material says of the point being drawn (glTF 2.0 section 3.9): textures and factors, before any light.
#include <Material>
#include "include/surface_point.glsl"

#ifdef BASE_COLOR_MAP
uniform sampler2D base_color_map;
#endif
#ifdef METALLIC_ROUGHNESS_MAP
uniform sampler2D metallic_roughness_map;
#endif
#ifdef NORMAL_MAP
uniform sampler2D normal_map;
#endif
#ifdef OCCLUSION_MAP
uniform sampler2D occlusion_map;
#endif
#ifdef EMISSIVE_MAP
uniform sampler2D emissive_map;
#endif

uniform float lod_bias;

vec2 map_uv(vec4 row0, vec4 row1)
{
    vec3 uv = vec3(row0.w > 0.5 ? vertex.texcoord.zw : vertex.texcoord.xy, 1.0);
    return vec2(dot(row0.xyz, uv), dot(row1.xyz, uv));
}

// Normal mapping without stored tangents: the frame comes from screen derivatives of position and uv.
vec3 mapped_normal(vec3 normal)
{
#ifdef NORMAL_MAP
    vec2 uv = map_uv(material.normal_uv0, material.normal_uv1);
    vec3 dp1 = dFdx(vertex.position), dp2 = dFdy(vertex.position);
    vec2 du1 = dFdx(uv), du2 = dFdy(uv);
    vec3 across = cross(dp2, normal), along = cross(normal, dp1);
    vec3 tangent = across * du1.x + along * du2.x;
    vec3 bitangent = across * du1.y + along * du2.y;
    float longest = max(dot(tangent, tangent), dot(bitangent, bitangent));
    if (longest <= 0.0) return normal;
    vec3 texel = texture(normal_map, uv, lod_bias).xyz * 2.0 - 1.0;
    texel.xy *= material.normal_scale;
    // v runs down the picture in glTF, so the green axis is the negative bitangent.
    return normalize((tangent * texel.x - bitangent * texel.y) * inversesqrt(longest) + normal * texel.z);
#else
    return normal;
#endif
}

// A normal that turns within a pixel widens the highlight, which would alias otherwise (Tokuyoshi, Kaplanyan: Improved
// Geometric Specular Antialiasing, 2019: the listing, with its kernel of σ² = 1/2π px² and its bound).
float filtered_roughness(vec3 normal, float roughness)
{
    vec3 across = dFdx(normal) * exp2(lod_bias), along = dFdy(normal) * exp2(lod_bias);
    float kernel = min(0.318310 * (dot(across, across) + dot(along, along)), 0.18);
    float alpha = roughness * roughness;
    return sqrt(sqrt(min(alpha * alpha + kernel, 1.0)));
}

Surface read_surface()
{
    vec4 base = material.base_color * vertex.color;
#ifdef BASE_COLOR_MAP
    base *= texture(base_color_map, map_uv(material.base_color_uv0, material.base_color_uv1), lod_bias);
#endif
    Surface surface = Surface(base.rgb, base.a, vec3(0.0), material.metallic, material.roughness, 1.0, vec3(0.0));
#ifndef UNLIT
    vec3 normal = normalize(vertex.normal);
    surface.normal = mapped_normal(gl_FrontFacing ? normal : -normal);
    surface.emissive = material.emissive.rgb;
#ifdef METALLIC_ROUGHNESS_MAP
    vec4 mr = texture(metallic_roughness_map,
        map_uv(material.metallic_roughness_uv0, material.metallic_roughness_uv1), lod_bias);
    surface.metallic *= mr.b;
    surface.roughness *= mr.g;
#endif
    surface.roughness = filtered_roughness(surface.normal, surface.roughness);
#ifdef OCCLUSION_MAP
    float occlusion = texture(occlusion_map, map_uv(material.occlusion_uv0, material.occlusion_uv1), lod_bias).r;
    surface.occlusion = 1.0 + material.occlusion_strength * (occlusion - 1.0);
#endif
#ifdef EMISSIVE_MAP
    surface.emissive *= texture(emissive_map, map_uv(material.emissive_uv0, material.emissive_uv1), lod_bias).rgb;
#endif
#endif
    return surface;
}
