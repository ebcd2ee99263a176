// The picture: for each pixel, rays through points of the lens, each stopped by the first surface it meets in the layers
// (Lee 2009 section 4.3), or spread to a cone that layers stop in part (section 4.4). Rays that leave the canvas without
// having met anything are left out of the mean.
//
// Cost per ray: one mask walk, one to three probes in each of the two or three layers that the mask leaves, one colour.
#include "methods/multiview/ray.glsl"
#include "methods/multiview/seen.glsl"
#include "methods/multiview/heat.glsl"

uniform usampler2D mask;       // layers to walk
uniform usampler2D tile_mask;  // layers with anything in reach, however walked: the picture is the same
uniform sampler2D lens_points;
uniform sampler2D noise;
uniform float noise_width;  // how far it moves a lens sample in all, lens radii
uniform vec3 background;
uniform int mask_shift;
uniform int guard;

out vec4 color;

const float MOST = 0.65;  // of a cone: with more, light gets through floors; with less, silhouettes grow
const int NONE = 32;

int lowest_bit(uint bits)
{
#if __VERSION__ >= 400
    return findLSB(bits);
#else
    int k = 0;
    while ((bits >> k & 1u) == 0u && k < 31) ++k;
    return k;
#endif
}

// What the ray meets, premultiplied by how much of it is stopped, by surfaces or by the background inside the canvas. It
// walks `layers`; those that are `near` may hold something.
vec4 ray(vec2 start, vec2 lens_point, uint layers, uint near)
{
    vec4 met = vec4(0.0);
    uint left = layers;
    float depth = 0.0;
    vec3 at = vec3(start, 0.0);
    int next = NONE;         // the layer behind the last that stopped a part of the cone, if anything is near in it,
    vec2 there = vec2(0.0);  // and where that part is
    bool hit = false, more = layers != 0u;
    do {
        int k = max(lowest_bit(left), 0);
        float front = slab_front(k), back = slab_back(k), t;
        vec2 a = ray_at(start, lens_point, front), b = ray_at(start, lens_point, back);
        bool found = intersect(k, front, back, a, b, t);
#if CONES
        // What a ray passes by, its cone may touch: rather towards the back, as a surface may go on in the next layer. There it
        // is read at the same place, for only so what both cover adds up to all.
        bool same = k == next && t < 0.25;
        if (t < 0.0) t = same ? 0.0 : 0.75;
        vec2 q = same ? there : mix(a, b, t);
#else
        vec2 q = mix(a, b, t);
#endif
        float inverse_depth = mix(front, back, t);
#if CONES
        // Layers share one surface more often than they hide each other, so what they cover adds up. Their squares differ, and
        // a little may be missing where one ends and the next begins: once that is passed, most of a cone is all of it.
        vec4 part = seen(q, k, inverse_depth, lens_point);
        bool passed = k > next && met.a > MOST;
        found = part.a > 0.0 && on_canvas(q) && !passed;
        float enough = k == next ? MOST : 0.95;
        if (more && found) {
            met += part * min(1.0, (1.0 - met.a) / part.a);
            next = (near >> k >> 1 & 1u) != 0u ? k + 1 : NONE;
            there = q;
        }
        found = passed || met.a > enough;
#endif
        if (more) {
            hit = found;
            at = vec3(q, k);
            depth = inverse_depth;
            left &= left - 1u;
            more = left != 0u && !hit;
        }
    } while (more);
#if CONES
    if (hit || (next < NONE && met.a > MOST)) return met / met.a;
#else
    if (hit) return vec4(seen(at.xy, int(at.z), depth, lens_point).rgb, 1.0);
#endif
    return on_canvas(ray_at(start, lens_point, slabs.farthest)) ? met + (1.0 - met.a) * vec4(background, 1.0) : met;
}

// Lens sample `i` of a pixel with `random`. Noise: each of the 16 pairs of its channels moves a sixteenth of the samples,
// by up to half their distance. Halton: the pixel's samples are a part of twice as many, from another place for each pixel
// (Lee 2009 section 4.5).
vec2 lens_sample(int i, vec4 random)
{
#if JITTER == JITTER_HALTON
    i = (i + int(random.x * float(2 * params.samples))) % (2 * params.samples);
#endif
    vec2 point = texelFetch(lens_points, ivec2(i, 0), 0).xy;
#if JITTER == JITTER_NOISE
    point += noise_width * (vec2(random[i & 3], random[i >> 2 & 3]) - 0.5);
#endif
    return point;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), size = textureSize(layer_color, 0).xy / int(detail);
    color = vec4(background, 1.0);
    // Nobody looks at the guard band of the result.
    if (any(lessThan(pixel, ivec2(guard))) || any(greaterThanEqual(pixel, size - guard))) return;
    uint layers = texelFetch(mask, pixel >> mask_shift, 0).r, near = texelFetch(tile_mask, pixel / TILE, 0).r;
    vec2 start = (gl_FragCoord.xy - detail_shift) * detail;
    vec4 random = texelFetch(noise, pixel & 63, 0), sum = vec4(0.0);
    for (int i = 0; i < params.samples; ++i) sum += ray(start, lens_sample(i, random), layers, near);
    if (params.show == SHOW_PROBES) {
        color = vec4(heat(float(probes_made) / float(8 * params.samples)), 1.0);
        return;
    }
    if (sum.a <= 0.0) sum = ray(start, vec2(0.0), layers, near);
    if (sum.a > 0.0) color = vec4(sum.rgb / sum.a, 1.0);
}
