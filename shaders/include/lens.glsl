// The thin lens of dofview/lens.py: signed circle-of-confusion radius in pixels, negative in front of the focus.
// c = B (1/s - 1/z) is affine in 1/z, which is what depth images hold; 1/z = 0 is background at infinity.
#include <Lens>

float coc_radius(float inverse_depth)
{
    return lens.scale * (lens.inverse_focus - inverse_depth);
}
