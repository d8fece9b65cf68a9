// Layers of surfaces: what a render reports in place of radiance, of the first surface that a path meets, or of the first that does not reflect
// or refract it as a mirror does. src/reference/layer.rs is the same in f64.
#import core/math.wgsl
#import core/parameters.wgsl
#import shading/scattering.wgsl
#import shading/surface.wgsl

// Stands for the value where nothing is met. Its square is not finite: the film counts no such sample.
const NOTHING_MET: f32 = 3.0e38;

// Whether the layer is of what is seen along the drawn direction.
fn is_followed(drawn: BsdfSample) -> bool {
    let goes_on = drawn.pdf_solid_angle < 0.0 && max_component(drawn.weight) > 0.0;
#if LAYER_OF_FIRST_SURFACE
    return goes_on && drawn.is_null;
#else
    return goes_on;
#endif
}

// Of a surface that a path of this throughput met and that is not followed further.
fn surface_value(throughput: vec3<f32>, surface: Surface, drawn: BsdfSample) -> vec3<f32> {
#if LAYER_ALBEDO
    return throughput * drawn.weight;
#endif
#if LAYER_NORMAL
    return surface.shading_normal;
#endif
#if LAYER_POSITION
    return surface.position;
#endif
#if LAYER_DEPTH
    return vec3<f32>(dot(surface.position - view.position.xyz, view.forward.xyz));
#endif
}
