// Texture coordinates at a point: the first ones, and behind them the second ones, which meshes may have.

alias TextureCoordinates = vec4<f32>;

// The coordinates of a point that has one set: they serve as the second ones too.
fn only_coordinates(uv: vec2<f32>) -> TextureCoordinates {
    return uv.xyxy;
}
