// Sum over blocks of BLOCK x BLOCK texels.
uniform sampler2D source;

out vec4 total;

void main()
{
    ivec2 from = ivec2(gl_FragCoord.xy) * BLOCK;
    ivec2 to = min(from + BLOCK, textureSize(source, 0));
    total = vec4(0.0);
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) total += texelFetch(source, ivec2(x, y), 0);
}
