// Closest hit and occlusion without any hierarchy: every primitive is a constant of the code.
#import core/math.wgsl
#import geometry/constants.wgsl
#import geometry/prepared_ray.wgsl
#import shading/path/shadow.wgsl

fn closest_hit(traced: Ray, t_max: f32) -> Hit {
    var hit = no_hit(t_max);
    closest_of_constants(prepare_ray(traced), &hit);
    return hit;
}

// The share of light that comes through all that lies between the origin and t_max.
fn shadow_transmittance(traced: Ray, t_max: f32) -> Spectrum {
    var shadow = begin_shadow(t_max);
    let blocked = is_blocked_by_constants(&shadow, prepare_ray(traced));
    return light_through(shadow, blocked);
}
