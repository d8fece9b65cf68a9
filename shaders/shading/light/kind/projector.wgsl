// A projector: a point light that projects a rectangular picture.
#import core/layout.wgsl
#import shading/light/record.wgsl
#import shading/light/light_sample.wgsl
#import shading/texture/coordinates.wgsl
#import shading/texture/texture.wgsl
#import shading/light/projected_picture.wgsl

fn sample_projector_light(light: u32, reference: vec3<f32>, pmf: f32) -> LightSample {
    let word1 = light_word(light, 1u);
    let to_light = word1.xyz - reference;
    let distance2 = dot(to_light, to_light);
    let word2 = light_word(light, 2u);
    let distance = sqrt(distance2);
    let wi = to_light / distance;
    let cosine = -dot(wi, word2.xyz);
    if distance2 == 0.0 || cosine <= 0.0 {
        return no_light();
    }
    let word3 = light_word(light, 3u);
    let uv = 0.5 + word3.xy * picture_place(wi, word2.xyz, vec2<f32>(word3.z, word1.w));
    if any(uv < vec2<f32>(0.0)) || any(uv > vec2<f32>(1.0)) {
        return no_light();
    }
    // On the plane at distance 1 the light is 1 / cosine away and meets the plane at that cosine.
    var intensity = light_word(light, 4u).xyz / (cosine * cosine * cosine);
#if LIGHT_TEXTURES
    let texture = bitcast<u32>(word3.w);
    if texture != NONE {
        intensity *= texture_color(texture, only_coordinates(uv));
    }
#endif
    return LightSample(wi, distance * SHADOW_SHORTENING, intensity / (distance2 * pmf), -1.0);
}
