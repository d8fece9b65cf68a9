// A point of a shape, as its own file finds it.

struct ShapePoint {
    position: vec3<f32>,
    // Unit normal on the front side.
    normal: vec3<f32>,
    // Tangents along two edges, where texture coordinates come from them.
    uv: vec2<f32>,
    // Directions in which those grow.
    along_u: vec3<f32>,
    along_v: vec3<f32>,
    // The sum of the magnitudes that rounding of the position is relative to.
    size: vec3<f32>,
    // How far along the normal the true surface can lie from the position on top of that.
    error: f32,
    // Area of the shape; 0 where points of it are not drawn by area.
    area: f32,
}

// Directions in which u and v grow, of any length; 0 where there are none.
struct Tangents {
    along_u: vec3<f32>,
    along_v: vec3<f32>,
}

fn no_shape_point() -> ShapePoint {
    var point: ShapePoint;
    return point;
}

// Point of a flat shape with two edges. The point is found from the corners, not along the ray, so that its
// error does not grow with the distance travelled.
fn flat_point(corner: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>, uv: vec2<f32>, share: f32, error: f32) -> ShapePoint {
    let perpendicular = cross(edge_u, edge_v);
    let parallelogram = length(perpendicular);
    return ShapePoint(
        corner + uv.x * edge_u + uv.y * edge_v, perpendicular / parallelogram, uv, edge_u, edge_v,
        abs(corner) + abs(edge_u) + abs(edge_v), error, share * parallelogram
    );
}

// A point drawn on a flat light that begins at `corner`.
fn drawn_flat_point(corner: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>, uv: vec2<f32>, error: f32) -> ShapePoint {
    return ShapePoint(
        corner + uv.x * edge_u + uv.y * edge_v, normalize(cross(edge_u, edge_v)), uv, edge_u, edge_v,
        abs(corner) + abs(edge_u) + abs(edge_v), error, 0.0
    );
}

// From a density by area to one by solid angle, seen along `direction` from the distance `t`.
fn area_pdf_by_solid_angle(t: f32, direction: vec3<f32>, normal: vec3<f32>, area: f32) -> f32 {
    return select(0.0, t * t / (abs(dot(direction, normal)) * area), t > 0.0);
}
