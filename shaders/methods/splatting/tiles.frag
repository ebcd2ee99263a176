// Largest CoC radius of the points of one level in each tile of TILE x TILE pixels: x of the visible ones in front of the
// focus, y of those behind it, z of the hidden ones, w of the second ones: on level 0 those that are drawn as sprites, on
// the others the farther ones of two in a block. -1 where there are none.
#include "methods/splatting/point.glsl"

uniform sampler2D points;
uniform float to;  // CoC radius from which points are merged into the next level
uniform int row;   // of the map, at which the part of this level begins
#ifdef SECOND
uniform sampler2D second_points;
#endif
#ifdef HIDDEN
uniform sampler2D hidden_points;
#endif

out vec4 largest;

float radius_of(vec4 point)
{
    float radius = abs(point_coc(point));
    return is_point(point) && staying(radius, to) > 0.0 ? radius : -1.0;
}

void add_visible(vec4 point)
{
    if (point_coc(point) < 0.0) largest.x = max(largest.x, radius_of(point));
    else largest.y = max(largest.y, radius_of(point));
}

void main()
{
    int side = TILE >> LEVEL;
    ivec2 first = (ivec2(gl_FragCoord.xy) - ivec2(0, row)) * side, last = min(first + side, textureSize(points, 0));
    largest = vec4(-1.0);
    for (int y = first.y; y < last.y; ++y)
        for (int x = first.x; x < last.x; ++x) {
            add_visible(texelFetch(points, ivec2(x, y), 0));
#ifdef SECOND
            vec4 second = texelFetch(second_points, ivec2(x, y), 0);
            largest.w = max(largest.w, LEVEL == 0 && is_point(second) ? abs(point_coc(second)) : radius_of(second));
            if (LEVEL > 0) add_visible(second);
#endif
#ifdef HIDDEN
            largest.z = max(largest.z, radius_of(texelFetch(hidden_points, ivec2(x, y), 0)));
#endif
        }
}
