// The three layers of a destination pixel q (Lee 2008, section 3.4) and their composition (section 3.5): sums of
// premultiplied sprite colours in front of, at, and behind the surface that is visible at q.
struct Layers
{
    vec4 front;
    vec4 same;
    vec4 behind;
};

// Where the layers of a pixel end: how far apart two CoC radii, px, may be and still share one (eq 6; the paper's
// diameters on both sides cancel), and over how much more the next layer is faded into.
//
// In focus the tolerance would be 0 and rounding would decide, so it is at least half a pixel. The paper's layers have
// sharp ends. But a surface that comes towards the camera passes its own end, and there its part in front would cover
// the rest of it, so that more of what is behind shows through: as stripes, since levels and rows differ in it.
struct Ends
{
    float tolerance;
    float fade;
};

Ends ends_of_layer(float coc)
{
    float tolerance = max(params.delta * abs(coc), 0.5);
    return Ends(tolerance, max(params.delta * -coc, 0.25));
}

// How much of what is `apart` px from a pixel's surface is beyond its layer, on that side.
float beyond(float apart, Ends ends)
{
    return clamp((apart - ends.tolerance) / ends.fade, 0.0, 1.0);
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
