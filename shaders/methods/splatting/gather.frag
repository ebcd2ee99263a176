// Splatting turned round: each pixel q collects from the points whose sprites reach it, classifies them by eq 6 into
// sums that never leave its registers, and composes them by eq 7. The same picture as drawing the sprites, with no
// blending and no layers in memory; the cost is one fetch per point within reach.
#include <Params>
#include "methods/splatting/point.glsl"
#include "methods/splatting/sprite.glsl"
#include "methods/splatting/layers.glsl"

uniform sampler2D points;
uniform sampler2D reach;
#ifdef HIDDEN
uniform sampler2D hidden_points;
#endif
#ifdef SPRITES
uniform sampler2D sprites_in_front;
uniform sampler2D sprites_with;
uniform sampler2D sprites_behind;
#endif
#if LEVELS > 0
uniform sampler2D points_1;
uniform sampler2D far_points_1;
uniform sampler2D hidden_points_1;
#endif
#if LEVELS > 1
uniform sampler2D points_2;
uniform sampler2D far_points_2;
uniform sampler2D hidden_points_2;
#endif
#if LEVELS > 2
uniform sampler2D points_3;
uniform sampler2D far_points_3;
uniform sampler2D hidden_points_3;
#endif

layout(location = 0) out vec4 color;
#ifdef INSPECT
layout(location = 1) out vec4 layer_0;
layout(location = 2) out vec4 layer_1;
layout(location = 3) out vec4 layer_2;
layout(location = 4) out float fetches;
#endif

#include "methods/splatting/collect.glsl"

vec3 look(int level)
{
    int rows = textureSize(reach, 0).y / (LEVELS + 1);
    return texelFetch(reach, ivec2(gl_FragCoord.xy) / TILE + ivec2(0, level * rows), 0).xyz;
}

void gather_level(sampler2D near_points, sampler2D far_points, int level, Here here, inout Layers layers)
{
    vec3 radius = look(level);
    gather(near_points, level, radius.x, false, here, layers);
    gather(far_points, level, radius.z, false, here, layers);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 own = texelFetch(points, pixel, 0);
    Here here = Here(point_coc(own), ends_of_layer(point_coc(own)));
    vec3 radius = look(0);
    Layers layers = Layers(vec4(0.0), vec4(0.0), vec4(0.0)), hidden = layers;
    // Where nothing of this level reaches, a pixel of this level is in focus, and opaque.
    if (radius.x < 0.0 && is_point(own) && (LEVELS == 0 || abs(here.coc) < merged_from))
        layers.same = vec4(own.rgb, 1.0);
#ifdef SPRITES
    if (radius.z >= 0.0) {
        layers.front += texelFetch(sprites_in_front, pixel, 0);
        layers.same += texelFetch(sprites_with, pixel, 0);
        layers.behind += texelFetch(sprites_behind, pixel, 0);
    }
#endif
    gather(points, 0, radius.x, false, here, layers);
#if LEVELS > 0
    gather_level(points_1, far_points_1, 1, here, layers);
#endif
#if LEVELS > 1
    gather_level(points_2, far_points_2, 2, here, layers);
#endif
#if LEVELS > 2
    gather_level(points_3, far_points_3, 3, here, layers);
#endif
#ifdef HIDDEN
    gather(hidden_points, 0, radius.y, true, here, hidden);
#if LEVELS > 0 && !defined BY_PAPER
    gather(hidden_points_1, 1, look(1).y, true, here, hidden);
#endif
#if LEVELS > 1
    gather(hidden_points_2, 2, look(2).y, true, here, hidden);
#endif
#if LEVELS > 2
    gather(hidden_points_3, 3, look(3).y, true, here, hidden);
#endif
#endif
    add_hidden(layers, hidden);
    color = compose(layers);
#ifdef INSPECT
    layer_0 = layers.front;
    layer_1 = layers.same;
    layer_2 = layers.behind;
    fetches = fetches_made;
#endif
}
