// Light sampling and its densities.
#import core/layout.wgsl
#import core/math.wgsl
#import core/sampler.wgsl
#import shading/light/delta_lights.wgsl
#import shading/light/distant.wgsl
#import shading/light/by_power.wgsl
#import shading/light/record.wgsl
#import shading/light/light_sample.wgsl
#import shading/light/outside.wgsl
#import shading/path/planted.wgsl
#import shading/shape_point.wgsl
#import shading/shapes.wgsl
#import shading/surface.wgsl
#import shading/light/tree.wgsl
#import shading/light/cells.wgsl
#import shading/light/emission_map.wgsl
#import shading/light/seen_place.wgsl
#import shading/light/sphere_light.wgsl
#import shading/light/portal.wgsl
#import shading/material/bsdf.wgsl
#import shading/texture/coordinates.wgsl
#import shading/material/seen.wgsl
#import shading/texture/attributes.wgsl
#import shading/shape/sphere.wgsl
#import shading/texture/normal_map.wgsl

#if VARYING_LIGHTS
// Σ wᵢ Leᵢ towards `wo` at a point of a light: what a ray that met it would see.
fn varying_radiance(light: u32, point: ShapePoint, wo: vec3<f32>) -> Spectrum {
    let front = dot(wo, point.normal) > 0.0;
    let kind = bitcast<u32>(light_word(light, 0u).x) & 255u;
    let material = bitcast<u32>(light_word(light, 4u).w);
    var own_normal = vec3<f32>(0.0);
    var uv = point.uv;
    let first = bitcast<u32>(light_word(light, 3u).w);
#if ATTRIBUTES
    if first != NONE {
        let looked_up = shape_attribute(kind, first, uv, point.normal);
        uv = looked_up.uv;
        own_normal = looked_up.normal;
    }
#endif
#if ATTRIBUTES
    let coordinates = texture_coordinates(kind, first, uv, point.uv);
#else
    let coordinates = only_coordinates(uv);
#endif
#if NORMAL_MAPS
    own_normal = mapped_normal(material, kind, first, own_normal, point, coordinates);
#endif
    let shading_normal = shading_normal_towards(own_normal, select(-point.normal, point.normal, front), wo);
    return material_emission(material, seen_by_light(clamp(dot(wo, shading_normal), 0.0, 1.0), front), coordinates);
}

#if SPHERE_LIGHTS_BY_PICTURE
// Draws a point of a sphere by what it shows.
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
#endif

#if SPHERE_LIGHTS
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
    var uv = vec2<f32>(0.0);
    let first = bitcast<u32>(light_word(light, 3u).w);
#if ATTRIBUTES
    if first != NONE {
        uv = sphere_uv(first, outward / l1.w);
    }
#endif
    let material = bitcast<u32>(light_word(light, 4u).w);
#if NORMAL_MAPS
    let normal = outward / l1.w;
    var point = no_shape_point();
    point.normal = normal;
    let mapped = mapped_normal(material, KIND_SPHERE, first, vec3<f32>(0.0), point, only_coordinates(uv));
    let wo = -light_sample.wi;
    cosine = clamp(dot(shading_normal_towards(mapped, select(normal, -normal, inside), wo), wo), 0.0, 1.0);
#endif
    light_sample.radiance *= material_emission(material, seen_by_light(cosine, !inside), only_coordinates(uv));
    return light_sample;
}
#endif
#endif

#if AREA_LIGHTS
// A point on a light, seen from `reference`: density by area turned into density by solid angle.
fn area_light_sample(reference: vec3<f32>, point: ShapePoint, area: f32, error: f32, radiance: Spectrum, two_sided: bool, pmf: f32) -> LightSample {
    let to_light = point.position - reference;
    let distance2 = dot(to_light, to_light);
    let distance = sqrt(distance2);
    let wi = to_light / distance;
    let cosine = -dot(wi, point.normal);
    if distance2 == 0.0 || cosine == 0.0 || (cosine < 0.0 && !two_sided) {
        return no_light();
    }
    // Along wi, the light's error is its error along the normal over the cosine, never more than the distance. That of the direction adds to it, but
    // what stands before a light that is all but seen from its edge is not left out for it.
    let own = min(error / abs(cosine), 0.5 * distance);
    let early = min(own + DIRECTION_ERROR * distance / abs(cosine), max(own, 0.01 * distance));
    return LightSample(wi, (distance - early) * SHADOW_SHORTENING, radiance, pmf * distance2 / (abs(cosine) * area));
}

