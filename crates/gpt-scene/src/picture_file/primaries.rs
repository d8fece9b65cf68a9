//! Colours of other primaries, as linear Rec. 709.

use glam::{DMat3, DVec2, DVec3};

/// Coordinates in CIE 1931 xy by which two points count as one: files round them.
const SAME: f64 = 1e-3;
/// Responses of cones to X, Y and Z (Lam 1985, "Metamerism and colour constancy", called Bradford), row by row.
const BRADFORD: [[f64; 3]; 3] = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

/// The red, green, blue and white of a picture, in CIE 1931 xy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Primaries {
    pub red: DVec2,
    pub green: DVec2,
    pub blue: DVec2,
    pub white: DVec2,
}

/// Primaries that have names: those of `colorInteropID`.
const NAMED: [(&str, Primaries); 7] = [
    ("rec709", Primaries::REC_709),
    ("ap0", Primaries::ACES_AP0),
    ("ap1", Primaries::new([0.713, 0.293], [0.165, 0.83], [0.128, 0.044], Primaries::ACES_WHITE)),
    ("p3d65", Primaries::new([0.68, 0.32], [0.265, 0.69], [0.15, 0.06], Primaries::D65)),
    ("rec2020", Primaries::new([0.708, 0.292], [0.17, 0.797], [0.131, 0.046], Primaries::D65)),
    ("adobergb", Primaries::new([0.64, 0.33], [0.21, 0.71], [0.15, 0.06], Primaries::D65)),
    ("ciexyzd65", Primaries::XYZ),
];

impl Primaries {
    const D65: [f64; 2] = [0.3127, 0.329];
    const ACES_WHITE: [f64; 2] = [0.32168, 0.33767];
    /// Rec. ITU-R BT.709, with D65.
    pub const REC_709: Self = Self::new([0.64, 0.33], [0.3, 0.6], [0.15, 0.06], Self::D65);
    /// SMPTE ST 2065-1, in which ACES containers are.
    pub const ACES_AP0: Self = Self::new([0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077], Self::ACES_WHITE);
    /// Channels that are X, Y and Z themselves.
    pub const XYZ: Self = Self::new([1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0 / 3.0, 1.0 / 3.0]);

    pub const fn new(
        [red_x, red_y]: [f64; 2],
        [green_x, green_y]: [f64; 2],
        [blue_x, blue_y]: [f64; 2],
        white: [f64; 2],
    ) -> Self {
        Self {
            red: DVec2::new(red_x, red_y),
            green: DVec2::new(green_x, green_y),
            blue: DVec2::new(blue_x, blue_y),
            white: DVec2::new(white[0], white[1]),
        }
    }

    pub fn named(name: &str) -> Option<Self> {
        NAMED.into_iter().find(|(known, _)| *known == name).map(|(_, primaries)| primaries)
    }

    /// X, Y and Z of a linear colour, of which white has Y = 1; None where the points span no colours.
    pub fn to_xyz(self) -> Option<DMat3> {
        let points = DMat3::from_cols(xyz(self.red), xyz(self.green), xyz(self.blue));
        if self.white.y <= 0.0 || points.determinant().abs() < 1e-6 {
            return None;
        }
        let amounts = points.inverse() * (xyz(self.white) / self.white.y);
        let matrix = points * DMat3::from_diagonal(amounts);
        (matrix.is_finite() && matrix.determinant().abs() > 1e-9).then_some(matrix)
    }

    /// The matrix that turns linear colours into those of Rec. 709, in which `neutral` becomes white, as OpenEXR's own reader of ACES pictures does;
    /// without one, the primaries' white. The outer None: the points span no colours; the inner one: these are Rec. 709's already.
    pub fn to_rec_709(self, neutral: Option<DVec2>) -> Option<Option<DMat3>> {
        let to_xyz = self.to_xyz()?;
        // Channels that are X, Y and Z have no white of their own: they say which colour a thing has.
        let own = if self.is_near(&Self::XYZ) { Self::REC_709.white } else { self.white };
        let neutral = neutral.unwrap_or(own);
        if self.is_near(&Self::REC_709) && is_near(neutral, Self::REC_709.white) {
            return Some(None);
        }
        let from_xyz = Self::REC_709.to_xyz()?.inverse();
        Some(Some(from_xyz * adaptation(neutral, Self::REC_709.white)? * to_xyz))
    }

    fn is_near(&self, other: &Self) -> bool {
        let pairs = [(self.red, other.red), (self.green, other.green), (self.blue, other.blue), (self.white, other.white)];
        pairs.into_iter().all(|(a, b)| is_near(a, b))
    }
}

fn is_near(a: DVec2, b: DVec2) -> bool {
    (a - b).abs().max_element() <= SAME
}

/// X, Y and Z with the sum 1.
fn xyz(point: DVec2) -> DVec3 {
    DVec3::new(point.x, point.y, 1.0 - point.x - point.y)
}

/// Turns what is seen under one white into what looks alike under another.
fn adaptation(from: DVec2, to: DVec2) -> Option<DMat3> {
    let cones = DMat3::from_cols_array_2d(&BRADFORD).transpose();
    if from.y <= 0.0 {
        return None;
    }
    if is_near(from, to) {
        return Some(DMat3::IDENTITY);
    }
    let [from, to] = [from, to].map(|white| cones * (xyz(white) / white.y));
    Some(cones.inverse() * DMat3::from_diagonal(to / from) * cones)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_primaries_become_what_is_published() {
        let of = |name: &str| Primaries::named(name).and_then(|primaries| primaries.to_rec_709(None));
        assert_eq!(of("rec709"), Some(None));
        // ITU-R BT.2087-0 (from BT.2020), and the ACES project's matrix from AP1, by their first rows.
        for (name, row) in [("rec2020", [1.6605, -0.5876, -0.0728]), ("ap1", [1.70505, -0.62179, -0.08326])] {
            let matrix = of(name).flatten().expect("a matrix").transpose();
            assert!((matrix.x_axis - DVec3::from(row)).abs().max_element() < 2e-4, "{name}: {matrix}");
        }
        // White stays white, whatever it is.
        for (name, primaries) in NAMED.into_iter().filter(|(name, _)| *name != "ciexyzd65") {
            let matrix = primaries.to_rec_709(None).expect("primaries").unwrap_or(DMat3::IDENTITY);
            assert!((matrix * DVec3::ONE - DVec3::ONE).abs().max_element() < 1e-3, "{name}");
        }
        // D65's X, Y and Z.
        let matrix = of("ciexyzd65").flatten().expect("a matrix");
        assert!((matrix * DVec3::new(0.95046, 1.0, 1.08906) - DVec3::ONE).abs().max_element() < 1e-3);
        let line = Primaries::new([0.1, 0.1], [0.2, 0.2], [0.3, 0.3], [0.3127, 0.329]);
        assert_eq!(line.to_rec_709(None), None);
    }
}
