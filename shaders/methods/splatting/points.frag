// The points that are splatted: the visible image V and the hidden image H, with CoC and share packed beside the colour.
// `other_point` takes those that keep their own sprites while others are merged; in the paper's way, those to be merged.
#include <Params>
#include "include/lens.glsl"
#include "methods/splatting/point.glsl"
#include "methods/splatting/sprite.glsl"

uniform sampler2D color;
uniform sampler2D inverse_depth;
uniform sampler2D k_n;
#ifdef HIDDEN
uniform sampler2D hidden_color;
uniform sampler2D hidden_inverse_depth;
uniform sampler2D hidden_limit;
uniform vec3 background;
#endif
#if LEVELS > 0 && !defined BY_PAPER
uniform sampler2D brightness_1;
uniform sampler2D brightness_2;
uniform sampler2D brightness_3;
#endif

layout(location = 0) out vec4 visible_point;
layout(location = 1) out vec4 hidden_point;
layout(location = 2) out vec4 other_point;

const vec3 LUMINANCE = vec3(0.30, 0.59, 0.11);

// Eq 8: a picture that was cut off at white gets back some of what its highlights had.
vec3 extrapolate(vec3 rgb)
{
#ifdef EXTRAPOLATE
    float above = (dot(rgb, LUMINANCE) - params.highlight_from) / (1.0 - params.highlight_from);
    float amount = pow(clamp(above, 0.0, 1.0), params.highlight_falloff);
    rgb *= 1.0 - amount + amount * params.highlight_gain;
#endif
    return rgb;
}

vec4 point(vec3 rgb, float coc)
{
    coc = rounded_coc(coc);
    float radius = sprite_radius(coc, 0), entry = min(abs(coc) * K_N_STEPS, float(K_N_COUNT - 1));
    int below = min(int(entry), K_N_COUNT - 2);
    float k = mix(texelFetch(k_n, ivec2(below, 0), 0).r, texelFetch(k_n, ivec2(below + 1, 0), 0).r, entry - float(below));
    // A pixel in focus is its own sprite, and must come out opaque to the last bit.
    if (abs(coc) <= sharp_radius()) k = 4.0 * radius * radius / sprite(vec2(0.0), radius, 0);
    return pack_point(extrapolate(rgb), coc, k * (PI / 4.0));
}

#if LEVELS > 0 && !defined BY_PAPER
// Whether the rim of this point's sprite would be seen to be as soft as the block that it would be merged into: it stands
// out of the block by more than white, and its sprite by more than a step of 8 bits; or it is alone in the dark.
bool sparkles(ivec2 pixel, float luminance, float radius)
{
    float around = texelFetch(brightness_3, pixel / 8, 0).r, mean = around;
    if (LEVELS == 1 || radius < 2.0 * REDUCED_FROM) mean = texelFetch(brightness_1, pixel / 2, 0).r;
    else if (LEVELS == 2 || radius < 4.0 * REDUCED_FROM) mean = texelFetch(brightness_2, pixel / 4, 0).r;
    return luminance - mean > max(1.0, PI * radius * radius / 255.0) || luminance > max(0.05, 16.0 * around);
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 rgb = texelFetch(color, pixel, 0).rgb;
    float coc = coc_radius(texelFetch(inverse_depth, pixel, 0).r);
    visible_point = point(rgb, coc);
    hidden_point = other_point = NO_POINT;
#ifdef HIDDEN
    // Where the tests let something be seen behind but no surface is there, the background is.
    vec2 limit = texelFetch(hidden_limit, pixel, 0).rg;
    vec4 hidden = texelFetch(hidden_color, pixel, 0);
    if (limit.x > 0.0)
        hidden_point = point(hidden.a > 0.0 ? hidden.rgb : background,
            coc_radius(texelFetch(hidden_inverse_depth, pixel, 0).r));
#else
    const vec2 limit = vec2(0.0);
#endif
#if LEVELS > 0
    if (abs(coc) < REDUCED_FROM) return;
#ifdef BY_PAPER
    // Section 5: partial occlusion keeps its resolution; the second mask is smaller, so that the two overlap.
    if (limit.y <= 0.0) other_point = visible_point;
    if (limit.x <= 0.0) visible_point.a = floor(visible_point.a);
#else
    if (sparkles(pixel, dot(visible_point.rgb, LUMINANCE), abs(coc))) {
        other_point = visible_point;
        visible_point.a = floor(visible_point.a);
    }
#endif
#endif
}
