// Portals: shapes that directions to the environment are drawn through. Rays do not meet them.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/primitives.wgsl
#import shading/light_record.wgsl
#import shading/sphere_light.wgsl

// A direction to a portal: to a point uniform over it, or to a sphere by its cone.
fn sample_portal(light: u32, reference: vec3<f32>, u: f32, v: f32) -> vec3<f32> {
    let l1 = light_word(light, 1u);
    let kind = bitcast<u32>(light_word(light, 0u).x) >> PORTAL_SHIFT;
    if kind == KIND_SPHERE {
        return sphere_cone_sample(reference, l1.xyz, l1.w, vec3<f32>(1.0), true, 1.0, u, v).wi;
    }
    var ab = vec2<f32>(u, v);
    if kind == KIND_TRIANGLE {
        let root = sqrt(u);
        ab = vec2<f32>(1.0 - root, v * root);
    }
    if kind == KIND_DISK {
        ab = sqrt(u) * sin_cos_turns(v).yx;
    }
    let to_point = l1.xyz + ab.x * light_word(light, 2u).xyz + ab.y * light_word(light, 3u).xyz - reference;
    return to_point / max(length(to_point), 1.0e-30);
}

// Density with which sample_portal draws the ray's direction from its origin; 0 where the ray does not meet the portal.
fn portal_pdf(light: u32, ray: PreparedRay) -> f32 {
    let l1 = light_word(light, 1u);
    let kind = bitcast<u32>(light_word(light, 0u).x) >> PORTAL_SHIFT;
    if kind == KIND_SPHERE {
        let met = intersect_sphere(ray, INFINITY_DISTANCE, l1.xyz, l1.w) > 0.0;
        return select(0.0, sphere_cone_pdf(ray.origin, l1.xyz, l1.w), met);
    }
    let edge_u = light_word(light, 2u).xyz;
    let edge_v = light_word(light, 3u).xyz;
    let normal = normalize(cross(edge_u, edge_v));
    var t = -1.0;
    if kind == KIND_TRIANGLE {
        t = intersect_triangle(ray, INFINITY_DISTANCE, l1.xyz, l1.xyz + edge_u, l1.xyz + edge_v).x;
    }
    if kind == KIND_QUAD {
        t = intersect_quad(ray, INFINITY_DISTANCE, l1.xyz, edge_u, edge_v).x;
    }
    if kind == KIND_DISK {
        t = intersect_disk(ray, INFINITY_DISTANCE, l1.xyz, normal, length(edge_u));
    }
    return select(0.0, t * t / (abs(dot(ray.direction, normal)) * l1.w), t > 0.0);
}

// All portals together, the choice of one included.
fn portals_pdf(ray: Ray) -> f32 {
    let prepared = prepare_ray(ray);
    var sum = 0.0;
    for (var light = FIRST_PORTAL; light < FIRST_PORTAL + PORTAL_COUNT; light++) {
        sum += light_word(light, 0u).w * portal_pdf(light, prepared);
    }
    return sum;
}
