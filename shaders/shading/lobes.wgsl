// What one leaf does, by its kind.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/diffuse.wgsl
#import shading/leaf.wgsl
#import shading/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl
#if COSINE_POWER
#import shading/cosine_power.wgsl
#endif
#if CONDUCTOR
#import shading/fresnel.wgsl
#endif
#if GLASS
#import shading/glass.wgsl
#endif
#if PHONG_GLASS
#import shading/fresnel.wgsl
#import shading/glass.wgsl
#endif
#if MICROFACETS
#import shading/microfacet.wgsl
#endif

// Whether it has a lobe that is not a delta, and not black.
fn leaf_is_non_delta(leaf: Leaf) -> bool {
    switch leaf_kind(leaf) {
        case DIFFUSE: { return max_component(leaf.first) > 0.0; }
#if GLOSSY
        case GLOSSY: { return true; }
#endif
#if PHONG
        case PHONG: { return max_component(leaf.first + leaf.second) > 0.0; }
#endif
#if PHONG_GLASS
        case PHONG_GLASS: { return true; }
#endif
#if MICROFACETS
        case CONDUCTOR, ROUGH_GLASS: { return leaf.scalar >= DELTA_ALPHA; }
#endif
        default: { return false; }
    }
}

// How much of the incoming light a leaf sends on, roughly: what its share of a mixture's samples goes by.
fn leaf_sampling_weight(leaf: Leaf) -> f32 {
    switch leaf_kind(leaf) {
        case EMISSIVE: { return 0.0; }
        case NULL_SURFACE: { return 1.0; }
        case GLASS, ROUGH_GLASS, PHONG_GLASS: { return max(max_component(leaf.first), max_component(leaf.second)); }
        case PHONG: { return max_component(leaf.first + leaf.second); }
#if CONDUCTOR
        case CONDUCTOR: { return max_component(conductor_fresnel(leaf.kind, leaf.first, leaf.second, 1.0)); }
#endif
        default: { return max_component(leaf.first); }
    }
}

// f |cos| and density of a leaf; 0 for delta lobes.
fn evaluate_leaf(leaf: Leaf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    switch leaf_kind(leaf) {
        case DIFFUSE: { return evaluate_diffuse(leaf.first, surface, wi); }
#if GLOSSY
        case GLOSSY: { return evaluate_glossy(leaf, surface, wo, wi); }
#endif
#if PHONG
        case PHONG: { return evaluate_phong(leaf, surface, wo, wi); }
#endif
#if PHONG_GLASS
        case PHONG_GLASS: { return evaluate_phong_glass(leaf, surface, wo, wi); }
#endif
#if CONDUCTOR
        case CONDUCTOR: { return evaluate_conductor(leaf, surface, wo, wi); }
#endif
#if ROUGH_GLASS
        case ROUGH_GLASS: { return evaluate_rough_glass(leaf, surface, wo, wi); }
#endif
        default: { return no_value(); }
    }
}

// Draws a direction. `lobe` chooses between the lobes of one leaf, (u, v) the direction within.
fn sample_leaf(leaf: Leaf, surface: Surface, wo: vec3<f32>, lobe: f32, u: f32, v: f32) -> BsdfSample {
    switch leaf_kind(leaf) {
        case DIFFUSE: { return sample_diffuse(leaf.first, surface, u, v); }
#if MIRROR
        case MIRROR: {
            let wi = mirrored(surface, wo);
            if dot(wi, surface.facing_normal) <= 0.0 {
                return no_sample();
            }
            return BsdfSample(wi, leaf.first, -1.0, 1.0, false);
        }
#endif
#if GLASS
        case GLASS: { return sample_delta_glass(leaf, surface, wo, lobe); }
#endif
#if GLOSSY
        case GLOSSY: {
            let wi = sample_cosine_power(mirrored(surface, wo), leaf.scalar, u, v);
            return from_value(wi, evaluate_glossy(leaf, surface, wo, wi), 1.0);
        }
#endif
#if PHONG
        case PHONG: {
            var wi = vec3<f32>(0.0);
            if lobe < phong_specular_share(leaf) {
                wi = sample_cosine_power(mirrored(surface, wo), leaf.scalar, u, v);
            } else {
                wi = sample_hemisphere(surface, u, v).xyz;
            }
            return from_value(wi, evaluate_phong(leaf, surface, wo, wi), 1.0);
        }
#endif
#if PHONG_GLASS
        case PHONG_GLASS: {
            let eta = relative_ior(leaf, surface);
            let reflected = fresnel_dielectric(min(dot(wo, surface.shading_normal), 1.0), eta);
            let reflects = lobe < reflection_probability(leaf, reflected);
            var axis = mirrored(surface, wo);
            if !reflects {
                axis = refracted(surface.shading_normal, wo, eta);
            }
            let wi = sample_cosine_power(axis, leaf.scalar, u, v);
            // A direction that strays to the other side would be taken for the other lobe's.
            if reflects != (dot(wi, surface.shading_normal) > 0.0) {
                return no_sample();
            }
            return from_value(wi, evaluate_phong_glass(leaf, surface, wo, wi), select(eta * eta, 1.0, reflects));
        }
#endif
#if CONDUCTOR
        case CONDUCTOR: { return sample_conductor(leaf, surface, wo, u, v); }
#endif
#if ROUGH_GLASS
        case ROUGH_GLASS: { return sample_rough_glass(leaf, surface, wo, lobe, u, v); }
#endif
#if NULL_SURFACES
        case NULL_SURFACE: {
            return BsdfSample(-wo, vec3<f32>(1.0), -1.0, 1.0, true);
        }
#endif
        default: { return no_sample(); }
    }
}
