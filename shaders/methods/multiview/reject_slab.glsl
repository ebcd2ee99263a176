// Leave out what belongs to another layer.
#include "methods/multiview/slabs.glsl"

#ifdef ONE_LAYER
uniform int slab;
#else
flat in int slab;
#endif

bool reject(float inverse_depth, ivec2 pixel)
{
    return !slab_holds(slab, inverse_depth);
}
