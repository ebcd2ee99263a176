// What is in focus, to be laid over the picture: surfaces with |c| <= blur are tinted, their rims drawn where the signed
// CoC radius c passes -blur (near limit) and +blur (far limit), and the focal plane itself where it passes 0.
#include "include/lens.glsl"
#include <Band>

uniform sampler2D inverse_depth;
uniform vec2 scale;
uniform int guard;

out vec4 color;

const vec3 SHARP = vec3(0.10, 0.85, 0.65), NEAR = vec3(1.0, 0.62, 0.10), FAR = vec3(0.35, 0.60, 1.0);
const float TINT = 0.28, LINE = 0.9;

// Neighbours farther apart than this in c are two surfaces: the jump between them crosses no limit.
const float ONE_SURFACE_PX = 2.0;

float coc_at(ivec2 pixel)
{
    ivec2 canvas = ivec2((vec2(pixel) + 0.5) * scale) + guard;
    return coc_radius(texelFetch(inverse_depth, clamp(canvas, ivec2(0), textureSize(inverse_depth, 0) - 1), 0).r);
}

bool passes(float here, vec2 beside, float limit)
{
    bvec2 other = notEqual(lessThan(beside, vec2(limit)), bvec2(here < limit));
    bvec2 joined = lessThan(abs(beside - here), vec2(ONE_SURFACE_PX));
    return (other.x && joined.x) || (other.y && joined.y);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float here = coc_at(pixel);
    vec2 beside = vec2(coc_at(pixel + ivec2(1, 0)), coc_at(pixel + ivec2(0, 1)));
    color = vec4(SHARP, abs(here) <= band.blur_px ? TINT : 0.0);
    if (lens.scale == 0.0) return;
    if (passes(here, beside, 0.0)) color = vec4(1.0, 1.0, 1.0, LINE);
    else if (passes(here, beside, -band.blur_px)) color = vec4(NEAR, LINE);
    else if (passes(here, beside, band.blur_px)) color = vec4(FAR, LINE);
}
