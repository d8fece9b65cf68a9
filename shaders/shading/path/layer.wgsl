// Layers of light: which light the layer holds that a render makes in place of the picture. src/reference/layer.rs is the same.
#import core/spectrum.wgsl

// Light that reaches the camera over so many edges, as far as the layer holds it: all of it where the picture itself is made.
fn in_layer(radiance: Spectrum, edges: u32) -> Spectrum {
    if HAS_LAYER_EMISSION {
        return select(BLACK, radiance, edges == 1u);
    } else if HAS_LAYER_DIRECT {
        return select(BLACK, radiance, edges == 2u);
    } else if HAS_LAYER_INDIRECT {
        return select(BLACK, radiance, edges > 2u);
    } else {
        return radiance;
    }
}
