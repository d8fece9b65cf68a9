//! Scene files of media, in parts.

use crate::common::media::phase::Phase;

/// A medium as a scene file has it, per channel and unit length.
pub struct Medium {
    pub scattering: [f64; 3],
    pub absorption: [f64; 3],
    pub emission: [f64; 3],
    pub phase: Phase,
}

impl Medium {
    /// A medium by its extinction and albedo.
    pub fn new(extinction: [f64; 3], albedo: [f64; 3], phase: Phase) -> Self {
        let of = |part: &dyn Fn(f64) -> f64| std::array::from_fn(|channel| extinction[channel] * part(albedo[channel]));
        Self { scattering: of(&|albedo| albedo), absorption: of(&|albedo| 1.0 - albedo), emission: [0.0; 3], phase }
    }

    pub fn extinction(&self, channel: usize) -> f64 {
        self.scattering[channel] + self.absorption[channel]
    }

    pub fn albedo(&self, channel: usize) -> f64 {
        self.scattering[channel] / self.extinction(channel)
    }

    /// The medium with this factor of what it scatters, and as much more that it absorbs.
    pub fn scattering_less(&self, factor: f64) -> Self {
        let scattering = self.scattering.map(|value| value * factor);
        let absorption = std::array::from_fn(|channel| self.extinction(channel) - scattering[channel]);
        Self { scattering, absorption, emission: self.emission, phase: self.phase.clone() }
    }

    /// Its entry in a scene file.
    pub fn entry(&self, name: &str) -> String {
        let Self { scattering, absorption, emission, phase } = self;
        format!(
            "[[medium]]\nname = \"{name}\"\nscattering = {scattering:?}\nabsorption = {absorption:?}\nemission = {emission:?}\nphase = {}\n",
            phase_entry(phase)
        )
    }
}

fn phase_entry(phase: &Phase) -> String {
    match phase {
        Phase::Isotropic => "{ type = \"isotropic\" }".into(),
        Phase::HenyeyGreenstein(g) => format!("{{ type = \"henyey_greenstein\", g = {g:?} }}"),
        Phase::Rayleigh => "{ type = \"rayleigh\" }".into(),
        Phase::Blend(first, second, weight) => {
            let (first, second) = (phase_entry(first), phase_entry(second));
            format!("{{ type = \"blend\", phases = [{first}, {second}], weights = [{:?}, {weight:?}] }}", 1.0 - weight)
        }
    }
}

/// A boundary of index 1 around a medium, named as the medium is.
pub fn null_boundary(medium: &str) -> String {
    format!("[[material]]\nname = \"around {medium}\"\ntype = \"pass\"\ninterior = \"{medium}\"\n")
}

/// A smooth boundary of a dielectric around a medium.
pub fn glass_boundary(medium: &str, index: f64) -> String {
    format!("[[material]]\nname = \"around {medium}\"\ntype = \"glass\"\nior = {index:?}\ninterior = \"{medium}\"\n")
}

/// A box filled with a medium.
pub fn block(medium: &str, min: [f64; 3], max: [f64; 3]) -> String {
    format!("[[shape]]\ntype = \"box\"\nmin = {min:?}\nmax = {max:?}\nmaterial = \"around {medium}\"\n")
}

/// A ball filled with a medium.
pub fn ball(medium: &str, center: [f64; 3], radius: f64) -> String {
    format!("[[shape]]\ntype = \"sphere\"\ncenter = {center:?}\nradius = {radius:?}\nmaterial = \"around {medium}\"\n")
}

/// A black plane that faces up.
pub fn black_floor(height: f64) -> String {
    format!(
        "[[material]]\nname = \"black\"\ntype = \"diffuse\"\nreflectance = 0\n\
         [[shape]]\ntype = \"plane\"\npoint = [0, {height:?}, 0]\nnormal = [0, 1, 0]\nmaterial = \"black\"\n"
    )
}

/// A sky of radiance 1, all round.
pub const SKY: &str = "[[light]]\ntype = \"environment\"\nradiance = 1\n";

/// A scene of 20 × 20 pixels that all look along one ray, by paths of any length.
pub fn scene(spp: u32, max_depth: u32, from: [f64; 3], to: [f64; 3], parts: &[String]) -> String {
    let frame = format!(
        "[film]\nsize = [20, 20]\n[render]\nspp = {spp}\nmax_depth = {max_depth}\n\
         [camera]\nposition = {from:?}\nlook_at = {to:?}\nup = [0.1, 0.9, 0.3]\nvfov = 0.001\n"
    );
    frame + &parts.concat()
}
