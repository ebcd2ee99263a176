// Texel by texel from `source`, which has the size of the target.
uniform sampler2D source;

out vec4 color;

void main()
{
    color = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
}
