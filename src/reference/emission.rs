//! Light that surfaces send out by themselves.

use std::f64::consts::PI;

use glam::DVec3;

use super::bsdf::{Lookup, View, blend};
use super::intersect::Surface;
use crate::scene::{Emission, MaterialId, MaterialKind, Scene};
use crate::spectrum::Spectrum;
use crate::texture;

/// Radiance that leaves the surface towards `wo` by its own emission: that of the material, and, where it is a blend, that of its
/// parts by their weights.
pub fn emitted(scene: &Scene, surface: &Surface, wo: DVec3) -> Spectrum {
    let front = wo.dot(surface.point.normal) > 0.0;
    let radiance = |emission: &Emission| {
        if front || emission.two_sided {
            texture::evaluate(scene, &emission.radiance, surface.coordinates())
        } else {
            Spectrum::BLACK
        }
    };
    let material = surface.owner.material;
    if !scene.materials[material].is_blend() {
        return scene.materials[material].emission.as_ref().map_or(Spectrum::BLACK, radiance);
    }
    let view = View::new(wo, surface.point.normal, surface.shading_normal);
    let mut sum = Spectrum::BLACK;
    blend::for_each_part(&Lookup::new(scene, surface, &view), material, |part, weight| {
        sum += part.emission.as_ref().map_or(Spectrum::BLACK, radiance) * weight;
    });
    sum
}

/// The weight of all null parts of the surface's material, seen along `wo`: the share of light that goes straight through it.
pub fn null_weight(scene: &Scene, surface: &Surface, wo: DVec3) -> f64 {
    let view = View::new(wo, surface.point.normal, surface.shading_normal);
    let mut sum = 0.0;
    blend::for_each_part(&Lookup::new(scene, surface, &view), surface.owner.material, |part, weight| {
        if matches!(part.kind, MaterialKind::Pass) {
            sum += weight;
        }
    });
    sum.min(1.0)
}

/// Luminous power per area: π·L, doubled where any part emits on both sides, L the luminance of the mean emission. Weights that
/// depend on the hit count as one half.
pub fn mean_exitance(scene: &Scene, material: MaterialId) -> f64 {
    let (mut radiance, mut sides) = (Spectrum::BLACK, 1.0);
    blend::for_each_part_on_average(scene, material, |part, weight| {
        if let Some(emission) = &part.emission {
            radiance += texture::mean(scene, &emission.radiance) * weight;
            sides = if emission.two_sided { 2.0 } else { sides };
        }
    });
    PI * radiance.luminance() * sides
}
