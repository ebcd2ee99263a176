// Which fragments may enter the hidden image H: those with an inverse depth below the `limit` written here. All three
// tests of Lee 2008 section 3.2 depend on the visible image only, so they are made once per pixel, not per fragment.
//
//   2. The visible pixel must be in front of the focus: only there does partial occlusion show. Below a blur of one
//      pixel nothing is spread.
//   3. Somewhere within its CoC the visible depth must fall away (eq 4); elsewhere the surface stays opaque however it
//      is blurred, and what is behind it is never seen.
//   1. The fragment must lie behind the visible surface by more than a margin, so that the rest of the same object stays
//      out: `gap` of the visible CoC, or the paper's epsilon of the scene's depth.
#include <Params>
#include "include/lens.glsl"

uniform sampler2D inverse_depth;
uniform vec2 depth_range;  // nearest and farthest depth of the scene, scene units

// Red as said; green the same for the smaller range within which the paper leaves out merged points (section 5).
layout(location = 0) out vec2 limit;

const float LEAST = 1.0;  // px of CoC radius that any two surfaces must differ by
const int TAPS = 12;
// Mirrored or turned by 90 degrees they are themselves, so that a scene that is gives a picture that is.
const vec2 DISC[TAPS] = vec2[](
    vec2(0.450, 0.0), vec2(0.0, 0.450), vec2(-0.450, 0.0), vec2(0.0, -0.450),
    vec2(0.878, 0.364), vec2(0.364, 0.878), vec2(-0.364, 0.878), vec2(-0.878, 0.364),
    vec2(-0.878, -0.364), vec2(-0.364, -0.878), vec2(0.364, -0.878), vec2(0.878, -0.364));

float inverse_depth_at(vec2 position)
{
    return texelFetch(inverse_depth, clamp(ivec2(floor(position)), ivec2(0), textureSize(inverse_depth, 0) - 1), 0).r;
}

#ifdef BY_DEPTH
const vec2 POISSON_DISC[TAPS] = vec2[](
    vec2(-0.313, 0.137), vec2(0.665, -0.575), vec2(0.665, 0.430), vec2(-0.584, -0.690), vec2(-0.382, 0.890),
    vec2(-0.984, -0.110), vec2(-0.060, -0.378), vec2(0.099, -0.963), vec2(0.166, 0.790), vec2(0.997, -0.076),
    vec2(0.400, -0.125), vec2(-0.799, 0.542));

// Depth scaled to 0 at the nearest and 1 at the farthest of the scene, as the paper's thresholds have it.
float normalised_depth(float inverse)
{
    float depth = inverse > 0.0 ? min(1.0 / inverse, depth_range.y) : depth_range.y;
    return (depth - depth_range.x) / (depth_range.y - depth_range.x);
}

// Eq 4 as printed: the mean rise of normalised depth over Poisson points within the CoC.
bool occludes(float inverse, float coc, float range)
{
    float sum = 0.0;
    for (int i = 0; i < TAPS; ++i) sum += normalised_depth(inverse_depth_at(gl_FragCoord.xy + POISSON_DISC[i] * range));
    return sum / float(TAPS) - normalised_depth(inverse) >= params.edge_depth;
}

// The inverse depth that lies behind the visible one by the margin; next to 0 where that is behind the scene.
float behind(float inverse, float coc)
{
    float depth = 1.0 / inverse + params.epsilon * (depth_range.y - depth_range.x);
    return depth < depth_range.y ? 1.0 / depth : 1e-20;
}
#else
// Any edge within reach, in CoC space: a thin gap that few points fall into counts as much as a wide one.
bool occludes(float inverse, float coc, float range)
{
    float highest = coc;
    // A group of pixels none of which enters the loop costs nothing; a branch around it might not save that.
    int taps = coc > -0.5 ? 0 : TAPS;
    for (int i = 0; i < taps; ++i) {
        vec2 position = gl_FragCoord.xy + DISC[i] * (range + 1.5);
        highest = max(highest, coc_radius(inverse_depth_at(position)));
    }
    return highest - coc > max(params.edge * -coc, LEAST);
}

float behind(float inverse, float coc)
{
    return max(inverse - max(params.gap * -coc, LEAST) / lens.scale, 0.0);
}
#endif

void main()
{
    float inverse = texelFetch(inverse_depth, ivec2(gl_FragCoord.xy), 0).r;
    float coc = coc_radius(inverse);
    limit = vec2(0.0);
    if (coc > -0.5) return;
    if (occludes(inverse, coc, -coc)) limit.x = behind(inverse, coc);
#ifdef BY_PAPER
    if (occludes(inverse, coc, -0.95 * coc)) limit.y = limit.x;
#endif
}
