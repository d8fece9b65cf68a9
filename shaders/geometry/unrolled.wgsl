// Closest hit and occlusion without any hierarchy: every primitive is a constant of the code.
#import core/math.wgsl
#import geometry/constants.wgsl
#import geometry/prepared_ray.wgsl

fn closest_hit(traced: Ray, t_max: f32) -> Hit {
    var hit = no_hit(t_max);
    closest_of_constants(prepare_ray(traced), &hit);
    return hit;
}

// What share of the light comes through all that lies between the origin and t_max; 0 where something opaque does.
fn transmittance(traced: Ray, t_max: f32) -> f32 {
    let ray = prepare_ray(traced);
    var through = select(1.0, 0.0, any_of_constants(ray, t_max));
#if TRANSPARENT_SHADOWS
    if through > 0.0 {
        through = transmittance_of_constants(ray, t_max);
    }
#endif
    return through;
}
