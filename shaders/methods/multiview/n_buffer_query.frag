// Adds the layers whose window is of this level's size: four overlapping squares at its corners cover it.
uniform usampler2D n_buffer;
uniform usampler2D found;
uniform int level;
uniform int reach[32];
uniform int count;

out uint bits;

uint window(ivec2 at)
{
    ivec2 inside = max(at, ivec2(0));
    return all(lessThan(inside, textureSize(n_buffer, 0))) ? texelFetch(n_buffer, inside, 0).r : 0u;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    bits = texelFetch(found, pixel, 0).r;
    int side = 1 << level;
    for (int k = 0; k < count; ++k) {
        int width = 2 * reach[k] + 1;
        if (width < side || width >= 2 * side) continue;
        ivec2 low = pixel - reach[k], high = pixel + reach[k] - side + 1;
        uint held = window(low) | window(high) | window(ivec2(low.x, high.y)) | window(ivec2(high.x, low.y));
        bits |= held & (1u << k);
    }
}
