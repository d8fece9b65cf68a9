// The layers of the material of glTF 2.0's Appendix B with its extensions; src/reference/bsdf/principled_layers.rs has the model.
// color0 is the base colour, color1 the specular colour.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/microfacet/coat.wgsl
#import shading/microfacet/dielectric.wgsl
#import shading/microfacet/fresnel.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/material/lobe.wgsl
#import shading/material/parameters.wgsl
#import shading/microfacet/microfacet.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl
#import shading/microfacet/albedo.wgsl
#import shading/microfacet/sheen.wgsl
#if THIN_FILM
#import shading/microfacet/thin_film.wgsl
#endif

struct Principled {
    base: Spectrum,
    // The dielectric's reflectance at normal incidence.
    normal_incidence: Spectrum,
    metallic: f32,
    specular: f32,
    transmission: f32,
    // The colour by which light goes through.
    tint: Spectrum,
    // The part of the diffuse base that scatters light on, and the colour by which it does.
    diffuse_transmission: f32,
    diffuse_transmission_color: Spectrum,
    coat: Coat,
    facets: Facets,
    // Transmitted light goes on as if the wall had no thickness.
    thin: bool,
    // The index of refraction beyond over that on wo's side; 1 if no light comes from within.
    eta: f32,
    sheen: Sheen,
#if THIN_FILM
    film: ThinFilm,
    // The part of the surface that it covers.
    film_share: f32,
#endif
}

struct PrincipledShares {
    below_coat: f32,
    coat: f32,
    reflection: f32,
    diffuse: f32,
    diffuse_transmission: f32,
    transmission: f32,
}

fn principled_of(lobe: Lobe, front: bool) -> Principled {
    let parameters = principled_parameters(lobe);
    var p: Principled;
    p.base = lobe.color0;
    let r = (lobe.ior - 1.0) / (lobe.ior + 1.0);
    p.normal_incidence = min(r * r * lobe.color1, WHITE);
    p.metallic = parameters.metallic;
    p.specular = parameters.specular;
    p.eta = 1.0;
    p.thin = true;
    if HAS_PRINCIPLED_TRANSMISSION {
        p.transmission = parameters.transmission;
        p.tint = select(p.base, WHITE, (lobe.kind & UNTINTED) != 0u);
        p.thin = (lobe.kind & THIN_WALL) != 0u || abs(lobe.ior - 1.0) < SMALLEST_BEND;
        if p.transmission > 0.0 && !p.thin {
            p.eta = select(1.0 / lobe.ior, lobe.ior, front);
        }
    }
    if HAS_PRINCIPLED_DIFFUSE_TRANSMISSION {
        p.diffuse_transmission = parameters.diffuse_transmission;
        p.diffuse_transmission_color = parameters.diffuse_transmission_color;
    }
    p.sheen = Sheen(parameters.sheen_color, max(parameters.sheen_roughness, SMALLEST_SHEEN_ROUGHNESS));
#if THIN_FILM
    p.film = thin_film_of(parameters.thin_film_thickness, parameters.thin_film);
    p.film_share = parameters.thin_film_share;
#endif
    p.coat = coat_of(lobe, parameters.coat, parameters.coat_roughness);
    let alpha = lobe.roughness * lobe.roughness;
    p.facets = Facets(alpha, alpha, lobe.kind);
    if HAS_ANISOTROPY && (lobe.kind & ANISOTROPIC) != 0u {
        let along = mix(alpha, 1.0, parameters.anisotropy * parameters.anisotropy);
        p.facets.alpha = along;
        if along >= DELTA_ALPHA {
            p.facets.alpha_v = max(alpha, DELTA_ALPHA);
        }
    }
    return p;
}

// The material on a surface seen from wo.
fn principled_at(lobe: Lobe, surface: Surface, wo: vec3<f32>) -> Principled {
    var p = principled_of(lobe, surface.front);
    p.coat = coat_on(p.coat, lobe, surface, wo);
    return p;
}

