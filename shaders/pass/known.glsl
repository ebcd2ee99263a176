// What a texel knows, from two images: `color` times its weight with the weight in alpha, and one more value times it.
uniform sampler2D colors;
uniform sampler2D extras;

void known(ivec2 texel, out vec4 color, out float extra)
{
    color = texelFetch(colors, texel, 0);
    extra = texelFetch(extras, texel, 0).r;
}
