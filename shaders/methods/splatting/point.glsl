// A point: what one pixel, or a block of them, sends out. rgb is its colour; a holds its signed CoC radius c in steps of
// 1/64 px and, as the fraction, its share: the part of its block that it stands for, times k_n(C) over that of an ideal
// disc (4/pi). One fetch per tap then gives all that a sprite needs. With a share of 0 there is no point.
const float PI = 3.14159265;
const float COC_STEPS = 64.0;
const float MOST_SHARE = 1.5;
const vec4 NO_POINT = vec4(0.0);

float rounded_coc(float coc)
{
    return floor(clamp(coc, -MOST_RADIUS, MOST_RADIUS) * COC_STEPS + 0.5) / COC_STEPS;
}

vec4 pack_point(vec3 color, float coc, float share)
{
    return vec4(color, rounded_coc(coc) * COC_STEPS + clamp(share / MOST_SHARE, 1e-3, 0.995));
}

// The part of a point that stays on its level when those from the CoC radius `limit` on are merged into the next, px. The
// rest goes there: over a sixteenth of the radius the levels fade into each other, so that nothing pops.
float staying(float coc, float limit)
{
    return clamp(17.0 - 16.0 * abs(coc) / max(limit, 1e-6), 0.0, 1.0);
}

bool is_point(vec4 point)
{
    return fract(point.a) > 0.0;
}

float point_coc(vec4 point)
{
    return floor(point.a) / COC_STEPS;
}

float point_share(vec4 point)
{
    return fract(point.a) * MOST_SHARE;
}
