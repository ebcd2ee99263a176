// Where the texels of layers lie on the canvas. Positions in layers are in texels.
uniform float detail;        // texels of a layer per pixel
uniform float detail_shift;  // where their grid begins, pixels, so that one in `detail` has a pixel's centre

#ifdef SURFACES
#include "include/shading.glsl"
#include <View>

// From the lens centre through texel position `q`, as far as depth 1; local space.
vec3 toward(vec2 q)
{
    vec2 pixel = q / detail + detail_shift;
    return view.corner + pixel.x * view.right + pixel.y * view.up;
}

// What layers hold of a surface: its colour, normal and roughness, emission and metalness.
vec3 lit(vec4 color, vec4 normal, vec4 emissive, float occlusion, vec3 to_eye)
{
    Surface surface = Surface(color.rgb, 1.0, normal.xyz, emissive.w, normal.w, occlusion, emissive.rgb);
    return min(shade(surface, to_eye), 1e4);
}
#endif
