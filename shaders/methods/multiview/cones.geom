// For a patch of the canvas, in every layer that holds anything there, the squares that it touches.
layout(triangles) in;
layout(triangle_strip, max_vertices = 128) out;

#include "methods/multiview/cones.glsl"
#include "methods/multiview/grid.glsl"

uniform usampler2D tiles;
uniform sampler2DArray layer_color;

flat out int slab;

void main()
{
    ivec2 size = textureSize(layer_color, 0).xy, count = textureSize(tiles, 0);
    int across = (size.x / int(detail) + PATCH - 1) / PATCH;
    ivec2 patch_ = ivec2(gl_PrimitiveIDIn % across, gl_PrimitiveIDIn / across);
    ivec2 first = patch_ * (PATCH / TILE), last = min(first + PATCH / TILE, count);
    uint bits = 0u;
    for (int y = first.y; y < last.y; ++y)
        for (int x = first.x; x < last.x; ++x) bits |= texelFetch(tiles, ivec2(x, y), 0).r;
    vec2 from = vec2(patch_ * PATCH) * detail, to = min(from + float(PATCH) * detail, vec2(size));
    vec2 middle = vec2(size) / 2.0;
    for (int k = 0; k < slabs.count; ++k) {
        if ((bits >> k & 1u) == 0u) continue;
        float side = square(k);
        // At the borders one more: bilinear fetches read it.
        vec2 low = floor((from - middle) / side + middle) - vec2(equal(from, vec2(0.0)));
        vec2 high = ceil((to - middle) / side + middle) + vec2(equal(to, vec2(size)));
        vec4 box = vec4(low, high) / vec4(size, size) * 2.0 - 1.0;
        for (int i = 0; i < 4; ++i) {
            gl_Layer = k;
            slab = k;
            gl_Position = vec4((i & 1) == 0 ? box.x : box.z, (i & 2) == 0 ? box.y : box.w, 0.0, 1.0);
            EmitVertex();
        }
        EndPrimitive();
    }
}
