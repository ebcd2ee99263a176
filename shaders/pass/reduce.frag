// Half the size, rounded up, by one, four or four bilinear taps around the parent's centre. The edge is repeated.
//
//     BOX2     weights [1 1] / 2 per axis        variance 1/4 texel^2 of `fine`
//     BOX4             [1 1 1 1] / 4             5/4
//     SPLINE           [1 3 3 1] / 8             3/4, the biquadratic B-spline
uniform sampler2D fine;

out vec4 color;

void main()
{
    vec2 texel = 1.0 / vec2(textureSize(fine, 0));
    vec2 center = 2.0 * floor(gl_FragCoord.xy) + 1.0;
#ifdef BOX2
    color = texture(fine, center * texel);
#else
#ifdef BOX4
    const vec2 tap = vec2(-1.0, 1.0);
#else
    const vec2 tap = vec2(-0.75, 0.75);
#endif
    color = 0.25 * (texture(fine, (center + tap.xx) * texel) + texture(fine, (center + tap.yx) * texel)
        + texture(fine, (center + tap.xy) * texel) + texture(fine, (center + tap.yy) * texel));
#endif
}
