// A pyramid in two images, even levels in one and odd levels in the other (dofview/gl/pyramids.py).
// Define LAST_LEVEL before including this.
uniform ivec2 atlas_size;                    // of level 0
uniform ivec2 atlas_corners[LAST_LEVEL + 1]; // where each level starts in its image

ivec2 level_size(int level)
{
    return (atlas_size + (1 << level) - 1) >> level;
}

// Bilinear value of `level` at `position` in pixels of level 0. The level's edge is repeated beyond it.
vec4 atlas_sample(sampler2D image, int level, vec2 position)
{
    vec2 texel = clamp(position * exp2(-float(level)), vec2(0.5), vec2(level_size(level)) - 0.5);
    return textureLod(image, (texel + vec2(atlas_corners[level])) / vec2(textureSize(image, 0)), 0.0);
}
