//! The WGSL file that hands each lobe on to the functions in its own file, by the table of materials.

use crate::scene::{LobeKind, LobeSupport};

/// Name under which kernels import it.
pub const FILE: &str = "shading/material/lobes.wgsl";

/// The file's text. A lobe `NAME` has the functions `NAME_sampling_weight` and `sample_NAME`, and unless it is a delta
/// `NAME_is_non_delta` and `evaluate_NAME`; only lobes that the plan turns on are compiled.
pub fn wgsl() -> String {
    let mut text = "// Written by src/plan/lobes.rs.\n".to_owned();
    for import in ["core/layout.wgsl", "shading/material/lobe.wgsl", "shading/material/scattering.wgsl", "shading/surface.wgsl"] {
        text += &format!("#import {import}\n");
    }
    for lobe in LobeKind::ALL {
        text += &format!("#if {}\n#import shading/bsdf/{}.wgsl\n#endif\n", lobe.switch(), lobe.file());
    }
    let all = || LobeKind::ALL.iter().copied();
    let non_delta = || all().filter(|lobe| lobe.support() != LobeSupport::Delta);
    text += "\n// Whether light sampling can contribute: it is no delta lobe, and not black.\n";
    text += &dispatch("lobe_is_non_delta(lobe: Lobe) -> bool", non_delta(), "false", |name| format!("{name}_is_non_delta(lobe)"));
    text += "\n// How much of the incoming light it sends on, roughly: what its share of a mixture's samples goes by.\n";
    text += &dispatch("lobe_sampling_weight(lobe: Lobe) -> f32", all(), "0.0", |name| format!("{name}_sampling_weight(lobe)"));
    text += "\n// f |cos| and density; 0 for delta lobes.\n";
    let signature = "evaluate_lobe(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue";
    text += &dispatch(signature, non_delta(), "no_value()", |name| format!("evaluate_{name}(lobe, surface, wo, wi)"));
    text += "\n// Draws a direction. `choice` chooses between the ways that one lobe has, (u, v) the direction within.\n";
    let signature = "sample_lobe(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample";
    text + &dispatch(signature, all(), "no_sample()", |name| format!("sample_{name}(lobe, surface, wo, choice, u, v)"))
}

/// A function that calls another one by the kind of lobe.
fn dispatch(
    signature: &str,
    lobes: impl Iterator<Item = LobeKind>,
    otherwise: &str,
    call: impl Fn(&'static str) -> String,
) -> String {
    let mut text = format!("fn {signature} {{\n    switch lobe_kind(lobe) {{\n");
    for lobe in lobes {
        let switch = lobe.switch();
        text += &format!("#if {switch}\n        case {switch}: {{ return {}; }}\n#endif\n", call(lobe.file()));
    }
    text + &format!("        default: {{ return {otherwise}; }}\n    }}\n}}\n")
}
