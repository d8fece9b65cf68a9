// The material of glTF 2.0's Appendix B with its extensions; src/reference/bsdf/principled.rs has the model. color0 is the base colour,
// color1 the specular colour; the further parameters are metallic, specular, transmission, clearcoat, its roughness, the anisotropy and its
// rotation, 1 plus its cosine and sine, and where there are more, an extinction, the colour and the roughness of the sheen, and what the coat's
// own normal map has here, its scale above and below 0, and what the map of the anisotropy's directions has.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/microfacet/coat.wgsl
#import shading/microfacet/dielectric.wgsl
#import shading/microfacet/fresnel.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/material/lobe.wgsl
#import shading/microfacet/microfacet.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl
#import shading/microfacet/albedo.wgsl
#import shading/microfacet/sheen.wgsl

struct Principled {
    base: Spectrum,
    // Reflectance of the dielectric at normal incidence.
    normal_incidence: Spectrum,
    metallic: f32,
    specular: f32,
    transmission: f32,
    coat: Coat,
    facets: Facets,
    // Transmitted light goes on as if the wall had no thickness.
    thin: bool,
    // Index of refraction beyond the surface over that on wo's side; 1 where no light comes from within.
    eta: f32,
#if SHEEN
    sheen: Sheen,
#endif
}

struct PrincipledShares {
    below_coat: f32,
    coat: f32,
    reflection: f32,
    diffuse: f32,
    transmission: f32,
}

fn principled_parameter(lobe: Lobe, index: u32) -> vec3<f32> {
#if FURTHER_PARAMETERS
    return further_parameter(lobe, index, vec3<f32>(0.0));
#else
    return vec3<f32>(0.0);
#endif
}

fn principled_of(lobe: Lobe, front: bool) -> Principled {
    var p: Principled;
    p.base = lobe.color0;
    let r = (lobe.ior - 1.0) / (lobe.ior + 1.0);
    p.normal_incidence = min(r * r * lobe.color1, WHITE);
    p.metallic = principled_parameter(lobe, 0u).x;
    p.specular = principled_parameter(lobe, 1u).x;
    p.eta = 1.0;
    p.thin = true;
#if PRINCIPLED_TRANSMISSION
    p.transmission = principled_parameter(lobe, 2u).x;
    p.thin = (lobe.kind & THIN_WALL) != 0u || abs(lobe.ior - 1.0) < SMALLEST_BEND;
    if p.transmission > 0.0 && !p.thin {
        p.eta = select(1.0 / lobe.ior, lobe.ior, front);
    }
#endif
#if SHEEN
    p.sheen = Sheen(principled_parameter(lobe, 8u), max(principled_parameter(lobe, 9u).x, SMALLEST_SHEEN_ROUGHNESS));
#endif
    p.coat = coat_of(lobe, principled_parameter(lobe, 3u).x, principled_parameter(lobe, 4u).x);
    let alpha = lobe.roughness * lobe.roughness;
    p.facets = Facets(alpha, alpha, lobe.kind);
#if ANISOTROPY
    if (lobe.kind & ANISOTROPIC) != 0u {
        let strength = principled_parameter(lobe, 5u).x;
        let along = mix(alpha, 1.0, strength * strength);
        p.facets.alpha = along;
        if along >= DELTA_ALPHA {
            p.facets.alpha_v = max(alpha, DELTA_ALPHA);
        }
    }
#endif
    return p;
}

// The principled lobe on a surface seen from wo.
fn principled_at(lobe: Lobe, surface: Surface, wo: vec3<f32>) -> Principled {
    var p = principled_of(lobe, surface.front);
    p.coat = coat_on(p.coat, lobe, surface, wo);
    return p;
}

