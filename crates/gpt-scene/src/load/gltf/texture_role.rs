//! Roles of textures, by which one picture of a file becomes several textures of a scene.

/// The meaning of a texture's texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TextureRole {
    /// Colours in sRGB.
    Colour,
    /// Numbers as they are.
    Numbers,
    /// Directions of a normal map.
    Normals,
    /// Numbers that are made of its alpha: roughness of glossiness, 1 − alpha times the factor of these bits.
    OfGlossiness(u64),
}

/// The texture coordinates of a mesh by which a texture lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum UvsOf {
    First,
    Second,
    /// The second, where the first are there for directions alone.
    Framed,
}
