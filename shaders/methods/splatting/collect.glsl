// All points of one level whose sprites reach a pixel, added to the layers of the pixel.
uniform float merged_from;  // CoC radius from which points of level 0 are merged into level 1; doubles with each level

#ifdef INSPECT
float fetches_made = 0.0;
#endif

struct Here
{
    float coc;
    Ends ends;
};

void gather(sampler2D points, int level, float radius, bool hidden, Here here, inout Layers layers)
{
    if (radius < 0.0) return;
    float texel = float(1 << level), bound = sprite_radius(radius, level) * extent + rim(level);
    vec2 q = gl_FragCoord.xy / texel;
    ivec2 last = textureSize(points, 0) - 1;
    for (int y = max(int(ceil(q.y - bound - 0.5)), 0); y <= min(int(floor(q.y + bound - 0.5)), last.y); ++y) {
        float dy = q.y - float(y) - 0.5, half_row = sqrt(max(bound * bound - dy * dy, 0.0));
        for (int x = max(int(ceil(q.x - half_row - 0.5)), 0); x <= min(int(floor(q.x + half_row - 0.5)), last.x); ++x) {
            vec4 point = texelFetch(points, ivec2(x, y), 0);
#ifdef INSPECT
            fetches_made += 1.0;
#endif
            float coc = point_coc(point), share = point_share(point);
            if (level < LEVELS) share *= staying(coc, merged_from * texel);
            float weight = alpha(q - vec2(x, y) - 0.5, coc, share, level), apart = coc - here.coc;
            vec4 light = vec4(point.rgb, 1.0);
            float behind = weight * beyond(apart, here.ends);
            layers.behind += light * behind;
#ifndef NO_FRONT
            float in_front = hidden ? 0.0 : weight * beyond(-apart, here.ends);
            layers.front += light * in_front;
            weight -= in_front;
#endif
            layers.same += light * (weight - behind);
        }
    }
}
