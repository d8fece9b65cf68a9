//! How surfaces scatter light.
//!
//! The contract, the same for every lobe: all directions have unit length and point away from the surface; wo is where the light
//! goes (back along the path), wi where it comes from. `evaluate` gives f(wo, wi)·|cosθi| and the density with which `sample` would
//! have drawn wi, per steradian. `sample` gives wi and the weight f·|cosθi| / density. A delta lobe, which scatters into one
//! direction only, has no density: `evaluate` is zero and `sample` says [`Density::Delta`].

//!
//! A surface is a weighted list of lobes, one per material of its blend, and follows the same contract as a single one: see [`Bsdf`].

pub mod blend;
mod blend_weight;
mod conductor;
mod diffuse;
mod fresnel;
mod glass;
mod glossy;
mod lobe;
mod microfacet;
mod mirror;
mod mixture;
mod phong;
mod phong_glass;
mod rough_glass;

pub use fresnel::{dielectric_reflectance, refract};
pub use mixture::Bsdf;

use glam::{DVec2, DVec3};

use super::intersect::Surface;
use super::texture;
use crate::math::Frame;
use crate::scene::{ColorInput, HemisphereSampling, Scene};

/// How densely a direction was sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Density {
    /// The only direction a lobe (or the camera) has; no other strategy can find it.
    Delta,
    /// Per steradian.
    Smooth(f64),
}

/// A direction drawn from a BSDF.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BsdfSample {
    pub wi: DVec3,
    /// f·|cosθi| / density.
    pub weight: DVec3,
    pub density: Density,
    /// Index of refraction on wi's side over that on wo's side: 1 for a reflection. Radiance is scaled by 1/eta² when light
    /// crosses, which is part of `weight`.
    pub eta: f64,
    /// The ray goes straight on and nothing happened to it but its weight: no edge of the path ends here.
    pub passes: bool,
}

impl BsdfSample {
    /// A direction on wo's side; the weight is still to be filled in.
    fn reflected(wi: DVec3, density: Density) -> Self {
        Self { wi, weight: DVec3::ZERO, density, eta: 1.0, passes: false }
    }
}

/// f·|cosθi| and density of one pair of directions.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Evaluation {
    pub value: DVec3,
    /// Per steradian.
    pub pdf: f64,
}

/// A surface as seen from wo, both normals on wo's side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    pub wo: DVec3,
    /// wo is on the surface's front side.
    pub front: bool,
    pub geometric_normal: DVec3,
    /// Around the shading normal.
    pub frame: Frame,
    /// How diffuse lobes are sampled.
    pub hemisphere: HemisphereSampling,
}

impl View {
    pub fn new(wo: DVec3, front_normal: DVec3, shading_normal: DVec3) -> Self {
        let front = wo.dot(front_normal) > 0.0;
        let geometric_normal = if front { front_normal } else { -front_normal };
        let mut normal = if shading_normal.dot(geometric_normal) < 0.0 { -shading_normal } else { shading_normal };
        if normal.dot(wo) <= 0.0 {
            // Near silhouettes an interpolated normal may turn away from the viewer; the true one does not.
            normal = geometric_normal;
        }
        Self { wo, front, geometric_normal, frame: Frame::around(normal), hemisphere: HemisphereSampling::Cosine }
    }

    pub fn with_hemisphere(self, hemisphere: HemisphereSampling) -> Self {
        Self { hemisphere, ..self }
    }

    pub fn normal(&self) -> DVec3 {
        self.frame.normal
    }

    /// Whether light from `wi` can be reflected to wo: on the same side, by the true and by the interpolated surface.
    fn reflects(&self, wi: DVec3) -> bool {
        wi.dot(self.geometric_normal) > 0.0 && wi.dot(self.normal()) > 0.0
    }

    /// Whether light from `wi` can come through to wo: on the other side, by the true and by the interpolated surface.
    fn transmits(&self, wi: DVec3) -> bool {
        wi.dot(self.geometric_normal) < 0.0 && wi.dot(self.normal()) < 0.0
    }
}

/// Where a material's parameters and weights are looked up.
#[derive(Debug, Clone, Copy)]
pub struct Lookup<'a> {
    pub scene: &'a Scene,
    pub uv: DVec2,
    /// Cosine of the angle between wo and the shading normal, in [0, 1].
    pub cosine: f64,
}

impl<'a> Lookup<'a> {
    pub fn new(scene: &'a Scene, surface: &Surface, view: &View) -> Self {
        Self { scene, uv: surface.uv, cosine: view.wo.dot(view.normal()).clamp(0.0, 1.0) }
    }

    fn color(&self, input: &ColorInput) -> DVec3 {
        texture::evaluate(self.scene, input, self.uv)
    }

    /// A scalar is the first channel of its colour.
    fn scalar(&self, input: &ColorInput) -> f64 {
        self.color(input).x
    }
}

#[cfg(test)]
mod tests;
