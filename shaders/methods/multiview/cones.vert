// Triangles that only count patches; the geometry shader places what is drawn.
void main()
{
    gl_Position = vec4(0.0);
}
