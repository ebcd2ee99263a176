// One level of both pyramids from the level before, in one pass: B and Z by an isotropic filter (eq 1), colour by the
// anisotropic one (eq 9), N as the greatest sigma among nearer neighbours in front of the focus (eq 10).
//
// The filter is [1 3 3 1] / 8 per axis around the parent's centre, so nothing drifts; the paper's (PAPER) is a 3x3
// Gaussian around an even texel, half a texel off. Children outside the picture count nothing.
#include "include/lens.glsl"
#include "methods/mipmap/keep.glsl"

uniform sampler2D colors;
uniform sampler2D zbns;
uniform ivec2 corner;         // of this level in its image
uniform ivec2 source_corner;  // of the level before in its image
uniform ivec2 source_size;

layout(location = 0) out vec4 color;
layout(location = 1) out vec4 zbn;

#ifdef PAPER
const int FROM = -1, TO = 1;
float weight(int offset) { return offset == 0 ? 2.0 : 1.0; }
#else
const int FROM = -1, TO = 2;
float weight(int offset) { return offset == 0 || offset == 1 ? 3.0 : 1.0; }
#endif

bool inside(ivec2 child)
{
    return all(greaterThanEqual(child, ivec2(0))) && all(lessThan(child, source_size));
}

void main()
{
    ivec2 first = 2 * (ivec2(gl_FragCoord.xy) - corner);
    vec3 mean = vec3(0.0);
    for (int y = FROM; y <= TO; ++y)
        for (int x = FROM; x <= TO; ++x) {
            ivec2 child = first + ivec2(x, y);
            if (inside(child))
                mean += vec3(texelFetch(zbns, source_corner + child, 0).xy, 1.0) * weight(x) * weight(y);
        }
    float coc = mean.x / mean.z, sigma = mean.y / mean.z, nearer = 0.0;
    vec4 total = vec4(0.0);
    float weights = 0.0;
    for (int y = FROM; y <= TO; ++y)
        for (int x = FROM; x <= TO; ++x) {
            ivec2 child = first + ivec2(x, y);
            if (!inside(child)) continue;
            vec3 there = texelFetch(zbns, source_corner + child, 0).xyz;
            if (there.x < min(coc, 0.0)) nearer = max(nearer, there.y);
            float w = weight(x) * weight(y) * keep(there.y, sigma, coc);
            total += texelFetch(colors, source_corner + child, 0) * w;
            weights += w;
        }
    // The mean never exceeds the greatest, so one child at least is kept.
    color = total / weights;
    zbn = vec4(coc, sigma, nearer, 0.0);
}
