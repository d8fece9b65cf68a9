// Surfaces that give light and are not in the picture: rays of the camera go through them, as through null surfaces.
#import core/layout.wgsl
#import core/spectrum.wgsl
#import geometry/scene.wgsl
#import shading/path/record.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl
#import shading/path/trace.wgsl

// The material, or a part of its blend, sends out radiance, on whichever side.
fn gives_light(material: u32) -> bool {
    return (bitcast<u32>(tables[material * MATERIAL_WORDS + 2u].w) & (EMITS | PARTS_EMIT)) != 0u;
}

// The path behind a surface that is not seen.
fn path_behind(incoming: Path, surface: Surface) -> Path {
    var straight_on = no_sample();
    straight_on.wi = incoming.ray.direction;
    straight_on.weight = WHITE;
    straight_on.pdf_solid_angle = -1.0;
    straight_on.is_null = true;
    trace_sample(straight_on.wi, straight_on.pdf_solid_angle, straight_on.weight, 1.0, true);
    return extended_path(incoming, surface, straight_on, incoming.throughput, incoming.roulette_scale);
}
