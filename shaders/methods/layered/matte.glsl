// How much of each peeled surface belongs to one layer, and how a layer joins the buffer in front of or behind it.
//
// Depths are inverse: nearer is greater, background at infinity is 0. A surface between the depths of two layers is
// shared out between them, linearly in 1/z, so that its blur is the mean of theirs (Schedl 2012, eq 3-4). How exactly is
// what MATTING chooses.
//
// SHARED: anchors lie at the layers' own depths. Of a surface between layers k-1 and k, the nearer of them takes the
// `head`, 1-t, and layer k the `tail`, t. In the front buffer the head is there first and has been blurred: beside it
// the tail adds t, or what coverage is left, so that the silhouette is the mean of the two blurs. In the back buffer the
// tail is there first, and the sharper head is blended over it. Inside a surface the tail must be whole, or what it
// hides would shine through; at silhouettes it must be t, or they would be widened and small lights be brighter. So it
// is in between by how much of the surface is around (`presence`).
// PAPER: anchors lie half way between layers; omega and omega-dot as printed. The tail is whole in front too and lies
// under its own head, which widens every silhouette by a part of the blur between two layers.
#include "include/lens.glsl"
#include "methods/layered/place.glsl"

const float MARGIN = 1e-5;

uniform sampler2D depths_first;
uniform sampler2D color0;
#if PEELS > 1
uniform sampler2D color1;
#endif
#if PEELS > 2
uniform sampler2D color2;
#endif
#if PEELS > 3
uniform sampler2D color3;
#endif
#if PEELS > 4
uniform sampler2D depths_last;
uniform sampler2D color4;
#endif
#if PEELS > 5
uniform sampler2D color5;
#endif
#if PEELS > 6
uniform sampler2D color6;
#endif
#if PEELS > 7
uniform sampler2D color7;
#endif
uniform vec4 anchors;  // inverse depths z_(k-2), z_(k-1), z_k, z_(k+1) of layer k, falling
#ifdef PRESENCE
uniform sampler2D depths_nearest;  // of the first peel, fetched bilinearly: a reach that grows finds nothing all at once
uniform float reach;  // px: how far the filter carries what is in this layer
#endif
uniform vec4 background;  // alpha 0: it cannot be seen, and what lies behind the last surface does not matter
#ifdef SKY
uniform sampler2D sky_distance;  // px from each cell of CELL x CELL pixels to the background that can be seen
#endif

// With EXHAUSTED no pixel has surfaces behind the last peel: there the background is as good as peeled.
#ifdef EXHAUSTED
const int COUNT = PEELS + 1;
#else
const int COUNT = PEELS;
#endif

struct Surface
{
    float inverse_depth;
    vec4 color;  // alpha 0 or 1
};

#ifdef SKY
// How much of the background behind a surface counts: all near where it is seen, nothing where the surface's blur cannot
// let it through. On steep surfaces, where layers do not quite close, it would shine through all the same.
float shining(vec2 place, float inverse_depth)
{
    vec2 cells = place / (float(CELL) * pixel_size * vec2(textureSize(sky_distance, 0)));
    float sigma = lens.sigma * abs(coc_radius(inverse_depth));
    return 1.0 - smoothstep(1.5, 3.0, texture(sky_distance, cells).r / max(sigma, 1.0));
}
#endif

void fetch_surfaces(vec2 place, out Surface surfaces[COUNT])
{
    float inverse_depths[9];
    vec4 depths = textureLod(depths_first, place, 0.0), colors[COUNT];
    for (int i = 0; i < 4; ++i) inverse_depths[i] = depths[i];
    colors[0] = textureLod(color0, place, 0.0);
#if PEELS > 1
    colors[1] = textureLod(color1, place, 0.0);
#endif
#if PEELS > 2
    colors[2] = textureLod(color2, place, 0.0);
#endif
#if PEELS > 3
    colors[3] = textureLod(color3, place, 0.0);
#endif
#if PEELS > 4
    depths = textureLod(depths_last, place, 0.0);
    for (int i = 0; i < 4; ++i) inverse_depths[4 + i] = depths[i];
    colors[4] = textureLod(color4, place, 0.0);
#endif
#if PEELS > 5
    colors[5] = textureLod(color5, place, 0.0);
#endif
#if PEELS > 6
    colors[6] = textureLod(color6, place, 0.0);
#endif
#if PEELS > 7
    colors[7] = textureLod(color7, place, 0.0);
#endif
    // Behind the last surface of a pixel is the background, which is known.
    vec4 behind_all = vec4(background.rgb, 1.0) * background.a;
#ifdef EXHAUSTED
    inverse_depths[PEELS] = 0.0;
    colors[PEELS] = vec4(0.0);
#endif
    for (int m = 0; m < COUNT; ++m) {
        surfaces[m] = Surface(inverse_depths[m], inverse_depths[m] > 0.0 ? vec4(colors[m].rgb, 1.0) : behind_all);
#ifdef SKY
        if (m == 0) behind_all *= shining(place, inverse_depths[0]);
#endif
    }
}

