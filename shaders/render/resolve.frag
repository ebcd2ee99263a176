// The picture out of its canvas: the guard band is left off, and `scale` canvas pixels become one by an exact box in
// linear light (texels at the box's edge count by the part that is inside). Below 1 the canvas is enlarged bilinearly.
uniform sampler2D canvas;
uniform vec2 scale;
uniform int guard;

out vec4 color;

vec4 fetch(ivec2 texel, ivec2 inner)
{
    return texelFetch(canvas, clamp(texel, ivec2(0), inner - 1) + guard, 0);
}

void main()
{
    ivec2 inner = textureSize(canvas, 0) - 2 * guard;
#ifdef SAME_SIZE
    color = fetch(ivec2(gl_FragCoord.xy), inner);
#else
    vec2 center = gl_FragCoord.xy * scale;
    if (scale.x < 1.0) {
        vec2 position = center - 0.5;
        ivec2 corner = ivec2(floor(position));
        vec2 t = position - vec2(corner);
        color = mix(mix(fetch(corner, inner), fetch(corner + ivec2(1, 0), inner), t.x),
            mix(fetch(corner + ivec2(0, 1), inner), fetch(corner + ivec2(1, 1), inner), t.x), t.y);
        return;
    }
    vec2 from = center - 0.5 * scale, to = center + 0.5 * scale;
    color = vec4(0.0);
    for (int y = int(from.y); float(y) < to.y; ++y)
        for (int x = int(from.x); float(x) < to.x; ++x) {
            vec2 covered = min(to, vec2(x + 1, y + 1)) - max(from, vec2(x, y));
            color += fetch(ivec2(x, y), inner) * covered.x * covered.y;
        }
    color /= scale.x * scale.y;
#endif
}
