// The accumulated views over their number.
uniform sampler2D total;
uniform float inverse_views;

out vec4 color;

void main()
{
    color = vec4(texelFetch(total, ivec2(gl_FragCoord.xy), 0).rgb * inverse_views, 1.0);
}
