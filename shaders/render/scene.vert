// The scene's one vertex shader. Every pass that must find the same fragments again (peels, slabs, hidden surfaces)
// uses this text and these uniforms, so positions agree to the last bit.
in vec3 in_position;
in vec3 in_normal;
in vec2 in_texcoord0;
in vec2 in_texcoord1;
in vec4 in_color;

uniform mat4 clip_from_local;

out Vertex
{
    vec3 position;
    vec3 normal;
    vec4 color;
    vec4 texcoord;  // set 0 in xy, set 1 in zw
} vertex;

invariant gl_Position;

void main()
{
    gl_Position = clip_from_local * vec4(in_position, 1.0);
    vertex.position = in_position;
    vertex.normal = in_normal;
    vertex.color = in_color;
    vertex.texcoord = vec4(in_texcoord0, in_texcoord1);
}
