// What a ray sees where it meets a layer: the colour that the lens centre saw, or, with SURFACES, the surface lit for the
// point of the lens that the ray came from. Premultiplied by how much of the cone around the ray the layer covers.
#include "methods/multiview/cones.glsl"

uniform sampler2DArray layer_color;

#ifdef SURFACES
#include "include/shading.glsl"
#include <View>

uniform sampler2DArray layer_normal;
uniform sampler2DArray layer_emissive;
uniform sampler2DArray layer_occlusion;
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
    float whole = 1.0 / color.a;
    vec4 normal = read_layer(layer_normal, q, k) * whole;
    vec4 emissive = read_layer(layer_emissive, q, k) * whole;
    float occlusion = read_layer(layer_occlusion, q, k).r * whole;
    vec2 pixel = q / detail + detail_shift;
    vec3 toward = view.corner + pixel.x * view.right + pixel.y * view.up;
    vec3 to_eye = lens_point.x * view.lens_right + lens_point.y * view.lens_up - toward / inverse_depth;
    float length_ = length(normal.xyz);
    Surface surface = Surface(
        color.rgb * whole, 1.0, length_ > 0.0 ? normal.xyz / length_ : vec3(0.0), emissive.w, normal.w, occlusion,
        emissive.rgb
    );
    color.rgb = min(shade(surface, normalize(to_eye)), 1e4) * color.a;
#endif
    return color;
}
