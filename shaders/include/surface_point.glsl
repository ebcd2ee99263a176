// A point of a surface before any light, wherever it was read from.
struct Surface
{
    vec3 base_color;
    float alpha;
    vec3 normal;
    float metallic;
    float roughness;
    float occlusion;
    vec3 emissive;
};
