// The material of glTF 2.0's Appendix B: its layers, with one index of refraction or one for each channel; src/reference/bsdf/principled.rs says how
// channels share paths.
#import core/layout.wgsl
#import core/math.wgsl
#if PRINCIPLED_DISPERSION
#import shading/material/channels.wgsl
#endif
#import shading/material/lobe.wgsl
#import shading/material/parameters.wgsl
#import shading/material/scattering.wgsl
#import shading/microfacet/microfacet.wgsl
#import shading/microfacet/principled_layers.wgsl
#import shading/surface.wgsl

fn principled_is_non_delta(lobe: Lobe) -> bool {
    let p = principled_of(lobe, true);
    var strongest = max_component(p.base);
    if HAS_PRINCIPLED_DIFFUSE_TRANSMISSION {
        strongest = max_component(max(p.base * (1.0 - p.diffuse_transmission), p.diffuse_transmission_color * p.diffuse_transmission));
    }
    let diffuse = (1.0 - p.metallic) * (1.0 - p.transmission) * strongest;
    if HAS_SHEEN && max_component(p.sheen.color) > 0.0 {
        return true;
    }
    return !facets_are_smooth(p.facets) || diffuse > 0.0 || (p.coat.strength > 0.0 && !facets_are_smooth(p.coat.facets));
}

fn principled_sampling_weight(lobe: Lobe) -> f32 {
    var p = principled_of(lobe, true);
    p.eta = 1.0;
    let split = principled_split(p, 1.0);
    let coat = COAT_REFLECTANCE * p.coat.strength;
    var base = p.base;
    if HAS_PRINCIPLED_DIFFUSE_TRANSMISSION {
        base = mix(p.base, p.diffuse_transmission_color, (1.0 - p.transmission) * p.diffuse_transmission);
    }
    let weight = coat + (1.0 - coat) * max_component(split.reflected + base * split.passed);
    return select(weight, weight + SHEEN_WEIGHT * max_component(p.sheen.color), HAS_SHEEN);
}

// The share of reflection by the diffuse layer in the sampling weight, about: that of samples which go in all directions above the surface.
fn principled_broad_share(lobe: Lobe) -> f32 {
    let p = principled_of(lobe, true);
    var share = (1.0 - p.metallic) * (1.0 - p.transmission);
    if HAS_PRINCIPLED_DIFFUSE_TRANSMISSION {
        share *= 1.0 - p.diffuse_transmission;
    }
    let weight = principled_sampling_weight(lobe);
    return select(0.0, min(share * max_component(p.base) / weight, 1.0), weight > 0.0);
}

fn evaluate_principled(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
#if PRINCIPLED_DISPERSION
    if (lobe.kind & DISPERSED) != 0u {
        return evaluate_dispersed(lobe, surface, wo, wi);
    }
#endif
    let p = principled_at(lobe, surface, wo);
    return principled_value(lobe, p, principled_shares(p, surface, wo), surface, wo, wi);
}

fn sample_principled(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
#if PRINCIPLED_DISPERSION
    if (lobe.kind & DISPERSED) != 0u {
        return sample_dispersed(lobe, surface, wo, choice, u, v);
    }
#endif
    let p = principled_at(lobe, surface, wo);
    let shares = principled_shares(p, surface, wo);
    let drawn = draw_principled(lobe, p, shares, surface, wo, choice, u, v);
    if !drawn.is_possible {
        return no_sample();
    }
    if principled_is_smooth(p, drawn.way) {
        let light = principled_of_smooth(p, shares, surface, wo, drawn);
        return principled_sample(p, drawn, light.value, light.probability);
    }
    let value = principled_value(lobe, p, shares, surface, wo, drawn.wi);
    return from_value(drawn.wi, value, principled_eta_scale(p, drawn));
}

#if PRINCIPLED_DISPERSION
// The lobe as if all channels had the index of refraction of one.
fn lobe_of_channel(lobe: Lobe, channel: u32) -> Lobe {
    var of_channel = lobe;
    of_channel.ior = principled_parameters(lobe).iors[channel];
    return of_channel;
}

fn evaluate_dispersed(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let carried = carried_shares(surface);
    var sum = no_value();
    for (var channel = 0u; channel < 3u; channel++) {
        let p = principled_at(lobe_of_channel(lobe, channel), surface, wo);
        let one = principled_value(lobe, p, principled_shares(p, surface, wo), surface, wo, wi);
        sum.value[channel] = one.value[channel];
        sum.pdf_solid_angle += carried[channel] * one.pdf_solid_angle;
    }
    return sum;
}

fn sample_dispersed(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let carried = carried_shares(surface);
    let chosen = choose_channel(carried, choice);
    let p = principled_at(lobe_of_channel(lobe, chosen.channel), surface, wo);
    let drawn = draw_principled(lobe, p, principled_shares(p, surface, wo), surface, wo, chosen.left, u, v);
    if !drawn.is_possible {
        return no_sample();
    }
    if !principled_is_smooth(p, drawn.way) {
        return from_value(drawn.wi, evaluate_dispersed(lobe, surface, wo, drawn.wi), principled_eta_scale(p, drawn));
    }
    var value = BLACK;
    var probability = 0.0;
    for (var channel = 0u; channel < 3u; channel++) {
        let other = principled_at(lobe_of_channel(lobe, channel), surface, wo);
        // Channels that are refracted otherwise come from elsewhere.
        if drawn.way != PRINCIPLED_TRANSMITTED || other.eta == p.eta {
            let light = principled_of_smooth(other, principled_shares(other, surface, wo), surface, wo, drawn);
            value[channel] = light.value[channel];
            probability += carried[channel] * light.probability;
        }
    }
    return principled_sample(p, drawn, value, probability);
}
#endif
