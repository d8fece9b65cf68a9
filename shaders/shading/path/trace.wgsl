// A debug build of the fused kernel writes down what happens at each vertex of one path: src/gpu/trace.rs reads it. In all other kernels
// these functions do nothing.
#import core/layout.wgsl
#import core/spectrum.wgsl

#if TRACE
// The vertex in the making:
//   0 (position; primitive or NONE), 1 (shading normal; material), 2 (direction of the ray that met it; its density),
//   3 (throughput up to here; bits of TRACED_*), 4 (radiance found, weighted; its weight),
//   5 (direction to the light; its density), 6 (what the light adds if seen; weight), 7 (light; density of BSDF sampling; survival; -),
//   8 (sampled direction; its density), 9 (its weight; squared ratio of indices)
var<private> traced: array<vec4<f32>, TRACE_WORDS>;
@group(0) @binding(BINDING_TRACE) var<storage, read_write> path_trace: array<vec4<f32>>;

fn trace_note(note: u32) {
    traced[3].w = bitcast<f32>(bitcast<u32>(traced[3].w) | note);
}

fn trace_arrival(direction: vec3<f32>, pdf: f32, throughput: Spectrum, primitive: u32) {
    traced = array<vec4<f32>, TRACE_WORDS>();
    traced[0].w = bitcast<f32>(primitive);
    traced[2] = vec4<f32>(direction, pdf);
    traced[3] = vec4<f32>(throughput, bitcast<f32>(TRACED_VERTEX));
}

fn trace_surface(position: vec3<f32>, normal: vec3<f32>, material: u32) {
    traced[0] = vec4<f32>(position, traced[0].w);
    traced[1] = vec4<f32>(normal, bitcast<f32>(material));
}

// The vertex is within a medium.
fn trace_medium() {
    trace_note(TRACED_MEDIUM);
}

fn trace_found(contribution: Spectrum, weight: f32) {
    traced[4] = vec4<f32>(contribution, weight);
    trace_note(TRACED_FOUND);
}

fn trace_light(wi: vec3<f32>, pdf: f32, contribution: Spectrum, weight: f32, light: u32, bsdf_pdf: f32) {
    if all(contribution == BLACK) {
        return;
    }
    traced[5] = vec4<f32>(wi, pdf);
    traced[6] = vec4<f32>(contribution, weight);
    traced[7] = vec4<f32>(bitcast<f32>(light), bsdf_pdf, traced[7].zw);
    // With several light samples the last is kept.
    traced[3].w = bitcast<f32>(bitcast<u32>(traced[3].w) & ~TRACED_LIGHT_SEEN);
    trace_note(TRACED_LIGHT);
}

fn trace_sample(wi: vec3<f32>, pdf: f32, weight: Spectrum, eta_scale: f32, is_null: bool) {
    traced[8] = vec4<f32>(wi, pdf);
    traced[9] = vec4<f32>(weight, eta_scale);
    trace_note(TRACED_SAMPLE | select(0u, TRACED_NULL, is_null));
}

fn trace_roulette(survival: f32) {
    traced[7].z = survival;
    trace_note(TRACED_ROULETTE);
}

// The light sample written down last reaches its light, of which this share comes through.
fn trace_light_seen(share: Spectrum) {
    traced[6] = vec4<f32>(traced[6].xyz * share, traced[6].w);
    trace_note(TRACED_LIGHT_SEEN);
}

// Ends vertex number `vertex`.
fn store_trace(vertex: u32) {
    if vertex <= TRACED_VERTICES {
        for (var word = 0u; word < TRACE_WORDS; word++) {
            path_trace[(vertex - 1u) * TRACE_WORDS + word] = traced[word];
        }
    }
}
#else
fn trace_arrival(direction: vec3<f32>, pdf: f32, throughput: Spectrum, primitive: u32) {}

fn trace_surface(position: vec3<f32>, normal: vec3<f32>, material: u32) {}

fn trace_medium() {}

fn trace_found(contribution: Spectrum, weight: f32) {}

fn trace_light(wi: vec3<f32>, pdf: f32, contribution: Spectrum, weight: f32, light: u32, bsdf_pdf: f32) {}

fn trace_light_seen(share: Spectrum) {}

fn trace_sample(wi: vec3<f32>, pdf: f32, weight: Spectrum, eta_scale: f32, is_null: bool) {}

fn trace_roulette(survival: f32) {}

fn store_trace(vertex: u32) {}
#endif
