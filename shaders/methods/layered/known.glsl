// What `pass/pull.frag` starts from, to fill what no peel knows behind the front buffer: the layer in focus, whole, over the
// back buffer, known as far as they cover.
#include "methods/layered/matte.glsl"

#ifdef HAS_BACK
uniform sampler2D back;
#endif
uniform ivec4 window;  // left, bottom, right, top of what will be seen; outside it the back buffer is not complete

void known(ivec2 texel, out vec4 color, out float extra)
{
    color = layer(texel);
#ifdef HAS_BACK
    color += (1.0 - color.a) * texel_of(back, texel);
#endif
    if (any(lessThan(texel, window.xy)) || any(greaterThanEqual(texel, window.zw))) color = vec4(0.0);
    extra = 0.0;
}
