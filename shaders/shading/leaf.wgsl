// A leaf: one material that is no blend, with its parameters looked up for one hit. Directions point away from the surface; values
// include the cosine.
#import core/math.wgsl
#import shading/surface.wgsl
#if TEXTURES
#import shading/texture.wgsl
#endif
#if COSINE_POWER
#import shading/cosine_power.wgsl
#endif
#if MICROFACETS
#import shading/microfacet.wgsl
#endif

const DIFFUSE: u32 = 0u;
const MIRROR: u32 = 1u;
const GLASS: u32 = 2u;
const EMISSIVE: u32 = 3u;
const GLOSSY: u32 = 4u;
const PHONG: u32 = 5u;
const CONDUCTOR: u32 = 6u;
const ROUGH_GLASS: u32 = 7u;
// Rough glass after Honsdorf: cosine-power lobes about the mirror and the refracted direction.
const PHONG_GLASS: u32 = 8u;
const PASS: u32 = 9u;
const BLEND: u32 = 10u;
// Flag beside the kind of a conductor: `first` and `second` are eta and k, not the reflectance at normal incidence.
const COMPLEX_FRESNEL: u32 = 256u;

const EMITS: u32 = 1u;
const EMITS_TWO_SIDED: u32 = 2u;
// Of a blend: some leaf emits.
const LEAVES_EMIT: u32 = 4u;

// GGX narrower than this is a delta lobe: f32 no longer resolves it.
const SMOOTH_ALPHA: f32 = 1.0e-4;

struct Leaf {
    // The kind, COMPLEX_FRESNEL beside it.
    kind: u32,
    // Reflectance, diffuse reflectance or eta.
    first: vec3<f32>,
    // Transmittance, specular reflectance or k.
    second: vec3<f32>,
    ior: f32,
    // GGX width or cosine exponent.
    scalar: f32,
}

struct BsdfSample {
    // Zero weight: no direction was found.
    wi: vec3<f32>,
    // f |cos| / pdf
    weight: vec3<f32>,
    // Negative for a delta lobe.
    pdf_solid_angle: f32,
    // Squared ratio of refractive indices crossed by a refraction, else 1.
    eta_scale: f32,
    // The ray goes straight on through a surface that is not there.
    passes: bool,
}

struct BsdfValue {
    // f |cos|
    value: vec3<f32>,
    pdf_solid_angle: f32,
}

fn no_sample() -> BsdfSample {
    return BsdfSample(vec3<f32>(0.0, 0.0, 1.0), vec3<f32>(0.0), -1.0, 1.0, false);
}

fn no_value() -> BsdfValue {
    return BsdfValue(vec3<f32>(0.0), 0.0);
}

fn material_color(constant: vec3<f32>, texture: f32, uv: vec2<f32>) -> vec3<f32> {
#if TEXTURES
    let index = bitcast<u32>(texture);
    if index != NONE {
        return constant * texture_color(index, uv);
    }
#endif
    return constant;
}

fn load_leaf(material: u32, uv: vec2<f32>) -> Leaf {
    let word = material * MATERIAL_WORDS;
    let m0 = tables[word];
    var leaf = Leaf(bitcast<u32>(m0.w), m0.xyz, vec3<f32>(0.0), 1.0, 0.0);
#if SECOND_COLORS
    let m1 = tables[word + 1u];
    leaf.second = m1.xyz;
    leaf.ior = m1.w;
#endif
#if SCALARS
    leaf.scalar = tables[word + 4u].x;
#endif
#if TEXTURES
    // One call for all three: software drivers copy what is called to wherever it is called.
    let textures = bitcast<vec4<u32>>(tables[word + 3u]);
    for (var slot = 0u; slot < 3u; slot++) {
        let texture = select(select(textures.x, textures.z, slot == 1u), textures.w, slot == 2u);
        if texture != NONE {
            let color = texture_color(texture, uv);
            leaf.first *= select(vec3<f32>(1.0), color, slot == 0u);
            leaf.second *= select(vec3<f32>(1.0), color, slot == 1u);
            leaf.scalar *= select(1.0, color.x, slot == 2u);
        }
    }
#if SCALARS
    // A texture of roughness: its square is the width.
    if bitcast<u32>(tables[word + 4u].z) != 0u {
        leaf.scalar *= leaf.scalar;
    }
#endif
#endif
    return leaf;
}