// The frame of the base's microfacets.
fn principled_frame(lobe: Lobe, facets: Facets, surface: Surface) -> Frame {
#if ANISOTROPY
    if (facets.flags & ANISOTROPIC) != 0u {
        let frame = facet_frame(facets, surface);
        let parameters = principled_parameters(lobe);
        var turned = parameters.rotation.xy;
        if HAS_ANISOTROPY_DIRECTIONS && (facets.flags & DIRECTED) != 0u {
            let direction = parameters.direction_texel.xy * 2.0 - 1.0;
            if dot(direction, direction) > 0.0 {
                let unit = normalize(direction);
                turned = vec2<f32>(turned.x * unit.x - turned.y * unit.y, turned.y * unit.x + turned.x * unit.y);
            }
        }
        // The bitangent counts towards the side where v grows.
        let side = select(-1.0, 1.0, dot(frame.bitangent, surface.along_v) >= 0.0);
        let tangent = turned.x * frame.tangent + turned.y * side * frame.bitangent;
        return Frame(tangent, cross(frame.normal, tangent), frame.normal);
    }
#endif
    return facet_frame(facets, surface);
}

// The reflectance of a layer by that along the normal: by Schlick's formula, or that of a film on it.
fn principled_fresnel(p: Principled, cosine: f32, normal_incidence: Spectrum) -> Spectrum {
    let plain = schlick(cosine, normal_incidence);
#if THIN_FILM
    if p.film.thickness > 0.0 {
        return mix(plain, film_reflectance_over(p.film, cosine, normal_incidence), p.film_share);
    }
#endif
    return plain;
}

struct PrincipledSplit {
    reflected: Spectrum,
    // Share that goes on to the dielectric's base.
    passed: f32,
}

// The effect of a facet on light that it sees at an angle of the given cosine. Fresnel's angle is that on the
// side of air.
fn principled_split(p: Principled, cosine: f32) -> PrincipledSplit {
    var outside = cosine;
    if p.eta < 1.0 {
        let cosine2 = transmitted_cosine2(cosine, p.eta);
        if cosine2 <= 0.0 {
            return PrincipledSplit(WHITE, 0.0);
        }
        outside = min(sqrt(cosine2), 1.0);
    }
    let dielectric = p.specular * principled_fresnel(p, outside, p.normal_incidence);
    let reflected = mix(dielectric, principled_fresnel(p, cosine, p.base), p.metallic);
    return PrincipledSplit(reflected, (1.0 - p.metallic) * (1.0 - max_component(dielectric)));
}

// Light that microfacets send to each other leaves as light reflected once does: a factor of 1 + F0 (1 - E) /
// E, E the share of light that white ones reflect.
fn principled_compensation(p: Principled, cosine: f32) -> Spectrum {
    if !HAS_COMPENSATION || (p.facets.flags & COMPENSATED) == 0u || p.eta != 1.0 {
        return WHITE;
    }
    let alpha = min(p.facets.alpha, alpha_across(p.facets));
    let table = select(CORRELATED_ALBEDO_WORD, SEPARABLE_ALBEDO_WORD, (p.facets.flags & SEPARABLE_MASKS) != 0u);
    let once = tabulated_albedo(table, cosine, sqrt(alpha), FACET_KNEE * alpha);
    var along_normal = mix(p.specular * p.normal_incidence, p.base, p.metallic);
#if THIN_FILM
    along_normal = mix(p.specular * principled_fresnel(p, 1.0, p.normal_incidence), principled_fresnel(p, 1.0, p.base), p.metallic);
#endif
    return 1.0 + along_normal * ((1.0 - once) / once);
}

// Light comes from within the volume that the surface encloses.
fn principled_is_within(p: Principled, surface: Surface) -> bool {
    return !surface.front && p.transmission > 0.0 && !p.thin;
}

