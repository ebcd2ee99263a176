// Inverse depths of up to eight peels side by side: a layer then learns them all in one or two fetches. Those of the first
// are there by themselves as well, to be fetched between pixels.
uniform sampler2D depth0;
uniform sampler2D depth1;
uniform sampler2D depth2;
uniform sampler2D depth3;
#if PEELS > 4
uniform sampler2D depth4;
uniform sampler2D depth5;
uniform sampler2D depth6;
uniform sampler2D depth7;
#endif

layout(location = 0) out vec4 depths_first;
layout(location = 1) out float depths_nearest;
#if PEELS > 4
layout(location = 2) out vec4 depths_last;
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    depths_first = vec4(texelFetch(depth0, pixel, 0).r, texelFetch(depth1, pixel, 0).r,
        texelFetch(depth2, pixel, 0).r, texelFetch(depth3, pixel, 0).r);
    depths_nearest = depths_first.r;
#if PEELS > 4
    depths_last = vec4(texelFetch(depth4, pixel, 0).r, texelFetch(depth5, pixel, 0).r,
        texelFetch(depth6, pixel, 0).r, texelFetch(depth7, pixel, 0).r);
#endif
}