// Radiance that a leaf's front, or back, sends out.
fn leaf_emission(material: u32, front: bool, uv: vec2<f32>) -> vec3<f32> {
    let word = material * MATERIAL_WORDS;
    let m2 = tables[word + 2u];
    let flags = bitcast<u32>(m2.w);
    if (flags & EMITS) == 0u || (!front && (flags & EMITS_TWO_SIDED) == 0u) {
        return vec3<f32>(0.0);
    }
#if TEXTURES
    return material_color(m2.xyz, tables[word + 3u].y, uv);
#else
    return m2.xyz;
#endif
}

fn leaf_kind(leaf: Leaf) -> u32 {
    return leaf.kind & 255u;
}

fn leaf_is_smooth(leaf: Leaf) -> bool {
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
        case CONDUCTOR, ROUGH_GLASS: { return leaf.scalar >= SMOOTH_ALPHA; }
#endif
        default: { return false; }
    }
}

// How much of the incoming light a leaf sends on, roughly: what its share of a mixture's samples goes by.
fn leaf_sampling_weight(leaf: Leaf) -> f32 {
    switch leaf_kind(leaf) {
        case EMISSIVE: { return 0.0; }
        case PASS: { return 1.0; }
        case GLASS, ROUGH_GLASS, PHONG_GLASS: { return max(max_component(leaf.first), max_component(leaf.second)); }
        case PHONG: { return max_component(leaf.first + leaf.second); }
#if CONDUCTOR
        case CONDUCTOR: { return max_component(conductor_fresnel(leaf.kind, leaf.first, leaf.second, 1.0)); }
#endif
        default: { return max_component(leaf.first); }
    }
}

// Squared cosine of the refracted direction by Snell's law, not above 0 in total reflection. As a sum of the difference of the indices and
// the cosine it keeps its accuracy where both are small: 1 - (1 - cos²) / eta² would take every grazing ray for totally reflected.
fn transmitted_cosine2(cosine: f32, eta: f32) -> f32 {
    return ((eta - 1.0) * (eta + 1.0) + cosine * cosine) / (eta * eta);
}

