// What the host tells a kernel beside the scene. Layouts are held against src/gpu/parameters.rs by a test.

// One pass: a run of consecutive pixels of the band, each with the same samples.
struct PassParameters {
    // First pixel of the pass, counted over the whole film (y * width + x), and counted within the band. Where pixels are listed:
    // of the band; and the first place in the list of the band's pixels.
    first_pixel: u32,
    first_pixel_in_band: u32,
    pixel_count: u32,
    // Absolute index of the pass's first sample, and how many samples each pixel gets.
    first_sample: u32,
    sample_count: u32,
    // Not 0 until each pixel of the band has its first samples: the film holds nothing yet.
    film_is_empty: u32,
    // Always 0. Adding it to a number's bits hides the number from the optimiser, which then cannot cancel terms.
    opaque_zero: u32,
    seed: u32,
    // Workgroups of one run, where workgroups are spread over runs.
    run_length: u32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
}

// Which vertex of its path a dispatch works on: 1 ends the camera's ray.
struct VertexParameters {
    vertex: u32,
    // Which half of the queues is read; the other is written.
    queue: u32,
    padding: vec2<u32>,
}

// The camera and what lies outside the scene.
struct View {
    position: vec4<f32>,
    // A ray through film position (x, y) goes along corner + x * step_x + y * step_y; orthographic: it starts there, relative to
    // the position.
    corner: vec4<f32>,
    step_x: vec4<f32>,
    step_y: vec4<f32>,
    // Viewing direction; the filter's radius in pixels.
    forward: vec4<f32>,
    // From the middle of the lens to the right, as long as the aperture's radius; distance of the plane in focus.
    lens_u: vec4<f32>,
    // Likewise upward; rotation of a polygon in turns.
    lens_v: vec4<f32>,
    // Radiance of a constant environment or at a sky's horizon; rotation of a map in turns.
    environment: vec4<f32>,
    // Radiance at a sky's zenith; share of the upper half in the sky's luminance.
    sky_zenith: vec4<f32>,
    // Radiance below the horizon; 1 over the integral of luminance over all directions.
    sky_ground: vec4<f32>,
    // Inverse cumulative distribution of the filter: coefficients of 1, s, s^2, s^3, piece by piece.
    filter_curve: array<vec4<f32>, 32>,
}

@group(0) @binding(0) var<uniform> pass_parameters: PassParameters;
@group(0) @binding(1) var<uniform> vertex_parameters: VertexParameters;
@group(0) @binding(2) var<uniform> sequence_points: array<vec4<u32>, SEQUENCE_POINTS>;
@group(0) @binding(3) var<uniform> view: View;
