// Sends a triangle to every layer it overlaps; each keeps only what lies inside. With FARTHEST to
// the layer of its farthest corner alone, as in Lee 2009 section 4.2, which a second pass has to put right.
#if INVOCATIONS > 1
layout(triangles, invocations = INVOCATIONS) in;
#else
layout(triangles) in;
#define gl_InvocationID 0
#endif
layout(triangle_strip, max_vertices = MOST_VERTICES) out;

#include "methods/multiview/slabs.glsl"

uniform float closest;  // greatest 1/z that is drawn; what is nearest of all is in view, so it need not be much more

in Vertex
{
    vec3 position;
    vec3 normal;
    vec4 color;
    vec4 texcoord;
} corner[];

out Vertex
{
    vec3 position;
    vec3 normal;
    vec4 color;
    vec4 texcoord;
} vertex;
flat out int slab;

int layer_at(float inverse_depth, float margin)
{
    float k = floor((slabs.nearest - inverse_depth) / slabs.step + margin);
    return int(clamp(k, 0.0, float(slabs.count - 1)));
}

// Near and far plane of layer `k`: what lies outside is cut off before it is shaded, as a software rasteriser shades what
// a fragment test leaves out. The test decides only at the cuts, where they lie within `margin` of a layer of them.
float depth_in_layer(int k, float w, float margin)
{
    float front = k == 0 ? closest : slab_front(k) + margin * slabs.step;
    float back = slab_back(k) - margin * slabs.step;
    return ((front + back) * w - 2.0) / (front - back);
}

void main()
{
    float nearest = 0.0, farthest = 3e38;
    for (int i = 0; i < 3; ++i) {
        // A corner behind the camera is cut off at the near plane, in the first layer.
        float inverse_depth = gl_in[i].gl_Position.w > 0.0 ? 1.0 / gl_in[i].gl_Position.w : 3e38;
        nearest = max(nearest, inverse_depth);
        farthest = min(farthest, inverse_depth);
    }
#ifdef FARTHEST
    int last = layer_at(farthest, 0.0), first = last;
#else
    // A little more than the overlap, for what rounding between the stages may do.
    float margin = slabs.overlap + 1e-3;
    int first = layer_at(nearest, -margin), last = layer_at(farthest, margin);
#endif
    int base = gl_InvocationID * MOST_LAYERS;
    for (int k = max(first, base); k <= min(last, base + MOST_LAYERS - 1); ++k) {
        for (int i = 0; i < 3; ++i) {
            gl_Layer = k;
            gl_Position = gl_in[i].gl_Position;
#ifndef FARTHEST
            gl_Position.z = depth_in_layer(k, gl_Position.w, margin);
#endif
            slab = k;
            vertex.position = corner[i].position;
            vertex.normal = corner[i].normal;
            vertex.color = corner[i].color;
            vertex.texcoord = corner[i].texcoord;
            EmitVertex();
        }
        EndPrimitive();
    }
}
