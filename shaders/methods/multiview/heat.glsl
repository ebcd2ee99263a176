// Numbers as colours: black, blue, red, yellow, white from 0 to 1.
vec3 heat(float x)
{
    return clamp(vec3(3.0 * x - 0.75, 3.0 * x - 1.75, x < 0.5 ? 3.0 * x : max(3.0 - 6.0 * x, 6.0 * x - 5.0)), 0.0, 1.0);
}
