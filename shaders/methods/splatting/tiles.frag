// Largest CoC radius in each tile of TILE x TILE pixels: x of what is in front of the focus, y of what is behind it,
// z of the hidden points; -1 where there are none.
#include "methods/splatting/point.glsl"

uniform sampler2D visible_points;
uniform sampler2D hidden_points;

out vec4 largest;

void main()
{
    ivec2 from = ivec2(gl_FragCoord.xy) * TILE, to = min(from + TILE, textureSize(visible_points, 0));
    largest = vec4(-1.0);
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) {
            vec4 point = texelFetch(visible_points, ivec2(x, y), 0);
            float coc = point_coc(point);
            if (coc < 0.0) largest.x = max(largest.x, -coc);
            else largest.y = max(largest.y, coc);
#ifdef HIDDEN
            point = texelFetch(hidden_points, ivec2(x, y), 0);
            if (point != NO_POINT) largest.z = max(largest.z, abs(point_coc(point)));
#endif
        }
}
