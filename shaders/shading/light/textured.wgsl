// Area lights whose radiance varies over them: by textures, by blends, or by the direction in which it leaves.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/light/emission_map.wgsl
#import shading/light/light_sample.wgsl
#import shading/light/record.wgsl
#import shading/light/sphere_light.wgsl
#import shading/material/bsdf.wgsl
#import shading/material/seen.wgsl
#import geometry/shape/sphere.wgsl
#import geometry/shape_point.wgsl
#import shading/shapes.wgsl
#import shading/surface.wgsl
#import shading/texture/attributes.wgsl
#import shading/texture/coordinates.wgsl
#import shading/texture/normal_map.wgsl

// Σ wᵢ Leᵢ towards `wo` at a point of a light: the radiance that a ray finds which meets it there.
fn varying_radiance(light: u32, point: ShapePoint, wo: vec3<f32>) -> Spectrum {
    let front = dot(wo, point.normal) > 0.0;
    let kind = bitcast<u32>(light_word(light, 0u).x) & 255u;
    let material = bitcast<u32>(light_word(light, 4u).w);
    var own_normal = vec3<f32>(0.0);
    let first = bitcast<u32>(light_word(light, 3u).w);
    var coordinates = only_coordinates(point.uv);
    if HAS_ATTRIBUTES {
        var uv = point.uv;
        if first != NONE {
            let looked_up = shape_attribute(kind, first, uv, point.normal);
            uv = looked_up.uv;
            own_normal = looked_up.normal;
        }
        coordinates = texture_coordinates(kind, first, uv, point.uv);
    }
    if HAS_NORMAL_MAPS {
        own_normal = mapped_normal(material, kind, first, own_normal, point, coordinates);
    }
    let shading_normal = shading_normal_towards(own_normal, select(-point.normal, point.normal, front), wo);
    return material_emission(material, seen_by_light(clamp(dot(wo, shading_normal), 0.0, 1.0), front, shading_normal), coordinates);
}

// Draws a point of a sphere by its emission map.
fn shown_sphere_sample(light: u32, kind_flags: u32, reference: vec3<f32>, two_sided: bool, pmf: f32, bits: vec2<u32>) -> LightSample {
    let l1 = light_word(light, 1u);
    let drawn = draw_shown_place(light, kind_flags, bits.x, bits.y);
    var point = no_shape_point();
    let band = sphere_band(light, drawn.place.y);
    point.normal = sphere_normal_at(bitcast<u32>(light_word(light, 3u).w), drawn.place.x, band.below);
    let area = 2.0 * TWO_PI * l1.w * l1.w;
    var light_sample = sphere_sample_of_point(reference, l1.xyz, l1.w, point.normal, WHITE, two_sided, pmf, area);
    light_sample.radiance *= varying_radiance(light, point, -light_sample.wi);
    light_sample.pdf_solid_angle *= drawn.density / band.area;
    return light_sample;
}

// Density with which that draws the ray's direction, which met the sphere at this surface.
fn shown_sphere_pdf(surface: Surface, ray: Ray, pmf: f32) -> f32 {
    let to_light = surface.position - ray.origin;
    let whole = 2.0 * TWO_PI * surface.sphere.w * surface.sphere.w;
    let by_area = pmf * dot(to_light, to_light) / (abs(dot(ray.direction, surface.facing_normal)) * whole);
    return by_area * shown_density_on_sphere(surface.light, surface.uv.xy);
}

// Draws a point of a sphere as one of even radiance, and looks up what leaves it.
fn varying_sphere_sample(light: u32, reference: vec3<f32>, two_sided: bool, pmf: f32, u: f32, v: f32) -> LightSample {
    let l1 = light_word(light, 1u);
    var light_sample = sphere_light_sample(reference, l1.xyz, l1.w, WHITE, two_sided, pmf, u, v);
    let to_center = l1.xyz - reference;
    let along = dot(to_center, light_sample.wi);
    let across = to_center - along * light_sample.wi;
    let half_chord = sqrt(max(0.0, l1.w * l1.w - dot(across, across)));
    let inside = dot(to_center, to_center) <= l1.w * l1.w;
    let outward = select(-half_chord, half_chord, inside) * light_sample.wi - across;
    var cosine = clamp(half_chord / l1.w, 0.0, 1.0);
    var shading_normal = select(outward, -outward, inside) / l1.w;
    var uv = vec2<f32>(0.0);
    let first = bitcast<u32>(light_word(light, 3u).w);
    if HAS_ATTRIBUTES && first != NONE {
        uv = sphere_uv(first, outward / l1.w);
    }
    let material = bitcast<u32>(light_word(light, 4u).w);
    if HAS_NORMAL_MAPS {
        let normal = outward / l1.w;
        var point = no_shape_point();
        point.normal = normal;
        let mapped = mapped_normal(material, KIND_SPHERE, first, vec3<f32>(0.0), point, only_coordinates(uv));
        let wo = -light_sample.wi;
        shading_normal = shading_normal_towards(mapped, select(normal, -normal, inside), wo);
        cosine = clamp(dot(shading_normal, wo), 0.0, 1.0);
    }
    light_sample.radiance *= material_emission(material, seen_by_light(cosine, !inside, shading_normal), only_coordinates(uv));
    return light_sample;
}
