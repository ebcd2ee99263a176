// DoN magnified with the circular filter (step 4 of figure 10, figure 8c): how blurred the foreground is that may reach
// here. It is smooth over many pixels, so it is made at half the size of the picture.
#include "methods/mipmap/ring.glsl"

uniform sampler2D even_levels;
uniform sampler2D odd_levels;
uniform float top;  // the level that fits the greatest blur, between two whole ones lest it pop

out float don;

void main()
{
    vec2 position = 2.0 * gl_FragCoord.xy;
    int level = min(int(top), LAST_LEVEL - 1);
    float share = top - float(level), reach = exp2(top - 1.0);
    don = CENTER * between_levels(even_levels, odd_levels, level, share, position).z;
    for (int i = 0; i < 8; ++i)
        don += TAP * between_levels(even_levels, odd_levels, level, share, position + RING[i] * reach).z;
}
