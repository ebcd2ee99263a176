// Any distribution of light over the lens, from its summed-area table: the light that the lens sends through the box of
// a pixel is four fetches, exact at every size, so that a small sprite is as right as a large one.
//
// `aperture_sums` has a texel more than the aperture each way: texel (i, j) is the sum of the i columns to its left and
// the j rows below it. A point lands at p + c v for each point v of the lens (y up), so the pixel at `offset` is lit
// through v = offset / c: upright behind the focus, turned by 180 degrees in front of it.
uniform sampler2D aperture_sums;
uniform float aperture_half_width;  // lens radii

float light_below(vec2 point)
{
    vec2 size = vec2(textureSize(aperture_sums, 0));
    vec2 texel = clamp(point / (2.0 * aperture_half_width) + 0.5, 0.0, 1.0) * (size - 1.0);
    return texture(aperture_sums, (texel + 0.5) / size).r;
}

// Light per area in units of the uniform disc's, as disc.glsl gives it; `radius` has the sign of the CoC.
float sprite(vec2 offset, float radius, int level)
{
    vec2 from = (offset - 0.5) / radius, to = (offset + 0.5) / radius;
    float light = light_below(to) - light_below(vec2(from.x, to.y)) - light_below(vec2(to.x, from.y)) + light_below(from);
    bool within = dot(offset, offset) < (extent * abs(radius) + 0.71) * (extent * abs(radius) + 0.71);
    return within ? max(light, 0.0) * PI * radius * radius : 0.0;
}

float sprite_area(float squared_radius, int level)
{
    return PI * squared_radius;
}

float rim(int level)
{
    return 0.71;
}
