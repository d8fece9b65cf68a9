// The path of a sample, on its first edge.
#import core/camera.wgsl
#import core/spectrum.wgsl
#import shading/path/record.wgsl

// The path that begins with the camera's ray. Where the camera sees nothing it carries nothing, which ends it at its first vertex.
fn camera_path(pixel: u32, sample_in_pass: u32) -> Path {
    let camera = camera_ray(pixel, sample_in_pass);
    var path = new_path(camera.ray, pixel, sample_in_pass);
    if HAS_BLIND_PIXELS && !camera.sees {
        path.throughput = BLACK;
    }
    return path;
}
