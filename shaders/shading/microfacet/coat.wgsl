// The clear coat of the principled material: a film of refractive index 1.5, by Schlick's formula, over all
// else. It lies about the surface's shading normal, or if some coat of the scene has a normal map of its own,
// all lie about theirs.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/microfacet/fresnel.wgsl
#import shading/material/lobe.wgsl
#import shading/material/parameters.wgsl
#import shading/microfacet/microfacet.wgsl
#import shading/surface.wgsl
#import geometry/shape_point.wgsl
#import shading/texture/tangent_space.wgsl

struct Coat {
    // The part of the surface that it covers.
    strength: f32,
    facets: Facets,
    // The coat's normal on wo's side.
    normal: vec3<f32>,
}

// A coat before `coat_on` places it on a surface.
fn coat_of(lobe: Lobe, strength: f32, roughness: f32) -> Coat {
    var coat: Coat;
    coat.strength = strength;
    coat.facets = Facets(roughness * roughness, roughness * roughness, lobe.kind & ~ANISOTROPIC);
    return coat;
}

// The coat on a surface seen from wo: about the surface's own normal, or the one that the coat's map makes of
// it.
fn coat_on(coat: Coat, lobe: Lobe, surface: Surface, wo: vec3<f32>) -> Coat {
    var placed = coat;
    placed.normal = surface.shading_normal;
#if COAT_NORMALS
    var normal = normalize(surface.coat_normal);
    if (lobe.kind & COAT_NORMAL_MAP) != 0u {
        let parameters = principled_parameters(lobe);
        let texel = parameters.coat_texel * 2.0 - 1.0;
        let local = vec3<f32>(texel.xy * parameters.coat_scale, texel.z);
        var tangents = Tangents(surface.along_u, surface.along_v);
#if SECOND_UVS
        if lobe.coat_by_second {
            tangents = Tangents(surface.second_along_u, surface.second_along_v);
        }
#endif
        let mapped = from_tangent_space(normal, tangents, local);
        normal = select(mapped, normal, dot(mapped, mapped) == 0.0);
    }
    placed.normal = shading_normal_towards(normal, surface.facing_normal, wo);
#endif
    return placed;
}

fn on_coat_side(coat: Coat, surface: Surface, wi: vec3<f32>) -> bool {
    return dot(wi, coat.normal) > 0.0 && dot(wi, surface.facing_normal) > 0.0;
}

fn coat_mirrored(coat: Coat, wo: vec3<f32>) -> vec3<f32> {
    return 2.0 * dot(wo, coat.normal) * coat.normal - wo;
}

// D G2 / (4 cosθo), and the density of the reflected direction wi. A coat about the surface's normal lies in
// the frame of its base.
fn coat_reflection(coat: Coat, base: Frame, wo: vec3<f32>, wi: vec3<f32>) -> vec2<f32> {
    var frame = base;
    if HAS_COAT_NORMALS {
        frame = frame_from_normal(coat.normal);
    }
    let o = to_local(frame, wo);
    let i = to_local(frame, wi);
    return facet_reflection(coat.facets, o, i, normalize(o + i));
}

// The share of light from wo that the coat reflects.
fn coat_reflectance(coat: Coat, wo: vec3<f32>) -> f32 {
    return coat.strength * schlick(clamp(dot(wo, coat.normal), 0.0, 1.0), Spectrum(COAT_REFLECTANCE)).x;
}
