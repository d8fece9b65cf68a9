// The modified Phong model: a diffuse lobe and a cosine-power lobe about the mirror direction.
#import core/math.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/microfacet/phong_lobe.wgsl
#import shading/material/lobe.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn phong_is_non_delta(lobe: Lobe) -> bool {
    return max_component(lobe.color0 + lobe.color1) > 0.0;
}

fn phong_sampling_weight(lobe: Lobe) -> f32 {
    return max_component(lobe.color0 + lobe.color1);
}

fn phong_specular_share(lobe: Lobe) -> f32 {
    let specular = lobe.color1.x + lobe.color1.y + lobe.color1.z;
    return specular / max(lobe.color0.x + lobe.color0.y + lobe.color0.z + specular, 1.0e-30);
}

fn evaluate_phong(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    if !on_wo_side(surface, wi) {
        return no_value();
    }
    let cosine = dot(wi, surface.shading_normal);
    let specular = phong_lobe(surface, wo, lobe.roughness, wi);
    let share = phong_specular_share(lobe);
    return BsdfValue(
        lobe.color0 * (INVERSE_PI * cosine) + lobe.color1 * specular.value,
        mix(hemisphere_pdf(cosine), specular.pdf, share)
    );
}

fn sample_phong(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    var wi = vec3<f32>(0.0);
    if choice < phong_specular_share(lobe) {
        wi = sample_phong_lobe(surface, wo, lobe.roughness, u, v);
    } else {
        wi = sample_hemisphere(surface, u, v).xyz;
    }
    return from_value(wi, evaluate_phong(lobe, surface, wo, wi), 1.0);
}
