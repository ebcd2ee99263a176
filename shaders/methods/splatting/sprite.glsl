// The sprite of the lens's distribution of light, and the weight it gives a pixel (eq 5).
#include "methods/splatting/disc.glsl"

// Radius of the sprite for a CoC radius, px. Without antialiasing a pixel is a sample that errs by up to half a pixel in
// place, which a blur as narrow as a pixel must average out too: below 1.5 px the sprite is wider than the CoC, at 0 it
// is the pixel itself. Measured against the reference: 0.3 to 1.2 dB.
float sprite_radius(float coc)
{
    float radius = abs(coc);
    return sqrt(radius * radius + 0.25 * max(1.0 - radius / 1.5, 0.0));
}

// A(p, q): what a point with `share` puts on the pixel at `offset` from it.
float alpha(vec2 offset, float coc, float share)
{
    float radius = sprite_radius(coc);
    return max(sprite(offset, radius), 0.0) * share / (PI * radius * radius);
}
