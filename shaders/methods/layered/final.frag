// Front buffer over the layer in focus over the back buffer. Where no peel knew what is behind, and on steep surfaces between
// layers, coverage is below 1: the rest is FILLed from what is known behind the front buffer, or what is there is divided
// by its coverage (GPU Pro 4, p. 206). Where nothing is in focus, all the layer in focus is EMPTY.
#include "methods/layered/place.glsl"
#ifdef EMPTY
uniform vec4 background;
#else
#include "methods/layered/matte.glsl"
#endif

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

#ifdef CLOSE
uniform sampler2D closed;  // of each cell of CELL x CELL pixels, how far nothing behind the front buffer can be seen

// What coverage is missing there was lost between the layers of a steep surface, and what is there stands for it.
vec4 close(vec4 sum, vec2 place)
{
    vec2 cells = place / (float(CELL) * pixel_size * vec2(textureSize(closed, 0)));
    return sum * mix(1.0, 1.0 / max(sum.a, 1e-4), textureLod(closed, cells, 0.0).r);
}
#endif

out vec4 color;

void main()
{
    vec2 place = gl_FragCoord.xy * pixel_size;
#ifdef HAS_FRONT
    vec4 sum = textureLod(front, place, 0.0);
#ifdef CLOSE
    sum = close(sum, place);
#endif
#else
    vec4 sum = vec4(0.0);
#endif
#ifndef EMPTY
    sum = under(sum, place);
#endif
#ifdef HAS_BACK
    sum += max(1.0 - sum.a, 0.0) * textureLod(back, place, 0.0);
#else
    sum += max(1.0 - sum.a, 0.0) * start;
#endif
#ifdef FILL
    sum += max(1.0 - sum.a, 0.0) * texture(filled, 0.5 * gl_FragCoord.xy / vec2(textureSize(filled, 0)));
#endif
    color = vec4(sum.a > 1e-4 ? sum.rgb / sum.a : background.rgb, 1.0);
}
