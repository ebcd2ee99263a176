// A lens ray through the layers. At pixel p the ray through lens point v passes q = p - c v where the circle of confusion
// is c (Lee 2009 eq 3; the sign is that of a gather from the lens centre's view), so in (x, y, 1/z) it is straight.
//
// Loops test at their end, because a software rasteriser runs a body before it finds that no pixel of a group needs it,
// and change nothing once `more` is false, because it may run the last turn again for a pixel that is done (Mesa 22.3
// hands out the values of that turn).
#include "include/lens.glsl"
#include "methods/multiview/grid.glsl"
#include "methods/multiview/slabs.glsl"
#include <Params>

uniform sampler2DArray layer_inverse_depth;

const float EMPTY = -1e9;

int probes_made = 0;

// Where the ray that the pixel begins at texel position `start` passes the depth 1 / `inverse_depth`.
vec2 ray_at(vec2 start, vec2 lens_point, float inverse_depth)
{
    return start - lens_point * (coc_radius(inverse_depth) * detail);
}

bool on_canvas(vec2 q)
{
    return all(greaterThanEqual(q, vec2(0.0))) && all(lessThan(q, vec2(textureSize(layer_inverse_depth, 0).xy)));
}

// Where in layer `k` the surface at `texel` lies, 0 at the layer's front and 1 at its back; EMPTY where none is.
float height(ivec2 texel, int k, float front, float scale)
{
    ++probes_made;
    ivec2 inside = clamp(texel, ivec2(0), textureSize(layer_inverse_depth, 0).xy - 1);
    float inverse_depth = texelFetch(layer_inverse_depth, ivec3(inside, k), 0).r;
    return inverse_depth > 0.0 && inside == texel ? (front - inverse_depth) * scale : EMPTY;
}

// Finds where the ray from `a` (layer front, t = 0) to `b` (layer back, t = 1) meets the layer's height field, by false
// position (Lee 2009 section 4.3): probe where the surface would be if it were straight between what is known at the
// two ends. The first probe assumes the layer's bounds (t = 1/2). While nothing has been met, the ends are looked at. An
// end not looked at is as high as what was met; an empty one is at the bound that makes the ray cross: the back at the
// start, the front at the end. Says whether the ray meets a surface, and at which t; -1
// where no probe found any.
bool intersect(int k, float front, float back, vec2 a, vec2 b, out float t)
{
    float scale = 1.0 / (front - back);
    float t0 = 0.0, t1 = 1.0, above = EMPTY, below = EMPTY;  // the interval, and surface minus ray at its ends
    float met = EMPTY;                                       // height at the last probe that met a surface
    bool hit = false, more = true;
    int probes = 0, most = PROBES;
    t = 0.5;
    do {
        ivec2 texel = ivec2(floor(mix(a, b, t)));
        float h = height(texel, k, front, scale);
        if (more) {
            hit = h != EMPTY;
            ++probes;
            bool nearer = hit ? h < t : met >= t;
            if (hit || met != EMPTY) {
                if (nearer) t1 = t, below = hit ? h - t : -t;
                else t0 = t, above = hit ? h - t : 1.0 - t;
            }
            if (hit) met = h;
            float from = above == EMPTY ? met - t0 : above, to = below == EMPTY ? met - t1 : below;
            float estimate = to > 0.0 ? t1 : from <= 0.0 ? t0 : t0 + (t1 - t0) * from / (from - to);
            // Nothing yet: the ends, if they are elsewhere; with one probe only the middle is looked at.
            if (met == EMPTY) estimate = probes == 1 && ivec2(floor(a)) != texel ? 0.0 : 1.0;
            bool same = ivec2(floor(mix(a, b, estimate))) == texel;
#if CONES
            // A cone sees beside the ray whether there is anything to look for.
            more = hit && !same && probes < PROBES;
#else
            // Looking at the ends does not count.
            if (probes == 1 && !hit && PROBES > 1) most = PROBES + 2;
            more = !same && probes < (met == EMPTY ? min(most, 3) : most);
#endif
            // Another texel counts only once it is looked at.
            if (same || more) t = estimate;
        }
    } while (more);
    if (!hit) t = -1.0;
    // Still behind the end of this layer: the next one holds it too.
    return hit && (met <= 1.0 || k + 1 == slabs.count);
}
