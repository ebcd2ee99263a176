// The sprite of the lens's distribution of light, and the weight it gives a pixel (eq 5). Points of level l stand for
// blocks of 2^l x 2^l pixels; lengths are in texels of their level, and so a block is the pixel of its level.
uniform float extent;  // how far the sprite reaches, CoC radii
uniform float spread;  // its standard deviation on one axis, CoC radii

#ifdef APERTURE
#include "methods/splatting/aperture.glsl"
#else
#include "methods/splatting/disc.glsl"
#endif

// Squared radius of a point's sprite, texels^2.
//
// A pixel: without antialiasing it is a sample that errs by up to half a pixel in place, which a blur as narrow as a pixel
// must average out too. Below 1.5 px the sprite is wider than the CoC, at 0 it just fills the pixel. Measured against
// the reference: 0.3 to 1.2 dB.
//
// A block: it has blurred by its own width already, (4^l - 1) / 12 px^2 more than a pixel. That much less is left for the
// sprite, whose variance on an axis is its squared spread.
float squared_sprite_radius(float coc, int level)
{
    float own = 0.5 / extent, texel = float(1 << level);
    if (level == 0) return coc * coc + own * own * max(1.0 - abs(coc) / 1.5, 0.0);
    return max(coc * coc - (texel * texel - 1.0) / (12.0 * spread * spread), 0.25) / (texel * texel);
}

float sprite_radius(float coc, int level)
{
    return sqrt(squared_sprite_radius(coc, level));
}

// CoC radius, px, up to which the sprite of a pixel stays within it.
float sharp_radius()
{
#ifdef APERTURE
    return 1.0 / (6.0 * extent * extent);
#else
    return SHARP_PX;  // the rim of disc.glsl bends inwards
#endif
}

// A(p, q): what a point with `share` puts on the pixel at `offset` from it, texels.
float alpha(vec2 offset, float coc, float share, int level)
{
    float squared = squared_sprite_radius(coc, level), radius = sqrt(squared);
    return sprite(offset, coc < 0.0 ? -radius : radius, level) * share / sprite_area(squared, level);
}
