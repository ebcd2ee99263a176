// Points of one level from those of the level before: the points of 2 x 2 texels become at most two, one of the nearer
// and one of the farther surface where an edge runs through the block, so that a silhouette stays a silhouette. Only
// points are taken whose CoC radius is above `from`, and of those the part that does not stay.
#include <Params>
#include "methods/splatting/point.glsl"
#include "methods/splatting/layers.glsl"

uniform sampler2D near_points;
uniform sampler2D far_points;
uniform sampler2D hidden_points;
uniform float from;

layout(location = 0) out vec4 near_point;
layout(location = 1) out vec4 far_point;
layout(location = 2) out vec4 hidden_point;

struct Group
{
    vec3 color;
    float coc;
    float share;
};

void collect(inout Group group, vec4 point)
{
    float share = point_share(point) * (1.0 - staying(point_coc(point), from));
    group.color += share * point.rgb;
    group.coc += share * point_coc(point);
    group.share += share;
}

vec4 merged(Group group)
{
    if (group.share <= 0.0) return NO_POINT;
    return pack_point(group.color / group.share, group.coc / group.share, group.share / 4.0);
}

vec4 fetch(sampler2D points, ivec2 texel)
{
    if (any(greaterThanEqual(texel, textureSize(points, 0)))) return NO_POINT;
    vec4 point = texelFetch(points, texel, 0);
    return staying(point_coc(point), from) < 1.0 ? point : NO_POINT;
}

void main()
{
    ivec2 block = ivec2(gl_FragCoord.xy) * 2;
    vec4 points[8];
    float nearest = MOST_RADIUS, farthest = -MOST_RADIUS;
    Group near = Group(vec3(0.0), 0.0, 0.0), far = near, hidden = near;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = block + ivec2(i & 1, i >> 1);
        points[i] = fetch(near_points, texel);
#ifdef FIRST
        points[i + 4] = NO_POINT;
#else
        points[i + 4] = fetch(far_points, texel);
#endif
#ifdef HIDDEN
        vec4 point = fetch(hidden_points, texel);
        if (is_point(point)) collect(hidden, point);
#endif
    }
    for (int i = 0; i < 8; ++i) {
        if (!is_point(points[i])) continue;
        nearest = min(nearest, point_coc(points[i]));
        farthest = max(farthest, point_coc(points[i]));
    }
    // Within half a layer's tolerance it is one surface.
    bool edge = farthest - nearest > 0.5 * ends_of_layer(min(abs(nearest), abs(farthest))).tolerance;
    float middle = edge ? 0.5 * (nearest + farthest) : farthest;
    for (int i = 0; i < 8; ++i) {
        if (!is_point(points[i])) continue;
        if (point_coc(points[i]) <= middle) collect(near, points[i]);
        else collect(far, points[i]);
    }
    near_point = merged(near);
    far_point = merged(far);
    hidden_point = merged(hidden);
}