fn principled_frame(lobe: Lobe, facets: Facets, surface: Surface) -> Frame {
#if ANISOTROPY
    if (facets.flags & ANISOTROPIC) != 0u {
        let frame = facet_frame(facets, surface);
        var turned = principled_parameter(lobe, 6u).xy - 1.0;
#if ANISOTROPY_DIRECTIONS
        if (facets.flags & DIRECTED) != 0u {
            let direction = principled_parameter(lobe, DIRECTION_PARAMETER).xy * 2.0 - 1.0;
            if dot(direction, direction) > 0.0 {
                let unit = normalize(direction);
                turned = vec2<f32>(turned.x * unit.x - turned.y * unit.y, turned.y * unit.x + turned.x * unit.y);
            }
        }
#endif
        // Towards the side where v grows.
        let side = select(-1.0, 1.0, dot(frame.bitangent, surface.along_v) >= 0.0);
        let tangent = turned.x * frame.tangent + turned.y * side * frame.bitangent;
        return Frame(tangent, cross(frame.normal, tangent), frame.normal);
    }
#endif
    return facet_frame(facets, surface);
}

struct PrincipledSplit {
    reflected: Spectrum,
    // Share that goes on to the dielectric's base.
    passed: f32,
}

// Reflection and transmission of light that meets a facet at an angle of this cosine. Fresnel's angle is the
// one on the side of air.
fn principled_split(p: Principled, cosine: f32) -> PrincipledSplit {
    var outside = cosine;
    if p.eta < 1.0 {
        let cosine2 = transmitted_cosine2(cosine, p.eta);
        if cosine2 <= 0.0 {
            return PrincipledSplit(WHITE, 0.0);
        }
        outside = min(sqrt(cosine2), 1.0);
    }
    let dielectric = p.specular * schlick(outside, p.normal_incidence);
    let reflected = mix(dielectric, schlick(cosine, p.base), p.metallic);
    return PrincipledSplit(reflected, (1.0 - p.metallic) * (1.0 - max_component(dielectric)));
}

#if COMPENSATION
// Compensation for light scattered among microfacets: 1 + F0 (1 - E) / E, E the share of light that white
// ones reflect once.
fn principled_compensation(p: Principled, cosine: f32) -> Spectrum {
    if (p.facets.flags & COMPENSATED) == 0u || p.eta != 1.0 {
        return WHITE;
    }
#if ANISOTROPY
    let alpha = min(p.facets.alpha, p.facets.alpha_v);
#else
    let alpha = p.facets.alpha;
#endif
    let table = select(CORRELATED_ALBEDO_WORD, SEPARABLE_ALBEDO_WORD, (p.facets.flags & SEPARABLE_MASKS) != 0u);
    let once = tabulated_albedo(table, cosine, sqrt(alpha), FACET_KNEE * alpha);
    return 1.0 + mix(p.specular * p.normal_incidence, p.base, p.metallic) * ((1.0 - once) / once);
}
#endif

// Light comes from within what the surface encloses.
fn principled_is_within(p: Principled, surface: Surface) -> bool {
    return !surface.front && p.transmission > 0.0 && !p.thin;
}

#if SHEEN
// Share of light that passes the sheen and reaches the layers below.
fn principled_below_sheen(p: Principled, cosine_o: f32, cosine_i: f32) -> f32 {
    return 1.0 - max(sheen_taken(p.sheen, cosine_o), sheen_taken(p.sheen, cosine_i));
}
#endif

fn principled_shares(p: Principled, surface: Surface, wo: vec3<f32>) -> PrincipledShares {
    let cosine = clamp(dot(wo, surface.shading_normal), 0.0, 1.0);
    // The coat lies on the outside.
    let coat = select(coat_reflectance(p.coat, surface, wo), 0.0, principled_is_within(p, surface));
    let split = principled_split(p, cosine);
    let possible = select(max(p.metallic, (1.0 - p.metallic) * p.specular), 1.0, p.eta < 1.0);
    var reflection = max(max_component(split.reflected), LEAST_REFLECTED * possible);
    let base = max(split.passed, (1.0 - p.metallic) * (1.0 - MOST_REFLECTED)) * max_component(p.base);
    var diffuse = base * (1.0 - p.transmission);
    var transmission = base * p.transmission;
#if SHEEN
    // The fibres stand on the outside, and are sampled as the diffuse base is.
    if !principled_is_within(p, surface) {
        let taken = sheen_taken(p.sheen, cosine);
        reflection *= 1.0 - taken;
        diffuse = diffuse * (1.0 - taken) + taken;
        transmission *= 1.0 - taken;
    }
#endif
    let sum = max(coat + (1.0 - coat) * (reflection + diffuse + transmission), 1.0e-30);
    return PrincipledShares(
        1.0 - coat, coat / sum, (1.0 - coat) * reflection / sum, (1.0 - coat) * diffuse / sum, (1.0 - coat) * transmission / sum
    );
}

