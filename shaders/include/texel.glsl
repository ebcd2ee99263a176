// One texel of an image whose sampler takes the nearest, and beyond the border the last. A software rasteriser fetches it
// so in two thirds of the time that `texelFetch` takes, which tests for the border by itself.
vec4 texel_of(sampler2D image, ivec2 texel)
{
    return textureLod(image, (vec2(texel) + 0.5) / vec2(textureSize(image, 0)), 0.0);
}
