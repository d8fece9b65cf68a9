// Materials: what a surface does to light. Directions point away from the surface; values include the cosine.
#import core/math.wgsl
#import shading/surface.wgsl
#if TEXTURES
#import shading/texture.wgsl
#endif

const DIFFUSE: u32 = 0u;
const MIRROR: u32 = 1u;
const GLASS: u32 = 2u;
const EMISSIVE: u32 = 3u;

const EMITS: u32 = 1u;
const EMITS_TWO_SIDED: u32 = 2u;

// A material with its parameters looked up for one hit.
struct Bsdf {
    kind: u32,
    reflectance: vec3<f32>,
    transmittance: vec3<f32>,
    ior: f32,
}

struct BsdfSample {
    // A zero weight means that no direction was found.
    wi: vec3<f32>,
    // f |cos| / pdf
    weight: vec3<f32>,
    // Negative for a delta lobe.
    pdf_solid_angle: f32,
    // Squared ratio of refractive indices crossed by a refraction, else 1.
    eta_scale: f32,
}

struct BsdfValue {
    // f |cos|
    value: vec3<f32>,
    pdf_solid_angle: f32,
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

fn load_bsdf(surface: Surface) -> Bsdf {
    let first = surface.material * 4u;
    let m0 = tables[first];
    var bsdf = Bsdf(bitcast<u32>(m0.w), m0.xyz, vec3<f32>(0.0), 1.0);
#if GLASS
    let m1 = tables[first + 1u];
    bsdf.transmittance = m1.xyz;
    bsdf.ior = m1.w;
#endif
#if TEXTURES
    let m3 = tables[first + 3u];
    bsdf.reflectance = material_color(bsdf.reflectance, m3.x, surface.uv);
#if GLASS
    bsdf.transmittance = material_color(bsdf.transmittance, m3.z, surface.uv);
#endif
#endif
    return bsdf;
}

// Radiance that the surface sends towards wo by itself.
fn emitted_radiance(surface: Surface) -> vec3<f32> {
    let m2 = tables[surface.material * 4u + 2u];
    let flags = bitcast<u32>(m2.w);
    if (flags & EMITS) == 0u || (!surface.front && (flags & EMITS_TWO_SIDED) == 0u) {
        return vec3<f32>(0.0);
    }
#if TEXTURES
    return material_color(m2.xyz, tables[surface.material * 4u + 3u].y, surface.uv);
#else
    return m2.xyz;
#endif
}

// Whether light sampling can contribute: some lobe is not a delta, and not black.
fn has_smooth_lobe(bsdf: Bsdf) -> bool {
    return bsdf.kind == DIFFUSE && max_component(bsdf.reflectance) > 0.0;
}

fn evaluate_bsdf(bsdf: Bsdf, surface: Surface, wi: vec3<f32>) -> BsdfValue {
    let cosine = dot(wi, surface.shading_normal);
    if cosine <= 0.0 || dot(wi, surface.facing_normal) <= 0.0 {
        return BsdfValue(vec3<f32>(0.0), 0.0);
    }
    return BsdfValue(bsdf.reflectance * (cosine * INVERSE_PI), cosine * INVERSE_PI);
}

// Unpolarised Fresnel reflectance of a dielectric; eta = transmitted over incident index of refraction.
fn fresnel_dielectric(cosine: f32, eta: f32) -> f32 {
    // 1 - cos² as a product keeps its accuracy at normal incidence.
    let sin2_transmitted = (1.0 - cosine) * (1.0 + cosine) / (eta * eta);
    if sin2_transmitted >= 1.0 {
        return 1.0;
    }
    let cosine_transmitted = sqrt(1.0 - sin2_transmitted);
    let parallel = (eta * cosine - cosine_transmitted) / (eta * cosine + cosine_transmitted);
    let perpendicular = (cosine - eta * cosine_transmitted) / (cosine + eta * cosine_transmitted);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

fn no_sample() -> BsdfSample {
    return BsdfSample(vec3<f32>(0.0, 0.0, 1.0), vec3<f32>(0.0), -1.0, 1.0);
}

fn sample_diffuse(bsdf: Bsdf, surface: Surface, u: f32, v: f32) -> BsdfSample {
    let circle = sin_cos_turns(v);
    let r = sqrt(u);
    let cosine = sqrt(1.0 - u);
    let local = vec3<f32>(r * circle.y, r * circle.x, cosine);
    let wi = frame_to_world(frame_from_normal(surface.shading_normal), local);
    if cosine <= 0.0 || dot(wi, surface.facing_normal) <= 0.0 {
        return no_sample();
    }
    return BsdfSample(wi, bsdf.reflectance, cosine * INVERSE_PI, 1.0);
}

#if MIRROR
fn sample_mirror(bsdf: Bsdf, surface: Surface, wo: vec3<f32>) -> BsdfSample {
    let wi = 2.0 * dot(wo, surface.shading_normal) * surface.shading_normal - wo;
    if dot(wi, surface.facing_normal) <= 0.0 {
        return no_sample();
    }
    return BsdfSample(wi, bsdf.reflectance, -1.0, 1.0);
}
#endif

#if GLASS
fn sample_glass(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, lobe: f32) -> BsdfSample {
    let n = surface.shading_normal;
    let cosine = min(dot(wo, n), 1.0);
    let eta = select(1.0 / bsdf.ior, bsdf.ior, surface.front);
    let reflected = fresnel_dielectric(cosine, eta);
    let weight_reflected = reflected * max_component(bsdf.reflectance);
    let weight_transmitted = (1.0 - reflected) * max_component(bsdf.transmittance);
    let total = weight_reflected + weight_transmitted;
    if total <= 0.0 {
        return no_sample();
    }
    let probability = weight_reflected / total;
    if lobe < probability {
        let wi = 2.0 * cosine * n - wo;
        if dot(wi, surface.facing_normal) <= 0.0 {
            return no_sample();
        }
        return BsdfSample(wi, bsdf.reflectance * (reflected / probability), -1.0, 1.0);
    }
    let inverse_eta = 1.0 / eta;
    let sin2_transmitted = (1.0 - cosine) * (1.0 + cosine) * inverse_eta * inverse_eta;
    let cosine_transmitted = sqrt(max(0.0, 1.0 - sin2_transmitted));
    let wi = normalize((inverse_eta * cosine - cosine_transmitted) * n - inverse_eta * wo);
    if dot(wi, surface.facing_normal) >= 0.0 {
        return no_sample();
    }
    // Radiance is squeezed into a smaller cone where it enters the denser side.
    let weight = (1.0 - reflected) / (1.0 - probability) * inverse_eta * inverse_eta;
    return BsdfSample(wi, bsdf.transmittance * weight, -1.0, eta * eta);
}
#endif

fn sample_bsdf(bsdf: Bsdf, surface: Surface, wo: vec3<f32>, lobe: f32, u: f32, v: f32) -> BsdfSample {
    switch bsdf.kind {
        case DIFFUSE: {
            return sample_diffuse(bsdf, surface, u, v);
        }
#if MIRROR
        case MIRROR: {
            return sample_mirror(bsdf, surface, wo);
        }
#endif
#if GLASS
        case GLASS: {
            return sample_glass(bsdf, surface, wo, lobe);
        }
#endif
        default: {
            return no_sample();
        }
    }
}
