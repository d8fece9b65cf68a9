//! Media that absorb light and scatter none, within the surfaces that enclose them.

use glam::DVec3;

use super::intersect::Surface;
use crate::scene::Media;
use crate::scene::medium::FARTHEST;
use crate::spectrum::Spectrum;

/// The numbers of the media that a ray is in, the innermost first: the one that was entered last. 0 stands for none. A fifth one within the others
/// makes the outermost forgotten, as on devices, where a number has 16 bits of two words.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MediumStack([usize; 4]);

impl MediumStack {
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

/// Beer and Lambert's law: the share of light that is left after a distance within a medium.
pub fn transmittance(media: &Media, medium: usize, distance: f64) -> Spectrum {
    let extinction = media.extinction(medium);
    if extinction.is_black() {
        return Spectrum::WHITE;
    }
    (extinction * -distance.min(FARTHEST)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Attenuation;

    #[test]
    fn light_is_left_as_the_colour_says() {
        let amber = Attenuation { color: Spectrum::new(1.0, 0.5, 0.0), distance: 2.0 };
        let mut media = Media::default();
        media.extinctions.push(amber.extinction());
        let left = transmittance(&media, 1, 2.0);
        assert!(left.distance(Spectrum::new(1.0, 0.5, 1e-6)) < 1e-12, "{left}");
        let twice = transmittance(&media, 1, 4.0);
        assert!(twice.distance(left * left) < 1e-12, "{twice}");
        assert_eq!(transmittance(&media, 1, f64::INFINITY), Spectrum::new(1.0, 0.0, 0.0));
        assert_eq!(transmittance(&media, 0, 4.0), Spectrum::WHITE);
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
