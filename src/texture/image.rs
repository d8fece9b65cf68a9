//! Images, looked up by uv.

use glam::{DVec2, DVec4};

use crate::scene::{ImageData, ImageTexture, TextureFilter, TextureWrap};
use crate::spectrum::Spectrum;

/// Red, green, blue and alpha at `uv`. Texel centres are at half-integers; v points up, rows run down.
pub fn sample(texture: &ImageTexture, uv: DVec2) -> [f64; 4] {
    let image = &*texture.image;
    let position = DVec2::new(uv.x, 1.0 - uv.y) * DVec2::new(f64::from(image.width), f64::from(image.height));
    match texture.filter {
        TextureFilter::Nearest => texel(image, texture.wrap, position.floor()).to_array(),
        TextureFilter::Bilinear => {
            let low = (position - 0.5).floor();
            let fraction = position - 0.5 - low;
            let row = |y: f64| {
                let left = texel(image, texture.wrap, low + DVec2::new(0.0, y));
                left.lerp(texel(image, texture.wrap, low + DVec2::new(1.0, y)), fraction.x)
            };
            row(0.0).lerp(row(1.0), fraction.y).to_array()
        }
        TextureFilter::Triangle => {
            let low = (position - 0.5).floor();
            let fraction = position - 0.5 - low;
            let corner = |x: f64, y: f64| texel(image, texture.wrap, low + DVec2::new(x, y));
            let [first, second, third] = [corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)];
            let along = (second - first) * fraction.x + (third - first) * fraction.y;
            // Beyond the triangle the plane ends at the corners' colours.
            (first + along).clamp(first.min(second).min(third), first.max(second).max(third)).to_array()
        }
    }
}

/// How the luminance at `uv` changes with it: of the bilinear interpolation between the four texels around, or of the plane of a triangle.
pub fn luminance_gradient(texture: &ImageTexture, uv: DVec2) -> DVec2 {
    let image = &*texture.image;
    let size = DVec2::new(f64::from(image.width), f64::from(image.height));
    let position = DVec2::new(uv.x, 1.0 - uv.y) * size;
    let low = (position - 0.5).floor();
    let is_triangle = texture.filter == TextureFilter::Triangle;
    let fraction = if is_triangle { DVec2::ZERO } else { position - 0.5 - low };
    let height = |x: f64, y: f64| {
        let [red, green, blue, _] = texel(image, texture.wrap, low + DVec2::new(x, y)).to_array();
        Spectrum::new(red, green, blue).luminance()
    };
    let [h00, h10, h01, h11] = [height(0.0, 0.0), height(1.0, 0.0), height(0.0, 1.0), height(1.0, 1.0)];
    let right = (h10 - h00) + fraction.y * ((h11 - h01) - (h10 - h00));
    let down = (h01 - h00) + fraction.x * ((h11 - h10) - (h01 - h00));
    DVec2::new(right, -down) * size
}

fn texel(image: &ImageData, wrap: [TextureWrap; 2], position: DVec2) -> DVec4 {
    let x = wrapped(position.x, image.width, wrap[0]);
    let y = wrapped(position.y, image.height, wrap[1]);
    DVec4::from(image.texels.get(y * image.width as usize + x).map(f64::from))
}

/// An index in 0..size.
fn wrapped(index: f64, size: u32, wrap: TextureWrap) -> usize {
    // Far beyond any picture, the conversion saturates; NaN becomes 0.
    wrap.index(index as i64, size as usize)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{DVec3, Vec3};

    use super::*;
    use crate::scene::{Texture, TextureKind};
    use crate::texture::look_up;

    /// Red grows to the right: 0 1 2; green grows downward: 0 10.
    fn ramp(wrap: TextureWrap, filter: TextureFilter) -> ImageTexture {
        let texels: Vec<_> = (0..6).map(|i| Vec3::new((i % 3) as f32, (i / 3 * 10) as f32, 0.0)).collect();
        let image = Arc::new(ImageData { width: 3, height: 2, texels: texels.into(), has_alpha: false });
        ImageTexture { image, wrap: [wrap; 2], filter, scale: [1.0, 1.0] }
    }

    #[test]
    fn texel_centres_give_the_texels_and_midpoints_the_means() {
        let texture = ramp(TextureWrap::Clamp, TextureFilter::Bilinear);
        let at = |u: f64, v: f64| DVec4::from(sample(&texture, DVec2::new(u, v))).truncate();
        // v = 0 is the bottom row.
        assert!((at(0.5 / 3.0, 0.25) - DVec3::new(0.0, 10.0, 0.0)).length() < 1e-12);
        assert!((at(2.5 / 3.0, 0.75) - DVec3::new(2.0, 0.0, 0.0)).length() < 1e-12);
        assert!((at(1.0 / 3.0, 0.5) - DVec3::new(0.5, 5.0, 0.0)).length() < 1e-12);
        assert!((at(-9.0, 9.0) - DVec3::ZERO).length() < 1e-12);
    }

    #[test]
    fn wrapping_covers_every_integer() {
        let all = |wrap| (-4..7).map(|i| wrapped(f64::from(i), 3, wrap)).collect::<Vec<_>>();
        assert_eq!(all(TextureWrap::Repeat), [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0]);
        assert_eq!(all(TextureWrap::Mirror), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
        assert_eq!(all(TextureWrap::Clamp), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]);
        assert_eq!(wrapped(f64::INFINITY, 3, TextureWrap::Mirror), wrapped(i64::MAX as f64, 3, TextureWrap::Mirror));
        assert!(wrapped(f64::NAN, 3, TextureWrap::Repeat) < 3);
    }

    #[test]
    fn nearest_does_not_blend_and_scale_repeats() {
        let image = ramp(TextureWrap::Repeat, TextureFilter::Nearest);
        assert_eq!(sample(&image, DVec2::new(0.34, 0.9)), [1.0, 0.0, 0.0, 1.0]);
        let mut texture = Texture::new("ramp", TextureKind::Image(ImageTexture { scale: [2.0, 1.0], ..image }));
        texture.transform.offset = [0.5, 0.0];
        let at = |texture: &Texture, u: f64, v: f64| look_up(std::slice::from_ref(texture), 0, DVec2::new(u, v));
        assert_eq!(at(&texture, 0.6, 0.4), Spectrum::new(2.0, 10.0, 0.0));
        // A quarter turn from u to v: (0.3, 0.1) scaled is (0.6, 0.1), turned (-0.1, 0.6), and moved (0.4, 0.6).
        texture.transform.rotation_degrees = 90.0;
        assert_eq!(at(&texture, 0.3, 0.1), Spectrum::new(1.0, 0.0, 0.0));
    }
}
