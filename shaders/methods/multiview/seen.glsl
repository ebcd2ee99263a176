// What a ray sees where it meets a layer: the colour that the lens centre saw, or, with SURFACES, the surface lit for the
// point of the lens that the ray came from. Premultiplied by how much of the cone around the ray the layer covers.
#include "methods/multiview/cones.glsl"
#include "methods/multiview/grid.glsl"

uniform sampler2DArray layer_color;

#ifdef SURFACES
uniform sampler2DArray layer_normal;
uniform sampler2DArray layer_emissive;
uniform sampler2DArray layer_occlusion;
uniform sampler2DArray layer_light;  // in cones alone: see cones.frag
#endif

// `layer` at texel position `q`, or averaged over the cone around it.
vec4 read_layer(sampler2DArray layer, vec2 q, int k)
{
#if CONES
    vec2 at = (q / vec2(textureSize(layer, 0).xy) - 0.5) / square(k) + 0.5;
    return textureLod(layer, vec3(at, float(k)), 0.0);
#else
    return texelFetch(layer, ivec3(floor(q), k), 0);
#endif
}

// At texel position `q` of layer `k` and depth 1 / `inverse_depth`.
vec4 seen(vec2 q, int k, float inverse_depth, vec2 lens_point)
{
    vec4 color = read_layer(layer_color, q, k);
#ifdef SURFACES
    if (color.a <= 0.0) return vec4(0.0);
    vec3 from_center = toward(q);
    vec3 to_eye = normalize(lens_point.x * view.lens_right + lens_point.y * view.lens_up - from_center / inverse_depth);
    float whole = 1.0 / color.a, occlusion = read_layer(layer_occlusion, q, k).r * whole;
    vec4 base = vec4(color.rgb * whole, 1.0), normal = read_layer(layer_normal, q, k) * whole;
#if CONES
    // Shading is far from linear, so the mean surface is not lit as its parts are: where two meet it may reflect what neither
    // does. The mean of their light for the lens centre is known, and the mean surface only says how that changes.
    vec4 light = read_layer(layer_light, q, k) * whole, metallic = vec4(0.0, 0.0, 0.0, light.w);
    float length_ = length(normal.xyz);
    normal.xyz = length_ > 0.0 ? normal.xyz / length_ : vec3(0.0);
    vec3 change = lit(base, normal, metallic, occlusion, to_eye) - lit(base, normal, metallic, occlusion, -normalize(from_center));
    color.rgb = max(light.rgb + change, 0.0) * color.a;
#else
    color.rgb = lit(base, normal, read_layer(layer_emissive, q, k), occlusion, to_eye);
#endif
#endif
    return color;
}
