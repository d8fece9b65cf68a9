//! Small mathematics that several steps of the data's way share: colour, outward rounding, frames, what a dielectric reflects.

use glam::{BVec3, DAffine3, DVec3, Vec3};

use crate::spectrum::Spectrum;

/// Relative size of the error of a surface point that devices compute in f32: some 16 rounding errors (2⁻²⁴ each).
pub const POINT_ERROR: f64 = 1.0e-6;
/// Distance by which a shadow ray may be off to the side at its end, as a share of its length: rounding of its direction.
pub const DIRECTION_ERROR: f64 = 2.5e-7;
/// Share of its length after which a shadow ray ends, on top of the light's own error: one rounding error of its distance.
pub const SHADOW_SHORTENING: f64 = 0.999_999;

/// The corners of an upright box.
pub fn box_corners(low: DVec3, high: DVec3) -> [DVec3; 8] {
    std::array::from_fn(|index| DVec3::select(BVec3::new(index & 1 != 0, index & 2 != 0, index & 4 != 0), high, low))
}

/// Linear Rec.709 of CIE XYZ: the inverse of the primaries and the white of Rec. ITU-R BT.709.
pub fn xyz_to_rec709(xyz: DVec3) -> Spectrum {
    let [x, y, z] = xyz.to_array();
    Spectrum::new(
        3.240_969_941_904_521 * x - 1.537_383_177_570_093 * y - 0.498_610_760_293_003 * z,
        -0.969_243_636_280_87 * x + 1.875_967_501_507_72 * y + 0.041_555_057_407_175 * z,
        0.055_630_079_696_993 * x - 0.203_976_958_888_976 * y + 1.056_971_514_242_878 * z,
    )
}

/// The luminance of a film's pixel: [`Spectrum::luminance`] in single precision.
pub fn luminance_f32([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// The sRGB transfer function, from encoded to linear (IEC 61966-2-1), exact at both pieces.
pub fn srgb_to_linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((f64::from(encoded) + 0.055) / 1.055).powf(2.4) as f32 }
}

