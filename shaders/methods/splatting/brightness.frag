// Mean luminance of blocks of 2 x 2 texels of the level before; the first level (FIRST) reads colours.
uniform sampler2D source;

out float brightness;

float fetch(ivec2 texel)
{
    vec3 value = texelFetch(source, min(texel, textureSize(source, 0) - 1), 0).rgb;
#ifdef FIRST
    return dot(value, vec3(0.30, 0.59, 0.11));
#else
    return value.r;
#endif
}

void main()
{
    ivec2 from = ivec2(gl_FragCoord.xy) * 2;
    brightness = 0.25 * (fetch(from) + fetch(from + ivec2(1, 0)) + fetch(from + ivec2(0, 1)) + fetch(from + 1));
}
