// Front buffer over the layer in focus over the back buffer. Where no peel knew what is behind, and on steep surfaces between
// layers, coverage is below 1: the rest is FILLed from what is known behind the front buffer, or what is there is divided
// by its coverage (GPU Pro 4, p. 206).
#include "methods/layered/matte.glsl"

#ifdef HAS_FRONT
uniform sampler2D front;
#endif
#ifdef HAS_BACK
uniform sampler2D back;
#endif
#ifdef FILL
uniform sampler2D filled;  // half the size
#endif
uniform vec4 start;

out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef HAS_FRONT
    vec4 sum = texel_of(front, pixel);
#else
    vec4 sum = vec4(0.0);
#endif
    sum = under(sum, pixel);
#ifdef HAS_BACK
    sum += max(1.0 - sum.a, 0.0) * texel_of(back, pixel);
#else
    sum += max(1.0 - sum.a, 0.0) * start;
#endif
#ifdef FILL
    sum += max(1.0 - sum.a, 0.0) * texture(filled, 0.5 * gl_FragCoord.xy / vec2(textureSize(filled, 0)));
#endif
    color = vec4(sum.a > 1e-4 ? sum.rgb / sum.a : background.rgb, 1.0);
}
