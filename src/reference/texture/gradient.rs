//! How textures change over a surface.

use glam::DVec2;

use super::look_up;
use crate::math::luminance;
use crate::scene::{Texture, TextureId, TextureKind};

/// Half the step over which the change of textures is measured that are no images.
const STEP: f64 = 1.0 / 1024.0;

/// How a texture's luminance changes along u and v. Of an image it is that of the bilinear interpolation between the four texels around; of
/// other textures a difference over a small step.
pub fn gradient(textures: &[Texture], id: TextureId, uv: DVec2) -> DVec2 {
    let texture = &textures[id];
    let (scale, size) = match &texture.kind {
        TextureKind::Image(image) => (image.scale, Some(DVec2::new(f64::from(image.image.width), f64::from(image.image.height)))),
        TextureKind::Checker { scale, .. } => (*scale, None),
        TextureKind::Perlin { scale, .. } | TextureKind::Worley { scale, .. } => ([*scale; 2], None),
    };
    let (scale, rotation) = (DVec2::from(scale), texture.transform.rotation());
    let st = texture.placed(uv * scale);
    let (low, high) = match size {
        Some(size) => {
            // From the middles of texels to the next ones; rows run down.
            let corner = (DVec2::new(st.x, 1.0 - st.y) * size - 0.5).floor();
            let place = |corner: DVec2| DVec2::new(corner.x / size.x, 1.0 - corner.y / size.y);
            (place(corner + 0.5), place(corner + 1.5))
        }
        None => (st - STEP, st + STEP),
    };
    // The texture as it lies in itself.
    let plain = Texture { transform: Default::default(), ..texture.clone() };
    let plain = std::slice::from_ref(&plain);
    let height = |at: DVec2| luminance(look_up(plain, 0, at / scale));
    let slope = DVec2::new(
        height(DVec2::new(high.x, st.y)) - height(DVec2::new(low.x, st.y)),
        height(DVec2::new(st.x, high.y)) - height(DVec2::new(st.x, low.y)),
    ) / (high - low);
    scale * (rotation.transpose() * slope)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;

    use super::*;
    use crate::scene::{ImageData, ImageTexture, TextureFilter, TextureWrap, UvTransform};

    /// Against differences of look-ups over steps that stay between the same texels.
    #[test]
    fn slopes_are_those_of_look_ups() {
        let texels: Vec<_> = (0..20).map(|index| Vec3::splat(((index * 7) % 11) as f32)).collect();
        let image = Arc::new(ImageData { width: 5, height: 4, texels: texels.into(), has_alpha: false });
        let (wrap, filter) = (TextureWrap::Repeat, TextureFilter::Bilinear);
        let kind = TextureKind::Image(ImageTexture { image, wrap, filter, scale: [2.0, -1.0] });
        let transform = UvTransform { rotation_degrees: 30.0, offset: [0.1, 0.2] };
        let textures = [Texture { transform, ..Texture::new("heights", kind) }];
        for uv in [[0.31, 0.22], [0.05, 0.91], [-0.4, 1.3], [0.77, 0.5]].map(DVec2::from) {
            let by_difference = [DVec2::X, DVec2::Y].map(|axis| {
                let at = |sign: f64| luminance(look_up(&textures, 0, uv + axis * sign * 1e-6));
                (at(1.0) - at(-1.0)) / 2e-6
            });
            let found = gradient(&textures, 0, uv);
            assert!((found - DVec2::from(by_difference)).length() < 1e-6 * found.length(), "{uv}: {found} {by_difference:?}");
        }
    }
}
