// Layers of light: which light the layer holds that a render makes in place of the picture. src/reference/layer.rs is the same.
#import core/spectrum.wgsl

// Light that reaches the camera over so many edges, as far as the layer holds it: all of it where the picture itself is made.
fn in_layer(radiance: Spectrum, edges: u32) -> Spectrum {
#if LAYER_OF_LIGHT
#if LAYER_EMISSION
    let is_held = edges == 1u;
#endif
#if LAYER_DIRECT
    let is_held = edges == 2u;
#endif
#if LAYER_INDIRECT
    let is_held = edges > 2u;
#endif
    return select(BLACK, radiance, is_held);
#else
    return radiance;
#endif
}
