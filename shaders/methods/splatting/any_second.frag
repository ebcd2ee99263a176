// Passes a sample for each tile with points that are to be drawn as sprites: what their drawing is conditional on.
uniform sampler2D largest;

out float unused;

void main()
{
    if (texelFetch(largest, ivec2(gl_FragCoord.xy), 0).w < 0.0) discard;
    unused = 1.0;
}
