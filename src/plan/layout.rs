//! The WGSL file of everything that Rust packs and kernels unpack: structs, kinds, flags, sizes, binding numbers. Each is defined once,
//! beside the Rust code that packs it.

use super::bindings::Binding;
use super::parameters::{PassParameters, VertexParameters};
use super::{counters, estimator, path_state, trace_record};
use crate::packed::{
    NONE, View, blend_weight, bvh4, guide, instance, layers, light, light_cells, links, material, medium, motion, primitive,
    shape, texture, view, volume,
};
use crate::shader::shared::{Constant, Constants, SharedStruct, declare_constant};

/// Name under which kernels import it.
pub const FILE: &str = "core/layout.wgsl";

/// All constants.
pub fn constants() -> Constants {
    [
        vec![("NONE", Constant::U32(NONE))],
        Binding::constants(),
        counters::constants(),
        estimator::constants(),
        path_state::constants(),
        trace_record::constants(),
        shape::constants(),
        primitive::constants(),
        bvh4::constants(),
        guide::constants(),
        instance::constants(),
        motion::constants(),
        view::constants(),
        material::constants(),
        layers::constants(),
        medium::constants(),
        volume::constants(),
        blend_weight::constants(),
        light::constants(),
        light::profile::constants(),
        light_cells::constants(),
        links::constants(),
        texture::constants(),
    ]
    .concat()
}

/// The file's text.
pub fn wgsl() -> String {
    let structs = [PassParameters::wgsl(), VertexParameters::wgsl(), View::wgsl()].join("\n");
    let constants: String = constants().into_iter().map(|(name, value)| declare_constant(name, value)).collect();
    format!("// Written by src/plan/layout.rs.\n\n{structs}\n{constants}")
}