// Unpolarised Fresnel reflectance of a dielectric; eta = transmitted over incident index of refraction.
fn fresnel_dielectric(cosine: f32, eta: f32) -> f32 {
    let cosine2 = transmitted_cosine2(cosine, eta);
    if cosine2 <= 0.0 {
        return 1.0;
    }
    let cosine_transmitted = sqrt(cosine2);
    let parallel = (eta * cosine - cosine_transmitted) / (eta * cosine + cosine_transmitted);
    let perpendicular = (cosine - eta * cosine_transmitted) / (cosine + eta * cosine_transmitted);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

#if CONDUCTOR
// Reflectance of a metal: the exact equations for a complex index of refraction, or Schlick's approximation.
fn conductor_fresnel(kind: u32, first: vec3<f32>, second: vec3<f32>, cosine: f32) -> vec3<f32> {
    let c2 = cosine * cosine;
    if (kind & COMPLEX_FRESNEL) == 0u {
        let away = 1.0 - cosine;
        let away2 = away * away;
        return first + (1.0 - first) * (away2 * away2 * away);
    }
    let s2 = (1.0 - cosine) * (1.0 + cosine);
    let eta2 = first * first;
    let k2 = second * second;
    let t0 = eta2 - k2 - s2;
    let a2_plus_b2 = sqrt(t0 * t0 + 4.0 * eta2 * k2);
    let t1 = a2_plus_b2 + c2;
    let a = sqrt(max(0.5 * (a2_plus_b2 + t0), vec3<f32>(0.0)));
    let t2 = 2.0 * cosine * a;
    let perpendicular = (t1 - t2) / (t1 + t2);
    let t3 = c2 * a2_plus_b2 + s2 * s2;
    let t4 = t2 * s2;
    let parallel = perpendicular * (t3 - t4) / (t3 + t4);
    return 0.5 * (parallel + perpendicular);
}
#endif

fn on_wo_side(surface: Surface, wi: vec3<f32>) -> bool {
    return dot(wi, surface.shading_normal) > 0.0 && dot(wi, surface.facing_normal) > 0.0;
}

fn on_far_side(surface: Surface, wi: vec3<f32>) -> bool {
    return dot(wi, surface.shading_normal) < 0.0 && dot(wi, surface.facing_normal) < 0.0;
}

fn mirrored(surface: Surface, wo: vec3<f32>) -> vec3<f32> {
    return 2.0 * dot(wo, surface.shading_normal) * surface.shading_normal - wo;
}

// The direction refracted about n, which is on wo's side; the caller rules out total reflection.
fn refracted(n: vec3<f32>, wo: vec3<f32>, eta: f32) -> vec3<f32> {
    let cosine = dot(wo, n);
    let inverse_eta = 1.0 / eta;
    let cosine_transmitted = sqrt(max(0.0, transmitted_cosine2(cosine, eta)));
    return normalize((inverse_eta * cosine - cosine_transmitted) * n - inverse_eta * wo);
}

// Transmitted over incident index of refraction for light that leaves towards wo.
fn relative_ior(leaf: Leaf, surface: Surface) -> f32 {
    return select(1.0 / leaf.ior, leaf.ior, surface.front);
}

// Share of reflection in sampling a dielectric.
fn reflection_probability(leaf: Leaf, reflected: f32) -> f32 {
    let reflection = reflected * max_component(leaf.first);
    let total = reflection + (1.0 - reflected) * max_component(leaf.second);
    return select(0.0, reflection / total, total > 0.0);
}

// A direction about the shading normal in proportion to its cosine, or uniform, and its cosine.
fn sample_hemisphere(surface: Surface, u: f32, v: f32) -> vec4<f32> {
    let circle = sin_cos_turns(v);
#if UNIFORM_HEMISPHERE
    let r = sqrt((1.0 - u) * (1.0 + u));
    let cosine = u;
#else
    let r = sqrt(u);
    let cosine = sqrt(1.0 - u);
#endif
    let local = vec3<f32>(r * circle.y, r * circle.x, cosine);
    return vec4<f32>(frame_to_world(frame_from_normal(surface.shading_normal), local), cosine);
}

fn hemisphere_pdf(cosine: f32) -> f32 {
#if UNIFORM_HEMISPHERE
    return 0.5 * INVERSE_PI;
#else
    return cosine * INVERSE_PI;
#endif
}

fn sample_diffuse(reflectance: vec3<f32>, surface: Surface, u: f32, v: f32) -> BsdfSample {
    let direction = sample_hemisphere(surface, u, v);
    let wi = direction.xyz;
    let cosine = direction.w;
    if cosine <= 0.0 || dot(wi, surface.facing_normal) <= 0.0 {
        return no_sample();
    }
#if UNIFORM_HEMISPHERE
    let weight = reflectance * (2.0 * cosine);
#else
    let weight = reflectance;
#endif
    return BsdfSample(wi, weight, hemisphere_pdf(cosine), 1.0, false);
}

fn evaluate_diffuse(reflectance: vec3<f32>, surface: Surface, wi: vec3<f32>) -> BsdfValue {
    if !on_wo_side(surface, wi) {
        return no_value();
    }
    let cosine = dot(wi, surface.shading_normal);
    return BsdfValue(reflectance * (cosine * INVERSE_PI), hemisphere_pdf(cosine));
}

#if GLASS
fn sample_smooth_glass(leaf: Leaf, surface: Surface, wo: vec3<f32>, lobe: f32) -> BsdfSample {
    let n = surface.shading_normal;
    let cosine = min(dot(wo, n), 1.0);
    let eta = relative_ior(leaf, surface);
    let reflected = fresnel_dielectric(cosine, eta);
    if max(max_component(leaf.first) * reflected, max_component(leaf.second) * (1.0 - reflected)) <= 0.0 {
        return no_sample();
    }
    let probability = reflection_probability(leaf, reflected);
    if lobe < probability {
        let wi = 2.0 * cosine * n - wo;
        if dot(wi, surface.facing_normal) <= 0.0 {
            return no_sample();
        }
        return BsdfSample(wi, leaf.first * (reflected / probability), -1.0, 1.0, false);
    }
    let wi = refracted(n, wo, eta);
    if dot(wi, surface.facing_normal) >= 0.0 {
        return no_sample();
    }
    // Radiance is squeezed into a smaller cone where it enters the denser side.
    let weight = (1.0 - reflected) / ((1.0 - probability) * eta * eta);
    return BsdfSample(wi, leaf.second * weight, -1.0, eta * eta, false);
}
#endif

// f |cos| and density of a smooth leaf; 0 for delta lobes.
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
        case GLASS: { return sample_smooth_glass(leaf, surface, wo, lobe); }
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
#if PASS
        case PASS: {
            return BsdfSample(-wo, vec3<f32>(1.0), -1.0, 1.0, true);
        }
#endif
        default: { return no_sample(); }
    }
}

fn from_value(wi: vec3<f32>, value: BsdfValue, eta_scale: f32) -> BsdfSample {
    if value.pdf_solid_angle <= 0.0 {
        return no_sample();
    }
    return BsdfSample(wi, value.value / value.pdf_solid_angle, value.pdf_solid_angle, eta_scale, false);
}
