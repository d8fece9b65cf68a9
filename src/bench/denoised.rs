//! Denoising as a part of what is measured: the picture, the layers that help, and the denoiser, all on the clock.

use std::rc::Rc;
use std::time::Instant;

use super::subject::{BenchError, Run, SceneSubject, Subject};
use crate::denoise::library::Library;
use crate::denoise::{Raw, denoise};

/// A scene whose pictures are denoised, by the help of albedo and normals of as many samples, as `gpt render --denoise` does it.
pub struct DenoisedSubject<'a> {
    pub picture: SceneSubject<'a>,
    pub albedo: SceneSubject<'a>,
    pub normal: SceneSubject<'a>,
    pub library: Rc<Library>,
}

impl Subject for DenoisedSubject<'_> {
    fn render(&mut self, seed: u32, spp: u32) -> Result<Run, BenchError> {
        let run = self.picture.render(seed, spp)?;
        let [albedo, normal] = [self.albedo.render(seed, spp)?, self.normal.render(seed, spp)?];
        let sum = |of: fn(&Run) -> f64| of(&run) + of(&albedo) + of(&normal);
        let (seconds, build_seconds, compile_seconds) =
            (sum(|run| run.seconds), sum(|run| run.build_seconds), sum(|run| run.compile_seconds));
        let start = Instant::now();
        let raw = Raw {
            placed: None,
            picture: run.picture,
            albedo: Some(albedo.picture.pixels),
            normal: Some(normal.picture.pixels),
            variances: None,
        };
        let picture = denoise(&self.library, &raw)?;
        let seconds = seconds + start.elapsed().as_secs_f64();
        let Run { rays, samples, non_finite_samples, .. } = run;
        Ok(Run { picture, seconds, rays, samples, non_finite_samples, build_seconds, compile_seconds })
    }
}
