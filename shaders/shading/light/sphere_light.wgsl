// Points on sphere lights.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/light/light_sample.wgsl

// From outside, uniform over the cone of directions that meet the sphere; from inside, over all directions.
fn sphere_cone_sample(
    reference: vec3<f32>, center: vec3<f32>, radius: f32, radiance: Spectrum, two_sided: bool, pmf: f32, u: f32, v: f32
) -> LightSample {
    let to_center = center - reference;
    let center_distance2 = dot(to_center, to_center);
    let circle = sin_cos_turns(v);
    let error = POINT_ERROR * (max_coordinate(abs(center)) + radius);
    if center_distance2 <= radius * radius {
        // From inside, light comes from everywhere.
        if !two_sided {
            return no_light();
        }
        let cosine = 1.0 - 2.0 * u;
        let sine = sqrt(max(0.0, (1.0 - cosine) * (1.0 + cosine)));
        let wi = vec3<f32>(sine * circle.y, sine * circle.x, cosine);
        let along = dot(to_center, wi);
        let across = to_center - along * wi;
        let distance = along + sqrt(max(0.0, radius * radius - dot(across, across)));
        return LightSample(wi, max(0.0, distance * SHADOW_SHORTENING - 4.0 * error), radiance, pmf * 0.25 * INVERSE_PI);
    }
    let center_distance = sqrt(center_distance2);
    let sin2_max = radius * radius / center_distance2;
    let one_minus_cos_max = sin2_max / (1.0 + sqrt(max(0.0, 1.0 - sin2_max)));
    let one_minus_cos = u * one_minus_cos_max;
    let sin2 = one_minus_cos * (2.0 - one_minus_cos);
    let cosine = 1.0 - one_minus_cos;
    let sine = sqrt(sin2);
    let frame = frame_from_normal(to_center / center_distance);
    let wi = frame_to_world(frame, vec3<f32>(sine * circle.y, sine * circle.x, cosine));
    let half_chord = sqrt(max(0.0, radius * radius - center_distance2 * sin2));
    let distance = center_distance * cosine - half_chord;
    // At grazing angles the chord is short and its end ill defined along wi: stay away from it by the error over the cosine there.
    let early = min(error * radius / max(half_chord, 1.0e-3 * radius), 0.5 * distance);
    return LightSample(wi, (distance - early) * SHADOW_SHORTENING, radiance, pmf / (TWO_PI * one_minus_cos_max));
}

// To the point with this normal, of which so large an area was drawn from evenly. From outside, the sphere hides its own far side.
fn sphere_sample_of_point(
    reference: vec3<f32>, center: vec3<f32>, radius: f32, normal: vec3<f32>, radiance: Spectrum, two_sided: bool, pmf: f32, area: f32
) -> LightSample {
    let to_reference = reference - center;
    let outside = dot(to_reference, to_reference) > radius * radius;
    let to_light = center + radius * normal - reference;
    let distance2 = dot(to_light, to_light);
    let distance = sqrt(distance2);
    let wi = to_light / distance;
    let cosine = -dot(wi, normal);
    if distance2 == 0.0 || cosine == 0.0 || (outside && cosine < 0.0) || (!outside && !two_sided) {
        return no_light();
    }
    let error = POINT_ERROR * (max_coordinate(abs(center)) + radius);
    let early = min(error / abs(cosine), 0.5 * distance);
    return LightSample(wi, (distance - early) * SHADOW_SHORTENING, radiance, pmf * distance2 / (abs(cosine) * area));
}

// Area over which points are drawn: that of the whole sphere, or of the half that faces an outside reference point.
fn sphere_sampled_area(radius: f32, outside: bool) -> f32 {
    if HAS_SPHERE_LIGHTS_VISIBLE_HALF {
        return select(2.0, 1.0, outside) * TWO_PI * radius * radius;
    } else {
        return 2.0 * TWO_PI * radius * radius;
    }
}

// Uniform over that area.
fn sphere_point_sample(
    reference: vec3<f32>, center: vec3<f32>, radius: f32, radiance: Spectrum, two_sided: bool, pmf: f32, u: f32, v: f32
) -> LightSample {
    let to_reference = reference - center;
    let reference_distance2 = dot(to_reference, to_reference);
    let outside = reference_distance2 > radius * radius;
    let circle = sin_cos_turns(v);
    let height = 1.0 - 2.0 * u;
    let sine = sqrt(max(0.0, (1.0 - height) * (1.0 + height)));
    var normal = vec3<f32>(sine * circle.y, sine * circle.x, height);
    if HAS_SPHERE_LIGHTS_VISIBLE_HALF && outside {
        let sine_of_half = sqrt(max(0.0, (1.0 - u) * (1.0 + u)));
        let frame = frame_from_normal(to_reference / sqrt(reference_distance2));
        normal = frame_to_world(frame, vec3<f32>(sine_of_half * circle.y, sine_of_half * circle.x, u));
    }
    return sphere_sample_of_point(reference, center, radius, normal, radiance, two_sided, pmf, sphere_sampled_area(radius, outside));
}

fn sphere_light_sample(
    reference: vec3<f32>, center: vec3<f32>, radius: f32, radiance: Spectrum, two_sided: bool, pmf: f32, u: f32, v: f32
) -> LightSample {
    if HAS_SPHERE_LIGHTS_BY_POINT {
        return sphere_point_sample(reference, center, radius, radiance, two_sided, pmf, u, v);
    } else {
        return sphere_cone_sample(reference, center, radius, radiance, two_sided, pmf, u, v);
    }
}
