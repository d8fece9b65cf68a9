// Light sampling and its densities.
#import core/layout.wgsl
#import core/math.wgsl
#import core/sampler.wgsl
#import shading/light/area_light.wgsl
#import shading/light/choice.wgsl
#import shading/light/delta_lights.wgsl
#import shading/light/light_sample.wgsl
#if LIGHT_LINKS
#import shading/light/links.wgsl
#endif
#import shading/light/outside.wgsl
#import shading/light/portal.wgsl
#import shading/light/record.wgsl
#import geometry/shape/sphere.wgsl
#import shading/light/sphere_light.wgsl
#import shading/light/textured.wgsl
#import shading/path/planted.wgsl
#import shading/surface.wgsl

// Density with which light sampling draws the ray's direction for the environment, by whichever way; 0 where it does not. The ray begins where
// `context` belongs to.
fn environment_pdf_solid_angle(ray: Ray, context: LightContext) -> f32 {
    var pdf = 0.0;
    if HAS_ENVIRONMENT_LIGHT {
        pdf += distant_light_pmf(context, ENVIRONMENT_LIGHT_INDEX) * outside_pdf(ray.direction);
    }
    if HAS_PORTALS {
        pdf += portals_pdf(ray, context);
    }
    return pdf;
}

// Samples a light at a point of a surface, which faces the way that `facing` says (`facing_of`).
fn sample_light(
    reference: vec3<f32>, facing: u32, bits: vec4<u32>
#if LIGHT_LINKS
    // The point is one of this receiver.
    , receiver: u32
#endif
) -> LightSample {
    let context = light_context(reference, facing);
    let choice = choose_light(context, bits.x);
    let light = choice.light;
    if choice.pmf == 0.0 || is_forgotten(light) {
        return no_light();
    }
#if LIGHT_LINKS
    if !mask_lights(link_of_light(light), receiver) {
        return no_light();
    }
#endif
    let kind_flags = bitcast<u32>(light_word(light, 0u).x);
    let kind = kind_flags & 255u;
    if HAS_SPHERE_LIGHTS && kind == KIND_SPHERE {
        return sample_sphere_light(light, kind_flags, reference, choice.pmf, bits.yz);
    }
    if HAS_ENVIRONMENT_LIGHT && kind == LIGHT_ENVIRONMENT {
        let drawn = sample_outside(bits.y, bits.z);
        var pdf = choice.pmf * drawn.pdf_solid_angle;
        if HAS_PORTALS {
            pdf += portals_pdf(Ray(reference, drawn.wi), context);
        }
        return sample_of_outside(drawn.wi, drawn.radiance, pdf);
    }
    if HAS_PORTALS && kind == LIGHT_PORTAL {
        let wi = sample_portal(light, reference, uniform_float(bits.y), uniform_float(bits.z));
        return sample_of_outside(wi, outside_radiance(wi), environment_pdf_solid_angle(Ray(reference, wi), context));
    }
    // Below that number are the kinds of surfaces.
    if HAS_AREA_LIGHTS && kind < LIGHT_PORTAL {
        return sample_area_light(light, kind_flags, reference, choice.pmf, bits.yz);
    }
    return sample_delta_light(kind, light, reference, choice.pmf);
}

// A direction to the environment. By rounding, one to a portal's very edge may miss it, and has no density then.
fn sample_of_outside(wi: vec3<f32>, radiance: Spectrum, pdf: f32) -> LightSample {
    if pdf <= 0.0 {
        return no_light();
    }
    if HAS_OUTSIDE_UNSEEN {
        return LightSample(wi, INFINITY_DISTANCE, BLACK, pdf);
    }
    return LightSample(wi, INFINITY_DISTANCE, radiance, pdf);
}

// Draws a point of a light that is a sphere.
fn sample_sphere_light(light: u32, kind_flags: u32, reference: vec3<f32>, pmf: f32, bits: vec2<u32>) -> LightSample {
    let two_sided = (kind_flags & LIGHT_TWO_SIDED) != 0u;
    if HAS_SPHERE_LIGHTS_BY_PICTURE && (kind_flags & LIGHT_WARPED) != 0u {
        return shown_sphere_sample(light, kind_flags, reference, two_sided, pmf, bits);
    }
    let u = uniform_float(bits.x);
    let v = uniform_float(bits.y);
    if HAS_VARYING_LIGHTS && (kind_flags & LIGHT_VARIES) != 0u {
        return varying_sphere_sample(light, reference, two_sided, pmf, u, v);
    }
    let center = light_word(light, 1u);
    return sphere_light_sample(reference, center.xyz, center.w, light_word(light, 4u).xyz, two_sided, pmf, u, v);
}

// Density with which that draws the ray's direction, which met the sphere at this surface.
fn sphere_light_pdf(surface: Surface, ray: Ray, pmf: f32) -> f32 {
    if HAS_TRANSPARENT_SHADOWS {
        // A ray that went through the near side has met the far one, to which no direction is drawn from outside.
        let away = ray.origin - surface.sphere.xyz;
        if !surface.front && dot(away, away) > surface.sphere.w * surface.sphere.w {
            return 0.0;
        }
    }
    if HAS_SPHERE_LIGHTS_BY_PICTURE && (bitcast<u32>(light_word(surface.light, 0u).x) & LIGHT_WARPED) != 0u {
        return shown_sphere_pdf(surface, ray, pmf);
    }
    if HAS_SPHERE_LIGHTS_BY_POINT {
        let to_center = surface.sphere.xyz - ray.origin;
        let outside = dot(to_center, to_center) > surface.sphere.w * surface.sphere.w;
        let to_point = surface.position - ray.origin;
        let area = sphere_sampled_area(surface.sphere.w, outside);
        return pmf * dot(to_point, to_point) / (abs(dot(ray.direction, surface.facing_normal)) * area);
    } else {
        return pmf * sphere_cone_pdf(ray.origin, surface.sphere.xyz, surface.sphere.w);
    }
}

// Density with which light sampling from `ray.origin` would have drawn the direction that met this emitting surface, the choice of
// the light included; 0 where light sampling cannot.
fn light_pdf_solid_angle(ray: Ray, facing: u32, surface: Surface) -> f32 {
    if surface.light == NONE {
        return 0.0;
    }
    let pmf = light_pmf(light_context(ray.origin, facing), surface.light);
    if HAS_SPHERE_LIGHTS && surface.area == 0.0 {
        return sphere_light_pdf(surface, ray, pmf);
    }
    return area_light_pdf(surface, ray, pmf);
}

// The light that these bits chose at a point, to be written down where paths are; elsewhere no choice is made twice, and this is 0.
fn traced_light(point: vec3<f32>, facing: u32, light_bits: u32) -> u32 {
    if HAS_TRACE {
        return choose_light(light_context(point, facing), light_bits).light;
    }
    return 0u;
}
