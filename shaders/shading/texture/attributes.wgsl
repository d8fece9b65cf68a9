// The attributes of a primitive at a point of it.
#import core/layout.wgsl
#import geometry/records.wgsl
#import shading/texture/coordinates.wgsl
#import geometry/shape_point.wgsl
#import geometry/instance.wgsl
#import geometry/motion.wgsl

struct Attribute {
    // Not normalised after interpolation; 0 if there is none.
    normal: vec3<f32>,
    uv: vec2<f32>,
}

fn interpolate_attributes(first: u32, weights: vec2<f32>) -> Attribute {
    let words = attribute_words(first);
    let a0 = words.w0;
    let a1 = words.w1;
    let a2 = words.w2;
    let a3 = words.w3;
    let w = 1.0 - weights.x - weights.y;
    var normals = array<vec3<f32>, 3>(a0.xyz, a1.xyz, a2.xyz);
#if MOTION
    let moving = bitcast<u32>(a3.w);
    if moving != NONE {
        let motion = motion_at_path_time(moving);
        for (var corner = 0u; corner < 3u; corner++) {
            normals[corner] = moved_unit_normal(motion, normals[corner]);
        }
    }
#endif
    return Attribute(
        w * normals[0] + weights.x * normals[1] + weights.y * normals[2],
        w * vec2<f32>(a0.w, a1.w) + weights.x * vec2<f32>(a2.w, a3.x) + weights.y * a3.yz
    );
}

// Second texture coordinates of a triangle, which stand behind the first ones.
fn second_uv(first: u32, weights: vec2<f32>) -> vec2<f32> {
    let words = attribute_words(first + 1u);
    let w = 1.0 - weights.x - weights.y;
    return w * vec2<f32>(words.w0.w, words.w1.w) + weights.x * vec2<f32>(words.w2.w, words.w3.x) + weights.y * words.w3.yz;
}

// The coordinates for textures at a point of a primitive whose first coordinates there are `uv`; triangles
// may have second ones.
fn texture_coordinates(kind: u32, first: u32, uv: vec2<f32>, weights: vec2<f32>) -> TextureCoordinates {
    if HAS_SECOND_UVS && first != NONE && kind == KIND_TRIANGLE {
        return vec4<f32>(uv, second_uv(first, weights));
    }
    return only_coordinates(uv);
}

// The tangents by the linear map from texture coordinates at the corners to the edges.
fn edge_tangents(first: u32, edge_u: vec3<f32>, edge_v: vec3<f32>) -> Tangents {
    let words = attribute_words(first);
    let uv0 = vec2<f32>(words.w0.w, words.w1.w);
    let du = vec2<f32>(words.w2.w, words.w3.x) - uv0;
    let dv = words.w3.yz - uv0;
    // Only directions matter, so the determinant's sign is enough.
    let orientation = sign(du.x * dv.y - du.y * dv.x);
    return Tangents((edge_u * dv.y - edge_v * du.y) * orientation, (edge_v * du.x - edge_u * dv.x) * orientation);
}

// The attributes of a primitive of an instance.
fn interpolate_in_instance(placement: Placement, first: u32, weights: vec2<f32>) -> Attribute {
    let words = attribute_words(first);
    let w = 1.0 - weights.x - weights.y;
    return Attribute(
        w * placed_normal(placement, words.w0.xyz) + weights.x * placed_normal(placement, words.w1.xyz)
            + weights.y * placed_normal(placement, words.w2.xyz),
        w * vec2<f32>(words.w0.w, words.w1.w) + weights.x * vec2<f32>(words.w2.w, words.w3.x) + weights.y * words.w3.yz
    );
}

// The area that the edges span in texture coordinates; 1 if they span none.
fn attribute_uv_area(first: u32) -> f32 {
    let words = attribute_words(first);
    let uv0 = vec2<f32>(words.w0.w, words.w1.w);
    let du = vec2<f32>(words.w2.w, words.w3.x) - uv0;
    let dv = words.w3.yz - uv0;
    let area = abs(du.x * dv.y - du.y * dv.x);
    return select(area, 1.0, area == 0.0);
}
