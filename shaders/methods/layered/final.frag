// Front buffer over the layer in focus over the back buffer. What no peel knew leaves coverage below 1 there: dividing by
// it fills such gaps, and the bands on steep surfaces, with what surrounds them.
#include "methods/layered/matte.glsl"

#ifdef HAS_FRONT
uniform sampler2D front;
#endif
#ifdef HAS_BACK
uniform sampler2D back;
#endif
uniform vec4 start;

out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef HAS_FRONT
    vec4 sum = texelFetch(front, pixel, 0);
#else
    vec4 sum = vec4(0.0);
#endif
    sum = under(sum, pixel);
#ifdef HAS_BACK
    sum += max(1.0 - sum.a, 0.0) * texelFetch(back, pixel, 0);
#else
    sum += max(1.0 - sum.a, 0.0) * start;
#endif
    color = vec4(sum.a > 1e-4 ? sum.rgb / sum.a : background, 1.0);
}
