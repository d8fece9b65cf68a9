//! The WGSL file that hands a place of the picture on to the camera's model in its own file, by the table of models.

use crate::scene::camera::model::camera_table;

/// Name under which kernels import it.
pub const FILE: &str = "core/camera_models.wgsl";

/// Module and switch of each model.
macro_rules! models {
    ($($(#[$meta:meta])* $variant:ident $module:ident $switch:ident $($needed:ident)*,)*) => {
        const MODELS: &[(&str, &str)] = &[$((stringify!($module), stringify!($switch))),*];
    };
}
camera_table!(models);

/// The text of [`FILE`]. A model `NAME` has the function `NAME_direction`. One of them is compiled; where the plan turns none on, nothing calls this.
pub fn wgsl() -> String {
    let mut text = "// Written by src/plan/camera_models.rs.\n".to_owned();
    let mut body = String::new();
    for (name, switch) in MODELS {
        text += &format!("#if {switch}\n#import core/camera/{name}.wgsl\n#endif\n");
        body += &format!("#if {switch}\n    return {name}_direction(place, tile);\n#else\n");
    }
    body += "    return vec4<f32>(0.0, 0.0, -1.0, 1.0);\n";
    body += &"#endif\n".repeat(MODELS.len());
    text += "\n// The direction that a place of a view sees: to the right, up, backward; not 0 where it sees something.\n";
    text + "fn camera_model_direction(place: vec2<f32>, tile: u32) -> vec4<f32> {\n" + &body + "}\n"
}
