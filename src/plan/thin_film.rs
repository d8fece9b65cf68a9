//! The WGSL file of the waves by which thin films are integrated over the spectrum.

use crate::scene::material::thin_film::WAVES;

/// Name under which kernels import it.
pub const FILE: &str = "shading/microfacet/thin_film_waves.wgsl";

/// The text: the numbers of each channel's waves, and the waves.
pub fn wgsl() -> String {
    let mut text = "// Written by src/plan/thin_film.rs.\n".to_owned();
    let mut ends = vec![0];
    for channel in WAVES {
        ends.push(ends.last().copied().unwrap_or(0) + channel.len());
    }
    let list: Vec<String> = ends.iter().map(|end| format!("{end}u")).collect();
    text += "\n// Waves of a channel begin at its number, and end before that of the next one.\n";
    text += &format!(
        "fn first_film_wave(channel: u32) -> u32 {{\n    let ends = vec4<u32>({});\n    return ends[channel];\n}}\n",
        list.join(", ")
    );
    text += "\n// Share of the channel; mean and standard deviation of the wavenumber, per micrometre.\n";
    text += "fn film_wave(index: u32) -> vec3<f32> {\n    switch index {\n";
    for (index, wave) in WAVES.iter().copied().flatten().enumerate() {
        let numbers = format!("vec3<f32>({:?}, {:?}, {:?})", wave.share, wave.wavenumber, wave.deviation);
        text += &format!("        case {index}u: {{ return {numbers}; }}\n");
    }
    text + "        default: { return vec3<f32>(0.0); }\n    }\n}\n"
}
