// Colours looked up by uv.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/scene.wgsl
#import shading/texture/coordinates.wgsl
#import shading/texture/image.wgsl
#import shading/texture/noise.wgsl

// A texture takes five vec4 of the tables:
//   (kind and flags; first texel or seed; width or octaves; height), (scale, offset), (colour a), (colour b),
//   (cosine and sine of its rotation; first value of an image's integers; one more than the texture by which it is multiplied)
fn texture_word(texture: u32, word: u32) -> vec4<f32> {
    return tables[FIRST_TEXTURE_WORD + texture * TEXTURE_WORDS + word];
}

// True of textures looked up by the second texture coordinates, on triangles that have some.
fn lies_by_second_uvs(texture: u32) -> bool {
#if SECOND_UVS
    return (bitcast<u32>(texture_word(texture, 0u).x) & TEXTURE_BY_SECOND_UVS) != 0u;
#else
    return false;
#endif
}

// The directions of a normal map that is this texture follow the second texture coordinates.
fn bends_by_second_uvs(texture: u32) -> bool {
    return lies_by_second_uvs(texture) && (bitcast<u32>(texture_word(texture, 0u).x) & TEXTURE_BENDS_BY_FIRST_UVS) == 0u;
}

// Position at which a texture is looked up, in its own coordinates.
fn texture_place(texture: u32, coordinates: TextureCoordinates) -> vec2<f32> {
    let t1 = texture_word(texture, 1u);
#if SECOND_UVS
    let uv = select(coordinates.xy, coordinates.zw, lies_by_second_uvs(texture));
#else
    let uv = coordinates;
#endif
#if TEXTURE_ROTATION
    let turn = texture_word(texture, 4u).xy;
    let scaled = uv * t1.xy;
    return vec2<f32>(scaled.x * turn.x - scaled.y * turn.y, scaled.x * turn.y + scaled.y * turn.x) + t1.zw;
#else
    return uv * t1.xy + t1.zw;
#endif
}

// `texture` counts from the scene's first texture.
fn texture_color(texture: u32, uv: TextureCoordinates) -> Spectrum {
#if TEXTURE_PRODUCTS
    // One call for both: software drivers copy what is called to wherever it is called.
    var color = WHITE;
    var next = texture + 1u;
    for (var factors = 0u; factors < 2u && next != 0u; factors++) {
        color *= texture_color_at(next - 1u, texture_place(next - 1u, uv));
        next = bitcast<u32>(texture_word(next - 1u, 4u).w);
    }
    return color;
#else
    return texture_color_at(texture, texture_place(texture, uv));
#endif
}

fn texture_color_at(texture: u32, st: vec2<f32>) -> Spectrum {
    let t0 = bitcast<vec4<u32>>(texture_word(texture, 0u));
    var share = 0.0;
    switch t0.x & 255u {
#if IMAGES
        case TEXTURE_IMAGE: {
            return image_color(Image(t0.x, t0.y, vec2<i32>(t0.zw), bitcast<u32>(texture_word(texture, 4u).z)), st);
        }
#endif
#if CHECKERS
        case TEXTURE_CHECKER: {
            let parity = i32(floor(st.x)) + i32(floor(st.y));
            share = select(0.0, 1.0, (parity & 1) != 0);
        }
#endif
#if PERLIN
        case TEXTURE_PERLIN: {
            share = clamp(0.5 * (perlin_noise(st, t0.z, t0.y) + 1.0), 0.0, 1.0);
        }
#endif
#if WORLEY
        case TEXTURE_WORLEY: {
            share = worley_noise(st, t0.y);
        }
#endif
        default: {}
    }
#if PROCEDURAL_TEXTURES
    return mix(texture_word(texture, 2u).xyz, texture_word(texture, 3u).xyz, share);
#else
    return Spectrum(share);
#endif
}

#if BUMP_MAPS
// How a texture's luminance changes along u and v. A checker changes in steps alone, and bends no normals.
// src/texture/gradient.rs is the same in f64.
fn texture_gradient(texture: u32, uv: TextureCoordinates) -> vec2<f32> {
    let st = texture_place(texture, uv);
    let t0 = bitcast<vec4<u32>>(texture_word(texture, 0u));
    var slope = vec2<f32>(0.0);
    switch t0.x & 255u {
#if IMAGES
        case TEXTURE_IMAGE: {
            return turned_back(texture, image_gradient(Image(t0.x, t0.y, vec2<i32>(t0.zw), bitcast<u32>(texture_word(texture, 4u).z)), st));
        }
#endif
#if PERLIN
        case TEXTURE_PERLIN: {
            slope = 0.5 * perlin_gradient(st, t0.z, t0.y);
        }
#endif
#if WORLEY
        case TEXTURE_WORLEY: {
            slope = worley_gradient(st, t0.y);
        }
#endif
        default: {}
    }
    return turned_back(texture, (luminance(texture_word(texture, 3u).xyz) - luminance(texture_word(texture, 2u).xyz)) * slope);
}

// How what changes so in the texture itself changes along u and v.
fn turned_back(texture: u32, slope: vec2<f32>) -> vec2<f32> {
    let scale = texture_word(texture, 1u).xy;
#if TEXTURE_ROTATION
    let turn = texture_word(texture, 4u).xy;
    return scale * vec2<f32>(turn.x * slope.x + turn.y * slope.y, turn.x * slope.y - turn.y * slope.x);
#else
    return scale * slope;
#endif
}
#endif
