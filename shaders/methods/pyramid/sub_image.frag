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

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float sigma = signed_sigma(pixel), front = nearest - sigma;
    color = vec4(texelFetch(pinhole, pixel, 0).rgb, 1.0);
    if (front > 0.0) {
        color = vec4(0.0);
#ifdef FILL
        vec2 place = gl_FragCoord.xy * 0.5 / vec2(textureSize(coarse_colors, 0));
        vec4 filled = texture(coarse_colors, place);
        // Where nothing is known anywhere the hole stays empty. A hole that has just opened was weightless until now, so
        // its filling begins weightless too.
        sigma = texture(coarse_extras, place).r / max(filled.a, 1e-6);
        color = filled / max(filled.a, 1e-6) * min(front / max(soft.y, 1e-6), 1.0);
#endif
    }
#ifndef WHOLE
    color *= ramp(ramps.x, ramps.y, sigma) * (1.0 - ramp(ramps.z, ramps.w, sigma));
#endif
}
