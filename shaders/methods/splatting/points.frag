// The points that are splatted: the visible image V and the hidden image H, with CoC and share packed beside the colour.
#include <Params>
#include "include/lens.glsl"
#include "methods/splatting/point.glsl"

uniform sampler2D color;
uniform sampler2D inverse_depth;
uniform sampler2D k_n;
#ifdef HIDDEN
uniform sampler2D hidden_color;
uniform sampler2D hidden_inverse_depth;
uniform sampler2D hidden_limit;
uniform vec3 background;
#endif

layout(location = 0) out vec4 visible_point;
layout(location = 1) out vec4 hidden_point;

const vec3 LUMINANCE = vec3(0.30, 0.59, 0.11);

// Eq 8: a picture that was cut off at white gets back some of what its highlights had.
vec3 extrapolate(vec3 rgb)
{
    float luminance = dot(rgb, LUMINANCE);
    if (params.extrapolate == 0 || luminance <= params.highlight_from) return rgb;
    float above = min((luminance - params.highlight_from) / (1.0 - params.highlight_from), 1.0);
    float amount = pow(above, params.highlight_falloff);
    return rgb * (1.0 - amount + amount * params.highlight_gain);
}

vec4 point(vec3 rgb, float coc)
{
    float radius = min(abs(coc), MOST_RADIUS);
    float entry = min(radius * K_N_STEPS, float(K_N_COUNT - 1));
    int below = min(int(entry), K_N_COUNT - 2);
    float k = mix(texelFetch(k_n, ivec2(below, 0), 0).r, texelFetch(k_n, ivec2(below + 1, 0), 0).r, entry - float(below));
    return pack_point(extrapolate(rgb), coc, k * (PI / 4.0));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    visible_point = point(texelFetch(color, pixel, 0).rgb, coc_radius(texelFetch(inverse_depth, pixel, 0).r));
    hidden_point = NO_POINT;
#ifdef HIDDEN
    // Where the tests let something be seen behind but no surface is there, the background is.
    vec4 hidden = texelFetch(hidden_color, pixel, 0);
    float inverse = texelFetch(hidden_inverse_depth, pixel, 0).r;
    if (texelFetch(hidden_limit, pixel, 0).r > 0.0)
        hidden_point = point(hidden.a > 0.0 ? hidden.rgb : background, coc_radius(inverse));
#endif
}