// The share of light that fibres leave to the layers below.
fn principled_below_sheen(p: Principled, cosine_o: f32, cosine_i: f32) -> f32 {
    if !HAS_SHEEN {
        return 1.0;
    }
    return 1.0 - max(sheen_taken(p.sheen, cosine_o), sheen_taken(p.sheen, cosine_i));
}

// Lambert's lobes of the dielectric's base, times π: of light from wo's side, and from the other one.
struct PrincipledDiffuse {
    back: Spectrum,
    on: Spectrum,
}

// On the denser side a part of what would be scattered on comes back.
fn principled_diffuse_base(p: Principled) -> PrincipledDiffuse {
    if !HAS_PRINCIPLED_DIFFUSE_TRANSMISSION {
        return PrincipledDiffuse(p.base * (1.0 - p.transmission), BLACK);
    }
    let on = p.diffuse_transmission_color * ((1.0 - p.transmission) * p.diffuse_transmission);
    let back = p.base * ((1.0 - p.transmission) * (1.0 - p.diffuse_transmission));
    return PrincipledDiffuse(back + on * max(1.0 - p.eta * p.eta, 0.0), on * min(1.0 / (p.eta * p.eta), 1.0));
}

fn principled_shares(p: Principled, surface: Surface, wo: vec3<f32>) -> PrincipledShares {
    let cosine = clamp(dot(wo, surface.shading_normal), 0.0, 1.0);
    // The coat lies on the outside.
    let coat = select(coat_reflectance(p.coat, wo), 0.0, principled_is_within(p, surface));
    let split = principled_split(p, cosine);
    let possible = select(max(p.metallic, (1.0 - p.metallic) * p.specular), 1.0, p.eta < 1.0);
    var reflection = max(max_component(split.reflected), LEAST_REFLECTED * possible);
    let passed = max(split.passed, (1.0 - p.metallic) * (1.0 - MOST_REFLECTED));
    var diffuse = passed * max_component(p.base) * (1.0 - p.transmission);
    var transmission = passed * max_component(p.tint) * p.transmission;
    var diffuse_transmission = 0.0;
    if HAS_PRINCIPLED_DIFFUSE_TRANSMISSION {
        let of_base = principled_diffuse_base(p);
        diffuse = passed * max_component(of_base.back);
        diffuse_transmission = passed * max_component(of_base.on) * p.eta * p.eta;
    }
    // The fibres stand on the outside, and are sampled as the diffuse base is.
    if HAS_SHEEN && !principled_is_within(p, surface) {
        let taken = sheen_taken(p.sheen, cosine);
        reflection *= 1.0 - taken;
        diffuse = diffuse * (1.0 - taken) + taken;
        transmission *= 1.0 - taken;
        diffuse_transmission *= 1.0 - taken;
    }
    let sum = max(coat + (1.0 - coat) * (reflection + diffuse + diffuse_transmission + transmission), 1.0e-30);
    return PrincipledShares(
        1.0 - coat,
        coat / sum,
        (1.0 - coat) * reflection / sum,
        (1.0 - coat) * diffuse / sum,
        (1.0 - coat) * diffuse_transmission / sum,
        (1.0 - coat) * transmission / sum
    );
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

// The value of the layers below the coat, for directions in their frame: o is that of wo and i that of wi.
fn principled_base_value(
    p: Principled, shares: PrincipledShares, surface: Surface, wi: vec3<f32>, o: vec3<f32>, i: vec3<f32>
) -> BsdfValue {
    if on_wo_side(surface, wi) {
        let m = normalize(o + i);
        let split = principled_split(p, clamp(dot(o, m), 0.0, 1.0));
        var value = principled_diffuse_base(p).back * (split.passed * INVERSE_PI * i.z);
        var pdf = shares.diffuse * hemisphere_pdf(i.z);
        if !facets_are_smooth(p.facets) {
            let mirror = facet_reflection(p.facets, o, i, m);
            value += split.reflected * principled_compensation(p, o.z) * mirror.x;
            pdf += shares.reflection * mirror.y;
        }
        if HAS_SHEEN && !principled_is_within(p, surface) && max_component(p.sheen.color) > 0.0 {
            value = value * principled_below_sheen(p, o.z, i.z) + sheen_value(p.sheen, o, i);
        }
        return BsdfValue(value * shares.below_coat, pdf);
    }
    if !on_far_side(surface, wi) {
        return no_value();
    }
    var far = no_value();
    if HAS_PRINCIPLED_DIFFUSE_TRANSMISSION && shares.diffuse_transmission > 0.0 {
        let m = normalize(o + vec3<f32>(i.xy, -i.z));
        // By the angle within the denser medium from either side, so that light goes both ways alike.
        var denser = p;
        denser.eta = min(p.eta, 1.0 / p.eta);
        let passed = principled_split(denser, clamp(dot(o, m), 0.0, 1.0)).passed * principled_below_sheen(p, o.z, -i.z);
        far = BsdfValue(principled_diffuse_base(p).on * (shares.below_coat * passed * INVERSE_PI * -i.z), shares.diffuse_transmission * hemisphere_pdf(-i.z));
    }
    if HAS_PRINCIPLED_TRANSMISSION && shares.transmission > 0.0 && !facets_are_smooth(p.facets) {
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
                return far;
            }
            cosine = min(o_m, 1.0);
            let lambda_o = facet_lambda(p.facets, o);
            let refraction = i_m + o_m / p.eta;
            let density = facet_distribution(p.facets, m) * o_m / o.z * (-i_m / (refraction * refraction));
            let shadowing = facet_shadowing(p.facets, lambda_o, facet_lambda(p.facets, i));
            terms = vec2<f32>(density * shadowing / (p.eta * p.eta), density / (1.0 + lambda_o));
        }
        let passed = principled_split(p, cosine).passed * principled_below_sheen(p, o.z, -i.z);
        far.value += p.tint * (shares.below_coat * passed * p.transmission * terms.x);
        far.pdf_solid_angle += shares.transmission * terms.y;
    }
    return far;
}

