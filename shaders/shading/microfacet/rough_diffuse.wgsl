// The common part of lobes that scatter broadly and whose directions are drawn as Lambert's are.
#import core/math.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

// Two directions above a surface.
struct Directions {
    // They are on wo's side.
    reflects: bool,
    // Their cosines with the normal.
    cos_o: f32,
    cos_i: f32,
    // sin θo · sin θi · cos Δφ, Δφ the angle between them around the normal.
    side_by_side: f32,
}

fn directions_above(surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> Directions {
    let cos_o = dot(wo, surface.shading_normal);
    let cos_i = dot(wi, surface.shading_normal);
    return Directions(on_wo_side(surface, wi) && cos_o > 0.0, cos_o, cos_i, dot(wo, wi) - cos_o * cos_i);
}

// sin θo · cos Δφ · tan θi where wi is the steeper one, and with both exchanged where wo is.
fn sine_times_tangent(directions: Directions) -> f32 {
    return directions.side_by_side / max(directions.cos_o, directions.cos_i);
}

fn sine_of_cosine(cosine: f32) -> f32 {
    return sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0));
}

// f·cos θi with the density of Lambert's directions.
fn rough_diffuse_value(directions: Directions, f: Spectrum) -> BsdfValue {
    return BsdfValue(f * directions.cos_i, hemisphere_pdf(directions.cos_i));
}
