// Which pixels an invocation of a fused kernel has.
#import core/parameters.wgsl
#import shading/path/camera_path.wgsl
#import shading/path/path.wgsl
#import geometry/motion.wgsl
#import stages/statistics.wgsl

struct PassPixel {
    // Over the whole film, and in the band's film.
    pixel: u32,
    in_band: u32,
}

// The pixel with this index in the pass.
fn pass_pixel(index: u32) -> PassPixel {
#if PIXEL_LIST
    let in_band = listed_pixel_in_band(index);
    return PassPixel(pass_parameters.first_pixel + in_band, in_band);
#else
    return PassPixel(pass_parameters.first_pixel + index, pass_parameters.first_pixel_in_band + index);
#endif
}

fn start_path(pixel: u32, sample_in_pass: u32) -> Path {
    if HAS_MOTION {
        set_path_time(pixel, sample_in_pass);
    }
    return camera_path(pixel, sample_in_pass);
}