// A way in which light is scattered.
const PRINCIPLED_COAT: u32 = 0u;
const PRINCIPLED_REFLECTION: u32 = 1u;
// By the diffuse base, to wo's side and to the other one.
const PRINCIPLED_BACK: u32 = 2u;
const PRINCIPLED_ON: u32 = 3u;
const PRINCIPLED_TRANSMITTED: u32 = 4u;

// A direction, and the way in which light comes from there.
struct PrincipledDrawn {
    wi: vec3<f32>,
    way: u32,
    is_possible: bool,
}

// The facets that send light this way cannot be told from a smooth surface: there is one direction.
fn principled_is_smooth(p: Principled, way: u32) -> bool {
    if way == PRINCIPLED_COAT {
        return facets_are_smooth(p.coat.facets);
    }
    return (way == PRINCIPLED_REFLECTION || way == PRINCIPLED_TRANSMITTED) && facets_are_smooth(p.facets);
}

fn principled_goes_on(way: u32) -> bool {
    return way >= PRINCIPLED_ON;
}

fn principled_way(shares: PrincipledShares, choice: f32) -> u32 {
    let below_reflection = shares.coat + shares.reflection;
    let below_diffuse = below_reflection + shares.diffuse;
    if choice < shares.coat {
        return PRINCIPLED_COAT;
    }
    if choice < below_reflection {
        return PRINCIPLED_REFLECTION;
    }
    if choice < below_diffuse || shares.diffuse_transmission + shares.transmission == 0.0 {
        return PRINCIPLED_BACK;
    }
    let is_on = choice < below_diffuse + shares.diffuse_transmission || shares.transmission == 0.0;
    return select(PRINCIPLED_TRANSMITTED, PRINCIPLED_ON, is_on);
}

