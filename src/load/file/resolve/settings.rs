//! `[film]` and `[render]`

use super::Resolver;
use crate::load::SceneError;
use crate::load::file::syntax::{FilterEntry, SceneFile};
use crate::scene::settings::{MOST_LIGHT_SAMPLES, MOST_LIGHT_SAMPLES_DEPTH};
use crate::scene::{Filter, FilterKind};

/// Most pixels on a side and in all.
const LARGEST_SIDE: u32 = 32_768;
const MOST_PIXELS: u64 = 1 << 28;

impl Resolver<'_> {
    pub(super) fn settings(&mut self, file: &SceneFile) -> Result<(), SceneError> {
        if let Some(size) = &file.film.size {
            let [width, height] = size.value.map(|side| side.get());
            if width.max(height) > LARGEST_SIDE || u64::from(width) * u64::from(height) > MOST_PIXELS {
                let message = format!("a picture of {width} x {height} pixels is too large");
                return Err(self
                    .error(&size.span, message)
                    .with_help(format!("at most {LARGEST_SIDE} pixels on a side and {MOST_PIXELS} in all")));
            }
            self.scene.film.size = [width, height];
        }
        if let Some(filter) = &file.film.filter {
            self.scene.film.filter = resolve_filter(filter);
        }
        let written = &file.render;
        let render = &mut self.scene.render;
        render.spp = written.spp.map_or(render.spp, |spp| spp.get());
        render.max_depth = written.max_depth.unwrap_or(render.max_depth);
        render.sampler = written.sampler.unwrap_or(render.sampler);
        render.pixel_sampler = written.pixel_sampler.map_or(render.pixel_sampler, Into::into);
        render.estimator = written.estimator.unwrap_or(render.estimator);
        render.heuristic = written.heuristic.unwrap_or(render.heuristic);
        render.hemisphere = written.hemisphere.unwrap_or(render.hemisphere);
        render.light_sampling = written.light_sampling.unwrap_or(render.light_sampling);
        render.seed = written.seed.unwrap_or(render.seed);
        if let Some(count) = &written.light_samples {
            render.light_samples = count.value;
            if !(1..=MOST_LIGHT_SAMPLES).contains(&count.value) {
                let message = format!("{} light samples are not possible", count.value);
                return Err(self.error(&count.span, message).with_help(format!("from 1 to {MOST_LIGHT_SAMPLES}")));
            }
        }
        if let Some(depth) = &written.light_samples_depth {
            render.light_samples_depth = depth.value;
            if !(1..=MOST_LIGHT_SAMPLES_DEPTH).contains(&depth.value) {
                let message = format!("several light samples at the surfaces of {} edges are not possible", depth.value);
                return Err(self.error(&depth.span, message).with_help(format!("from 1 to {MOST_LIGHT_SAMPLES_DEPTH}")));
            }
        }
        if let Some(depth) = &written.roulette_depth {
            render.roulette_depth = depth.value;
            if render.max_depth == 0 && depth.value == 0 {
                let message = "with max_depth = 0 and roulette_depth = 0 paths would never end";
                return Err(self.error(&depth.span, message).with_help("bound max_depth, or let Russian roulette end paths"));
            }
        }
        Ok(())
    }
}

fn resolve_filter(entry: &FilterEntry) -> Filter {
    let (kind, keys, default_radius) = match entry {
        FilterEntry::Box(keys) => (FilterKind::Box, keys, 0.5),
        FilterEntry::Tent(keys) => (FilterKind::Tent, keys, 1.0),
        FilterEntry::Gaussian(keys) => (FilterKind::Gaussian, keys, 1.5),
        FilterEntry::BlackmanHarris(keys) => (FilterKind::BlackmanHarris, keys, 2.0),
    };
    Filter { kind, radius: keys.radius.map_or(default_radius, |radius| radius.0) }
}
