// What `pass/pull.frag` starts from, to fill what no peel knows behind the front buffer: the layer in focus, whole, over the
// back buffer, known as far as they cover.
#include "methods/layered/place.glsl"
#ifndef EMPTY
#include "methods/layered/matte.glsl"
#endif

#ifdef HAS_BACK
uniform sampler2D back;
#endif
uniform ivec4 window;  // left, bottom, right, top of what will be seen; outside it the back buffer is not complete

void known(ivec2 texel, out vec4 color, out float extra)
{
#ifdef EMPTY
    color = vec4(0.0);
#else
    color = layer(place_of(texel));
#endif
#ifdef HAS_BACK
    color += (1.0 - color.a) * textureLod(back, place_of(texel), 0.0);
#endif
    if (any(lessThan(texel, window.xy)) || any(greaterThanEqual(texel, window.zw))) color = vec4(0.0);
    extra = 0.0;
}
