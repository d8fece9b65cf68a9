// Layers of light: which light the layer holds that a render makes in place of the picture. src/reference/layer.rs is the same.

// Whether light that reaches the camera over so many edges belongs to the layer.
fn is_in_layer(edges: u32) -> bool {
#if LAYER_EMISSION
    return edges == 1u;
#endif
#if LAYER_DIRECT
    return edges == 2u;
#endif
#if LAYER_INDIRECT
    return edges > 2u;
#endif
}
