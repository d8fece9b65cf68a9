// Portals: shapes that directions to the environment are drawn through. Rays do not meet them.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/prepared_ray.wgsl
#import shading/light/choice.wgsl
#import shading/light/record.wgsl
#import shading/shapes.wgsl
#import shading/light/sphere_light.wgsl

// A direction to a portal: to a point uniform over it, or to a sphere by its cone.
fn sample_portal(light: u32, reference: vec3<f32>, u: f32, v: f32) -> vec3<f32> {
    let l1 = light_word(light, 1u);
    let kind = bitcast<u32>(light_word(light, 0u).x) >> PORTAL_SHIFT;
    if HAS_SPHERE_LIGHTS && kind == KIND_SPHERE {
        return sphere_cone_sample(reference, l1.xyz, l1.w, WHITE, true, 1.0, u, v).wi;
    }
    let to_point = sample_shape(kind, l1.xyz, light_word(light, 2u).xyz, light_word(light, 3u).xyz, u, v).position - reference;
    return to_point / max(length(to_point), 1.0e-30);
}

// Density with which sample_portal draws the ray's direction from its origin; 0 where the ray does not meet the portal.
fn portal_pdf(light: u32, ray: PreparedRay) -> f32 {
    let kind = bitcast<u32>(light_word(light, 0u).x) >> PORTAL_SHIFT;
    return shape_direction_pdf(kind, ray, light_word(light, 1u), light_word(light, 2u).xyz, light_word(light, 3u).xyz);
}

// Density with which all portals together draw the ray's direction, the choice of one included.
fn portals_pdf(ray: Ray, context: LightContext) -> f32 {
    let prepared = prepare_ray(ray);
    var sum = 0.0;
    for (var light = FIRST_PORTAL; light < FIRST_PORTAL + PORTAL_COUNT; light++) {
        sum += distant_light_pmf(context, light) * portal_pdf(light, prepared);
    }
    return sum;
}
