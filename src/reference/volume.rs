//! Volumes that take light and scatter none, behind the surfaces that enclose them.

use glam::DVec3;

use super::intersect::Surface;
use crate::scene::Scene;
use crate::scene::material::FARTHEST;
use crate::spectrum::Spectrum;

/// Volumes behind surfaces.
#[derive(Debug, Clone)]
pub struct Volumes {
    /// The extinction behind a surface of each material; None: such a surface encloses nothing. Empty: none does.
    behind: Vec<Option<Spectrum>>,
}

impl Volumes {
    pub fn new(scene: &Scene) -> Self {
        let volumes = scene.volumes_behind().into_iter();
        let mut behind: Vec<_> = volumes.map(|volume| volume.map(|attenuation| attenuation.extinction())).collect();
        if behind.iter().all(Option::is_none) {
            behind.clear();
        }
        Self { behind }
    }

    /// Extinction on the side of a surface that `toward` points to, given that on wo's side.
    pub fn extinction_towards(&self, surface: &Surface, front: bool, toward: DVec3, here: Spectrum) -> Spectrum {
        let Some(&Some(extinction)) = self.behind.get(surface.owner.material) else { return here };
        let leads_to_front = toward.dot(surface.point.normal) > 0.0;
        if leads_to_front == front {
            here
        } else if front {
            extinction
        } else {
            Spectrum::BLACK
        }
    }
}

/// Beer and Lambert's law: the share of light that is left after a distance.
pub fn transmittance(extinction: Spectrum, distance: f64) -> Spectrum {
    if extinction.is_black() {
        return Spectrum::WHITE;
    }
    (extinction * -distance.min(FARTHEST)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Attenuation;

    #[test]
    fn light_is_left_as_the_colour_says() {
        let amber = Attenuation { color: Spectrum::new(1.0, 0.5, 0.0), distance: 2.0 };
        let left = transmittance(amber.extinction(), 2.0);
        assert!(left.distance(Spectrum::new(1.0, 0.5, 1e-6)) < 1e-12, "{left}");
        let twice = transmittance(amber.extinction(), 4.0);
        assert!(twice.distance(left * left) < 1e-12, "{twice}");
        assert_eq!(transmittance(amber.extinction(), f64::INFINITY), Spectrum::new(1.0, 0.0, 0.0));
    }
}