/// Decodes as [`srgb_to_linear`], in double precision.
pub fn srgb_to_linear_f64(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The number that a half-precision one is, by its bits; infinities and what is no number come out as numbers above the largest.
pub fn half_to_f32(bits: u16) -> f32 {
    let (sign, magnitude) = (if bits >> 15 == 0 { 1.0 } else { -1.0 }, u32::from(bits & 0x7fff));
    // Below the least normal number, steps are of 2⁻²⁴; above, the exponent's bias differs.
    let absolute =
        if magnitude < 0x400 { magnitude as f32 / 16_777_216.0 } else { f32::from_bits((magnitude << 13) + (112 << 23)) };
    sign * absolute
}

/// A box rounded to f32, and grown by two rounding errors on every side: it holds whatever the given one holds.
pub fn outward(min: DVec3, max: DVec3) -> (Vec3, Vec3) {
    let margin = min.abs().max(max.abs()) * 2.4e-7;
    ((min - margin).as_vec3(), (max + margin).as_vec3())
}

/// Share of unpolarised light that a dielectric boundary reflects. `cos_incident` is that of the angle with the normal on the
/// incident side, `eta` the index of refraction of the other side over the incident side's. Exactly 1 in total internal reflection.
pub fn dielectric_reflectance(cos_incident: f64, eta: f64) -> f64 {
    let sin_squared_transmitted = (1.0 - cos_incident * cos_incident) / (eta * eta);
    if sin_squared_transmitted >= 1.0 {
        return 1.0;
    }
    let cos_transmitted = (1.0 - sin_squared_transmitted).sqrt();
    let parallel = (eta * cos_incident - cos_transmitted) / (eta * cos_incident + cos_transmitted);
    let perpendicular = (cos_incident - eta * cos_transmitted) / (cos_incident + eta * cos_transmitted);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

/// A right-handed frame whose z axis is a given unit vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    pub tangent: DVec3,
    pub bitangent: DVec3,
    pub normal: DVec3,
}

impl Frame {
    /// The frame of Duff et al. (2017), "Building an Orthonormal Basis, Revisited". `normal` has unit length.
    ///
    /// The two halves of the construction meet at z = -0.2137 and not at z = 0, so that the many normals whose z is a zero of
    /// either sign, or rounds to one, give the same frame at every precision.
    pub fn around(normal: DVec3) -> Self {
        let sign = if normal.z < -0.2137 { -1.0 } else { 1.0 };
        let a = -1.0 / (sign + normal.z);
        let b = normal.x * normal.y * a;
        Self {
            tangent: DVec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
            bitangent: DVec3::new(b, sign + normal.y * normal.y * a, -normal.y),
            normal,
        }
    }

    /// About `normal`, x along what of `tangent` is perpendicular to it, of any length; as [`Frame::around`] where nothing is.
    pub fn along(normal: DVec3, tangent: DVec3) -> Self {
        match (tangent - normal * normal.dot(tangent)).try_normalize() {
            Some(tangent) => Self { tangent, bitangent: normal.cross(tangent), normal },
            None => Self::around(normal),
        }
    }

    /// From frame coordinates to the world.
    pub fn to_world(&self, local: DVec3) -> DVec3 {
        self.tangent * local.x + self.bitangent * local.y + self.normal * local.z
    }

    /// From the world to frame coordinates.
    pub fn to_local(&self, world: DVec3) -> DVec3 {
        DVec3::new(world.dot(self.tangent), world.dot(self.bitangent), world.dot(self.normal))
    }
}

/// Directions as places on the octahedron |x| + |y| + |z| = 1, the lower half of which is folded outward around the upper one; shaders find them
/// in `core/octahedron.wgsl`.
pub mod octahedron {
    use glam::DVec3;

    /// The place of a direction, in [−1, 1] × [−1, 1].
    pub fn place_of(direction: DVec3) -> [f64; 2] {
        let on = direction / (direction.x.abs() + direction.y.abs() + direction.z.abs());
        if on.z >= 0.0 { [on.x, on.y] } else { [over_edge(on.x, on.y), over_edge(on.y, on.x)] }
    }

    /// The direction at a place, of length 1.
    pub fn direction_at([x, y]: [f64; 2]) -> DVec3 {
        let z = 1.0 - x.abs() - y.abs();
        let [x, y] = if z >= 0.0 { [x, y] } else { [over_edge(x, y), over_edge(y, x)] };
        DVec3::new(x, y, z).normalize()
    }

    /// A coordinate on the other side of an edge of the square.
    fn over_edge(x: f64, y: f64) -> f64 {
        (1.0 - y.abs()).copysign(x)
    }
}

/// The map leads axes to axes: it scales along them and exchanges them alone.
pub fn is_upright(map: &DAffine3) -> bool {
    let is_axis = |axis: [f64; 3]| {
        let largest = axis.into_iter().map(f64::abs).fold(0.0, f64::max);
        axis.into_iter().filter(|part| part.abs() > 1e-9 * largest).count() == 1
    };
    map.matrix3.to_cols_array_2d().into_iter().all(is_axis)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn frames_are_orthonormal_and_right_handed(z in -1.0..=1.0_f64, phi in 0.0..6.3_f64) {
            let r = (1.0 - z * z).sqrt();
            let n = DVec3::new(r * phi.cos(), r * phi.sin(), z).normalize();
            let frame = Frame::around(n);
            let determinant = frame.tangent.cross(frame.bitangent).dot(frame.normal);
            prop_assert!((determinant - 1.0).abs() < 1e-14);
            prop_assert!(frame.tangent.dot(frame.bitangent).abs() < 1e-14);
            prop_assert!((frame.tangent.length() - 1.0).abs() < 1e-14);
            let v = DVec3::new(0.3, -2.0, 0.7);
            prop_assert!((frame.to_world(frame.to_local(v)) - v).length() < 1e-14);
        }
    }

    #[test]
    fn a_zero_of_either_sign_gives_the_same_frame() {
        let tiny = DVec3::new(0.6, 0.8, -1e-9);
        let (a, b) = (Frame::around(DVec3::new(0.6, 0.8, 0.0)), Frame::around(DVec3::new(0.6, 0.8, -0.0)));
        assert_eq!(a.to_world(DVec3::ONE), b.to_world(DVec3::ONE));
        assert!((Frame::around(tiny).tangent - a.tangent).length() < 1e-8);
    }
}
