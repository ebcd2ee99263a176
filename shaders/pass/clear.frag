// Nothing, where it is drawn: a part of an image is emptied for less than the whole.
out vec4 color;

void main()
{
    color = vec4(0.0);
}
