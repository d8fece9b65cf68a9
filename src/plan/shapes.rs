//! The WGSL files that hand each primitive on to the functions in its own files, by the table of shapes.

use crate::packed::shape::{Curvature, PrimitiveKind, SurfaceCoordinates, SurfaceSampling};

/// Name under which kernels import the tests of rays.
pub const GEOMETRY_FILE: &str = "geometry/shapes.wgsl";

/// Name under which kernels import what a hit or a light is.
pub const SHADING_FILE: &str = "shading/shapes.wgsl";

fn all() -> impl Iterator<Item = PrimitiveKind> {
    PrimitiveKind::ALL.iter().copied()
}

fn finite() -> impl Iterator<Item = PrimitiveKind> {
    all().filter(|kind| !kind.is_infinite())
}

/// The text of [`GEOMETRY_FILE`]. A primitive `NAME` has the function `intersect_NAME`, `intersect_NAME_again` where a ray can cross it twice, and
/// `move_NAME` unless it is infinite; only those that the plan turns on are compiled.
pub fn geometry_wgsl() -> String {
    let mut text = "// Written by src/plan/shapes.rs.\n#import core/layout.wgsl\n#import geometry/prepared_ray.wgsl\n".to_owned();
    text += "#if MOTION\n#import geometry/motion.wgsl\n#endif\n";
    for kind in all() {
        text += &format!("#if {}\n#export geometry/shape/{}.wgsl\n#endif\n", kind.switch(), kind.file());
    }
    text += "\n// A ray against a primitive of the hierarchy, by the points of its record: (t or -1, and where it is met).\n";
    let points = "p0: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>";
    let stored =
        finite().map(|kind| (kind, kind.switch_in_hierarchy(), format!("intersect_{}(ray, t_max, p0, p1, p2)", kind.file())));
    let signature = format!("intersect_shape(ray: PreparedRay, t_max: f32, kind: u32, {points}) -> vec3<f32>");
    text += &dispatch(&signature, stored, "vec3<f32>(-1.0, 0.0, 0.0)");
    text += "\n#if TRANSPARENT_SHADOWS\n// Where a ray crosses a primitive after its first crossing, as intersect_shape: (t or -1, and where it is met).\n";
    let again = all().filter(|kind| kind.curvature() == Curvature::Curved);
    let again = again.map(|kind| (kind, kind.switch(), format!("intersect_{}_again(ray, t_max, p0, p1, p2)", kind.file())));
    let signature = format!("intersect_again(ray: PreparedRay, t_max: f32, kind: u32, {points}) -> vec3<f32>");
    text += &dispatch(&signature, again, "vec3<f32>(-1.0, 0.0, 0.0)");
    text += "#endif\n\n#if MOTION\n// The points of a primitive's record as a motion has moved them.\n";
    let moved = finite().map(|kind| (kind, kind.switch(), format!("move_{}(motion, p0, p1, p2)", kind.file())));
    let otherwise = "MovedPoints(p0, p1, p2, vec3<f32>(0.0))";
    text + &dispatch(&format!("move_shape(motion: Motion, kind: u32, {points}) -> MovedPoints"), moved, otherwise) + "#endif\n"
}

/// The text of [`SHADING_FILE`]. A primitive `NAME` has the function `NAME_point`; where points of it are drawn by area, `sample_NAME`; unless
/// it is infinite, `NAME_direction_pdf`; and where texture coordinates come from its normal, `NAME_uv` and `NAME_tangents`.
pub fn shading_wgsl() -> String {
    let mut text = "// Written by src/plan/shapes.rs.\n#import core/layout.wgsl\n#import core/math.wgsl\n".to_owned();
    text += "#import geometry/prepared_ray.wgsl\n#import geometry/shape_point.wgsl\n#if ATTRIBUTES\n#import shading/texture/attributes.wgsl\n#endif\n";
    for kind in all() {
        text += &format!("#if {}\n#import geometry/shape/{}.wgsl\n#endif\n", kind.switch(), kind.file());
    }
    text += "\n// What a ray meets of a primitive, by the points of its record.\n";
    let signature = "shape_point(kind: u32, ray: Ray, hit: Hit, p0: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> ShapePoint";
    let points = all().map(|kind| (kind, kind.switch(), format!("{}_point(ray, hit, p0, p1, p2)", kind.file())));
    text += &dispatch(signature, points, "no_shape_point()");

    text += "\n// A point of a light or a portal, even over its area, by the points of its record.\n";
    let signature = "sample_shape(kind: u32, p0: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>, u: f32, v: f32) -> ShapePoint";
    let by_area = all().filter(|kind| kind.sampling() == SurfaceSampling::Area);
    let drawn = by_area.map(|kind| (kind, kind.switch_of_lights(), format!("sample_{}(p0, p1, p2, u, v)", kind.file())));
    text += &dispatch(signature, drawn, "no_shape_point()");

    text += "\n// Density by solid angle of directions drawn to a portal, in the ray's direction from its origin; 0 where it is not met.\n";
    let signature = "shape_direction_pdf(kind: u32, ray: PreparedRay, l1: vec4<f32>, l2: vec3<f32>, l3: vec3<f32>) -> f32";
    let densities =
        finite().map(|kind| (kind, kind.switch_of_lights(), format!("{}_direction_pdf(ray, l1, l2, l3)", kind.file())));
    text += &dispatch(signature, densities, "0.0");

    let of_normal = || all().filter(|kind| kind.coordinates() == SurfaceCoordinates::Normal);
    text += "\n#if ATTRIBUTES\n// Texture coordinates and an own normal, by the attributes from `first` on.\n";
    let signature = "shape_attribute(kind: u32, first: u32, uv: vec2<f32>, normal: vec3<f32>) -> Attribute";
    let attributes =
        of_normal().map(|kind| (kind, kind.switch(), format!("Attribute(vec3<f32>(0.0), {}_uv(first, normal))", kind.file())));
    text += &dispatch(signature, attributes, "interpolate_attributes(first, uv)");
    text += "#endif\n\n// The directions in which texture coordinates grow; `first` may be NONE.\n";
    text += "fn shape_tangents(kind: u32, first: u32, point: ShapePoint) -> Tangents {\n";
    text += "    var tangents = Tangents(point.along_u, point.along_v);\n#if ATTRIBUTES\n    if first != NONE {\n        switch kind {\n";
    for kind in of_normal() {
        let (switch, number, name) = (kind.switch(), kind.number_name(), kind.file());
        text +=
            &format!("#if {switch}\n            case {number}: {{ tangents = {name}_tangents(first, point.normal); }}\n#endif\n");
    }
    for kind in all().filter(|kind| kind.coordinates() == SurfaceCoordinates::None) {
        text += &format!("#if {}\n            case {}: {{}}\n#endif\n", kind.switch(), kind.number_name());
    }
    text += "            default: { tangents = edge_tangents(first, point.along_u, point.along_v); }\n";
    text + "        }\n    }\n#endif\n    return tangents;\n}\n"
}

/// A function with the result of another one, which the kind and its switch choose.
fn dispatch(signature: &str, calls: impl Iterator<Item = (PrimitiveKind, &'static str, String)>, otherwise: &str) -> String {
    let mut text = format!("fn {signature} {{\n    switch kind {{\n");
    for (kind, switch, call) in calls {
        text += &format!("#if {switch}\n        case {}: {{ return {call}; }}\n#endif\n", kind.number_name());
    }
    text + &format!("        default: {{ return {otherwise}; }}\n    }}\n}}\n")
}
