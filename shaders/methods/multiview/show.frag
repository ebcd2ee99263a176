// What the layers hold, to look at: one layer's colour or coverage, or how many layers a pixel's rays walk.
#include "methods/multiview/grid.glsl"
#include "methods/multiview/heat.glsl"
#include <Params>
#include <Slabs>

uniform sampler2DArray layer_color;
uniform usampler2D mask;
uniform int mask_shift;

out vec4 color;

void main()
{
    ivec2 texel = ivec2((gl_FragCoord.xy - detail_shift) * detail);
    vec4 held = texelFetch(layer_color, ivec3(texel, min(params.shown_layer, max(slabs.count - 1, 0))), 0);
    if (slabs.count == 0) held = vec4(0.0);
    if (params.show == SHOW_COLOR) color = vec4(held.rgb, 1.0);
    else if (params.show == SHOW_COVERAGE) color = vec4(held.aaa, 1.0);
    else {
        uint bits = texelFetch(mask, ivec2(gl_FragCoord.xy) >> mask_shift, 0).r;
        int layers = 0;
        for (int k = 0; k < slabs.count; ++k) layers += int(bits >> k & 1u);
        color = vec4(heat(float(layers) / float(max(slabs.count, 1))), 1.0);
    }
}
