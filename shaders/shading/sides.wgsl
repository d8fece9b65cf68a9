// Sides of a surface on which directions lie.
#import shading/surface.wgsl

fn on_wo_side(surface: Surface, wi: vec3<f32>) -> bool {
    return dot(wi, surface.shading_normal) > 0.0 && dot(wi, surface.facing_normal) > 0.0;
}

fn on_far_side(surface: Surface, wi: vec3<f32>) -> bool {
    return dot(wi, surface.shading_normal) < 0.0 && dot(wi, surface.facing_normal) < 0.0;
}

fn mirrored(surface: Surface, wo: vec3<f32>) -> vec3<f32> {
    return 2.0 * dot(wo, surface.shading_normal) * surface.shading_normal - wo;
}