fn principled_is_non_delta(lobe: Lobe) -> bool {
    let p = principled_of(lobe, true);
    let diffuse = (1.0 - p.metallic) * (1.0 - p.transmission) * max_component(p.base);
#if SHEEN
    if max_component(p.sheen.color) > 0.0 {
        return true;
    }
#endif
    return !facets_are_smooth(p.facets) || diffuse > 0.0 || (p.coat.strength > 0.0 && !facets_are_smooth(p.coat.facets));
}

fn principled_sampling_weight(lobe: Lobe) -> f32 {
    var p = principled_of(lobe, true);
    p.eta = 1.0;
    let split = principled_split(p, 1.0);
    let coat = COAT_REFLECTANCE * p.coat.strength;
    let weight = coat + (1.0 - coat) * max_component(split.reflected + p.base * split.passed);
#if SHEEN
    return weight + SHEEN_WEIGHT * max_component(p.sheen.color);
#else
    return weight;
#endif
}

fn evaluate_principled(lobe: Lobe, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let p = principled_at(lobe, surface, wo);
    return principled_value(lobe, p, principled_shares(p, surface, wo), surface, wo, wi);
}

fn principled_value(
    lobe: Lobe, p: Principled, shares: PrincipledShares, surface: Surface, wo: vec3<f32>, wi: vec3<f32>
) -> BsdfValue {
    let frame = principled_frame(lobe, p.facets, surface);
    var value = principled_base_value(p, shares, surface, wi, to_local(frame, wo), to_local(frame, wi));
    if shares.coat > 0.0 && !facets_are_smooth(p.coat.facets) && on_coat_side(p.coat, surface, wi) {
        let coat = coat_reflection(p.coat, frame, wo, wi);
        value.value += (1.0 - shares.below_coat) * coat.x;
        value.pdf_solid_angle += shares.coat * coat.y;
    }
    return value;
}

// All that lies below the coat, of directions in its frame; o is that of wo and i that of wi.
fn principled_base_value(
    p: Principled, shares: PrincipledShares, surface: Surface, wi: vec3<f32>, o: vec3<f32>, i: vec3<f32>
) -> BsdfValue {
    if on_wo_side(surface, wi) {
        let m = normalize(o + i);
        let split = principled_split(p, clamp(dot(o, m), 0.0, 1.0));
        var value = p.base * (split.passed * (1.0 - p.transmission) * INVERSE_PI * i.z);
        var pdf = shares.diffuse * hemisphere_pdf(i.z);
        if !facets_are_smooth(p.facets) {
            let mirror = facet_reflection(p.facets, o, i, m);
#if COMPENSATION
            value += split.reflected * principled_compensation(p, o.z) * mirror.x;
#else
            value += split.reflected * mirror.x;
#endif
            pdf += shares.reflection * mirror.y;
        }
#if SHEEN
        if !principled_is_within(p, surface) && max_component(p.sheen.color) > 0.0 {
            value = value * principled_below_sheen(p, o.z, i.z) + sheen_value(p.sheen, o, i);
        }
#endif
        return BsdfValue(value * shares.below_coat, pdf);
    }
#if PRINCIPLED_TRANSMISSION
    if on_far_side(surface, wi) && shares.transmission > 0.0 && !facets_are_smooth(p.facets) {
        var terms = vec2<f32>(0.0);
        var cosine = 0.0;
        if p.thin {
            let across = vec3<f32>(i.xy, -i.z);
            let m = normalize(o + across);
            cosine = clamp(dot(o, m), 0.0, 1.0);
            terms = facet_reflection(p.facets, o, across, m);
        } else {
            var m = normalize(o + p.eta * i);
            m = select(-m, m, m.z > 0.0);
            let o_m = dot(o, m);
            let i_m = dot(i, m);
            if o_m <= 0.0 || i_m >= 0.0 {
                return no_value();
            }
            cosine = min(o_m, 1.0);
            let lambda_o = facet_lambda(p.facets, o);
            let refraction = i_m + o_m / p.eta;
            let density = facet_distribution(p.facets, m) * o_m / o.z * (-i_m / (refraction * refraction));
            let shadowing = facet_shadowing(p.facets, lambda_o, facet_lambda(p.facets, i));
            terms = vec2<f32>(density * shadowing / (p.eta * p.eta), density / (1.0 + lambda_o));
        }
        var passed = principled_split(p, cosine).passed;
#if SHEEN
        passed *= principled_below_sheen(p, o.z, -i.z);
#endif
        return BsdfValue(p.base * (shares.below_coat * passed * p.transmission * terms.x), shares.transmission * terms.y);
    }
#endif
    return no_value();
}

