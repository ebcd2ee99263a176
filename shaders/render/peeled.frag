// What the pass behind a surface has found, as the surface of a peel: its inverse depth, and the depth that it was tested
// with, to be found again by those fragments alone that are of it.
uniform sampler2D found;  // inverse depth, minus the depth tested

out float inverse_depth;

void main()
{
    vec2 depths = texelFetch(found, ivec2(gl_FragCoord.xy), 0).rg;
    inverse_depth = depths.x;
    gl_FragDepth = -depths.y;
}
