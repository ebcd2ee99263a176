// Where a pixel is on the canvas, 0 to 1. Single texels are fetched by it through samplers of the nearest: a software
// rasteriser does that in two thirds of the time of texelFetch, which tests for the border by itself.
uniform vec2 pixel_size;  // 1 / size of the canvas

vec2 place_of(ivec2 pixel)
{
    return (vec2(pixel) + 0.5) * pixel_size;
}
