// IEC 61966-2-1 transfer function, linear to encoded, clipped to the display's range.
vec3 srgb_encode(vec3 linear)
{
    vec3 clipped = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(clipped, vec3(1.0 / 2.4)) - 0.055, 12.92 * clipped, lessThanEqual(clipped, vec3(0.0031308)));
}
