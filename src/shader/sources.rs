//! The files of `shaders/`, embedded.

use crate::scene::camera::model::camera_table;
use crate::scene::light::light_table;
use crate::scene::material::material_table;
use crate::scene::shape::shape_table;

macro_rules! shader_files {
    ($($name:literal),* $(,)?) => {
        /// All but those of cameras, lobes, lights and shapes.
        const FILES: &[(&str, &str)] = &[$(($name, include_str!(concat!("../../shaders/", $name)))),*];
    };
}

shader_files![
    "core/camera.wgsl",
    "core/camera/rising.wgsl",
    "core/exposure.wgsl",
    "core/lcg.wgsl",
    "core/math.wgsl",
    "core/octahedron.wgsl",
    "core/parameters.wgsl",
    "core/sampler.wgsl",
    "core/spectrum.wgsl",
    "core/stream.wgsl",
    "geometry/bvh4.wgsl",
    "geometry/closest.wgsl",
    "geometry/instance.wgsl",
    "geometry/motion.wgsl",
    "geometry/placed.wgsl",
    "geometry/prepared_ray.wgsl",
    "geometry/ray_query.wgsl",
    "geometry/records.wgsl",
    "geometry/scene.wgsl",
    "geometry/shape_point.wgsl",
    "geometry/software/lanes.wgsl",
    "geometry/software/packet.wgsl",
    "geometry/software/packet_stack.wgsl",
    "geometry/stored.wgsl",
    "geometry/texels.wgsl",
    "geometry/traversal.wgsl",
    "geometry/unrolled.wgsl",
    "geometry/words.wgsl",
    "shading/cell_grid.wgsl",
    "shading/layered/approximation.wgsl",
    "shading/layered/scatterer.wgsl",
    "shading/layered/stack.wgsl",
    "shading/layered/walk.wgsl",
    "shading/layered/walker.wgsl",
    "shading/light/area_light.wgsl",
    "shading/light/choice.wgsl",
    "shading/light/choice/by_power.wgsl",
    "shading/light/choice/cells.wgsl",
    "shading/light/choice/power.wgsl",
    "shading/light/choice/tree.wgsl",
    "shading/light/constant_environment.wgsl",
    "shading/light/emission_map.wgsl",
    "shading/light/environment_sample.wgsl",
    "shading/light/hidden_emitters.wgsl",
    "shading/light/light_sample.wgsl",
    "shading/light/links.wgsl",
    "shading/light/place.wgsl",
    "shading/light/portal.wgsl",
    "shading/light/profile.wgsl",
    "shading/light/projected_picture.wgsl",
    "shading/light/record.wgsl",
    "shading/light/sampling.wgsl",
    "shading/light/seen_place.wgsl",
    "shading/light/seen_rectangle.wgsl",
    "shading/light/seen_triangle.wgsl",
    "shading/light/sphere_light.wgsl",
    "shading/light/textured.wgsl",
    "shading/material/blend.wgsl",
    "shading/material/blend_weight.wgsl",
    "shading/material/bsdf.wgsl",
    "shading/material/channels.wgsl",
    "shading/material/lobe.wgsl",
    "shading/material/mixture.wgsl",
    "shading/material/scattering.wgsl",
    "shading/material/seen.wgsl",
    "shading/medium/boundaries.wgsl",
    "shading/medium/free_flight.wgsl",
    "shading/medium/medium.wgsl",
    "shading/medium/phase.wgsl",
    "shading/medium/stack.wgsl",
    "shading/medium/tracking.wgsl",
    "shading/medium/volume.wgsl",
    "shading/medium/volume_crossing.wgsl",
    "shading/microfacet/albedo.wgsl",
    "shading/microfacet/beckmann.wgsl",
    "shading/microfacet/coat.wgsl",
    "shading/microfacet/cosine_power.wgsl",
    "shading/microfacet/dielectric.wgsl",
    "shading/microfacet/fresnel.wgsl",
    "shading/microfacet/hemisphere.wgsl",
    "shading/microfacet/microfacet.wgsl",
    "shading/microfacet/phong_lobe.wgsl",
    "shading/microfacet/plastic.wgsl",
    "shading/microfacet/principled_layers.wgsl",
    "shading/microfacet/rough_diffuse.wgsl",
    "shading/microfacet/sheen.wgsl",
    "shading/microfacet/spectral_dielectric.wgsl",
    "shading/microfacet/thin_film.wgsl",
    "shading/path/arrival.wgsl",
    "shading/path/camera_path.wgsl",
    "shading/path/guide.wgsl",
    "shading/path/guided.wgsl",
    "shading/path/guided_phase.wgsl",
    "shading/path/layer.wgsl",
    "shading/path/mis.wgsl",
    "shading/path/object_layer.wgsl",
    "shading/path/path.wgsl",
    "shading/path/planted.wgsl",
    "shading/path/record.wgsl",
    "shading/path/roulette.wgsl",
    "shading/path/scatterer.wgsl",
    "shading/path/shadow.wgsl",
    "shading/path/surface_layer.wgsl",
    "shading/path/trace.wgsl",
    "shading/path/transmittance.wgsl",
    "shading/sides.wgsl",
    "shading/surface.wgsl",
    "shading/texture/attributes.wgsl",
    "shading/texture/coordinates.wgsl",
    "shading/texture/image.wgsl",
    "shading/texture/noise.wgsl",
    "shading/texture/normal_map.wgsl",
    "shading/texture/normal_shadowing.wgsl",
    "shading/texture/tangent_space.wgsl",
    "shading/texture/tangents.wgsl",
    "shading/texture/texture.wgsl",
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
    ($($(#[$doc:meta])* $material:ident $(($($boxed:tt)*))? $({$($fields:tt)*})? $type_name:ident { $($lobe:ident $file:ident $switch:ident $support:ident $(($($slots:tt)*))? $([$($parameters:tt)*])?)* })*) => {
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
            concat!("shading/light/kind/", stringify!($file), ".wgsl"),
            include_str!(concat!("../../shaders/shading/light/kind/", stringify!($file), ".wgsl")),
        ),)*)*];
    };
}
light_table!(light_files);

/// The file of each model in the table of cameras.
macro_rules! camera_files {
    ($($(#[$meta:meta])* $variant:ident $file:ident $switch:ident $($needed:ident)*,)*) => {
        const CAMERAS: &[(&str, &str)] = &[$((
            concat!("core/camera/", stringify!($file), ".wgsl"),
            include_str!(concat!("../../shaders/core/camera/", stringify!($file), ".wgsl")),
        ),)*];
    };
}
camera_table!(camera_files);

/// The file of each primitive in the table of shapes.
macro_rules! shape_files {
    ($($variant:ident($type:ty) $module:ident $name:literal $(=> $primitive:ident $file:ident $capitals:ident $sampling:ident $coordinates:ident $curvature:ident)?,)*) => {
        const SHAPES: &[(&str, &str)] = &[$($(
            (
                concat!("geometry/shape/", stringify!($file), ".wgsl"),
                include_str!(concat!("../../shaders/geometry/shape/", stringify!($file), ".wgsl")),
            ),
        )?)*];
    };
}
shape_table!(shape_files);

/// Name within `shaders/` and text of every file.
pub fn files() -> impl Iterator<Item = (&'static str, &'static str)> {
    FILES.iter().chain(CAMERAS).chain(LOBES).chain(LIGHTS).chain(SHAPES).copied()
}
