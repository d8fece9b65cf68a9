//! The media that a ray is in, within the surfaces that enclose them, and what they leave of light.

use glam::DVec3;

use super::intersect::Surface;
use crate::scene::media::FARTHEST;
use crate::scene::{Filling, Media};
use crate::spectrum::Spectrum;

/// The numbers of the media that a ray is in, the innermost first: the one that was entered last. 0 stands for none. A fifth one within the others
/// makes the outermost forgotten, as on devices, where a number has 16 bits of two words.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MediumStack([usize; 4]);

impl MediumStack {
    /// Around the camera.
    pub fn around(medium: usize) -> Self {
        Self([medium, 0, 0, 0])
    }

    pub fn innermost(self) -> usize {
        self.0[0]
    }

    fn enter(self, medium: usize) -> Self {
        let [first, second, third, _] = self.0;
        Self([medium, first, second, third])
    }

    /// Takes out a medium at its innermost place; those around it move inwards. Media that a ray began in are on no stack.
    fn leave(self, medium: usize) -> Self {
        let mut numbers = self.0;
        if let Some(place) = numbers.iter().position(|&number| number == medium) {
            numbers.copy_within(place + 1.., place);
            numbers[3] = 0;
        }
        Self(numbers)
    }

    /// The media on the side of a surface that `toward` points to, given those on wo's side, which is the front or not.
    pub fn towards(self, media: &Media, surface: &Surface, front: bool, toward: DVec3) -> Self {
        let inside = media.behind(surface.owner.material);
        let leads_to_front = toward.dot(surface.point.normal) > 0.0;
        match (inside, leads_to_front == front, front) {
            (0, _, _) | (_, true, _) => self,
            (_, false, true) => self.enter(inside),
            (_, false, false) => self.leave(inside),
        }
    }
}

/// Beer and Lambert's law: the share of light that is left after a distance.
pub fn left(extinction: Spectrum, distance: f64) -> Spectrum {
    if extinction.is_black() {
        return Spectrum::WHITE;
    }
    (extinction * -distance.min(FARTHEST)).exp()
}

/// The light that a medium gives off along a ray, as it arrives at the ray's origin: ∫ emission · exp(−extinction · t) dt.
pub fn given_off(filling: &Filling, distance: f64) -> Spectrum {
    let distance = distance.min(FARTHEST);
    let of_channel = |emission: f64, extinction: f64| {
        let depth = extinction * distance;
        emission * if depth < 1e-9 { distance } else { -(-depth).exp_m1() / extinction }
    };
    let [emission, extinction] = [filling.emission, filling.extinction].map(Spectrum::to_rgb);
    Spectrum::from_rgb(std::array::from_fn(|channel| of_channel(emission[channel], extinction[channel])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Attenuation;

    #[test]
    fn light_is_left_as_the_colour_says() {
        let amber = Attenuation { color: Spectrum::new(1.0, 0.5, 0.0), distance: 2.0 };
        let once = left(amber.extinction(), 2.0);
        assert!(once.distance(Spectrum::new(1.0, 0.5, 1e-6)) < 1e-12, "{once}");
        let twice = left(amber.extinction(), 4.0);
        assert!(twice.distance(once * once) < 1e-12, "{twice}");
        assert_eq!(left(amber.extinction(), f64::INFINITY), Spectrum::new(1.0, 0.0, 0.0));
        assert_eq!(left(Spectrum::BLACK, 4.0), Spectrum::WHITE);
    }

    /// A medium that is left makes way for the one around it, and one that ends within another takes itself out.
    #[test]
    fn media_nest() {
        let within = MediumStack::default().enter(1).enter(2);
        assert_eq!(within.innermost(), 2);
        assert_eq!(within.leave(2).innermost(), 1);
        assert_eq!(within.leave(1), MediumStack::default().enter(2));
        assert_eq!(within.leave(3), within);
        assert_eq!(within.leave(1).leave(2), MediumStack::default());
        let five = within.enter(3).enter(4).enter(5);
        assert_eq!(five.leave(5).leave(4).leave(3).leave(2).innermost(), 0);
    }
}
