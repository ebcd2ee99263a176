// Blended surfaces in the layers, which hold only what is at least half opaque. Where a layer holds what the pinhole picture
// shows, it takes the picture's colour, in which they are laid over it in order of depth. With MISSING, before that, the
// depths of what the picture shows and no layer has: glass before nothing.
#include "methods/multiview/grid.glsl"
#include "methods/multiview/slabs.glsl"

uniform sampler2D inverse_depth;  // of the pinhole picture
uniform int layer;
#ifdef MISSING
uniform sampler2DArray layer_color;
out float depth;
#else
uniform sampler2DArray layer_inverse_depth;
uniform sampler2D pinhole;
out vec4 color;

const float SAME = 0.05;  // of a layer: how far from the picture's surface, on a finer grid, one is still the same
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) / int(detail);
    ivec3 texel = ivec3(gl_FragCoord.xy, layer);
    float seen = texelFetch(inverse_depth, pixel, 0).r;
#ifdef MISSING
    if (seen <= 0.0 || !slab_owns(layer, seen) || texelFetch(layer_color, texel, 0).a > 0.0) discard;
    depth = seen;
#else
    float here = texelFetch(layer_inverse_depth, texel, 0).r;
    if (here <= 0.0 || abs(here - seen) > max(SAME * slabs.step, 1e-4 * seen)) discard;
    color = vec4(texelFetch(pinhole, pixel, 0).rgb, 1.0);
#endif
}
