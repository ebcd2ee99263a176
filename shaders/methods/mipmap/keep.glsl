#include <Params>

// How much of a neighbour with `sigma_q` may flow into a place with `sigma_p` and CoC `coc_p` (the anisotropic filter H,
// eq 9): nothing where it is sharper by more than delta and the place is behind the focus.
float keep(float sigma_q, float sigma_p, float coc_p)
{
#ifdef ANISOTROPIC
    float sharper = sigma_p - sigma_q - params.delta;
#ifdef PAPER
    return sharper > 0.0 && coc_p > 0.0 ? 0.0 : 1.0;
#else
    // A step would pop when a slider moves: fade out over another delta, and in over the first pixel behind the focus.
    float cut = clamp(sharper / max(params.delta + 0.25 * sigma_p, 1e-3), 0.0, 1.0);
    return 1.0 - cut * clamp(coc_p, 0.0, 1.0);
#endif
#else
    return 1.0;
#endif
}
