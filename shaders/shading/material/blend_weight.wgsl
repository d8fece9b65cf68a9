// The weights of a blend: one vec4 of the tables each,
//   (kind and flags; value, power or index of refraction; threshold; texture, axis or NONE)
#import core/layout.wgsl
#import core/math.wgsl
#import core/octahedron.wgsl
#import geometry/scene.wgsl
#import shading/texture/coordinates.wgsl
#import shading/material/seen.wgsl
#import shading/microfacet/fresnel.wgsl
#import shading/texture/texture.wgsl

fn blend_weight(index: u32, seen: Seen, uv: TextureCoordinates) -> f32 {
    let h = tables[FIRST_BLEND_WEIGHT_WORD + index];
    let flags = bitcast<u32>(h.x);
    let cosine = seen.cosine;
    var w = h.y;
    switch flags & 255u {
        case WEIGHT_FACING: {
            if HAS_WEIGHTS_BY_ANGLE {
                w = select(pow(cosine, h.y), 0.0, cosine <= 0.0);
            }
        }
        case WEIGHT_FRESNEL_SCHLICK: {
            if HAS_WEIGHTS_BY_ANGLE {
                let r = (h.y - 1.0) / (h.y + 1.0);
                let away = 1.0 - cosine;
                let away2 = away * away;
                w = 1.0 - mix(away2 * away2 * away, 1.0, r * r);
            }
        }
        case WEIGHT_FRESNEL_EXACT: {
            if HAS_WEIGHTS_BY_ANGLE {
                w = fresnel_dielectric(cosine, h.y).transmitted;
            }
        }
        case WEIGHT_FRONT: {
            if HAS_WEIGHTS_BY_SIDE {
                w = select(0.0, 1.0, seen.front);
            }
        }
        case WEIGHT_CAMERA: {
            if HAS_WEIGHTS_BY_VIEWER {
                w = select(0.0, 1.0, seen.by_camera);
            }
        }
        case WEIGHT_UP: {
#if WEIGHTS_BY_DIRECTION
            let along = dot(seen.normal, octahedron_direction(unpack2x16snorm(bitcast<u32>(h.w))));
            w = select(pow(along, h.y), 0.0, along <= 0.0);
#endif
        }
        case WEIGHT_TEXTURE, WEIGHT_CHANNEL: {
            if HAS_TEXTURES {
                let color = texture_color(bitcast<u32>(h.w), uv);
                w = select(luminance(color), h.y * color.x, (flags & 255u) == WEIGHT_CHANNEL);
            }
        }
        default: {}
    }
    w = clamp(w, 0.0, 1.0);
    w = select(w, 1.0 - w, (flags & REVERSED_WITHIN) != 0u);
    w = select(w, select(0.0, 1.0, w >= h.z), (flags & THRESHOLDED) != 0u);
    return select(w, 1.0 - w, (flags & REVERSED) != 0u);
}
