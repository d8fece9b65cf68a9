// Colours looked up by uv.
#import core/layout.wgsl
#import geometry/scene.wgsl
#if PERLIN
#import shading/noise.wgsl
#endif
#if WORLEY
#import shading/noise.wgsl
#endif

// A texture takes four vec4 of the tables:
//   (kind and flags; first texel or seed; width or octaves; height), (scale, offset), (colour a), (colour b)
fn texture_word(texture: u32, word: u32) -> vec4<f32> {
    return tables[FIRST_TEXTURE_WORD + texture * TEXTURE_WORDS + word];
}

#if IMAGES

fn wrapped_texel(index: i32, size: i32, wrap: u32) -> i32 {
    switch wrap {
        // Clamp.
        case 1u: { return clamp(index, 0, size - 1); }
        // Mirror.
        case 2u: {
            let period = 2 * size;
            let folded = ((index % period) + period) % period;
            return select(folded, period - 1 - folded, folded >= size);
        }
        // Repeat.
        default: { return ((index % size) + size) % size; }
    }
}

fn texel(first: u32, x: i32, y: i32, width: i32) -> vec3<f32> {
    let index = first + 3u * u32(y * width + x);
    return vec3<f32>(texels[index], texels[index + 1u], texels[index + 2u]);
}

// v = 0 is the bottom row.
fn image_color(t0: vec4<u32>, st: vec2<f32>) -> vec3<f32> {
    let size = vec2<i32>(t0.zw);
    let first = t0.y;
    let wrap = (t0.x >> 8u) & 3u;
    let position = vec2<f32>(st.x, 1.0 - st.y) * vec2<f32>(size);
    if (t0.x & 1024u) != 0u {
        let nearest = vec2<i32>(floor(position));
        return texel(first, wrapped_texel(nearest.x, size.x, wrap), wrapped_texel(nearest.y, size.y, wrap), size.x);
    }
    let corner = floor(position - 0.5);
    let blend = position - 0.5 - corner;
    let x0 = wrapped_texel(i32(corner.x), size.x, wrap);
    let x1 = wrapped_texel(i32(corner.x) + 1, size.x, wrap);
    let y0 = wrapped_texel(i32(corner.y), size.y, wrap);
    let y1 = wrapped_texel(i32(corner.y) + 1, size.y, wrap);
    let upper = mix(texel(first, x0, y0, size.x), texel(first, x1, y0, size.x), blend.x);
    let lower = mix(texel(first, x0, y1, size.x), texel(first, x1, y1, size.x), blend.x);
    return mix(upper, lower, blend.y);
}
#endif

// `texture` counts from the scene's first texture.
fn texture_color(texture: u32, uv: vec2<f32>) -> vec3<f32> {
    let t0 = bitcast<vec4<u32>>(texture_word(texture, 0u));
    let t1 = texture_word(texture, 1u);
    let st = uv * t1.xy + t1.zw;
    var share = 0.0;
    switch t0.x & 255u {
#if IMAGES
        case TEXTURE_IMAGE: {
            return image_color(t0, st);
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
    return vec3<f32>(share);
#endif
}
