// The picture: for each pixel, rays through points of the lens, each stopped by the first surface it meets in the layers
// (Lee 2009 section 4.3). Rays that leave the canvas without having met anything are left out of the mean.
//
// Cost per ray: one mask walk, one to three probes in each of the two or three layers that the mask leaves, one colour.
#include "methods/multiview/ray.glsl"

uniform sampler2DArray layer_color;
uniform usampler2D mask;
uniform sampler2D lens_points;
uniform vec3 background;
uniform int mask_shift;
uniform int guard;

out vec4 color;

int lowest_bit(uint bits)
{
#if __VERSION__ >= 400
    return findLSB(bits);
#else
    int k = 0;
    while ((bits >> k & 1u) == 0u) ++k;
    return k;
#endif
}

// Colour that the ray meets, and 1; 0 when it left the canvas.
vec4 ray(vec2 pixel, vec2 lens_point, uint layers)
{
    for (uint left = layers; left != 0u; left &= left - 1u) {
        int k = lowest_bit(left);
        vec2 a = pixel - lens_point * coc_radius(slab_front(k)), b = pixel - lens_point * coc_radius(slab_back(k));
        ivec2 texel;
        float t;
        if (intersect(k, a, b, texel, t)) return vec4(texelFetch(layer_color, ivec3(texel, k), 0).rgb, 1.0);
    }
    vec2 end = pixel - lens_point * coc_radius(slabs.farthest);
    vec2 size = vec2(textureSize(layer_color, 0).xy);
    bool inside = all(greaterThanEqual(end, vec2(0.0))) && all(lessThan(end, size));
    return inside ? vec4(background, 1.0) : vec4(0.0);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), size = textureSize(layer_color, 0).xy;
    color = vec4(background, 1.0);
    // Nobody looks at the guard band of the result.
    if (any(lessThan(pixel, ivec2(guard))) || any(greaterThanEqual(pixel, size - guard))) return;
    uint layers = texelFetch(mask, pixel >> mask_shift, 0).r;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < params.samples; ++i)
        sum += ray(gl_FragCoord.xy, texelFetch(lens_points, ivec2(i, 0), 0).xy, layers);
    color = sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : ray(gl_FragCoord.xy, vec2(0.0), layers);
    if (color.a == 0.0) color = vec4(background, 1.0);
}
