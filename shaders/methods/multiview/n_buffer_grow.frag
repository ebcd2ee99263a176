// The next level of an N-buffer: windows of twice the side, each from four of this level (Decoret 2005).
uniform usampler2D n_buffer;
uniform int stride;

out uint bits;

uint window(ivec2 at)
{
    return all(lessThan(at, textureSize(n_buffer, 0))) ? texelFetch(n_buffer, at, 0).r : 0u;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    bits = window(pixel) | window(pixel + ivec2(stride, 0)) | window(pixel + ivec2(0, stride)) | window(pixel + stride);
}
