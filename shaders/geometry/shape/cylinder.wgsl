// A ray against the wall of a cylinder: (t or -1, 0, height between the ends). The points of its record are one end, the axis to the other,
// and a radius from the axis to where u is 0.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/motion.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/shape_point.wgsl

// Crossings of a ray's line with the infinite cylinder: t and height of the nearer and of the farther; `met`
// where there are any.
struct CylinderCrossings {
    met: bool,
    near: vec2<f32>,
    far: vec2<f32>,
}

// Across the axis the wall is a circle. Roots are taken relative to the point of closest approach, and the one that would cancel is found
// from the product of both, as a sphere's.
fn cylinder_crossings(ray: PreparedRay, start: vec3<f32>, axis: vec3<f32>, radial: vec3<f32>) -> CylinderCrossings {
    let per_height = axis / dot(axis, axis);
    let to_start = start - ray.origin;
    let rise = dot(per_height, ray.direction);
    let below = dot(per_height, to_start);
    let direction = ray.direction - rise * axis;
    let to_axis = to_start - below * axis;
    let slope2 = dot(direction, direction);
    let radius2 = dot(radial, radial);
    let nothing = vec2<f32>(-1.0);
    if slope2 == 0.0 {
        return CylinderCrossings(false, nothing, nothing);
    }
    let along = dot(to_axis, direction) / slope2;
    let across = to_axis - along * direction;
    let discriminant = (radius2 - dot(across, across)) / slope2;
    if discriminant < 0.0 {
        return CylinderCrossings(false, nothing, nothing);
    }
    let half_chord = sqrt(discriminant);
    let outside = (dot(to_axis, to_axis) - radius2) / slope2;
    let far_root = along + select(-half_chord, half_chord, along >= 0.0);
    let other_root = select(0.0, outside / far_root, far_root != 0.0);
    let near = min(far_root, other_root);
    let far = max(far_root, other_root);
    return CylinderCrossings(true, vec2<f32>(near, near * rise - below), vec2<f32>(far, far * rise - below));
}

// True where a crossing lies ahead and between the ends, which overlap their neighbours as a quad's edges do.
fn is_on_cylinder(crossing: vec2<f32>) -> bool {
    return crossing.x > 0.0 && crossing.y >= -QUAD_OVERLAP && crossing.y <= 1.0 + QUAD_OVERLAP;
}

fn intersect_cylinder(ray: PreparedRay, t_max: f32, start: vec3<f32>, axis: vec3<f32>, radial: vec3<f32>) -> vec3<f32> {
    let crossings = cylinder_crossings(ray, start, axis, radial);
    let crossing = select(crossings.far, crossings.near, is_on_cylinder(crossings.near));
    let met = crossings.met && is_on_cylinder(crossing) && crossing.x < t_max;
    return vec3<f32>(select(-1.0, crossing.x, met), 0.0, crossing.y);
}

// The crossing behind the one that intersect_cylinder finds.
fn intersect_cylinder_again(ray: PreparedRay, t_max: f32, start: vec3<f32>, axis: vec3<f32>, radial: vec3<f32>) -> vec3<f32> {
    let crossings = cylinder_crossings(ray, start, axis, radial);
    let both = crossings.met && is_on_cylinder(crossings.near) && is_on_cylinder(crossings.far);
    return vec3<f32>(select(-1.0, crossings.far.x, both && crossings.far.x < t_max), 0.0, crossings.far.y);
}

fn move_cylinder(motion: Motion, start: vec3<f32>, axis: vec3<f32>, radial: vec3<f32>) -> MovedPoints {
    let size = abs(start) + abs(axis) + length(radial);
    return MovedPoints(moved_point(motion, start), motion.linear * axis, motion.linear * radial, size);
}

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
