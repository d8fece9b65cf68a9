// What a hit is: position, normals, texture coordinates, material.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/records.wgsl
#import geometry/scene.wgsl
#if MOTION
#import geometry/motion.wgsl
#endif
#if NORMAL_MAPS
#import shading/normal_map.wgsl
#endif

struct Surface {
    position: vec3<f32>,
    // The geometric normal on wo's side.
    facing_normal: vec3<f32>,
    // The shading normal on wo's side.
    shading_normal: vec3<f32>,
    uv: vec2<f32>,
    // wo is on the side where the normal points.
    front: bool,
    // How far along its normal the true surface can lie from `position`.
    error: f32,
    material: u32,
    // Index of the light that this primitive is, or NONE.
    light: u32,
    // For densities of light sampling: area, or 0 for a sphere; center and radius of a sphere.
    area: f32,
    sphere: vec4<f32>,
}

#if ATTRIBUTES
struct Attribute {
    // As long as interpolation leaves it; 0 where there is none.
    normal: vec3<f32>,
    uv: vec2<f32>,
}

fn interpolate_attributes(first: u32, weights: vec2<f32>) -> Attribute {
    let words = attribute_words(first);
    let a0 = words.w0;
    let a1 = words.w1;
    let a2 = words.w2;
    let a3 = words.w3;
    let w = 1.0 - weights.x - weights.y;
#if MOTION
    var normals = array<vec3<f32>, 3>(a0.xyz, a1.xyz, a2.xyz);
    let moving = bitcast<u32>(a3.w);
    if moving != NONE {
        let motion = motion_at_path_time(moving);
        for (var corner = 0u; corner < 3u; corner++) {
            normals[corner] = moved_unit_normal(motion, normals[corner]);
        }
    }
    return Attribute(
        w * normals[0] + weights.x * normals[1] + weights.y * normals[2],
        w * vec2<f32>(a0.w, a1.w) + weights.x * vec2<f32>(a2.w, a3.x) + weights.y * a3.yz
    );
#else
    return Attribute(
        w * a0.xyz + weights.x * a1.xyz + weights.y * a2.xyz,
        w * vec2<f32>(a0.w, a1.w) + weights.x * vec2<f32>(a2.w, a3.x) + weights.y * a3.yz
    );
#endif
}
#endif

// An interpolated or mapped normal on wo's side; the facing normal where there is none or wo is below its horizon.
fn shading_normal_towards(interpolated: vec3<f32>, facing_normal: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    if dot(interpolated, interpolated) == 0.0 {
        return facing_normal;
    }
    let unit = normalize(interpolated);
    let shading_normal = select(-unit, unit, dot(unit, facing_normal) > 0.0);
    return select(facing_normal, shading_normal, dot(shading_normal, wo) > 0.0);
}

// What a triangle's width adds to the error of its points: a ray that starts in its plane finds it again at a distance of rounding size,
// and that grows with the triangle. A wide floor at height 0 has no other error to keep rays off it.
fn triangle_error(edge_u: vec3<f32>, edge_v: vec3<f32>) -> f32 {
    return 0.125 * POINT_ERROR * max_component(abs(edge_u) + abs(edge_v));
}