// Draws a point of a light that is a surface, evenly over its area unless its flags say otherwise. `bits` are those of u and v.
fn sample_area_light(light: u32, kind_flags: u32, reference: vec3<f32>, pmf: f32, bits: vec2<u32>) -> LightSample {
    let l1 = light_word(light, 1u);
    let u = uniform_float(bits.x);
    let v = uniform_float(bits.y);
    var place = vec2<f32>(u, v);
#if FLAT_LIGHTS_BY_SOLID_ANGLE
    let seen = draw_seen_place(light, kind_flags, reference, u, v);
    place = seen.numbers;
#endif
#if AREA_LIGHTS_BY_PICTURE
    var density = 1.0;
    if (kind_flags & LIGHT_WARPED) != 0u {
        let drawn = draw_shown_place(light, kind_flags, bits.x, bits.y);
        place = drawn.place;
        density = drawn.density;
    }
#endif
    let point = sample_shape(kind_flags & 255u, l1.xyz, light_word(light, 2u).xyz, light_word(light, 3u).xyz, place.x, place.y);
    var size = point.size;
#if MOVING_LIGHTS
    size += moved_light_magnitude(light);
#endif
    let error = POINT_ERROR * dot(abs(point.normal), size) + point.error;
    let two_sided = (kind_flags & LIGHT_TWO_SIDED) != 0u;
#if VARYING_LIGHTS
    if (kind_flags & LIGHT_VARIES) != 0u {
        var light_sample = area_light_sample(reference, point, l1.w, error, WHITE, two_sided, pmf);
        light_sample.radiance *= varying_radiance(light, point, -light_sample.wi);
#if AREA_LIGHTS_BY_PICTURE
        light_sample.pdf_solid_angle *= density;
#endif
#if FLAT_LIGHTS_BY_SOLID_ANGLE
        if seen.solid_angle > 0.0 {
            light_sample.pdf_solid_angle = pmf / seen.solid_angle;
        }
#endif
        return light_sample;
    }
#endif
#if FLAT_LIGHTS_BY_SOLID_ANGLE
    var light_sample = area_light_sample(reference, point, l1.w, error, light_word(light, 4u).xyz, two_sided, pmf);
    if seen.solid_angle > 0.0 {
        light_sample.pdf_solid_angle = pmf / seen.solid_angle;
    }
    return light_sample;
#else
    return area_light_sample(reference, point, l1.w, error, light_word(light, 4u).xyz, two_sided, pmf);
#endif
}
#endif

// Density with which light sampling from `ray.origin`, in a cell of lights, draws the ray's direction for the environment, by whichever way; 0 where it
// does not.
fn environment_pdf_solid_angle(ray: Ray, cell: u32) -> f32 {
    var pdf = 0.0;
#if ENVIRONMENT_LIGHT
    pdf += distant_light_pmf(ENVIRONMENT_LIGHT_INDEX, cell) * outside_pdf(ray.direction);
#endif
#if PORTALS
    pdf += portals_pdf(ray, cell);
#endif
    return pdf;
}

// `facing`: which way the surface there faces, as facing_of says.
fn sample_light(reference: vec3<f32>, facing: u32, bits: vec4<u32>) -> LightSample {
    let cell = cell_of_lights(reference, facing);
#if LIGHT_CELLS
    let choice = choose_light_in(cell, bits.x);
    let light = choice.light;
#else
#if LIGHT_TREE
    let choice = choose_light_at(reference, bits.x);
    let light = choice.light;
    if choice.pmf == 0.0 {
        return no_light();
    }
#else
    let light = choose_light(bits.x);
#endif
#endif
    if is_forgotten(light) {
        return no_light();
    }
    let u = uniform_float(bits.y);
    let v = uniform_float(bits.z);
    let l0 = light_word(light, 0u);
    let kind_flags = bitcast<u32>(l0.x);
    let kind = kind_flags & 255u;
#if LIGHT_CELLS
    let pmf = choice.pmf;
#else
#if LIGHT_TREE
    let pmf = choice.pmf;
#else
    let pmf = l0.w;
#endif
#endif
    switch kind {
#if SPHERE_LIGHTS
        case KIND_SPHERE: {
            let two_sided = (kind_flags & LIGHT_TWO_SIDED) != 0u;
#if SPHERE_LIGHTS_BY_PICTURE
            if (kind_flags & LIGHT_WARPED) != 0u {
                return shown_sphere_sample(light, kind_flags, reference, two_sided, pmf, bits.yz);
            }
#endif
#if VARYING_LIGHTS
            if (kind_flags & LIGHT_VARIES) != 0u {
                return varying_sphere_sample(light, reference, two_sided, pmf, u, v);
            }
#endif
            let center = light_word(light, 1u);
            return sphere_light_sample(reference, center.xyz, center.w, light_word(light, 4u).xyz, two_sided, pmf, u, v);
        }
#endif
#if ENVIRONMENT_LIGHT
        case LIGHT_ENVIRONMENT: {
            let drawn = sample_outside(bits.y, bits.z);
            var pdf = pmf * drawn.pdf_solid_angle;
#if PORTALS
            pdf += portals_pdf(Ray(reference, drawn.wi), cell);
#endif
            if pdf <= 0.0 {
                return no_light();
            }
            return LightSample(drawn.wi, INFINITY_DISTANCE, drawn.radiance, pdf);
        }
#endif
#if PORTALS
        case LIGHT_PORTAL: {
            let wi = sample_portal(light, reference, u, v);
            let pdf = environment_pdf_solid_angle(Ray(reference, wi), cell);
            // By rounding, a direction to a portal's very edge may miss it.
            if pdf <= 0.0 {
                return no_light();
            }
            return LightSample(wi, INFINITY_DISTANCE, outside_radiance(wi), pdf);
        }
#endif
        default: {
#if AREA_LIGHTS
            // Below that number are the kinds of surfaces.
            if kind < LIGHT_PORTAL {
                return sample_area_light(light, kind_flags, reference, pmf, bits.yz);
            }
#endif
            return sample_delta_light(kind, light, reference, pmf);
        }
    }
}

