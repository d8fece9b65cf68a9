//! The WGSL files that hand each light which is no surface on to the function in its own file, by the table of lights.

use crate::packed::light::LightKind;
use crate::scene::light::light_table;

/// Name under which kernels import the dispatch of delta lights.
pub const DELTA_FILE: &str = "shading/light/delta_lights.wgsl";

/// Name under which kernels import the light from outside the scene.
pub const OUTSIDE_FILE: &str = "shading/light/outside.wgsl";

/// The text of [`DELTA_FILE`]. A delta light `NAME` has the function `sample_NAME_light`; only those that the plan turns on are compiled.
pub fn delta_wgsl() -> String {
    let mut text = "// Written by src/plan/lights.rs.\n".to_owned();
    let mut cases = String::new();
    for (kind, file) in LightKind::DELTA.iter().filter_map(|kind| Some((kind, kind.file()?))) {
        let switch = kind.number_name();
        text += &format!("#if {switch}\n#import shading/light/kind/{file}.wgsl\n#endif\n");
        cases +=
            &format!("#if {switch}\n        case {switch}: {{ return sample_{file}_light(light, reference, pmf); }}\n#endif\n");
    }
    text += "#import core/layout.wgsl\n#import shading/light/light_sample.wgsl\n\n";
    text += "// What arrives at `reference` from a delta light of this kind, over the probability `pmf` of the light.\n";
    text += "fn sample_delta_light(kind: u32, light: u32, reference: vec3<f32>, pmf: f32) -> LightSample {\n    switch kind {\n";
    text + &cases + "        default: { return no_light(); }\n    }\n}\n"
}

/// Module and switch of each light from outside the scene.
macro_rules! outside {
    (environment { $($environment:ident($type:ident) $module:ident $switch:ident $($needed:ident)*,)* } delta { $($delta:tt)* }) => {
        const OUTSIDE: &[(&str, &str)] = &[$((stringify!($module), stringify!($switch))),*];
    };
}
light_table!(outside);

/// The text of [`OUTSIDE_FILE`]. A light `NAME` has the functions `NAME_radiance`, `NAME_pdf` and `sample_NAME`. One of them is compiled; where
/// the plan turns none on, the radiance is the same from everywhere.
pub fn outside_wgsl() -> String {
    let mut text = "// Written by src/plan/lights.rs.\n#import shading/light/environment_sample.wgsl\n".to_owned();
    for (name, switch) in OUTSIDE {
        text += &format!("#if {switch}\n#import shading/light/kind/{name}.wgsl\n#endif\n");
    }
    text += "#import shading/light/constant_environment.wgsl\n";
    text += "\n// Radiance that arrives against a direction.\n";
    text += &choice("outside_radiance(wi: vec3<f32>) -> vec3<f32>", |name| format!("{name}_radiance(wi)"));
    text += "\n// Density of sample_outside, per steradian.\n";
    text += &choice("outside_pdf(wi: vec3<f32>) -> f32", |name| format!("{name}_pdf(wi)"));
    text += "\n// Draws a direction by 32 bits each.\n";
    let signature = "sample_outside(bits_u: u32, bits_v: u32) -> EnvironmentSample";
    text + &choice(signature, |name| format!("sample_{name}(bits_u, bits_v)"))
}

/// A function that calls the one of the light that is turned on, and else that of a constant environment.
fn choice(signature: &str, call: impl Fn(&str) -> String) -> String {
    let mut text = format!("fn {signature} {{\n");
    for (name, switch) in OUTSIDE {
        text += &format!("#if {switch}\n    return {};\n#else\n", call(name));
    }
    text += &format!("    return {};\n", call("constant"));
    text + &"#endif\n".repeat(OUTSIDE.len()) + "}\n"
}
