// The difference of two pictures as a colour, in sRGB values as PSNR compares them. One-sided differences take cividis
// (Nuñez, Anderton and Renslow 2018: even steps of lightness, the same with red-green blindness); signed ones go from
// blue (first is darker) over grey to orange (first is brighter). With LEGEND the target is the scale itself, in x.
#include "include/srgb.glsl"
#include <Heat>

#ifndef LEGEND
uniform sampler2D first;
uniform sampler2D second;
#else
const float LEGEND_PX = 256.0;
#endif

out vec4 color;

// Below this a relative difference is one of the darkest tones, which nobody sees.
const float DARKEST = 1.0 / 64.0;

// cividis at 0, 1/8 … 1.
const vec3 CIVIDIS[9] = vec3[](
    vec3(0.000, 0.135, 0.305), vec3(0.103, 0.220, 0.436), vec3(0.264, 0.308, 0.423), vec3(0.381, 0.395, 0.436),
    vec3(0.489, 0.485, 0.471), vec3(0.609, 0.580, 0.464), vec3(0.736, 0.681, 0.424), vec3(0.871, 0.790, 0.343),
    vec3(0.996, 0.909, 0.218));

const vec3 BLUE = vec3(0.20, 0.55, 1.00), GREY = vec3(0.16), ORANGE = vec3(1.00, 0.60, 0.10);

vec3 one_sided(float x)
{
    float at = clamp(x, 0.0, 1.0) * 8.0;
    int low = min(int(at), 7);
    return mix(CIVIDIS[low], CIVIDIS[low + 1], at - float(low));
}

vec3 signed_colour(float x)
{
    return x < 0.0 ? mix(GREY, BLUE, min(-x, 1.0)) : mix(GREY, ORANGE, min(x, 1.0));
}

void main()
{
#ifdef LEGEND
    float value = gl_FragCoord.x / LEGEND_PX;
    if (heat.difference == DIFFERENCE_SIGNED) value = 2.0 * value - 1.0;
#else
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 a = srgb_encode(texelFetch(first, pixel, 0).rgb), b = srgb_encode(texelFetch(second, pixel, 0).rgb);
    vec3 d = a - b;
    if (heat.difference == DIFFERENCE_ABSOLUTE) d = abs(d);
    else if (heat.difference == DIFFERENCE_SQUARED) d *= d;
    else if (heat.difference == DIFFERENCE_RELATIVE) d = abs(d) / max(b, DARKEST);
    float value = dot(d, vec3(1.0 / 3.0)) * heat.gain;
#endif
    color = vec4(heat.difference == DIFFERENCE_SIGNED ? signed_colour(value) : one_sided(value), 1.0);
}
