// Two triangles for each rectangle of a list (dofview/gl/tiles.py).
uniform sampler2D tile_list;  // left, bottom, right, top in pixels of the full image
uniform int tile_row;
uniform vec2 tile_extent;  // pixels of the full image that the target covers

void main()
{
    vec4 rectangle = texelFetch(tile_list, ivec2(gl_VertexID / 6, tile_row), 0);
    int corner = gl_VertexID % 6;
    bvec2 upper = bvec2(corner == 1 || corner == 2 || corner == 4, corner == 2 || corner == 4 || corner == 5);
    gl_Position = vec4(2.0 * mix(rectangle.xy, rectangle.zw, upper) / tile_extent - 1.0, 0.0, 1.0);
}
