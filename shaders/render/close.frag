// Closes pixels to a pass that draws only behind an image of inverse depths: where that is 0 there is nothing to be found,
// and with the nearest depth there no fragment gets as far as its shader.
uniform sampler2D behind;

layout(location = 0) out vec4 color;
layout(location = 1) out float inverse_depth;

void main()
{
    if (texelFetch(behind, ivec2(gl_FragCoord.xy), 0).r > 0.0) discard;
    color = vec4(0.0);
    inverse_depth = 0.0;
    gl_FragDepth = 0.0;
}
