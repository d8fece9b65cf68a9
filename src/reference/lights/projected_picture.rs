//! Pictures that lights throw.

use glam::{DVec2, DVec3};

use crate::scene::{Scene, Texture, TextureId};
use crate::spectrum::Spectrum;
use crate::texture;

/// A texture on the plane at distance 1 before a light, over a rectangle about the light's axis.
#[derive(Debug)]
pub struct ProjectedPicture {
    axis: DVec3,
    right: DVec3,
    up: DVec3,
    half_extent: DVec2,
    /// None: white everywhere.
    texture: Option<Texture>,
}

impl ProjectedPicture {
    pub fn new(axis: DVec3, up: DVec3, half_extent: [f64; 2], texture: Option<TextureId>, scene: &Scene) -> Self {
        let right = axis.cross(up).normalize_or(DVec3::X);
        let half_extent = DVec2::from(half_extent);
        Self { axis, right, up: right.cross(axis), half_extent, texture: texture.map(|id| scene.textures[id].clone()) }
    }

    /// The texture coordinates to which light goes along a direction; None backwards.
    pub fn coordinates(&self, direction: DVec3) -> Option<DVec2> {
        let cosine = direction.dot(self.axis);
        let across = DVec2::new(direction.dot(self.right), direction.dot(self.up)) / (2.0 * cosine);
        (cosine > 0.0).then(|| DVec2::splat(0.5) + across / self.half_extent)
    }

    pub fn color(&self, uv: DVec2) -> Spectrum {
        self.texture.as_ref().map_or(Spectrum::WHITE, |one| texture::look_up(std::slice::from_ref(one), 0, uv))
    }
}
