// Metallic-roughness shading (glTF 2.0 appendix B: GGX, Smith, Schlick) under three directional lights that stand with
// the camera, and a soft sky. The lights follow the lens centre, not the lens sample, so all views see the same light.
// Where there is an environment it takes the place of the sky, and the lights are dark.
#include <Lights>
#include "include/surface_point.glsl"
#ifdef ENVIRONMENT_LEVELS
#include "include/equirect.glsl"
uniform sampler2D environment_map;
#endif

const float PI = 3.14159265;
const float LAMP = 0.03;  // half the tangent of a lamp's angular radius: some 7 degrees across, as a softbox in a studio

float distribution_ggx(float n_h, float alpha)
{
    float a2 = alpha * alpha;
    float d = n_h * n_h * (a2 - 1.0) + 1.0;
    return a2 / (PI * d * d);
}

// Smith visibility over 4 n.l n.v, height-correlated (Heitz 2014).
float visibility_smith(float n_l, float n_v, float alpha)
{
    float a2 = alpha * alpha;
    float l = n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
    float v = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2);
    return 0.5 / max(l + v, 1e-5);
}

vec3 direct_light(Surface surface, vec3 diffuse, vec3 f0, vec3 to_eye, vec3 to_light, vec3 radiance)
{
    float n_l = dot(surface.normal, to_light);
    if (n_l <= 0.0) return vec3(0.0);
    // As wide as the lamp's image, with the same energy (Karis: Real Shading in Unreal Engine 4, 2013, area lights).
    float alpha = length(vec2(surface.roughness * surface.roughness, LAMP));
    vec3 halfway = normalize(to_light + to_eye);
    float n_v = max(dot(surface.normal, to_eye), 1e-4);
    float n_h = clamp(dot(surface.normal, halfway), 0.0, 1.0);
    float grazing = 1.0 - clamp(dot(to_eye, halfway), 0.0, 1.0);
    float grazing2 = grazing * grazing;
    vec3 fresnel = f0 + (1.0 - f0) * (grazing2 * grazing2 * grazing);
    float specular = distribution_ggx(n_h, alpha) * visibility_smith(n_l, n_v, alpha);
    return ((1.0 - fresnel) * diffuse / PI + fresnel * specular) * radiance * n_l;
}

// Radiance of the sky from `direction`, blurred by `roughness`: a smooth gradient along the camera's up.
vec3 sky(vec3 direction, float roughness)
{
#ifdef ENVIRONMENT_LEVELS
    return textureLod(environment_map, equirect(direction), roughness * float(ENVIRONMENT_LEVELS - 1)).rgb;
#endif
    float height = dot(direction, lights.up.xyz);
    float edge = mix(0.15, 1.0, roughness);
    return mix(lights.ground.rgb, lights.zenith.rgb, smoothstep(-edge, edge, height));
}

// Split-sum environment reflectance, Karis' analytic fit (Unreal Engine 4 mobile, 2014).
vec3 environment_brdf(vec3 f0, float roughness, float n_v)
{
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a004 = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    vec2 ab = vec2(-1.04, 1.04) * a004 + r.zw;
    return f0 * ab.x + ab.y;
}

vec3 shade(Surface surface, vec3 to_eye)
{
    vec3 diffuse = surface.base_color * (1.0 - surface.metallic);
    vec3 f0 = mix(vec3(0.04), surface.base_color, surface.metallic);
    vec3 color = surface.emissive;
    color += direct_light(surface, diffuse, f0, to_eye, lights.key_direction.xyz, lights.key_radiance.rgb);
    color += direct_light(surface, diffuse, f0, to_eye, lights.fill_direction.xyz, lights.fill_radiance.rgb);
    color += direct_light(surface, diffuse, f0, to_eye, lights.back_direction.xyz, lights.back_radiance.rgb);
    float n_v = clamp(dot(surface.normal, to_eye), 0.0, 1.0);
    vec3 ambient = diffuse * sky(surface.normal, 1.0);
    ambient += environment_brdf(f0, surface.roughness, n_v) * sky(reflect(-to_eye, surface.normal), surface.roughness);
    return color + ambient * surface.occlusion;
}
