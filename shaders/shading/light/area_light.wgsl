// Sampling of points on lights that are surfaces of any shape but the sphere.
#import core/layout.wgsl
#import core/math.wgsl
#import core/sampler.wgsl
#import shading/light/emission_map.wgsl
#import shading/light/light_sample.wgsl
#import shading/light/record.wgsl
#import shading/light/seen_place.wgsl
#import shading/light/textured.wgsl
#import geometry/shape_point.wgsl
#import shading/shapes.wgsl
#import shading/surface.wgsl

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
    // Along wi, the light's error is its error along the normal over the cosine, never more than the distance. The direction's error adds to it, but
    // an occluder before a light that is all but seen from its edge still counts.
    let own = min(error / abs(cosine), 0.5 * distance);
    let early = min(own + DIRECTION_ERROR * distance / abs(cosine), max(own, 0.01 * distance));
    return LightSample(wi, (distance - early) * SHADOW_SHORTENING, radiance, pmf * distance2 / (abs(cosine) * area));
}

// Draws a point of a light that is a surface, evenly over its area unless its flags say otherwise. `bits` are those of u and v.
fn sample_area_light(light: u32, kind_flags: u32, reference: vec3<f32>, pmf: f32, bits: vec2<u32>) -> LightSample {
    let l1 = light_word(light, 1u);
    var place = vec2<f32>(uniform_float(bits.x), uniform_float(bits.y));
    // The solid angle over which directions are drawn evenly; 0 where points are.
    var solid_angle = 0.0;
    if HAS_FLAT_LIGHTS_BY_SOLID_ANGLE {
        let seen = draw_seen_place(light, kind_flags, reference, place.x, place.y);
        place = seen.numbers;
        solid_angle = seen.solid_angle;
    }
    var density = 1.0;
    if HAS_AREA_LIGHTS_BY_PICTURE && (kind_flags & LIGHT_WARPED) != 0u {
        let drawn = draw_shown_place(light, kind_flags, bits.x, bits.y);
        place = drawn.place;
        density = drawn.density;
    }
    let point = sample_shape(kind_flags & 255u, l1.xyz, light_word(light, 2u).xyz, light_word(light, 3u).xyz, place.x, place.y);
    var size = point.size;
    if HAS_MOVING_LIGHTS {
        size += moved_light_magnitude(light);
    }
    let error = POINT_ERROR * dot(abs(point.normal), size) + point.error;
    let two_sided = (kind_flags & LIGHT_TWO_SIDED) != 0u;
    let varies = HAS_VARYING_LIGHTS && (kind_flags & LIGHT_VARIES) != 0u;
    let radiance = select(light_word(light, 4u).xyz, WHITE, varies);
    var light_sample = area_light_sample(reference, point, l1.w, error, radiance, two_sided, pmf);
    if HAS_VARYING_LIGHTS && varies {
        light_sample.radiance *= varying_radiance(light, point, -light_sample.wi);
        light_sample.pdf_solid_angle *= density;
    }
    if HAS_FLAT_LIGHTS_BY_SOLID_ANGLE && solid_angle > 0.0 {
        light_sample.pdf_solid_angle = pmf / solid_angle;
    }
    return light_sample;
}

// Density with which that draws the ray's direction, which met the light at this surface.
fn area_light_pdf(surface: Surface, ray: Ray, pmf: f32) -> f32 {
    if HAS_FLAT_LIGHTS_BY_SOLID_ANGLE {
        let solid_angle = drawn_solid_angle(surface.light, ray.origin);
        if solid_angle > 0.0 {
            return pmf / solid_angle;
        }
    }
    let to_light = surface.position - ray.origin;
    let even = pmf * dot(to_light, to_light) / (abs(dot(ray.direction, surface.facing_normal)) * surface.area);
    if HAS_AREA_LIGHTS_BY_PICTURE && (bitcast<u32>(light_word(surface.light, 0u).x) & LIGHT_WARPED) != 0u {
        return even * shown_density(surface.light, surface.uv.xy);
    }
    return even;
}
