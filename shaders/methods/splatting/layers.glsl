// The three layers of a destination pixel q (Lee 2008, section 3.4) and their composition (section 3.5): sums of
// premultiplied sprite colours in front of, at, and behind the surface that is visible at q.
struct Layers
{
    vec4 front;
    vec4 same;
    vec4 behind;
};

// How far apart two CoC radii, px, may be and still share a layer (eq 6; the paper's diameters on both sides cancel).
// In focus it would be 0 and rounding would decide, so it is at least half a pixel.
float layer_tolerance(float coc)
{
    return max(params.delta * abs(coc), 0.5);
}

// Eq 6: -1 in front of q, 0 with it, 1 behind it.
float layer_of(float coc, float coc_here, float tolerance)
{
    float difference = coc - coc_here;
    return difference < -tolerance ? -1.0 : difference > tolerance ? 1.0 : 0.0;
}

// M into L (section 3.5). The paper adds them. A hidden surface that the visible ones already cover would then dilute
// them, so with `fill` it only fills up what they leave open.
vec4 with_hidden(vec4 layer, vec4 hidden)
{
    float room = params.fill == 1 ? max(1.0 - layer.a, 0.0) / max(hidden.a, 1e-6) : 1.0;
    return layer + hidden * min(room, 1.0);
}

void add_hidden(inout Layers layers, Layers hidden)
{
    layers.same = with_hidden(layers.same, hidden.same);
    layers.behind = with_hidden(layers.behind, hidden.behind);
}

// One layer over what is behind it. Overlapping sprites of different sizes can add up to an alpha above 1 ("hyper
// intensity"), which covers no more than 1 does; then the sum is normalised to alpha 1.
vec4 over(vec4 layer, vec4 below)
{
    layer /= max(layer.a, 1.0);
    vec4 sum = layer + (1.0 - layer.a) * below;
    return sum.a > 1e-6 ? sum / sum.a : vec4(0.0);
}

// Eq 7.
vec4 compose(Layers layers)
{
    return over(layers.front, over(layers.same, over(layers.behind, vec4(0.0))));
}
