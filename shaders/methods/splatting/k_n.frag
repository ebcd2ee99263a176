// k_n(C) of eq 5 for the sprite in use: C^2 over the sum of a sprite's weights, C = 2 i / K_N_STEPS px. What the pixels of
// a sprite really add up to is counted here, so that every point keeps its energy at every fractional C.
#include "methods/splatting/point.glsl"
#include "methods/splatting/sprite.glsl"

out float k;

void main()
{
    float radius = sprite_radius((gl_FragCoord.x - 0.5) / K_N_STEPS, 0);
    int reach = int(ceil(radius * extent + 1.0));
    float sum = 0.0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) sum += sprite(vec2(x, y), radius, 0);
    k = 4.0 * radius * radius / sum;
}
