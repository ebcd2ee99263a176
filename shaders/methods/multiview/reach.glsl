// How far a lens ray can be from its pixel while it passes through a layer.
#include "include/lens.glsl"
#include "methods/multiview/slabs.glsl"

uniform float lens_extent;  // largest coordinate of a lens sample, lens radii
uniform float footprint;    // what a fetch reads around its point, pixels per pixel of CoC radius

// Pixels; the overlap is in it, and a pixel for rounding.
float reach_pixels(int k)
{
    float overlap = slabs.overlap * slabs.step;
    float largest = max(abs(coc_radius(slab_front(k) + overlap)), abs(coc_radius(slab_back(k) - overlap)));
    return largest * (lens_extent + footprint) + 2.0;
}

int reach_tiles(int k)
{
    return int(min(ceil(reach_pixels(k) / float(TILE)), 4096.0));
}
