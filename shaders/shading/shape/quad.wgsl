// Points of parallelograms.
#import core/math.wgsl
#import geometry/shape/quad.wgsl
#import geometry/prepared_ray.wgsl
#import shading/shape_point.wgsl

fn quad_point(ray: Ray, hit: Hit, corner: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>) -> ShapePoint {
    return flat_point(corner, edge_u, edge_v, vec2<f32>(hit.u, hit.v), 1.0, 0.0);
}

fn sample_quad(corner: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>, u: f32, v: f32) -> ShapePoint {
    return drawn_flat_point(corner, edge_u, edge_v, vec2<f32>(u, v), 0.0);
}

fn quad_direction_pdf(ray: PreparedRay, corner: vec4<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>) -> f32 {
    let t = intersect_quad(ray, INFINITY_DISTANCE, corner.xyz, edge_u, edge_v).x;
    return area_pdf_by_solid_angle(t, ray.direction, normalize(cross(edge_u, edge_v)), corner.w);
}
