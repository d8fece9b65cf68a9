//! How surfaces scatter light.
//!
//! The contract, the same for every lobe: all directions have unit length and point away from the surface; wo is where the light
//! goes (back along the path), wi where it comes from. `evaluate` gives f(wo, wi)·|cosθi| and the density with which `sample` would
//! have drawn wi, per steradian. `sample` gives wi and the weight f·|cosθi| / density. A delta lobe, which scatters into one
//! direction only, has no density: `evaluate` is zero and `sample` says [`Density::Delta`].

mod diffuse;
mod fresnel;
mod glass;
mod mirror;

pub use fresnel::{dielectric_reflectance, refract};

use glam::{DVec2, DVec3};

use super::frame::Frame;
use super::intersect::Surface;
use super::texture;
use crate::scene::{ColorInput, MaterialKind, Scene};
use diffuse::Diffuse;
use glass::Glass;
use mirror::Mirror;

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
        Self { wo, front, geometric_normal, frame: Frame::around(normal) }
    }

    pub fn normal(&self) -> DVec3 {
        self.frame.normal
    }

    /// Whether light from `wi` can be reflected to wo: on the same side, by the true and by the interpolated surface.
    fn reflects(&self, wi: DVec3) -> bool {
        wi.dot(self.geometric_normal) > 0.0 && wi.dot(self.normal()) > 0.0
    }
}

/// One way of scattering.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Lobe {
    Diffuse(Diffuse),
    Mirror(Mirror),
    Glass(Glass),
}

/// The scattering at one hit: the material's parameters looked up, seen from one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bsdf {
    pub view: View,
    /// None: nothing is scattered.
    lobe: Option<Lobe>,
}

impl Bsdf {
    pub fn new(scene: &Scene, surface: &Surface, wo: DVec3) -> Self {
        let view = View::new(wo, surface.point.normal, surface.shading_normal);
        Self { view, lobe: lobe(scene, &scene.materials[surface.owner.material].kind, surface.uv) }
    }

    /// Whether light sampling can contribute.
    pub fn has_smooth_lobe(&self) -> bool {
        matches!(self.lobe, Some(Lobe::Diffuse(_)))
    }

    /// The smooth lobes' f·|cosθi| and density.
    pub fn evaluate(&self, wi: DVec3) -> Evaluation {
        match &self.lobe {
            Some(Lobe::Diffuse(diffuse)) => diffuse.evaluate(&self.view, wi),
            Some(Lobe::Mirror(_) | Lobe::Glass(_)) | None => Evaluation::default(),
        }
    }

    /// Draws wi: `u_lobe` chooses among lobes, `u1` and `u2` the direction. None where nothing is scattered.
    pub fn sample(&self, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        match self.lobe.as_ref()? {
            Lobe::Diffuse(diffuse) => diffuse.sample(&self.view, u1, u2),
            Lobe::Mirror(mirror) => mirror.sample(&self.view),
            Lobe::Glass(glass) => glass.sample(&self.view, u_lobe),
        }
    }
}

fn lobe(scene: &Scene, kind: &MaterialKind, uv: DVec2) -> Option<Lobe> {
    let color = |input: &ColorInput| texture::evaluate(scene, input, uv);
    let lobe = match kind {
        MaterialKind::Diffuse { reflectance } => Lobe::Diffuse(Diffuse { reflectance: color(reflectance) }),
        MaterialKind::Mirror { reflectance } => Lobe::Mirror(Mirror { reflectance: color(reflectance) }),
        MaterialKind::Glass { ior, reflectance, transmittance } => {
            Lobe::Glass(Glass { ior: *ior, reflectance: color(reflectance), transmittance: color(transmittance) })
        }
        MaterialKind::Emissive => return None,
        // Refused before rendering, or not in the world at all.
        MaterialKind::Glossy { .. }
        | MaterialKind::Phong { .. }
        | MaterialKind::RoughGlass { .. }
        | MaterialKind::Conductor { .. }
        | MaterialKind::Blend { .. }
        | MaterialKind::Pass => return None,
    };
    // A black Lambert surface sends nothing on, so its path ends here.
    let black = matches!(lobe, Lobe::Diffuse(Diffuse { reflectance }) if reflectance == DVec3::ZERO);
    (!black).then_some(lobe)
}

#[cfg(test)]
mod tests;
