// What is not known of a level from the filled level above it, enlarged by biquadratic B-splines; what is known stays.
#include <KNOWN>

uniform sampler2D coarse_colors;
#ifndef COLOR_ALONE
uniform sampler2D coarse_extras;
#endif

layout(location = 0) out vec4 color;
#ifdef COLOR_ALONE
float extra;
#else
layout(location = 1) out float extra;
#endif

void main()
{
    known(ivec2(gl_FragCoord.xy), color, extra);
    vec2 place = gl_FragCoord.xy * 0.5 / vec2(textureSize(coarse_colors, 0));
    float missing = 1.0 - color.a;
    color += missing * texture(coarse_colors, place);
#ifndef COLOR_ALONE
    extra += missing * texture(coarse_extras, place).r;
#endif
}
