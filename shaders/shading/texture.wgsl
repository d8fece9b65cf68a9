// Colours looked up by uv.
#import geometry/scene.wgsl

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

// `texture` counts from the plan's first texture; v = 0 is the bottom row.
fn texture_color(texture: u32, uv: vec2<f32>) -> vec3<f32> {
    let t0 = bitcast<vec4<u32>>(tables[FIRST_TEXTURE_WORD + texture * 2u]);
    let t1 = tables[FIRST_TEXTURE_WORD + texture * 2u + 1u];
    let size = vec2<i32>(t0.yz);
    let wrap = t0.w & 3u;
    let st = uv * t1.xy + t1.zw;
    let position = vec2<f32>(st.x, 1.0 - st.y) * vec2<f32>(size);
    if (t0.w & 4u) != 0u {
        let nearest = vec2<i32>(floor(position));
        return texel(t0.x, wrapped_texel(nearest.x, size.x, wrap), wrapped_texel(nearest.y, size.y, wrap), size.x);
    }
    let corner = floor(position - 0.5);
    let blend = position - 0.5 - corner;
    let x0 = wrapped_texel(i32(corner.x), size.x, wrap);
    let x1 = wrapped_texel(i32(corner.x) + 1, size.x, wrap);
    let y0 = wrapped_texel(i32(corner.y), size.y, wrap);
    let y1 = wrapped_texel(i32(corner.y) + 1, size.y, wrap);
    let upper = mix(texel(t0.x, x0, y0, size.x), texel(t0.x, x1, y0, size.x), blend.x);
    let lower = mix(texel(t0.x, x0, y1, size.x), texel(t0.x, x1, y1, size.x), blend.x);
    return mix(upper, lower, blend.y);
}
