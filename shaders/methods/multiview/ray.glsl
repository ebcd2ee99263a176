// A lens ray through the layers. At pixel p the ray through lens point v passes q = p - c v where the circle of confusion
// is c (Lee 2009 eq 3; the sign is that of a gather from the lens centre's view), so in (x, y, 1/z) it is straight.
#include "include/lens.glsl"
#include "methods/multiview/slabs.glsl"
#include <Params>

uniform sampler2DArray layer_inverse_depth;

const float EMPTY = -1e9;

int probes_made = 0;

// Where in layer `k` the surface at `texel` lies, 0 at the layer's front and 1 at its back; EMPTY where none is.
float height(ivec2 texel, int k)
{
    ivec2 size = textureSize(layer_inverse_depth, 0).xy;
    ++probes_made;
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) return EMPTY;
    float inverse_depth = texelFetch(layer_inverse_depth, ivec3(texel, k), 0).r;
    if (inverse_depth <= 0.0) return EMPTY;
    return (slab_front(k) - inverse_depth) / (slab_front(k) - slab_back(k));
}

// Finds where the ray from `a` (layer front, t = 0) to `b` (layer back, t = 1) meets the layer's height field, by false
// position (Lee 2009 section 4.3): probe where the surface would be if it were straight between what is known at the
// two ends. The first probe assumes the layer's bounds (t = 1/2); an end not looked at yet is taken to be as high as what
// that probe found. Returns t and the texel hit, or false.
bool intersect(int k, vec2 a, vec2 b, out ivec2 texel, out float t)
{
    t = 0.5;
    texel = ivec2(floor(mix(a, b, t)));
    float h = height(texel, k);
    if (params.probes == 1) return h != EMPTY;
    // Surface minus ray at both ends of the interval; EMPTY while unknown.
    float t0 = 0.0, t1 = 1.0, above = EMPTY, below = EMPTY;
    if (h == EMPTY) {
        ivec2 first = ivec2(floor(a)), last = ivec2(floor(b));
        float h0 = first == texel ? EMPTY : height(first, k);
        float h1 = last == texel ? EMPTY : height(last, k);
        if (h0 == EMPTY && h1 == EMPTY) return false;
        // An empty start counts as the back bound and an empty end as the front, so that the ray must cross.
        above = h0 == EMPTY ? 1.0 : h0;
        below = h1 == EMPTY ? -1.0 : h1 - 1.0;
    }
    for (int probe = 1; probe < params.probes; ++probe) {
        if (h != EMPTY) {
            if (h < t) t1 = t, below = h - t;
            else t0 = t, above = h - t;
        }
        float from = above == EMPTY ? h - t0 : above, to = below == EMPTY ? h - t1 : below;
        if (to > 0.0) t = t1;
        else if (from <= 0.0) t = t0;
        else t = t0 + (t1 - t0) * from / (from - to);
        ivec2 next = ivec2(floor(mix(a, b, t)));
        if (next == texel) break;
        texel = next;
        float before = h;
        h = height(texel, k);
        if (h == EMPTY && before != EMPTY) {
            if (before < t) t0 = t, above = 1.0 - t;
            else t1 = t, below = -t;
        }
    }
    // Still behind the end of this layer: the next one holds it too.
    return h != EMPTY && h <= 1.0 || h != EMPTY && k + 1 == slabs.count;
}
