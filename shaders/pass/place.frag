// A part of an image on a place of a canvas, both counted in pixels from the upper left; the result is premultiplied. One
// texel of the image on one pixel is copied as it is. Enlarged, its texels stay sharp; made smaller, a pixel is the mean
// of all that falls on it, so that nothing bright or thin is stepped over. With SOLID it is a colour.
#ifdef SOLID
uniform vec4 solid;
#else
uniform sampler2D source;
uniform vec4 place;
uniform vec4 part;
uniform float canvas_height;
#endif

out vec4 color;

// From here on enlarged texels are seen as squares, below they would only shimmer.
const float SHARP_FROM = 1.5;

#ifdef DECODE
vec3 decoded(vec3 encoded)
{
    return mix(pow((encoded + 0.055) / 1.055, vec3(2.4)), encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}
#endif

void main()
{
#ifdef SOLID
    vec4 found = solid;
#else
    ivec2 size = textureSize(source, 0);
    vec2 at = vec2(gl_FragCoord.x, canvas_height - gl_FragCoord.y) - place.xy;
    vec2 texels = part.zw * vec2(size) / place.zw;
    vec2 middle = part.xy * vec2(size) + at * texels;
    vec2 extent = texels.x * SHARP_FROM < 1.0 ? vec2(0.0) : max(texels, 1.0);
    vec2 low = middle - 0.5 * extent, high = middle + 0.5 * extent;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int y = int(floor(low.y)); y < max(int(ceil(high.y)), int(floor(low.y)) + 1); ++y)
        for (int x = int(floor(low.x)); x < max(int(ceil(high.x)), int(floor(low.x)) + 1); ++x) {
            vec2 covered = min(vec2(x, y) + 1.0, high) - max(vec2(x, y), low);
            float weight = extent.x == 0.0 ? 1.0 : covered.x * covered.y;
            ivec2 texel = clamp(ivec2(x, size.y - 1 - y), ivec2(0), size - 1);
            sum += weight * texelFetch(source, texel, 0);
            weights += weight;
        }
    vec4 found = sum / weights;
#endif
#ifdef DECODE
    found.rgb = decoded(found.rgb);
#endif
    color = vec4(found.rgb * found.a, found.a);
}
