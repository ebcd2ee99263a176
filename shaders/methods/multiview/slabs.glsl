// Layers of equal steps of 1/z, which are equal steps of CoC radius whatever the lens (Lee 2009 eq 4): layer k holds
// surfaces from slab_front(k) down to slab_back(k). The last may reach farther than a step, to the end of the scene.
#include <Slabs>

float slab_front(int k)
{
    return slabs.nearest - float(k) * slabs.step;
}

float slab_back(int k)
{
    return k + 1 == slabs.count ? slabs.farthest : slabs.nearest - float(k + 1) * slabs.step;
}

// Whether layer `k` keeps a fragment: its own, and those of its neighbours within the overlap. The last keeps nothing of its
// neighbour: that would hide what lies behind, and no other layer stops the light there.
bool slab_holds(int k, float inverse_depth)
{
    float overlap = slabs.overlap * slabs.step;
    bool last = k + 1 == slabs.count;
    return (k == 0 || inverse_depth <= slab_front(k) + (last ? 0.0 : overlap))
        && (last || inverse_depth >= slab_back(k) - overlap);
}

// Whether it is layer `k` alone that counts a surface: its own, without the overlap.
bool slab_owns(int k, float inverse_depth)
{
    return (k == 0 || inverse_depth < slab_front(k)) && (k + 1 == slabs.count || inverse_depth >= slab_back(k));
}
