// No layer found yet.
out uint bits;

void main()
{
    bits = 0u;
}
