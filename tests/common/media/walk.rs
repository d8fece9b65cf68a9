//! A random walk through a layer, photon by photon: nothing but Beer's law, the phase function and Fresnel's formulas. Its noise is known, so it is a
//! third opinion where no table is at hand.

use super::fresnel;
use super::phase::Phase;

/// A layer, by its optical thickness and the index of refraction over that of its surroundings.
#[derive(Debug, Clone)]
pub struct Layer {
    pub albedo: f64,
    pub thickness: f64,
    pub phase: Phase,
    pub index: f64,
}

/// Counts of photons.
#[derive(Debug, Clone, Copy, Default)]
pub struct Counts {
    pub sent: u64,
    pub reflected: u64,
    pub transmitted: u64,
}

impl Counts {
    /// A part of all photons and its standard error.
    pub fn part(self, count: u64) -> (f64, f64) {
        let part = count as f64 / self.sent as f64;
        (part, (part * (1.0 - part) / self.sent as f64).sqrt())
    }
}

/// Sends photons at the layer, whose direction outside has this cosine with the normal; `random` draws from [0, 1).
pub fn send(layer: &Layer, cosine: f64, photons: u64, random: &mut dyn FnMut() -> f64) -> Counts {
    let mut counts = Counts { sent: photons, ..Counts::default() };
    for _ in 0..photons {
        match walk(layer, cosine, random) {
            Some(true) => counts.transmitted += 1,
            Some(false) => counts.reflected += 1,
            None => {}
        }
    }
    counts
}

/// True if the photon comes out below; None where it is absorbed.
fn walk(layer: &Layer, cosine: f64, random: &mut dyn FnMut() -> f64) -> Option<bool> {
    if random() < fresnel::reflectance(cosine, layer.index) {
        return Some(false);
    }
    let mut down = fresnel::refracted(cosine, layer.index).expect("total reflection has been drawn");
    let mut depth = 0.0;
    loop {
        depth -= (1.0 - random()).ln() * down;
        // Both boundaries in turn, until the photon stays within or is out.
        while !(0.0..=layer.thickness).contains(&depth) {
            if random() >= fresnel::reflectance(down.abs(), 1.0 / layer.index) {
                return Some(depth > 0.0);
            }
            depth = if depth < 0.0 { -depth } else { 2.0 * layer.thickness - depth };
            down = -down;
        }
        if random() >= layer.albedo {
            return None;
        }
        let turned = layer.phase.invert(random());
        let azimuth = std::f64::consts::TAU * random();
        down = (down * turned + ((1.0 - down * down) * (1.0 - turned * turned)).max(0.0).sqrt() * azimuth.cos()).clamp(-1.0, 1.0);
    }
}
