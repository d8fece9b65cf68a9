//! The files of `shaders/`, embedded.

macro_rules! shader_files {
    ($($name:literal),* $(,)?) => {
        /// Name within `shaders/` and text of every file.
        pub const FILES: &[(&str, &str)] = &[$(($name, include_str!(concat!("../../shaders/", $name)))),*];
    };
}

shader_files![
    "core/camera.wgsl",
    "core/lanes.wgsl",
    "core/math.wgsl",
    "core/parameters.wgsl",
    "core/sampler.wgsl",
    "geometry/bvh4.wgsl",
    "geometry/closest.wgsl",
    "geometry/motion.wgsl",
    "geometry/packet.wgsl",
    "geometry/packet_stack.wgsl",
    "geometry/primitives.wgsl",
    "geometry/ray_query.wgsl",
    "geometry/records.wgsl",
    "geometry/scene.wgsl",
    "geometry/stored.wgsl",
    "geometry/traversal.wgsl",
    "geometry/unrolled.wgsl",
    "shading/blend.wgsl",
    "shading/bsdf.wgsl",
    "shading/cosine_power.wgsl",
    "shading/environment.wgsl",
    "shading/heuristic.wgsl",
    "shading/leaf.wgsl",
    "shading/light.wgsl",
    "shading/microfacet.wgsl",
    "shading/mis.wgsl",
    "shading/mixture.wgsl",
    "shading/noise.wgsl",
    "shading/normal_map.wgsl",
    "shading/path.wgsl",
    "shading/portal.wgsl",
    "shading/sphere_light.wgsl",
    "shading/surface.wgsl",
    "shading/texture.wgsl",
    "shading/trace.wgsl",
    "stages/accumulate.wgsl",
    "stages/connect.wgsl",
    "stages/extend.wgsl",
    "stages/film.wgsl",
    "stages/fused.wgsl",
    "stages/fused_lanes.wgsl",
    "stages/fused_pixels.wgsl",
    "stages/generate.wgsl",
    "stages/prepare.wgsl",
    "stages/queue.wgsl",
    "stages/shade.wgsl",
    "stages/statistics.wgsl",
    "stages/wavefront.wgsl",
];
