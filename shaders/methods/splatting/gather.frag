// Splatting turned round: each pixel q collects from the points whose sprites reach it, classifies them by eq 6 into
// sums that never leave its registers, and composes them by eq 7. The same picture as drawing the sprites, with no
// blending and no layers in memory; the cost is one fetch per point within reach.
#include <Params>
#include "methods/splatting/point.glsl"
#include "methods/splatting/sprite.glsl"
#include "methods/splatting/layers.glsl"

uniform sampler2D visible_points;
uniform sampler2D hidden_points;
uniform sampler2D reach;
uniform int guard;

layout(location = 0) out vec4 color;
#ifdef DEBUG
layout(location = 1) out vec4 layer_0;
layout(location = 2) out vec4 layer_1;
layout(location = 3) out vec4 layer_2;
#endif

void gather(sampler2D points, float radius, bool hidden, float coc_here, float tolerance, inout Layers layers)
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(points, 0) - 1;
    float bound = radius + 0.71;
    int rows = int(ceil(bound));
    for (int y = max(pixel.y - rows, 0); y <= min(pixel.y + rows, last.y); ++y) {
        float dy = float(y - pixel.y);
        int columns = int(ceil(sqrt(max(bound * bound - dy * dy, 0.0))));
        for (int x = max(pixel.x - columns, 0); x <= min(pixel.x + columns, last.x); ++x) {
            vec4 point = texelFetch(points, ivec2(x, y), 0);
            float coc = point_coc(point);
            vec4 light = vec4(point.rgb, 1.0) * alpha(vec2(pixel - ivec2(x, y)), coc, point_share(point));
            float layer = layer_of(coc, coc_here, tolerance);
            if (hidden) layer = max(layer, 0.0);
            layers.front += layer < 0.0 ? light : vec4(0.0);
            layers.same += layer == 0.0 ? light : vec4(0.0);
            layers.behind += layer > 0.0 ? light : vec4(0.0);
        }
    }
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 here = texelFetch(visible_points, pixel, 0);
    vec3 look = texelFetch(reach, pixel / TILE, 0).xyz;
    bool inside = all(greaterThanEqual(pixel, ivec2(guard))) &&
        all(lessThan(pixel, textureSize(visible_points, 0) - guard));
    if (!inside) look = vec3(-1.0);
    float coc = point_coc(here), tolerance = layer_tolerance(coc);
    Layers layers = Layers(vec4(0.0), vec4(0.0), vec4(0.0));
    if (look.x >= 0.0) gather(visible_points, look.x, false, coc, tolerance, layers);
#ifdef HIDDEN
    Layers hidden = Layers(vec4(0.0), vec4(0.0), vec4(0.0));
    if (look.y >= 0.0) gather(hidden_points, look.y, true, coc, tolerance, hidden);
    add_hidden(layers, hidden);
#endif
    color = look.x >= 0.0 ? compose(layers) : vec4(here.rgb, 1.0);
#ifdef DEBUG
    layer_0 = layers.front;
    layer_1 = layers.same;
    layer_2 = layers.behind;
#endif
}
