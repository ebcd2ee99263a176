// One level of an environment, blurred as a surface of `roughness` reflects it seen along its normal (Karis 2013): GGX
// half vectors by importance, each sample read from the mip level that matches the solid angle it stands for.
#include "include/equirect.glsl"

uniform sampler2D environment;
uniform vec2 extent;
uniform float roughness;

out vec4 radiance;

const int SAMPLES = 64;
const float PI = 3.14159265;

float radical_inverse(int i)
{
    float result = 0.0, digit = 0.5;
    for (; i > 0; i >>= 1, digit *= 0.5) result += float(i & 1) * digit;
    return result;
}

void main()
{
    vec3 normal = equirect_direction(gl_FragCoord.xy / extent);
    vec3 tangent = normalize(cross(abs(normal.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0), normal));
    vec3 bitangent = cross(normal, tangent);
    float a2 = pow(roughness, 4.0);
    vec2 base = vec2(textureSize(environment, 0));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < SAMPLES; ++i) {
        float u = (float(i) + 0.5) / float(SAMPLES), turn = 2.0 * PI * radical_inverse(i);
        float n_h2 = (1.0 - u) / (1.0 + (a2 - 1.0) * u), s = sqrt(1.0 - n_h2);
        vec3 halfway = normal * sqrt(n_h2) + s * (tangent * cos(turn) + bitangent * sin(turn));
        vec3 to_light = reflect(-normal, halfway);
        float n_l = dot(normal, to_light);
        if (n_l <= 0.0) continue;
        float d = n_h2 * (a2 - 1.0) + 1.0, density = a2 / (4.0 * PI * d * d);
        float level = 0.5 * log2(base.x * base.y / (4.0 * PI * density * float(SAMPLES))) + 0.5;
        sum += vec4(textureLod(environment, equirect(to_light), max(level, 0.0)).rgb, 1.0) * n_l;
    }
    radiance = vec4(sum.rgb / sum.a, 1.0);
}