fn hit_surface(ray: Ray, hit: Hit) -> Surface {
#if MOTION
    let placed = placed_primitive(primitive_words(hit.primitive));
    let p0 = placed.p0;
    let p1 = placed.p1;
    let p2 = placed.p2;
#else
    let words = primitive_words(hit.primitive);
    let p0 = words.w0;
    let p1 = words.w1;
    let p2 = words.w2;
#endif
    let kind = primitive_kind(p0.w);
    let wo = -ray.direction;

    // Quads and triangles alike: the point is found from the corners, not along the ray, so that its error does not grow with the
    // distance travelled.
    let edge_u = select(p1.xyz - p0.xyz, p1.xyz, kind == KIND_QUAD);
    let edge_v = select(p2.xyz - p0.xyz, p2.xyz, kind == KIND_QUAD);
    let perpendicular = cross(edge_u, edge_v);
    let twice_area = length(perpendicular);
    var normal = perpendicular / twice_area;
    var position = p0.xyz + hit.u * edge_u + hit.v * edge_v;
    var size = abs(p0.xyz) + abs(edge_u) + abs(edge_v);
    var area = select(0.5 * twice_area, twice_area, kind == KIND_QUAD);
    var sphere = vec4<f32>(0.0);
    var uv = vec2<f32>(hit.u, hit.v);

#if SPHERES
    if kind == KIND_SPHERE {
        normal = normalize(ray.origin + hit.t * ray.direction - p0.xyz);
        position = p0.xyz + p1.x * normal;
        size = abs(p0.xyz) + p1.x;
        area = 0.0;
        sphere = vec4<f32>(p0.xyz, p1.x);
#if ATTRIBUTES
        let attributes_of_sphere = bitcast<u32>(p2.w);
        if attributes_of_sphere != NONE {
            uv = sphere_uv(attributes_of_sphere, normal);
        }
#endif
    }
#endif
#if FLAT_ROUND
    // Disks and planes: the point along the ray is put back onto the plane.
    if kind == KIND_DISK || kind == KIND_PLANE {
        normal = p1.xyz;
        let along = ray.origin + hit.t * ray.direction;
        position = along + normal * dot(normal, p0.xyz - along);
        size = abs(p0.xyz) + abs(position);
        area = PI * p2.x * p2.x;
    }
#endif

    let front = dot(wo, normal) > 0.0;
    let facing_normal = select(-normal, normal, front);
    // 0: the geometric normal.
    var own_normal = vec3<f32>(0.0);
#if ATTRIBUTES
    let first = bitcast<u32>(p2.w);
    if first != NONE && kind != KIND_SPHERE {
        let interpolated = interpolate_attributes(first, uv);
        uv = interpolated.uv;
        own_normal = interpolated.normal;
    }
#endif
#if NORMAL_MAPS
    own_normal = mapped_normal(
        primitive_material(p0.w), kind, bitcast<u32>(p2.w), own_normal, normal, uv, edge_u, edge_v
    );
#endif
    let shading_normal = shading_normal_towards(own_normal, facing_normal, wo);
#if MOTION
    size += placed.magnitude;
#endif
    var error = POINT_ERROR * dot(abs(facing_normal), size);
    if kind == KIND_TRIANGLE {
        error += triangle_error(edge_u, edge_v);
    }
    return Surface(
        position, facing_normal, shading_normal, uv, front, error,
        primitive_material(p0.w), bitcast<u32>(p1.w), area, sphere
    );
}

#if SPHERES
#if ATTRIBUTES
// u = atan2(x, -z) / 2π (mod 1), v = acos(-y) / π of the direction from the centre in the sphere's own space: the attributes' first
// three vec4 hold the rows of the rotation into it.
fn sphere_uv(first: u32, normal_now: vec3<f32>) -> vec2<f32> {
    var normal = normal_now;
#if MOTION
    let moving = motion_of_attributes(first);
    if moving != NONE {
        // The transpose of a rotation, up to a factor, takes it back.
        normal = normal * motion_at_path_time(moving).linear;
    }
#endif
    let words = attribute_words(first);
    let direction = vec3<f32>(dot(words.w0.xyz, normal), dot(words.w1.xyz, normal), dot(words.w2.xyz, normal));
    let turns = atan2_turns(direction.x, -direction.z);
    return vec2<f32>(select(turns, turns + 1.0, turns < 0.0), 2.0 * atan2_turns(length(direction.xz), -direction.y));
}
#endif
#endif

// The surface point moved off the surface to the side of `toward`, past its error.
fn offset_origin(surface: Surface, toward: vec3<f32>) -> vec3<f32> {
    let side = select(-surface.error, surface.error, dot(toward, surface.facing_normal) > 0.0);
    return surface.position + side * surface.facing_normal;
}
