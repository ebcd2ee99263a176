// A sprite's light on the layer that eq 6 assigns it to at each pixel; blending adds (section 3.3).
#include <Params>
#include "methods/splatting/point.glsl"
#include "methods/splatting/sprite.glsl"
#include "methods/splatting/layers.glsl"

uniform sampler2D points;
uniform int level;

flat in vec4 point;
flat in vec2 center;
flat in float share;

layout(location = 0) out vec4 same;
layout(location = 1) out vec4 behind;
#ifndef OF_HIDDEN
layout(location = 2) out vec4 in_front;
#endif

void main()
{
    float coc = point_coc(point), coc_here = point_coc(texelFetch(points, ivec2(gl_FragCoord.xy), 0));
    Ends ends = ends_of_layer(coc_here);
    float apart = coc - coc_here;
    float weight = alpha((gl_FragCoord.xy - center) / float(1 << level), coc, share, level);
    vec4 light = vec4(point.rgb, 1.0) * weight;
    behind = light * beyond(apart, ends);
    same = light - behind;
#ifndef OF_HIDDEN
    in_front = light * beyond(-apart, ends);
    same -= in_front;
#endif
}
