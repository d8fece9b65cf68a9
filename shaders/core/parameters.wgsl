// Parameters of a kernel beside the scene (src/plan/parameters.rs, src/packed/view.rs).
#import core/layout.wgsl

@group(0) @binding(BINDING_PASS) var<uniform> pass_parameters: PassParameters;
@group(0) @binding(BINDING_VERTEX) var<uniform> vertex_parameters: VertexParameters;
@group(0) @binding(BINDING_SEQUENCE) var<uniform> sequence_points: array<vec4<u32>, SEQUENCE_POINTS>;
@group(0) @binding(BINDING_VIEW) var<uniform> view: View;
