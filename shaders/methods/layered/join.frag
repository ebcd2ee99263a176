// One step of the recursion: a layer joins the buffer, at full size or, where the blur to come hides the difference, at
// one texel for LEVEL x LEVEL pixels. What it joins is, by SOURCE,
//     0  what a buffer holds before its first layer,
//     1  the buffer blurred across, which is blurred along y here,
//     2  the buffer at half the size, which is enlarged here by the biquadratic B-spline.
//
// With ADDED it is only what the layer adds to the buffer in front, or what is to be blended over the one behind.
#include "methods/layered/matte.glsl"

uniform sampler2D buffered;
uniform vec4 start;
#if SOURCE == 1
uniform float weights[TAPS];
#endif

out vec4 color;

vec4 before(ivec2 texel)
{
#if SOURCE == 0
    return start;
#elif SOURCE == 1
    int last = textureSize(buffered, 0).y - 1;
    vec4 sum = weights[0] * texelFetch(buffered, texel, 0);
    for (int i = 1; i < TAPS; ++i)
        sum += weights[i]
            * (texelFetch(buffered, ivec2(texel.x, max(texel.y - i, 0)), 0)
                + texelFetch(buffered, ivec2(texel.x, min(texel.y + i, last)), 0));
    return sum;
#else
    return texture(buffered, gl_FragCoord.xy * 0.5 / vec2(textureSize(buffered, 0)));
#endif
}

vec4 joined(vec4 buffer, ivec2 pixel)
{
#ifdef FRONT
#ifdef ADDED
    return under(buffer, pixel) - buffer;
#else
    return under(buffer, pixel);
#endif
#else
    vec4 nearer = layer(pixel);
#ifdef ADDED
    return nearer;
#else
    return nearer + (1.0 - nearer.a) * buffer;
#endif
#endif
}

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 buffer = before(texel);
#if LEVEL == 1
    color = joined(buffer, texel);
#else
    ivec2 from = texel * LEVEL, to = min(from + LEVEL, textureSize(color0, 0));
    color = vec4(0.0);
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) color += joined(buffer, ivec2(x, y));
    color /= float((to.x - from.x) * (to.y - from.y));
#endif
}