fn sample_principled(lobe: Lobe, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let p = principled_at(lobe, surface, wo);
    let shares = principled_shares(p, surface, wo);
    let below_reflection = shares.coat + shares.reflection;
    let below_diffuse = below_reflection + shares.diffuse;
    let is_coat = choice < shares.coat;
    let is_reflection = !is_coat && choice < below_reflection;
    let is_diffuse = !is_coat && !is_reflection && (choice < below_diffuse || shares.transmission == 0.0);
    let transmits = !is_coat && !is_reflection && !is_diffuse;
    var facets = p.facets;
    if is_coat {
        facets = p.coat.facets;
    }
    let cosine = min(dot(wo, surface.shading_normal), 1.0);
    var eta_scale = 1.0;
    if transmits {
        eta_scale = p.eta * p.eta;
    }
    if !is_diffuse && facets_are_smooth(facets) {
        var wi = mirrored(surface, wo);
        if is_coat {
            wi = coat_mirrored(p.coat, surface, wo);
        }
        var weight = Spectrum((1.0 - shares.below_coat) / shares.coat);
        let split = principled_split(p, cosine);
        if is_reflection {
            weight = split.reflected * (shares.below_coat / shares.reflection);
#if SHEEN
            if !principled_is_within(p, surface) {
                weight *= principled_below_sheen(p, cosine, cosine);
            }
#endif
        } else if transmits {
            if split.passed <= 0.0 {
                return no_sample();
            }
            wi = -wo;
            if !p.thin {
                wi = refracted(surface.shading_normal, wo, p.eta);
            }
            weight = p.base * (shares.below_coat * split.passed * p.transmission / (shares.transmission * eta_scale));
#if SHEEN
            weight *= principled_below_sheen(p, cosine, abs(dot(wi, surface.shading_normal)));
#endif
        }
        if transmits == (dot(wi, surface.facing_normal) > 0.0) {
            return no_sample();
        }
        return BsdfSample(wi, weight, -1.0, eta_scale, false);
    }
    var wi = vec3<f32>(0.0);
    if is_diffuse {
        wi = sample_hemisphere(surface, u, v).xyz;
    } else {
        var frame = principled_frame(lobe, facets, surface);
        if is_coat {
            frame = coat_frame(p.coat, surface);
        }
        let o = to_local(frame, wo);
        let m = sample_visible_normal(facets, o, u, v);
        var i = 2.0 * dot(o, m) * m - o;
        if transmits {
            if p.thin {
                i.z = -i.z;
            } else {
                if transmitted_cosine2(clamp(dot(o, m), 0.0, 1.0), p.eta) <= 0.0 {
                    return no_sample();
                }
                i = refracted(m, o, p.eta);
            }
        }
        wi = frame_to_world(frame, i);
    }
    // A facet that is seen from the other side would be taken for the other way.
    if !select(select(on_wo_side(surface, wi), on_far_side(surface, wi), transmits), on_coat_side(p.coat, surface, wi), is_coat) {
        return no_sample();
    }
    return from_value(wi, principled_value(lobe, p, shares, surface, wo, wi), eta_scale);
}
