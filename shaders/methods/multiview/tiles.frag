// Which layers hold anything in a square of `tile` by `tile` texels.
uniform usampler2D occupied;
uniform int tile;

out uint bits;

void main()
{
    ivec2 from = ivec2(gl_FragCoord.xy) * tile;
    ivec2 to = min(from + tile, textureSize(occupied, 0));
    bits = 0u;
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) bits |= texelFetch(occupied, ivec2(x, y), 0).r;
}
