//! The files of `shaders/`, embedded.

use crate::scene::light::light_table;
use crate::scene::material::material_table;
use crate::scene::shape::shape_table;

macro_rules! shader_files {
    ($($name:literal),* $(,)?) => {
        /// All but those of lobes, lights and shapes.
        const FILES: &[(&str, &str)] = &[$(($name, include_str!(concat!("../../shaders/", $name)))),*];
    };
}

shader_files![
    "core/camera.wgsl",
    "core/math.wgsl",
    "core/octahedron.wgsl",
    "core/parameters.wgsl",
    "core/sampler.wgsl",
    "core/spectrum.wgsl",
    "geometry/bvh4.wgsl",
    "geometry/closest.wgsl",
    "geometry/instance.wgsl",
    "geometry/motion.wgsl",
    "geometry/placed.wgsl",
    "geometry/prepared_ray.wgsl",
    "geometry/ray_query.wgsl",
    "geometry/records.wgsl",
    "geometry/scene.wgsl",
    "geometry/software/lanes.wgsl",
    "geometry/software/packet.wgsl",
    "geometry/software/packet_stack.wgsl",
    "geometry/stored.wgsl",
    "geometry/texels.wgsl",
    "geometry/traversal.wgsl",
    "geometry/unrolled.wgsl",
    "geometry/words.wgsl",
    "shading/albedo.wgsl",
    "shading/attributes.wgsl",
    "shading/beckmann.wgsl",
    "shading/blend.wgsl",
    "shading/blend_weight.wgsl",
    "shading/bsdf.wgsl",
    "shading/dielectric.wgsl",
    "shading/distant_light.wgsl",
    "shading/cell_grid.wgsl",
    "shading/coat.wgsl",
    "shading/constant_environment.wgsl",
    "shading/coordinates.wgsl",
    "shading/cosine_power.wgsl",
    "shading/environment_sample.wgsl",
    "shading/fresnel.wgsl",
    "shading/guide.wgsl",
    "shading/guided.wgsl",
    "shading/hemisphere.wgsl",
    "shading/hidden_emitters.wgsl",
    "shading/layer.wgsl",
    "shading/light.wgsl",
    "shading/light_by_power.wgsl",
    "shading/light_cells.wgsl",
    "shading/light_tree.wgsl",
    "shading/light_picture.wgsl",
    "shading/light_record.wgsl",
    "shading/light_sample.wgsl",
    "shading/lobe.wgsl",
    "shading/microfacet.wgsl",
    "shading/mis.wgsl",
    "shading/mixture.wgsl",
    "shading/noise.wgsl",
    "shading/normal_map.wgsl",
    "shading/normal_shadowing.wgsl",
    "shading/path.wgsl",
    "shading/path_record.wgsl",
    "shading/planted.wgsl",
    "shading/plastic.wgsl",
    "shading/portal.wgsl",
    "shading/seen.wgsl",
    "shading/seen_light.wgsl",
    "shading/seen_rectangle.wgsl",
    "shading/seen_triangle.wgsl",
    "shading/roulette.wgsl",
    "shading/scatterer.wgsl",
    "shading/scattering.wgsl",
    "shading/shadow.wgsl",
    "shading/shape_point.wgsl",
    "shading/sheen.wgsl",
    "shading/sides.wgsl",
    "shading/sphere_light.wgsl",
    "shading/surface.wgsl",
    "shading/surface_layer.wgsl",
    "shading/transmittance.wgsl",
    "shading/image.wgsl",
    "shading/tangent_space.wgsl",
    "shading/tangents.wgsl",
    "shading/texture.wgsl",
    "shading/thrown_picture.wgsl",
    "shading/trace.wgsl",
    "shading/volume.wgsl",
    "shading/warp.wgsl",
    "stages/accumulate.wgsl",
    "stages/connect.wgsl",
    "stages/extend.wgsl",
    "stages/film.wgsl",
    "stages/fused.wgsl",
    "stages/fused_lanes.wgsl",
    "stages/fused_pixels.wgsl",
    "stages/fused_vertex.wgsl",
    "stages/generate.wgsl",
    "stages/prepare.wgsl",
    "stages/queue.wgsl",
    "stages/shade.wgsl",
    "stages/statistics.wgsl",
    "stages/wavefront.wgsl",
];

/// The file of each lobe in the table of materials.
macro_rules! lobe_files {
    ($($material:ident $type_name:ident { $($lobe:ident $file:ident $switch:ident $support:ident)* })*) => {
        const LOBES: &[(&str, &str)] = &[$($((
            concat!("shading/bsdf/", stringify!($file), ".wgsl"),
            include_str!(concat!("../../shaders/shading/bsdf/", stringify!($file), ".wgsl")),
        ),)*)*];
    };
}
material_table!(lobe_files);

/// The file of each light in the table of lights.
macro_rules! light_files {
    ($($group:ident { $($variant:ident($type:ident) $file:ident $switch:ident $($needed:ident)*,)* })*) => {
        const LIGHTS: &[(&str, &str)] = &[$($((
            concat!("shading/light/", stringify!($file), ".wgsl"),
            include_str!(concat!("../../shaders/shading/light/", stringify!($file), ".wgsl")),
        ),)*)*];
    };
}
light_table!(light_files);

/// The files of each primitive in the table of shapes.
macro_rules! shape_files {
    ($($variant:ident($type:ty) $module:ident $name:literal $(=> $primitive:ident $file:ident $capitals:ident $sampling:ident $coordinates:ident $curvature:ident)?,)*) => {
        const SHAPES: &[(&str, &str)] = &[$($(
            (
                concat!("geometry/shape/", stringify!($file), ".wgsl"),
                include_str!(concat!("../../shaders/geometry/shape/", stringify!($file), ".wgsl")),
            ),
            (
                concat!("shading/shape/", stringify!($file), ".wgsl"),
                include_str!(concat!("../../shaders/shading/shape/", stringify!($file), ".wgsl")),
            ),
        )?)*];
    };
}
shape_table!(shape_files);

/// Name within `shaders/` and text of every file.
pub fn files() -> impl Iterator<Item = (&'static str, &'static str)> {
    FILES.iter().chain(LOBES).chain(LIGHTS).chain(SHAPES).copied()
}