// A direction that light comes from, drawn by the shares.
fn draw_principled(
    lobe: Lobe, p: Principled, shares: PrincipledShares, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32
) -> PrincipledDrawn {
    let way = principled_way(shares, choice);
    let goes_on = principled_goes_on(way);
    let is_coat = way == PRINCIPLED_COAT;
    if principled_is_smooth(p, way) {
        var wi = mirrored(surface, wo);
        if is_coat {
            wi = coat_mirrored(p.coat, wo);
        } else if goes_on {
            wi = -wo;
            if !p.thin {
                if transmitted_cosine2(min(dot(wo, surface.shading_normal), 1.0), p.eta) <= 0.0 {
                    return PrincipledDrawn(wi, way, false);
                }
                wi = refracted(surface.shading_normal, wo, p.eta);
            }
        }
        return PrincipledDrawn(wi, way, goes_on != (dot(wi, surface.facing_normal) > 0.0));
    }
    var wi = vec3<f32>(0.0);
    if way == PRINCIPLED_BACK || way == PRINCIPLED_ON {
        let direction = sample_hemisphere(surface, u, v);
        wi = direction.xyz;
        if goes_on {
            wi -= 2.0 * direction.w * surface.shading_normal;
        }
    } else {
        var facets = p.facets;
        if is_coat {
            facets = p.coat.facets;
        }
        var frame = principled_frame(lobe, facets, surface);
        if is_coat {
            frame = frame_from_normal(p.coat.normal);
        }
        let o = to_local(frame, wo);
        let m = sample_visible_normal(facets, o, u, v);
        var i = 2.0 * dot(o, m) * m - o;
        if goes_on {
            if p.thin {
                i.z = -i.z;
            } else {
                if transmitted_cosine2(clamp(dot(o, m), 0.0, 1.0), p.eta) <= 0.0 {
                    return PrincipledDrawn(wi, way, false);
                }
                i = refracted(m, o, p.eta);
            }
        }
        wi = frame_to_world(frame, i);
    }
    // A facet that is seen from the other side would count for the other way to scatter.
    let leaves_as_drawn = select(select(on_wo_side(surface, wi), on_far_side(surface, wi), goes_on), on_coat_side(p.coat, surface, wi), is_coat);
    return PrincipledDrawn(wi, way, leaves_as_drawn);
}

struct PrincipledLight {
    value: Spectrum,
    probability: f32,
}

// The part of light that comes this one way from a single direction, and the probability of the way.
fn principled_of_smooth(p: Principled, shares: PrincipledShares, surface: Surface, wo: vec3<f32>, drawn: PrincipledDrawn) -> PrincipledLight {
    if drawn.way == PRINCIPLED_COAT {
        return PrincipledLight(Spectrum(1.0 - shares.below_coat), shares.coat);
    }
    let cosine = min(dot(wo, surface.shading_normal), 1.0);
    let split = principled_split(p, cosine);
    if drawn.way == PRINCIPLED_REFLECTION {
        var below = shares.below_coat;
        if !principled_is_within(p, surface) {
            below *= principled_below_sheen(p, cosine, cosine);
        }
        return PrincipledLight(split.reflected * below, shares.reflection);
    }
    let below = shares.below_coat * principled_below_sheen(p, cosine, abs(dot(drawn.wi, surface.shading_normal)));
    return PrincipledLight(p.tint * (below * split.passed * p.transmission / (p.eta * p.eta)), shares.transmission);
}

// A sample of a direction that was drawn.
fn principled_sample(p: Principled, drawn: PrincipledDrawn, value: Spectrum, probability: f32) -> BsdfSample {
    if drawn.way == PRINCIPLED_TRANSMITTED && max_component(value) <= 0.0 {
        return no_sample();
    }
    return BsdfSample(drawn.wi, value / probability, -1.0, principled_eta_scale(p, drawn), false);
}

fn principled_eta_scale(p: Principled, drawn: PrincipledDrawn) -> f32 {
    return select(1.0, p.eta * p.eta, principled_goes_on(drawn.way));
}
