// The clear coat of the principled material: a film of refractive index 1.5, by Schlick's formula, over all else. It lies about the surface's
// shading normal, or where some coat of the scene has a normal of its own, all of them lie about theirs.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/microfacet/fresnel.wgsl
#import shading/material/lobe.wgsl
#import shading/microfacet/microfacet.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl
#import shading/shape_point.wgsl
#import shading/texture/tangent_space.wgsl

struct Coat {
    // The part of the surface that it covers.
    strength: f32,
    facets: Facets,
#if COAT_NORMALS
    // On wo's side.
    normal: vec3<f32>,
#endif
}

fn coat_of(lobe: Lobe, strength: f32, roughness: f32) -> Coat {
    var coat: Coat;
    coat.strength = strength;
    coat.facets = Facets(roughness * roughness, roughness * roughness, lobe.kind & ~ANISOTROPIC);
    return coat;
}

#if COAT_NORMALS

// The coat on a surface seen from wo: about the surface's own normal, or the normal of the coat's map.
fn coat_on(coat: Coat, lobe: Lobe, surface: Surface, wo: vec3<f32>) -> Coat {
    var normal = normalize(surface.coat_normal);
    if (lobe.kind & COAT_NORMAL_MAP) != 0u {
        let scale = further_parameter(lobe, COAT_NORMAL_PARAMETER + 1u, vec3<f32>(0.0));
        let texel = further_parameter(lobe, COAT_NORMAL_PARAMETER, vec3<f32>(0.0)) * 2.0 - 1.0;
        let local = vec3<f32>(texel.xy * (scale.x - scale.y), texel.z);
        var tangents = Tangents(surface.along_u, surface.along_v);
#if SECOND_UVS
        if lobe.coat_by_second {
            tangents = Tangents(surface.second_along_u, surface.second_along_v);
        }
#endif
        let bent = from_tangent_space(normal, tangents, local);
        normal = select(bent, normal, dot(bent, bent) == 0.0);
    }
    var bent_coat = coat;
    bent_coat.normal = shading_normal_towards(normal, surface.facing_normal, wo);
    return bent_coat;
}

fn coat_cosine(coat: Coat, surface: Surface, wo: vec3<f32>) -> f32 {
    return clamp(dot(wo, coat.normal), 0.0, 1.0);
}

fn on_coat_side(coat: Coat, surface: Surface, wi: vec3<f32>) -> bool {
    return dot(wi, coat.normal) > 0.0 && dot(wi, surface.facing_normal) > 0.0;
}

fn coat_mirrored(coat: Coat, surface: Surface, wo: vec3<f32>) -> vec3<f32> {
    return 2.0 * dot(wo, coat.normal) * coat.normal - wo;
}

fn coat_frame(coat: Coat, surface: Surface) -> Frame {
    return frame_from_normal(coat.normal);
}

// D G2 / (4 cosθo), and the density of the reflected direction wi.
fn coat_reflection(coat: Coat, base: Frame, wo: vec3<f32>, wi: vec3<f32>) -> vec2<f32> {
    let frame = frame_from_normal(coat.normal);
    let o = to_local(frame, wo);
    let i = to_local(frame, wi);
    return facet_reflection(coat.facets, o, i, normalize(o + i));
}

#else

// The coat on a surface seen from wo; without a normal map of its own there is nothing to adapt.
fn coat_on(coat: Coat, lobe: Lobe, surface: Surface, wo: vec3<f32>) -> Coat {
    return coat;
}

fn coat_cosine(coat: Coat, surface: Surface, wo: vec3<f32>) -> f32 {
    return clamp(dot(wo, surface.shading_normal), 0.0, 1.0);
}

fn on_coat_side(coat: Coat, surface: Surface, wi: vec3<f32>) -> bool {
    return on_wo_side(surface, wi);
}

fn coat_mirrored(coat: Coat, surface: Surface, wo: vec3<f32>) -> vec3<f32> {
    return mirrored(surface, wo);
}

fn coat_frame(coat: Coat, surface: Surface) -> Frame {
    return facet_frame(coat.facets, surface);
}

// D G2 / (4 cosθo), and the density of the reflected direction wi. It lies in the frame of its base.
fn coat_reflection(coat: Coat, base: Frame, wo: vec3<f32>, wi: vec3<f32>) -> vec2<f32> {
    let o = to_local(base, wo);
    let i = to_local(base, wi);
    return facet_reflection(coat.facets, o, i, normalize(o + i));
}

#endif

// The share of light from wo that it reflects.
fn coat_reflectance(coat: Coat, surface: Surface, wo: vec3<f32>) -> f32 {
    return coat.strength * schlick(coat_cosine(coat, surface, wo), Spectrum(COAT_REFLECTANCE)).x;
}
