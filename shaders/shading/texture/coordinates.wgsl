// Texture coordinates at a point: the first ones, and where some texture lies by them, the second ones of meshes behind them.

#if SECOND_UVS
alias TextureCoordinates = vec4<f32>;

// Texture coordinates of surfaces with a single set.
fn only_coordinates(uv: vec2<f32>) -> TextureCoordinates {
    return uv.xyxy;
}
#else
alias TextureCoordinates = vec2<f32>;

fn only_coordinates(uv: vec2<f32>) -> TextureCoordinates {
    return uv;
}
#endif
