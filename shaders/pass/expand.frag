// Twice the size by biquadratic B-splines: a bilinear fetch at the texel's own place in `coarse`, which covers pixels
// 2i to 2i + 2 also at odd sizes. Its variance is 3/4 of a texel squared.
uniform sampler2D coarse;

out vec4 color;

void main()
{
    color = texture(coarse, gl_FragCoord.xy * 0.5 / vec2(textureSize(coarse, 0)));
}
