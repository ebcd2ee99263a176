// A layer averaged over squares as wide as its cones, colour premultiplied by how much of the square is covered. Surfaces
// are averaged, and so is their light for the lens centre (seen.glsl).
#include "methods/multiview/cones.glsl"
#include "methods/multiview/grid.glsl"

uniform sampler2DArray layer_color;
uniform sampler2DArray layer_inverse_depth;
#ifdef SURFACES
uniform sampler2DArray layer_normal;
uniform sampler2DArray layer_emissive;
uniform sampler2DArray layer_occlusion;
#endif

flat in int slab;

layout(location = 0) out vec4 color;
#ifdef SURFACES
layout(location = 1) out vec4 normal_roughness;
layout(location = 2) out vec4 light_metallic;
layout(location = 3) out float occlusion;
#endif

void main()
{
    float side = square(slab);
    vec2 size = vec2(textureSize(layer_color, 0).xy);
    vec2 low = (floor(gl_FragCoord.xy) - size / 2.0) * side + size / 2.0;
    // What lies outside the canvas is not known: squares beyond the border are the first or last one inside.
    low = mix(low, max(size - side, 0.0), greaterThan(low, size - 0.5));
    low = mix(low, vec2(0.0), lessThan(low, 0.5 - vec2(side)));
    vec2 high = min(low + side, size);
    low = max(low, 0.0);
    ivec2 first = ivec2(low), last = ivec2(ceil(high)) - 1;
    vec4 sums[4] = vec4[4](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    float whole = 0.0;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            vec2 inside = min(vec2(x + 1, y + 1), high) - max(vec2(x, y), low);
            float weight = inside.x * inside.y;
            ivec3 texel = ivec3(x, y, slab);
            vec4 held = texelFetch(layer_color, texel, 0);
            whole += weight;
            if (!slab_owns(slab, texelFetch(layer_inverse_depth, texel, 0).r)) continue;
            sums[0] += weight * held;
#ifdef SURFACES
            vec4 normal = texelFetch(layer_normal, texel, 0), emissive = texelFetch(layer_emissive, texel, 0);
            float open = texelFetch(layer_occlusion, texel, 0).r;
            vec3 light = lit(held, normal, emissive, open, -normalize(toward(vec2(x, y) + 0.5)));
            sums[1] += weight * normal;
            sums[2] += weight * vec4(light, emissive.w);
            sums[3].r += weight * open;
#endif
        }
    color = sums[0] / whole;
#ifdef SURFACES
    normal_roughness = sums[1] / whole;
    light_metallic = sums[2] / whole;
    occlusion = sums[3].r / whole;
#endif
}
