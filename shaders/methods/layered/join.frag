// One step of the recursion: a layer joins the buffer, at full size or, where the blur to come hides the difference, at
// one texel for LEVEL x LEVEL pixels. Without CASCADE it is the layer alone.
#include "methods/layered/matte.glsl"

#ifdef CASCADE
uniform sampler2D buffered;
#endif
uniform vec4 start;  // what a buffer holds before its first layer

out vec4 color;

vec4 before(ivec2 texel)
{
#ifndef CASCADE
    return start;
#elif EXPAND
    // The biquadratic B-spline through texels twice as large.
    return texture(buffered, gl_FragCoord.xy * 0.5 / vec2(textureSize(buffered, 0)));
#else
    return texelFetch(buffered, texel, 0);
#endif
}

vec4 joined(vec4 buffer, ivec2 pixel)
{
#ifdef FRONT
    return under(buffer, pixel);
#else
    vec4 nearer = layer(pixel);
    return nearer + (1.0 - nearer.a) * buffer;
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
