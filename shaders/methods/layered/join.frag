// One step of the recursion: a layer joins the buffer. What it joins is, by SOURCE,
//     0  what a buffer holds before its first layer,
//     1  the buffer blurred across, which is blurred along y here,
//     2  the buffer at one texel for 2^LEVEL x 2^LEVEL pixels,
//     3  the buffer at half the size, which is enlarged here by the biquadratic B-spline.
//
// With ADDED it is only what the layer adds to the buffer in front, or what is to be blended over the one behind, to be
// reduced to the buffer's size.
#include "methods/layered/matte.glsl"

uniform sampler2D buffered;  // of SOURCE 1 and 2 the nearest texel
uniform vec4 start;
#if SOURCE == 1
uniform float weights[TAPS];
#endif

out vec4 color;

vec4 before()
{
#if SOURCE == 0
    return start;
#elif SOURCE == 1
    vec2 place = gl_FragCoord.xy * pixel_size, along = vec2(0.0, pixel_size.y);
    vec4 sum = weights[0] * textureLod(buffered, place, 0.0);
    for (int i = 1; i < TAPS; ++i)
        sum += weights[i]
            * (textureLod(buffered, place - float(i) * along, 0.0) + textureLod(buffered, place + float(i) * along, 0.0));
    return sum;
#elif SOURCE == 2
    return textureLod(buffered, gl_FragCoord.xy / (float(1 << LEVEL) * vec2(textureSize(buffered, 0))), 0.0);
#elif SOURCE == 3
    return texture(buffered, gl_FragCoord.xy * 0.5 / vec2(textureSize(buffered, 0)));
#endif
}

vec4 joined(vec4 buffer, vec2 place)
{
#ifdef FRONT
#ifdef ADDED
    return under(buffer, place) - buffer;
#else
    return under(buffer, place);
#endif
#else
    vec4 nearer = layer(place);
#ifdef ADDED
    return nearer;
#else
    return nearer + (1.0 - nearer.a) * buffer;
#endif
#endif
}

void main()
{
    color = joined(before(), gl_FragCoord.xy * pixel_size);
}
