// A point: what one pixel sends out. Its colour is in rgb; a holds its signed CoC radius c in steps of 1/64 px and, as
// the fraction, its share: k_n(C) over that of an ideal disc (4/pi), times the part of its pixel block it stands for.
// One fetch per tap then gives all that a sprite needs; a share of 0 means that there is no point.
const float PI = 3.14159265;
const float COC_STEPS = 64.0;
const float MOST_SHARE = 1.5;
const float SHARP = 0.35;  // CoC radius, px, up to which a sprite stays within its pixel
const vec4 NO_POINT = vec4(0.0);

vec4 pack_point(vec3 color, float coc, float share)
{
    coc = clamp(coc, -MOST_RADIUS, MOST_RADIUS);
    return vec4(color, floor(coc * COC_STEPS + 0.5) + clamp(share / MOST_SHARE, 1e-3, 0.995));
}

float point_coc(vec4 point)
{
    return floor(point.a) / COC_STEPS;
}

float point_share(vec4 point)
{
    return fract(point.a) * MOST_SHARE;
}
