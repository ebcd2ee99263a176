// Non-linear mipmap interpolation with circular taps (eq 8): the picture at the blur that each pixel asks for.
//
// The mix of two levels is linear; the paper's geometric mix is 0 where either is.
#include "include/lens.glsl"
#include "methods/mipmap/keep.glsl"
#include "methods/mipmap/ring.glsl"

uniform sampler2D inverse_depth;
uniform sampler2D even_levels;
uniform sampler2D odd_levels;
#ifdef SMOOTHED
uniform sampler2D don;
uniform sampler2D even_zbn;
uniform sampler2D odd_zbn;
#endif

out vec4 color;

// Distance of the taps in units of sigma: one texel of level l - 1 where the blur is that of level l exactly.
const float REACH = 1.1;

#ifdef SMOOTHED
// A straight silhouette covers a half; a little more, so that the blur is that of the silhouette on both its sides.
const float FULL_COVER = 0.6;
#endif

// Variance per axis, px^2, that reducing to `level` and magnifying it bilinearly gives, mean over positions: each
// [1 3 3 1] / 8 adds 3/4 texel^2, interpolation 1/6 texel^2 of the level.
float level_variance(int level)
{
    return level == 0 ? 0.0 : exp2(2.0 * float(level)) * (5.0 / 12.0) - 0.25;
}

// Variance that the ring at distance d gives on level 0, where a tap between pixels is spread over them.
float ring_variance(float d)
{
    vec2 t = fract(d * vec2(1.0, DIAGONAL));
    vec2 spread = t * (1.0 - t);
    return TAP * (2.0 * (d * d + spread.x) + 4.0 * (0.5 * d * d + spread.y));
}

#ifdef SMOOTHED
// DoB where blurred foreground is near (eq 11, figure 8b): read from a coarse level of B, so that blur fades out across
// a silhouette instead of stopping there. `widest` is the blur of that foreground; where there is none, it is the `own`.
float smoothed_sigma(vec2 position, float widest, float own)
{
    float n = paper_level(widest);
    if (n <= 0.0) return own;
    int lower = min(int(n), LAST_LEVEL - 1);
    return between_levels(even_zbn, odd_zbn, lower, n - float(lower), position).y;
}
#endif

// The picture around `position`, blurred by `sigma`.
vec3 blurred(vec2 position, float sigma, float coc)
{
#ifdef PAPER
    float m = paper_level(sigma);
    float reach = exp2(m - 1.0), share = m <= 0.0 ? 0.0 : 1.0;
    float level = max(m - 1.0, 0.0);
    int lower = min(int(level), LAST_LEVEL - 1);
    float mixing = clamp(level - float(lower), 0.0, 1.0);
#else
    // The ring gives 0.4 d^2 of the variance, two neighbouring levels the rest. Below level 0 the other neighbour is the
    // pixel itself, so that the blur begins without a step.
    float reach = REACH * sigma, variance = sigma * sigma;
    float rest = variance - 4.0 * TAP * reach * reach;
    int lower = clamp(int(0.5 * log2(max((rest + 0.25) * 2.4, 1.0))), 0, LAST_LEVEL - 1);
    float ring = lower == 0 ? ring_variance(reach) - 4.0 * TAP * reach * reach : level_variance(lower);
    float mixing = clamp((rest - ring) / (level_variance(lower + 1) - ring), 0.0, 1.0);
    float share = lower == 0 && ring > rest ? variance / ring_variance(reach) : 1.0;
#endif

    vec4 center = between_levels(even_levels, odd_levels, lower, mixing, position);
    float weight = 1.0 - (1.0 - CENTER) * share;
#ifndef PAPER
    weight *= max(keep(center.a, sigma, coc), 1e-3);
#endif
    vec4 total = vec4(center.rgb, 1.0) * weight;
    for (int i = 0; i < 8; ++i) {
        vec4 tap = between_levels(even_levels, odd_levels, lower, mixing, position + RING[i] * reach);
        weight = TAP * share;
#ifndef PAPER
        weight *= keep(tap.a, sigma, coc);
#endif
        total += vec4(tap.rgb, 1.0) * weight;
    }
    return total.rgb / total.a;
}

void main()
{
    vec2 position = gl_FragCoord.xy;
    float coc = coc_radius(texelFetch(inverse_depth, ivec2(position), 0).r), sigma = lens.sigma * abs(coc);
#ifdef SMOOTHED
    float widest = textureLod(don, 0.5 * position / vec2(textureSize(don, 0)), 0.0).r;
    float smoothed = smoothed_sigma(position, widest, sigma), near = 1.0;
#ifndef PAPER
    // Of what is around a place with the blur `sigma`, the part `cover` has the foreground's. Where that is little, strands
    // of grass say, the place is seen between them as sharp as it is; from a silhouette on, it is as blurred as that.
    float cover = (smoothed - sigma) / max(widest - sigma, 1e-4);
    near = smoothed > sigma ? smoothstep(0.0, FULL_COVER, cover) : 1.0;
#endif
    vec3 found = vec3(0.0);
    if (near < 1.0) found = (1.0 - near) * blurred(position, sigma, coc);
    if (near > 0.0) found += near * blurred(position, smoothed, coc);
    color = vec4(found, 1.0);
#else
    color = vec4(blurred(position, sigma, coc), 1.0);
#endif
}
