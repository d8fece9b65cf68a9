// Closest hit and occlusion without any hierarchy: every primitive is a constant of the code.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/constants.wgsl
#import geometry/prepared_ray.wgsl

fn closest_hit(traced: Ray, t_max: f32) -> Hit {
    var hit = Hit(t_max, NONE, 0.0, 0.0);
    closest_of_constants(prepare_ray(traced), &hit);
    return hit;
}

// Whether anything lies between the origin and t_max.
fn occluded(traced: Ray, t_max: f32) -> bool {
    return any_of_constants(prepare_ray(traced), t_max);
}
