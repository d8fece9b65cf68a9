//! Geometry as code: every primitive's test with its coordinates as constants.
//!
//! A constant is the cheapest operand there is. On software Vulkan, where each word of a storage buffer is fetched lane by lane, a
//! few dozen primitives tested this way take less time than a hierarchy over them.

use std::fmt::Write as _;

use glam::Vec3;

use crate::packed::PackedScene;
use crate::packed::primitive::Primitive;
use crate::packed::shape::PrimitiveKind;

/// WGSL with `closest_of_constants` and `any_of_constants` for the primitives from `first` on. With `shadows_are_transparent`, surfaces that
/// let light through are left out of the second and stand in `next_of_transparent_constants`, which finds them one after the other:
/// nearest first, and equally near ones by their number.
pub fn constants(packed: &PackedScene, first: usize, shadows_are_transparent: bool) -> String {
    let mut closest = String::new();
    let mut any = String::new();
    let mut next = String::new();
    for (index, primitive) in packed.primitives.iter().enumerate().skip(first) {
        let test = test_for(primitive, "best.t");
        // Selects instead of branches: every lane runs every test anyway.
        let _ = writeln!(
            closest,
            "    {{ let f = {test}; let met = f.x > 0.0; best.t = select(best.t, f.x, met); \
             best.primitive = select(best.primitive, {index}u, met); best.u = select(best.u, f.y, met); \
             best.v = select(best.v, f.z, met); }}"
        );
        let material = &packed.materials.materials[primitive.material() as usize];
        if shadows_are_transparent && material.lets_through() {
            let test = test_for(primitive, "next.t");
            let _ = writeln!(
                next,
                "    {{ let f = {test}; let met = f.x > 0.0 && (f.x > after.t || (f.x == after.t && {index}u > after.primitive)); \
                 next.t = select(next.t, f.x, met); next.primitive = select(next.primitive, {index}u, met); \
                 next.u = select(next.u, f.y, met); next.v = select(next.v, f.z, met); }}"
            );
            continue;
        }
        let _ = writeln!(any, "    blocked = blocked || ({}).x > 0.0;", test_for(primitive, "t_max"));
    }
    format!(
        "#import core/math.wgsl\n#import geometry/prepared_ray.wgsl\n#import geometry/shapes.wgsl\n\n\
         fn closest_of_constants(ray: PreparedRay, hit: ptr<function, Hit>) {{\n    \
         var best = *hit;\n{closest}    *hit = best;\n}}\n\n\
         fn any_of_constants(ray: PreparedRay, t_max: f32) -> bool {{\n    \
         var blocked = false;\n{any}    return blocked;\n}}\n\n#if TRANSPARENT_SHADOWS\n\
         fn next_of_transparent_constants(ray: PreparedRay, after: Hit, t_max: f32) -> Hit {{\n    \
         var next = no_hit(t_max);\n{next}    return next;\n}}\n#endif\n"
    )
}

/// An expression of type `vec3<f32>`: (t or -1, u, v).
fn test_for(primitive: &Primitive, t_max: &str) -> String {
    let points = [primitive.p0, primitive.p1, primitive.p2].map(Vec3::from);
    if primitive.is(PrimitiveKind::Quad) {
        return test_for_quad(points, t_max);
    }
    let [p0, p1, p2] = points.map(vector);
    let shape = PrimitiveKind::of(primitive.kind()).map_or("", PrimitiveKind::file);
    format!("intersect_{shape}(ray, {t_max}, {p0}, {p1}, {p2})")
}

/// With the plane's numbers folded in.
fn test_for_quad([corner, edge_u, edge_v]: [Vec3; 3], t_max: &str) -> String {
    let (edge_u, edge_v) = (edge_u.as_dvec3(), edge_v.as_dvec3());
    let normal = edge_u.cross(edge_v);
    let squared = normal.length_squared();
    let numbers = [normal / squared.sqrt(), edge_v.cross(normal) / squared, normal.cross(edge_u) / squared];
    let [unit, dual_u, dual_v] = numbers.map(|numbers| vector(numbers.as_vec3()));
    format!("intersect_quad_constant(ray, {t_max}, {}, {unit}, {dual_u}, {dual_v})", vector(corner))
}

fn vector(v: Vec3) -> String {
    format!("vec3<f32>({}, {}, {})", literal(v.x), literal(v.y), literal(v.z))
}

/// The shortest decimal that reads back as the same f32.
fn literal(x: f32) -> String {
    format!("{x:?}f")
}
