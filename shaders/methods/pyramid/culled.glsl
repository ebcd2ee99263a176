#include "include/lens.glsl"

uniform sampler2D pinhole;
uniform sampler2D inverse_depth;
uniform float nearest;  // signed sigma, px: what is in front of it is culled
uniform vec2 soft;      // px of sigma behind and in front of `nearest` over which culling comes into effect

// Blur of a pixel as a Gaussian: sigma in pixels, negative in front of the focus.
float signed_sigma(ivec2 pixel)
{
    return lens.sigma * coc_radius(texelFetch(inverse_depth, pixel, 0).r);
}

// What the holes are filled from: the pinhole picture without what is culled (section 3.1). Pixels close to being culled
// count little, or all holes would change at once when they are.
void known(ivec2 pixel, out vec4 color, out float sigma)
{
    sigma = signed_sigma(pixel);
    float weight = clamp((sigma - nearest) / max(soft.x, 1e-6), 0.0, 1.0);
    color = vec4(texelFetch(pinhole, pixel, 0).rgb, 1.0) * weight;
    sigma *= weight;
}
