// One sub-image before it is blurred: what is in front of it culled (section 3.1), the holes filled from what surrounds
// them (3.2, FILL), and weighted by its matting function (3.3). WHOLE leaves out the weights, to look at.
#include "methods/pyramid/culled.glsl"

#ifdef FILL
uniform sampler2D coarse_colors;
uniform sampler2D coarse_extras;
#endif
uniform vec4 ramps;  // signed sigma, px, where the weight starts and ends to rise, and starts and ends to fall

out vec4 color;

// What the ramps are linear in: sigma, affine in 1/z, or the paper's depth z (in units of the focus distance).
float place(float sigma)
{
#ifdef PAPER
    float infinity = lens.sigma * coc_radius(0.0);
    if (infinity > 0.0 && abs(sigma) < 1e20) return 1.0 / max(1.0 - sigma / infinity, 1e-6);
#endif
    return sigma;
}

// 0 before `from`, 1 after `to`; a step where they are one.
float ramp(float from, float to, float value)
{
    from = place(from), to = place(to), value = place(value);
    return to > from ? clamp((value - from) / (to - from), 0.0, 1.0) : step(to, value);
}

float weight(float sigma)
{
#ifdef WHOLE
    return 1.0;
#else
    return ramp(ramps.x, ramps.y, sigma) * (1.0 - ramp(ramps.z, ramps.w, sigma));
#endif
}

#ifdef FILL
// How much of what is filled in at a pixel with `sigma` is seen: all where the pixel is culled. Where it is only partly
// in this sub-image, as much of the rest as the filling lies behind it, or thin things would hide what they are too
// blurred to hide. A hole that has just opened begins with this share too, so nothing changes at once.
float seen(float sigma, float behind)
{
#ifdef PAPER
    return sigma < nearest ? 1.0 : 0.0;
#else
    float apart = smoothstep(0.0, 1.0, (behind - sigma) / max(soft.x, 1e-6));
    float culled = clamp((nearest - sigma) / max(soft.y, 1e-6), 0.0, 1.0);
    return (1.0 - ramp(ramps.x, ramps.y, sigma)) * mix(apart, 1.0, culled);
#endif
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float sigma = signed_sigma(pixel);
    color = vec4(0.0);
    if (sigma >= nearest) color = vec4(texelFetch(pinhole, pixel, 0).rgb, 1.0) * weight(sigma);
#ifdef FILL
    vec2 coarse = gl_FragCoord.xy * 0.5 / vec2(textureSize(coarse_colors, 0));
    vec4 filled = texture(coarse_colors, coarse);
    // Where nothing is known anywhere, the hole stays empty.
    float known_share = max(filled.a, 1e-6);
    float behind = texture(coarse_extras, coarse).r / known_share;
    color += filled / known_share * seen(sigma, behind) * weight(behind);
#endif
}
