// What a texel knows, from two images: `color` times its weight with the weight in alpha, and, but for COLOR_ALONE, one more
// value times it.
uniform sampler2D colors;
#ifndef COLOR_ALONE
uniform sampler2D extras;
#endif

void known(ivec2 texel, out vec4 color, out float extra)
{
    color = texelFetch(colors, texel, 0);
#ifdef COLOR_ALONE
    extra = 0.0;
#else
    extra = texelFetch(extras, texel, 0).r;
#endif
}
