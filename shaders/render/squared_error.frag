// Squared difference of two images as a person sees them: clipped and sRGB-encoded.
#include "include/srgb.glsl"

uniform sampler2D first;
uniform sampler2D second;

out vec4 squared;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 a = srgb_encode(texelFetch(first, pixel, 0).rgb), b = srgb_encode(texelFetch(second, pixel, 0).rgb);
    squared = vec4((a - b) * (a - b), 1.0);
}
