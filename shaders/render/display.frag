// Linear light to what a screen shows: exposure, tone curve, sRGB.
#include "include/srgb.glsl"
#include <Display>

uniform sampler2D picture;

out vec4 color;

// Reinhard et al. 2002 eq 3 without the log-average: the key `a` scales, bright light compresses (a = 0.72 in Lee 2008).
vec3 reinhard(vec3 x)
{
    x *= 0.72;
    return x / (1.0 + x);
}

// Narkowicz 2015, a rational fit of the ACES reference rendering transform.
vec3 aces(vec3 x)
{
    return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
}

// Khronos PBR neutral tone mapper (2024): base colours below 0.8 stay as they are, highlights roll off to white.
vec3 neutral(vec3 x)
{
    const float START = 0.8 - 0.04, DESATURATION = 0.15;
    float least = min(x.r, min(x.g, x.b));
    x -= least < 0.08 ? least - 6.25 * least * least : 0.04;
    float peak = max(x.r, max(x.g, x.b));
    if (peak < START) return x;
    float room = 1.0 - START;
    float compressed = 1.0 - room * room / (peak + room - START);
    x *= compressed / peak;
    float mixing = 1.0 - 1.0 / (DESATURATION * (peak - compressed) + 1.0);
    return mix(x, vec3(compressed), mixing);
}

void main()
{
    vec3 light = texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb * exp2(display.exposure_ev);
    if (display.tonemap == TONEMAP_REINHARD) light = reinhard(light);
    else if (display.tonemap == TONEMAP_ACES) light = aces(light);
    else if (display.tonemap == TONEMAP_NEUTRAL) light = neutral(light);
    color = vec4(srgb_encode(light), 1.0);
}
