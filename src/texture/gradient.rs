//! How textures change over a surface.

use glam::DVec2;

use super::{Coordinates, image, perlin, worley};
use crate::scene::{Texture, TextureId, TextureKind};
use crate::spectrum::Spectrum;

/// How a texture's luminance changes along u and v. A checker changes in steps alone, and bends no normals.
pub fn gradient(textures: &[Texture], id: TextureId, uv: impl Into<Coordinates>) -> DVec2 {
    let texture = &textures[id];
    let uv = uv.into().of(texture);
    let at = |scale: [f64; 2]| texture.placed(uv * DVec2::from(scale));
    let between = |a: Spectrum, b: Spectrum| b.luminance() - a.luminance();
    let (scale, slope) = match texture.kind {
        TextureKind::Image(ref image) => (image.scale, image::luminance_gradient(image, at(image.scale))),
        TextureKind::Checker { scale, .. } => (scale, DVec2::ZERO),
        TextureKind::Perlin { scale, octaves, a, b, seed } => {
            ([scale; 2], between(a, b) * perlin::gradient(at([scale; 2]), octaves, seed))
        }
        TextureKind::Worley { scale, a, b, seed } => ([scale; 2], between(a, b) * worley::gradient(at([scale; 2]), seed)),
    };
    DVec2::from(scale) * (texture.transform.rotation().transpose() * slope)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;

    use super::*;
    use crate::scene::{ImageData, ImageTexture, TextureFilter, TextureWrap, UvTransform};
    use crate::texture::look_up;

    /// Against differences of look-ups over steps that stay between the same texels.
    #[test]
    fn slopes_are_those_of_look_ups() {
        let texels: Vec<_> = (0..20).map(|index| Vec3::splat(((index * 7) % 11) as f32)).collect();
        let image = Arc::new(ImageData { width: 5, height: 4, texels: texels.into(), has_alpha: false });
        let image = |filter| ImageTexture { image: image.clone(), wrap: [TextureWrap::Repeat; 2], filter, scale: [2.0, -1.0] };
        let (a, b) = (Spectrum::new(0.1, 0.2, 0.0), Spectrum::new(0.9, 0.4, 3.0));
        let kinds = [
            TextureKind::Image(image(TextureFilter::Bilinear)),
            TextureKind::Image(image(TextureFilter::Triangle)),
            TextureKind::Perlin { scale: 3.0, octaves: 5, a, b, seed: 4 },
            TextureKind::Worley { scale: 2.5, a, b, seed: 4 },
            TextureKind::Checker { a, b, scale: [2.0, 3.0] },
        ];
        let transform = UvTransform { rotation_degrees: 30.0, offset: [0.1, 0.2] };
        for kind in kinds {
            let textures = [Texture { transform, ..Texture::new("heights", kind) }];
            check(&textures);
        }
    }

    fn check(textures: &[Texture]) {
        for uv in [[0.31, 0.22], [0.05, 0.91], [-0.4, 1.3], [0.77, 0.5]].map(DVec2::from) {
            let by_difference = [DVec2::X, DVec2::Y].map(|axis| {
                let at = |sign: f64| look_up(textures, 0, uv + axis * sign * 1e-6).luminance();
                (at(1.0) - at(-1.0)) / 2e-6
            });
            let found = gradient(textures, 0, uv);
            let apart = (found - DVec2::from(by_difference)).length();
            assert!(apart <= 1e-6 * found.length(), "{:?} at {uv}: {found} {by_difference:?}", textures[0].kind);
        }
    }
}
