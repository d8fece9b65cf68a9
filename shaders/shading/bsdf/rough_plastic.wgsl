// Plastic with a rough surface: a boundary of microfacets over a diffuse base, which gets the light that the
// whole surface lets through.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/scene.wgsl
#import shading/microfacet/fresnel.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/material/lobe.wgsl
#import shading/material/parameters.wgsl
#import shading/microfacet/microfacet.wgsl
#import shading/microfacet/plastic.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn rough_plastic_is_non_delta(lobe: Lobe) -> bool {
    return true;
}

fn rough_plastic_sampling_weight(lobe: Lobe) -> f32 {
    return plastic_weight(lobe);
}

// An entry of the lobe's table, the transmittance of its surface. Three stand in a word.
fn transmittance_node(lobe: Lobe, node: u32) -> f32 {
    let word = tables[lobe.table_word + node / 3u];
    let place = node % 3u;
    return select(select(word.x, word.y, place == 1u), word.z, place == 2u);
}

// The transmittance of the surface: linear between the entries, which are for cosines from 0 to 1 in even
// steps.
fn plastic_transmittance(lobe: Lobe, cosine: f32) -> f32 {
    let place = clamp(cosine, 0.0, 1.0) * f32(TRANSMITTANCE_NODES - 1u);
    let below = min(u32(place), TRANSMITTANCE_NODES - 2u);
    return mix(transmittance_node(lobe, below), transmittance_node(lobe, below + 1u), place - f32(below));
}

fn evaluate_rough_plastic(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    if !on_wo_side(surface, wi) {
        return no_value();
    }
    let facets = isotropic_facets(lobe);
    let frame = frame_from_normal(surface.shading_normal);
    let o = to_local(frame, wo);
    let i = to_local(frame, wi);
    let m = normalize(o + i);
    let lambda_o = facet_lambda(facets, o);
    let common_factor = facet_distribution(facets, m) / (4.0 * o.z);
    let reflected = fresnel_dielectric(clamp(dot(o, m), 0.0, 1.0), lobe.ior).reflected;
    let specular = lobe.color1 * (reflected * common_factor * facet_shadowing(facets, lambda_o, facet_lambda(facets, i)));
    let transmitted = plastic_transmittance(lobe, o.z);
    let internal_reflectance = rough_plastic_parameters(lobe).internal_reflectance;
    let diffuse = plastic_base(lobe, internal_reflectance, transmitted, plastic_transmittance(lobe, i.z)) * i.z;
    let share = plastic_specular_share(lobe, 1.0 - transmitted);
    return BsdfValue(specular + diffuse, mix(hemisphere_pdf(i.z), common_factor / (1.0 + lambda_o), share));
}

fn sample_rough_plastic(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let frame = frame_from_normal(surface.shading_normal);
    let o = to_local(frame, wo);
    var wi = vec3<f32>(0.0);
    if choice < plastic_specular_share(lobe, 1.0 - plastic_transmittance(lobe, o.z)) {
        let m = sample_visible_normal(isotropic_facets(lobe), o, u, v);
        wi = frame_to_world(frame, 2.0 * dot(o, m) * m - o);
    } else {
        wi = sample_hemisphere(surface, u, v).xyz;
    }
    return from_value(wi, evaluate_rough_plastic(lobe, surface, wo, wi), 1.0);
}
