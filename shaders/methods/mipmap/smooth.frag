// DoB smoothed around what is blurred in front of the focus (eq 10-11, figure 8): where foreground is near, the blur is
// read from a coarse level of B, so that it fades out across the silhouette instead of stopping there.
#include "methods/mipmap/ring.glsl"

uniform float top;  // level of N that fits the greatest blur, between two whole ones

out vec4 smoothed;

void main()
{
    vec2 position = gl_FragCoord.xy;
    int level = min(int(top), LAST_LEVEL - 1);
    float reach = exp2(float(level));
    float don = CENTER * between_levels(level, top - float(level), position).z;
    for (int i = 0; i < 8; ++i) don += TAP * between_levels(level, top - float(level), position + RING[i] * reach).z;

    float n = paper_level(don);
    int lower = min(int(n), LAST_LEVEL - 1);
    vec4 zbn = between_levels(lower, n - float(lower), position);
    smoothed = vec4(between_levels(0, 0.0, position).x, zbn.y, don, 0.0);
}
