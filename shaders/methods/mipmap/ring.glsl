#include "include/atlas.glsl"

// Magnification with the circular filter (figure 4b): a centre and eight taps at one distance, all eight with the
// weight that the 3x3 Gaussian [1 2 1] has at distance 1. Its variance per axis is 0.4 d^2.
const float CENTER = 0.2, TAP = 0.1;
const float DIAGONAL = 0.70710678;
const vec2 RING[8] = vec2[8](
    vec2(1.0, 0.0), vec2(DIAGONAL, DIAGONAL), vec2(0.0, 1.0), vec2(-DIAGONAL, DIAGONAL),
    vec2(-1.0, 0.0), vec2(-DIAGONAL, -DIAGONAL), vec2(0.0, -1.0), vec2(DIAGONAL, -DIAGONAL));

// Value of a pyramid at `position` between level `lower` (share 0) and the next (share 1).
vec4 between_levels(sampler2D even_levels, sampler2D odd_levels, int lower, float share, vec2 position)
{
    bool swap = (lower & 1) == 1;
    vec4 even = atlas_sample(even_levels, swap ? lower + 1 : lower, position);
    vec4 odd = atlas_sample(odd_levels, lower | 1, position);
    return mix(even, odd, swap ? 1.0 - share : share);
}

// Continuous level for a blur of sigma, eq 6 and 11.
float paper_level(float sigma)
{
    return max(1.0 + log2(max(2.0 / 3.0 * sigma, 0.5)), 0.0);
}
