//! WGSL files by the table of materials: one hands each lobe on to the functions in its own file, one names
//! the further parameters of each.

use crate::scene::material::ParameterType;
use crate::scene::{LobeKind, LobeSupport};

/// Name under which kernels import the file that hands lobes on.
pub const FILE: &str = "shading/material/lobes.wgsl";

/// Name under which kernels import the file of further parameters.
pub const PARAMETERS_FILE: &str = "shading/material/parameters.wgsl";

/// The function that says how much of a lobe a guide may replace, but for the lobes that are broad.
const BROAD_SHARE: &str = "
// The share of the lobe's samples that go in all directions above the surface, mostly evenly, which a guide may replace.
fn lobe_broad_share(lobe: Lobe) -> f32 {
    let kind = lobe_kind(lobe);
#if PRINCIPLED
    if kind == PRINCIPLED {
        return principled_broad_share(lobe);
    }
#endif
    return select(0.0, 1.0, BROAD);
}
";

/// The text of the file that hands lobes on. A lobe `NAME` has the functions `NAME_sampling_weight` and
/// `sample_NAME`, and unless it is a delta `NAME_is_non_delta` and `evaluate_NAME`; only lobes that the plan
/// turns on are compiled.
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
    text += "\n// Light sampling can contribute: the lobe is no delta, and not black.\n";
    text += &dispatch("lobe_is_non_delta(lobe: Lobe) -> bool", non_delta(), "false", |name| format!("{name}_is_non_delta(lobe)"));
    text += "\n// The share of incoming light that the lobe scatters, roughly, by which a mixture chooses its samples.\n";
    text += &dispatch("lobe_sampling_weight(lobe: Lobe) -> f32", all(), "0.0", |name| format!("{name}_sampling_weight(lobe)"));
    let is_broad = all().filter(|lobe| lobe.support() == LobeSupport::Broad).map(|lobe| format!("kind == {}", lobe.switch()));
    text += &BROAD_SHARE.replace("BROAD", &is_broad.collect::<Vec<_>>().join(" || "));
    text += "\n// f |cos| and density; 0 for delta lobes.\n";
    let signature = "evaluate_lobe(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue";
    text += &dispatch(signature, non_delta(), "no_value()", |name| format!("evaluate_{name}(lobe, surface, wo, wi)"));
    text += "\n// Draws a direction. `choice` chooses between the ways of one lobe to scatter, (u, v) the direction within.\n";
    let signature = "sample_lobe(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample";
    text + &dispatch(signature, all(), "no_sample()", |name| format!("sample_{name}(lobe, surface, wo, choice, u, v)"))
}

/// The text of the file of further parameters: of each lobe that has some, a struct of them and the function
/// that fills it.
pub fn parameters_wgsl() -> String {
    let mut text =
        "// Written by src/plan/lobes.rs.\n#import core/spectrum.wgsl\n#import shading/material/lobe.wgsl\n".to_owned();
    for lobe in LobeKind::ALL.iter().filter(|lobe| !lobe.parameters().is_empty()) {
        let (mut fields, mut values) = (String::new(), Vec::new());
        for (place, parameter) in lobe.parameters().iter().enumerate() {
            let (type_name, part) = match parameter.parameter_type {
                ParameterType::Scalar | ParameterType::SignedScalar => ("f32", ".x"),
                ParameterType::Color => ("Spectrum", ""),
                ParameterType::Vector => ("vec3<f32>", ""),
            };
            fields += &format!("    {}: {type_name},\n", parameter.name);
            let default = parameter.default.unwrap_or("0.0");
            // A kernel has room for as many as some material of its scene has.
            let found = format!("further[min({place}u, MOST_FURTHER - 1u)]");
            values.push(format!("        select(vec3<f32>({default}), {found}, lobe.further_count > {place}u){part}"));
        }
        let (file, values) = (lobe.file(), values.join(",\n"));
        text +=
            &format!("\nstruct {lobe:?}Parameters {{\n{fields}}}\n\nfn {file}_parameters(lobe: Lobe) -> {lobe:?}Parameters {{\n");
        text += &format!("    let further = lobe.further;\n    return {lobe:?}Parameters(\n{values}\n    );\n}}\n");
    }
    text
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
