// Along one axis, the layers that lie within their own reach of this tile. Squares are separable, so two such passes
// spread over the plane.
uniform usampler2D tiles;
uniform usampler2D reaching;  // a row: bit k of texel d, whether layer k reaches d tiles far
uniform ivec2 axis;

out uint bits;

void main()
{
    ivec2 tile = ivec2(gl_FragCoord.xy), size = textureSize(tiles, 0);
    int most = min(textureSize(reaching, 0).x, size.x * axis.x + size.y * axis.y) - 1;
    bits = 0u;
    for (int distance = 0; distance <= most; ++distance) {
        ivec2 before = max(tile - distance * axis, ivec2(0)), after = min(tile + distance * axis, size - 1);
        bits |= (texelFetch(tiles, before, 0).r | texelFetch(tiles, after, 0).r) & texelFetch(reaching, ivec2(distance, 0), 0).r;
    }
}