// Density with which light sampling from `ray.origin` would have drawn the direction that met this emitting surface, the choice of
// the light included; 0 where light sampling cannot.
fn light_pdf_solid_angle(ray: Ray, facing: u32, surface: Surface) -> f32 {
    if surface.light == NONE {
        return 0.0;
    }
#if LIGHT_CELLS
    let pmf = light_pmf_in(cell_of_lights(ray.origin, facing), surface.light);
#else
#if LIGHT_TREE
    let pmf = local_light_pmf(surface.light, ray.origin);
#else
    let pmf = light_word(surface.light, 0u).w;
#endif
#endif
#if SPHERE_LIGHTS
    if surface.area == 0.0 {
#if TRANSPARENT_SHADOWS
        // A ray that went through the near side has met the far one, to which no direction is drawn from outside.
        let away = ray.origin - surface.sphere.xyz;
        if !surface.front && dot(away, away) > surface.sphere.w * surface.sphere.w {
            return 0.0;
        }
#endif
#if SPHERE_LIGHTS_BY_PICTURE
        if (bitcast<u32>(light_word(surface.light, 0u).x) & LIGHT_WARPED) != 0u {
            let to_lamp = surface.position - ray.origin;
            let whole = 2.0 * TWO_PI * surface.sphere.w * surface.sphere.w;
            let by_area = pmf * dot(to_lamp, to_lamp) / (abs(dot(ray.direction, surface.facing_normal)) * whole);
            return by_area * shown_density_on_sphere(surface.light, surface.uv.xy);
        }
#endif
#if SPHERE_LIGHTS_BY_POINT
        let to_center = surface.sphere.xyz - ray.origin;
        let outside = dot(to_center, to_center) > surface.sphere.w * surface.sphere.w;
        let to_point = surface.position - ray.origin;
        let area = sphere_sampled_area(surface.sphere.w, outside);
        return pmf * dot(to_point, to_point) / (abs(dot(ray.direction, surface.facing_normal)) * area);
#else
        return pmf * sphere_cone_pdf(ray.origin, surface.sphere.xyz, surface.sphere.w);
#endif
    }
#endif
#if FLAT_LIGHTS_BY_SOLID_ANGLE
    let solid_angle = drawn_solid_angle(surface.light, ray.origin);
    if solid_angle > 0.0 {
        return pmf / solid_angle;
    }
#endif
    let to_light = surface.position - ray.origin;
    let even = pmf * dot(to_light, to_light) / (abs(dot(ray.direction, surface.facing_normal)) * surface.area);
#if AREA_LIGHTS_BY_PICTURE
    if (bitcast<u32>(light_word(surface.light, 0u).x) & LIGHT_WARPED) != 0u {
        return even * shown_density(surface.light, surface.uv.xy);
    }
#endif
    return even;
}

// The light that these bits chose at a point, to be written down where paths are. Elsewhere a tree is not walked twice for nothing: 0.
fn traced_light(point: vec3<f32>, facing: u32, light_bits: u32) -> u32 {
#if LIGHT_CELLS
#if TRACE
    return choose_light_in(cell_of_lights(point, facing), light_bits).light;
#else
    return 0u;
#endif
#else
#if !LIGHT_TREE
    return choose_light(light_bits);
#else
#if TRACE
    return choose_light_at(point, light_bits).light;
#else
    return 0u;
#endif
#endif
#endif
}
