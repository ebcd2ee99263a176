// Half the size, rounded up, from what is known: the mean of the known children. ENOUGH known children of four are enough
// to be known with full weight (Gortler's saturated weights).
//
// The file named in KNOWN declares
//     void known(ivec2 texel, out vec4 color, out float extra)   // both times the weight, which is in color.a
#include <KNOWN>

uniform ivec2 fine_size;

const float ENOUGH = 1.0;

layout(location = 0) out vec4 color;
#ifdef COLOR_ALONE
float extra;
#else
layout(location = 1) out float extra;
#endif

void main()
{
    color = vec4(0.0);
    extra = 0.0;
    ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x) {
            ivec2 child = first + ivec2(x, y);
            if (any(greaterThanEqual(child, fine_size))) continue;
            vec4 child_color;
            float child_extra;
            known(child, child_color, child_extra);
            color += child_color;
            extra += child_extra;
        }
    float scale = 1.0 / max(color.a, ENOUGH);
    color *= scale;
    extra *= scale;
}
