// Least and greatest inverse depth in blocks of BLOCK x BLOCK: x the least above zero, y the greatest, z 1 where any
// texel is empty. The first level reads an inverse depth image (FIRST), the others the level before.
#include "include/texel.glsl"

uniform sampler2D source;

out vec4 range;

void main()
{
    ivec2 size = textureSize(source, 0);
    ivec2 from = ivec2(gl_FragCoord.xy) * BLOCK;
    ivec2 to = min(from + BLOCK, size);
    range = vec4(3e38, 0.0, 0.0, 0.0);
    for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) {
            vec3 texel = texel_of(source, ivec2(x, y)).xyz;
#ifdef FIRST
            texel = vec3(texel.x > 0.0 ? texel.x : 3e38, texel.x, texel.x > 0.0 ? 0.0 : 1.0);
#endif
            range.x = min(range.x, texel.x);
            range.yz = max(range.yz, texel.yz);
        }
}
