// The squares over which layers are averaged for cones. Each layer is made smaller about the middle of its image, so that a
// mirrored scene has mirrored squares.
#include "include/lens.glsl"
#include "methods/multiview/slabs.glsl"

uniform float cone_width;  // texels of a layer per pixel of CoC radius

// Side of the squares of layer `k`, texels: the radius of a cone where it passes the middle of the layer. A layer in which
// the focus lies has surfaces that are sharp, which wider squares would blur, so it has those of a texel.
float square(int k)
{
    float front = coc_radius(slab_front(k)), back = coc_radius(slab_back(k));
    float middle = 0.5 * abs(front + back), half_ = 0.5 * abs(front - back);
    return max(cone_width * clamp(2.0 * (middle - half_), 0.0, middle), 1.0);
}
