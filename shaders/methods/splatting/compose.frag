// The layers that the sprites were drawn to, composed.
#include <Params>
#include "methods/splatting/layers.glsl"

uniform sampler2D layer_0;
uniform sampler2D layer_1;
uniform sampler2D layer_2;
#ifdef HIDDEN
uniform sampler2D hidden_layer_1;
uniform sampler2D hidden_layer_2;
#endif

out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Layers layers = Layers(texelFetch(layer_0, pixel, 0), texelFetch(layer_1, pixel, 0), texelFetch(layer_2, pixel, 0));
#ifdef HIDDEN
    Layers hidden = Layers(
        vec4(0.0), texelFetch(hidden_layer_1, pixel, 0), texelFetch(hidden_layer_2, pixel, 0));
    add_hidden(layers, hidden);
#endif
    color = compose(layers);
}
