//! Parameters of materials at one hit.

use glam::DVec3;

use super::view::View;
use crate::reference::intersect::Surface;
use crate::scene::{ColorInput, Scene};
use crate::spectrum::Spectrum;
use crate::texture::{self, Coordinates};

/// The place where a material's parameters and weights are looked up.
#[derive(Debug, Clone, Copy)]
pub struct Lookup<'a> {
    pub scene: &'a Scene,
    pub uv: Coordinates,
    /// Cosine of the angle between wo and the shading normal, in [0, 1].
    pub cosine: f64,
    /// The shading normal on wo's side.
    pub normal: DVec3,
    /// wo is on the front side.
    pub front: bool,
    /// The camera sees it, and nothing in between.
    pub by_camera: bool,
}

impl<'a> Lookup<'a> {
    pub fn new(scene: &'a Scene, surface: &Surface, view: &View) -> Self {
        Self {
            scene,
            uv: surface.coordinates(),
            cosine: view.wo.dot(view.normal()).clamp(0.0, 1.0),
            normal: view.normal(),
            front: view.front,
            by_camera: surface.by_camera,
        }
    }

    pub(super) fn color(&self, input: &ColorInput) -> Spectrum {
        texture::evaluate(self.scene, input, self.uv)
    }

    /// A scalar is the first channel of its colour.
    pub(super) fn scalar(&self, input: &ColorInput) -> f64 {
        self.color(input).r()
    }

    /// The exponent of a power of a cosine.
    pub(super) fn exponent(&self, input: &ColorInput) -> f64 {
        self.scalar(input).max(0.0)
    }
}
