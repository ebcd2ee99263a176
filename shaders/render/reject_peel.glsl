// Depth peeling: leave out what is nearer than, or the same as, the surface peeled before. Where that one is empty
// (inverse depth 0) there is nothing behind it either.
uniform sampler2D peeled_inverse_depth;

bool reject(float inverse_depth, ivec2 pixel)
{
    return inverse_depth >= texelFetch(peeled_inverse_depth, pixel, 0).r;
}
