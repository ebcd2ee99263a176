// Level 0 of both pyramids (step 1 of the paper's figure 10). Both carry the degree of blurring sigma.
#include "include/lens.glsl"

uniform sampler2D pinhole;
uniform sampler2D inverse_depth;

layout(location = 0) out vec4 color;  // linear colour, sigma of that colour
layout(location = 1) out vec4 zbn;    // signed CoC radius for the paper's depth Z, sigma for B, no DoN yet

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float coc = coc_radius(texelFetch(inverse_depth, pixel, 0).r);
    float sigma = lens.sigma * abs(coc);
    color = vec4(texelFetch(pinhole, pixel, 0).rgb, sigma);
    zbn = vec4(coc, sigma, 0.0, 0.0);
}
