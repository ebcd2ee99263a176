// The squares over which layers are averaged for cones. Each layer is made smaller about the middle of its image, so that a
// mirrored scene has mirrored squares.
#include "include/lens.glsl"
#include "methods/multiview/slabs.glsl"

uniform float cone_width;  // texels of a layer per pixel of CoC radius

// Side of the squares of layer `k`, texels: the radius of a cone where it passes the middle of the layer.
float square(int k)
{
    return max(cone_width * abs(coc_radius(0.5 * (slab_front(k) + slab_back(k)))), 1.0);
}
