// Camera rays.
#import core/math.wgsl
#import core/parameters.wgsl
#import core/sampler.wgsl

fn camera_ray(pixel: u32, random: vec4<u32>) -> Ray {
    // Division by a constant is a multiplication and a shift.
    let y = pixel / FILM_WIDTH;
    let x = pixel - y * FILM_WIDTH;
    let film_x = f32(x) + uniform_float(random.x);
    let film_y = f32(y) + uniform_float(random.y);
    let direction = view.corner.xyz + film_x * view.step_x.xyz + film_y * view.step_y.xyz;
    return Ray(view.position.xyz, normalize(direction));
}
