// Puts a sub-image behind those in front of it, enlarging it from its first level on the way (section 3.5).
//
// PAPER (eq 14): its light is dimmed by the opacity of each in front, as if their silhouettes were chance.
// PARTITION: it takes what they leave. The parts of one surface in neighbouring sub-images lie side by side, not over
// one another; dimming one by the other would let the background through. The sum is divided by its opacity at the
// end, since blurs of different width do not add up to exactly 1.
uniform sampler2D in_front;
uniform sampler2D sub_image;

out vec4 color;

void main()
{
    color = texture(sub_image, gl_FragCoord.xy * SCALE / vec2(textureSize(sub_image, 0)));
#ifndef FIRST
    vec4 front = texelFetch(in_front, ivec2(gl_FragCoord.xy), 0);
    float left = 1.0 - front.a;
#ifdef PAPER
    color = front + left * color;
#else
    color = front + min(left / max(color.a, 1e-6), 1.0) * color;
#endif
#endif
#if defined(LAST) && defined(PARTITION)
    color /= max(color.a, 1e-6);
#endif
}
