//! The light that comes along shadow rays: through surfaces that let some of it pass, and through media.

use super::Integrator;
use crate::reference::emission::null_weight;
use crate::reference::intersect::{PathTime, Ray, Surface, SurfaceId};
use crate::reference::lights::LightSample;
use crate::reference::medium::{MediumStack, left};
use crate::reference::tracking::{Passage, Stream, pass_through};
use crate::sampling::hash::mix;
use crate::scene::MaterialId;
use crate::scene::media::MOST_CROSSINGS;
use crate::spectrum::Spectrum;

impl Integrator {
    /// The share of a sample's light that comes along its shadow ray, which begins in the media of a stack: through all
    /// surfaces on the way, and through media.
    pub(super) fn shadow_transmittance(
        &self,
        ray: Ray,
        light: &LightSample,
        media: (MediumStack, u32),
        time: &PathTime,
    ) -> Spectrum {
        let share = |surface: &Surface| null_weight(&self.scene, surface, -ray.direction);
        let lets_through = |material: MaterialId| self.lights.lets_through(material);
        if self.media.order_shadow_rays() {
            return self.transmittance_across_boundaries(ray, light, media, time);
        }
        // No boundary of a medium lets a shadow ray through, so it stays in the one where it begins
        let through_surfaces = self.world.transmittance(ray, light.distance, light.target, time, lets_through, share);
        let (stack, numbers) = media;
        self.medium_transmittance(stack, (&ray, light.distance), numbers) * through_surfaces
    }

    /// The share of light that is left after a distance within the innermost medium; an estimate by random numbers of this key where it differs from
    /// place to place.
    fn medium_transmittance(&self, stack: MediumStack, (ray, distance): (&Ray, f64), numbers: u32) -> Spectrum {
        let Some(filling) = self.media.filling(stack.innermost()) else { return Spectrum::WHITE };
        let Some(grids) = &filling.grids else { return left(filling.extinction, distance) };
        let mut numbers = Stream::new(numbers);
        let Passage { left, .. } = pass_through((filling, grids), (ray, distance), false, || numbers.draw());
        left
    }

    /// The share of a sample's light that comes along its shadow ray, from surface to surface in their order, because
    /// they decide which medium lies behind them.
    fn transmittance_across_boundaries(
        &self,
        ray: Ray,
        light: &LightSample,
        (stack, numbers): (MediumStack, u32),
        time: &PathTime,
    ) -> Spectrum {
        let (mut ray, mut stack, mut share, mut remaining) = (ray, stack, Spectrum::WHITE, light.distance);
        for crossed in 0..MOST_CROSSINGS {
            let through = |stack: MediumStack, ray: &Ray, distance: f64| {
                self.medium_transmittance(stack, (ray, distance), mix(numbers.wrapping_add(crossed)))
            };
            let hit = self.world.closest(ray, time).filter(|hit| hit.distance < remaining);
            let Some(hit) = hit else { return share * through(stack, &ray, remaining) };
            let surface = self.world.surface(&ray, &hit, time);
            if !self.lights.lets_through(surface.owner.material) {
                // The light's own surface is the end of the way
                let is_light = light.target.is_some_and(|target| hit.surface == SurfaceId::Primitive(target));
                return if is_light { share * through(stack, &ray, hit.distance) } else { Spectrum::BLACK };
            }
            let unmet = null_weight(&self.scene, &surface, -ray.direction);
            share *= unmet;
            if !share.is_black() {
                share *= through(stack, &ray, hit.distance);
            }
            if share.is_black() {
                return share;
            }
            if self.media.is_open(surface.owner.material) {
                let front = surface.point.normal.dot(ray.direction) < 0.0;
                stack = stack.towards(&self.media, &surface, front, ray.direction);
            }
            let origin = surface.point.leave_towards(ray.direction);
            remaining -= (origin - ray.origin).dot(ray.direction);
            ray.origin = origin;
        }
        Spectrum::BLACK
    }
}
