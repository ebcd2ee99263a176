// One direction of a separable filter, with weights from dofview/gl/gaussian.py. The number of taps is a constant so that
// the loop is unrolled. Without BILINEAR the sampler takes the nearest texel; a software rasteriser does that faster than
// texelFetch. Beyond the border the last texel is repeated, coverage included: what is constant stays so.
uniform sampler2D source;
uniform ivec2 axis;
#ifdef BILINEAR
uniform vec2 taps[TAPS];  // distance in texels, weight
#else
uniform float weights[TAPS];
#endif

out vec4 color;

void main()
{
#ifdef BILINEAR
    vec2 texel = 1.0 / vec2(textureSize(source, 0)), place = gl_FragCoord.xy * texel, along = vec2(axis) * texel;
    color = taps[0].y * texture(source, place);
    for (int i = 1; i < TAPS; ++i)
        color += taps[i].y * (texture(source, place - taps[i].x * along) + texture(source, place + taps[i].x * along));
#else
    vec2 texel = 1.0 / vec2(textureSize(source, 0)), place = gl_FragCoord.xy * texel, along = vec2(axis) * texel;
    color = weights[0] * textureLod(source, place, 0.0);
    for (int i = 1; i < TAPS; ++i)
        color += weights[i]
            * (textureLod(source, place - float(i) * along, 0.0) + textureLod(source, place + float(i) * along, 0.0));
#endif
}
