// Points of cylinders.
#import core/math.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/shape/cylinder.wgsl
#import shading/shape_point.wgsl

// The point at a height between the ends, in a direction of length 1 from the axis. u is 0 along `radial`, and grows towards radial x axis.
fn point_of_cylinder(start: vec3<f32>, axis: vec3<f32>, radial: vec3<f32>, normal: vec3<f32>, height: f32) -> ShapePoint {
    let radius = length(radial);
    let quarter = cross(radial, axis) / length(axis);
    let turns = atan2_turns(dot(normal, quarter), dot(normal, radial));
    let uv = vec2<f32>(select(turns, turns + 1.0, turns < 0.0), height);
    let area = TWO_PI * radius * length(axis);
    let size = abs(start) + abs(axis) + radius;
    return ShapePoint(start + height * axis + radius * normal, normal, uv, cross(normal, axis), axis, size, 0.0, area);
}

fn cylinder_point(ray: Ray, hit: Hit, start: vec3<f32>, axis: vec3<f32>, radial: vec3<f32>) -> ShapePoint {
    let place = ray.origin + hit.t * ray.direction - start;
    let across = place - dot(place, axis) / dot(axis, axis) * axis;
    return point_of_cylinder(start, axis, radial, normalize(across), hit.v);
}

fn sample_cylinder(start: vec3<f32>, axis: vec3<f32>, radial: vec3<f32>, u: f32, v: f32) -> ShapePoint {
    let circle = sin_cos_turns(u);
    let quarter = cross(radial, axis) / length(axis);
    return point_of_cylinder(start, axis, radial, normalize(circle.y * radial + circle.x * quarter), v);
}

// Both crossings of a ray are drawn.
fn cylinder_direction_pdf(ray: PreparedRay, start: vec4<f32>, axis: vec3<f32>, radial: vec3<f32>) -> f32 {
    let crossings = cylinder_crossings(ray, start.xyz, axis, radial);
    var pdf = 0.0;
    for (var index = 0u; index < 2u; index++) {
        let crossing = select(crossings.near, crossings.far, index == 1u);
        if crossings.met && is_on_cylinder(crossing) {
            let place = ray.origin + crossing.x * ray.direction - start.xyz;
            let normal = normalize(place - dot(place, axis) / dot(axis, axis) * axis);
            pdf += area_pdf_by_solid_angle(crossing.x, ray.direction, normal, start.w);
        }
    }
    return pdf;
}
