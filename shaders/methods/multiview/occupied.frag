// One bit per layer: set where the layer holds a surface at this pixel.
#include <Slabs>

uniform sampler2DArray layer_inverse_depth;

out uint occupied;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    occupied = 0u;
    for (int k = 0; k < slabs.count; ++k)
        if (texelFetch(layer_inverse_depth, ivec3(pixel, k), 0).r > 0.0) occupied |= 1u << k;
}
