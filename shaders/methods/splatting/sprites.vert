// Two triangles per point: a square around it, large enough for its sprite. Unlike a GL point it has no
// largest size, no rounding to whole pixels, and is not lost when its centre lies outside the picture.
#include "methods/splatting/point.glsl"
#include "methods/splatting/sprite.glsl"

uniform sampler2D sprite_points;
uniform vec2 canvas;  // px
uniform int first_row;
uniform int level;
uniform float to;     // CoC radius from which points are merged into the next level

flat out vec4 point;
flat out vec2 center;
flat out float share;

const vec2 CORNERS[6] = vec2[](
    vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(-1.0, 1.0), vec2(-1.0, 1.0), vec2(1.0, -1.0), vec2(1.0, 1.0));

void main()
{
    int width = textureSize(sprite_points, 0).x;
    int index = gl_VertexID / 6, corner_index = gl_VertexID - 6 * index;
    ivec2 texel = ivec2(index % width, first_row + index / width);
    point = texelFetch(sprite_points, texel, 0);
    float size = float(1 << level), coc = point_coc(point);
    center = (vec2(texel) + 0.5) * size;
    vec2 corner = CORNERS[corner_index];
    share = point_share(point) * staying(coc, to);
    vec2 position = center + corner * (sprite_radius(coc, level) * extent + 1.0) * size;
    gl_Position = share > 0.0 ? vec4(position / canvas * 2.0 - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
