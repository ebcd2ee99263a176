// Inverse depths of up to eight peels side by side: a layer then learns them all in one or two fetches.
uniform sampler2D depth0;
uniform sampler2D depth1;
#if PEELS > 2
uniform sampler2D depth2;
#endif
#if PEELS > 3
uniform sampler2D depth3;
#endif
#if PEELS > 4
uniform sampler2D depth4;
#endif
#if PEELS > 5
uniform sampler2D depth5;
#endif
#if PEELS > 6
uniform sampler2D depth6;
#endif
#if PEELS > 7
uniform sampler2D depth7;
#endif

#include "include/texel.glsl"

layout(location = 0) out vec4 depths_first;
#if PEELS > 4
layout(location = 1) out vec4 depths_last;
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    depths_first = vec4(texel_of(depth0, pixel).r, texel_of(depth1, pixel).r, 0.0, 0.0);
#if PEELS > 2
    depths_first.z = texel_of(depth2, pixel).r;
#endif
#if PEELS > 3
    depths_first.w = texel_of(depth3, pixel).r;
#endif
#if PEELS > 4
    depths_last = vec4(texel_of(depth4, pixel).r, 0.0, 0.0, 0.0);
#endif
#if PEELS > 5
    depths_last.y = texel_of(depth5, pixel).r;
#endif
#if PEELS > 6
    depths_last.z = texel_of(depth6, pixel).r;
#endif
#if PEELS > 7
    depths_last.w = texel_of(depth7, pixel).r;
#endif
}
