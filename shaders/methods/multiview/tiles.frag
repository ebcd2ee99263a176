// Which layers hold anything in a tile of TILE x TILE pixels.
uniform usampler2D occupied;

out uint bits;

void main()
{
    ivec2 from = ivec2(gl_FragCoord.xy) * TILE;
    ivec2 to = min(from + TILE, textureSize(occupied, 0));
    bits = 0u;
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) bits |= texelFetch(occupied, ivec2(x, y), 0).r;
}
