// One channel, or three, of any image as grey or colour between the ends of a range; not-a-number is magenta. With VALUE
// the target is one texel, and holds what the image holds at `texel`, unchanged.
#include "include/srgb.glsl"
#include <Inspect>

#if defined(INTEGER) && defined(LAYERED)
uniform usampler2DArray source;
#elif defined(INTEGER)
uniform usampler2D source;
#elif defined(LAYERED)
uniform sampler2DArray source;
#else
uniform sampler2D source;
#endif

#ifdef VALUE
uniform ivec2 texel;
#endif

out vec4 color;

const vec3 NOT_A_NUMBER = vec3(1.0, 0.0, 1.0);

void main()
{
#ifndef VALUE
    ivec2 texel = ivec2(gl_FragCoord.xy);
#endif
#ifdef LAYERED
    vec4 found = vec4(texelFetch(source, ivec3(texel, inspect.layer), 0));
#else
    vec4 found = vec4(texelFetch(source, texel, 0));
#endif
#ifdef VALUE
    color = found;
#else
    vec3 value = inspect.channel == CHANNEL_COLOUR ? found.rgb : vec3(found[max(inspect.channel - 1, 0)]);
    value = (value - inspect.low) / (inspect.high - inspect.low);
    bool light = inspect.light != 0 && inspect.channel == CHANNEL_COLOUR;
    color = vec4(any(isnan(value)) ? NOT_A_NUMBER : light ? srgb_encode(value) : clamp(value, 0.0, 1.0), 1.0);
#endif
}
