// World directions on an equirectangular picture: +y up, the middle of the picture towards -z.
vec2 equirect(vec3 direction)
{
    const float HALF_TURN = 0.31830989;
    return vec2(atan(direction.x, -direction.z) * 0.5, asin(clamp(direction.y, -1.0, 1.0))) * HALF_TURN + 0.5;
}

vec3 equirect_direction(vec2 uv)
{
    vec2 angle = (uv - 0.5) * vec2(6.2831853, 3.14159265);
    return vec3(sin(angle.x) * cos(angle.y), sin(angle.y), -cos(angle.x) * cos(angle.y));
}