// 0 at `near` and before, 1 at `far` and beyond, and exactly so within MARGIN of them: a wall in the plane of focus, a few
// millionths of a pixel to either side of it, is no content of the layers next to it.
float ramp(float inverse_depth, float near, float far)
{
    return clamp((near - inverse_depth) / max(near - far, 1e-37) * (1.0 + 2.0 * MARGIN) - MARGIN, 0.0, 1.0);
}

// The part of a surface that lies behind this layer's anchor. A surface right behind another one of the same interval
// (`before`) waits until that one is complete, or it would be blended over what hides it.
float head(float inverse_depth, float before)
{
    return before >= anchors.z ? 1.0 - ramp(inverse_depth, anchors.z, anchors.w) : 0.0;
}

float tail(float inverse_depth, float before)
{
    float share = ramp(inverse_depth, anchors.y, anchors.z);
    return before >= anchors.y ? share : float(share > 0.0);
}

#ifdef PRESENCE
// 1 inside a surface, towards 0 where what is around a pixel lies farther than it by a quarter of the interval. A steep
// surface is no border: what lies farther on one side of the pixel and as much nearer on the other belongs to it, since
// 1/z of a plane is linear in the picture.
float presence(vec2 place, float inverse_depth)
{
    const vec2 around[4] = vec2[4](vec2(1.0, 0.0), vec2(0.7, 0.7), vec2(0.0, 1.0), vec2(-0.7, 0.7));
    float quarter = max(0.25 * (anchors.y - anchors.z), 1e-37), missing = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 apart = reach * around[i] * pixel_size;
        vec2 farther = (inverse_depth
            - vec2(texture(depths_nearest, place + apart).r, texture(depths_nearest, place - apart).r)) / quarter;
        vec2 alone = clamp(farther, 0.0, 1.0);
        float bend = abs(farther.x + farther.y);
        missing += min(farther.x, farther.y) < 0.0 ? min(alone.x + alone.y, bend) : alone.x + alone.y;
    }
    return smoothstep(0.3, 1.0, 1.0 - missing / 8.0);
}
#endif

// How present the first surface of the tail's interval is; what comes behind it in there has a share of 0 or 1. Asked
// once for all surfaces of a pixel, because a software rasteriser runs both sides of every branch.
float first_presence(vec2 place, Surface surfaces[COUNT])
{
#ifdef PRESENCE
    float before = 3e38, first = 0.0;
    for (int m = 0; m < COUNT; ++m) {
        if (before >= anchors.y) first = surfaces[m].inverse_depth;
        before = surfaces[m].inverse_depth;
    }
    return presence(place, first);
#else
    return 1.0;
#endif
}

// What a tail covers in the back buffer; its first tenth without a step, or a silhouette would get a halo at once.
float covering(float share, float present)
{
    return mix(share, min(10.0 * share, 1.0), present);
}

// The layer by itself, premultiplied.
vec4 layer(vec2 place)
{
    Surface surfaces[COUNT];
    fetch_surfaces(place, surfaces);
    vec4 sum = vec4(0.0);
    float before = 3e38, present = first_presence(place, surfaces);
    for (int m = 0; m < COUNT; ++m) {
        float z = surfaces[m].inverse_depth;
#ifdef PAPER
        float omega = z >= anchors.z ? ramp(z, anchors.x, anchors.y) : m == 0 ? 1.0 - ramp(z, anchors.z, anchors.w) : 0.0;
#else
        float omega = z > anchors.y ? 0.0
            : z >= anchors.z        ? covering(tail(z, before), present)
                                    : head(z, before);
#endif
        sum += (1.0 - sum.a) * omega * surfaces[m].color;
        before = z;
    }
    return sum;
}

// The front buffer with this layer under it.
vec4 under(vec4 front, vec2 place)
{
#ifdef PAPER
    return front + (1.0 - front.a) * layer(place);
#else
    Surface surfaces[COUNT];
    fetch_surfaces(place, surfaces);
    float before = 3e38;
    for (int m = 0; m < COUNT; ++m) {
        float z = surfaces[m].inverse_depth, left = max(1.0 - front.a, 0.0);
        float share = z > anchors.y ? 0.0 : z >= anchors.z ? min(tail(z, before), left) : head(z, before) * left;
        front += share * surfaces[m].color;
        before = z;
    }
    return front;
#endif
}
