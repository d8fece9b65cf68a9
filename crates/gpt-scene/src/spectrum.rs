//! Light, and what is multiplied with it.

use std::fmt;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Sub};

use glam::{DVec3, DVec4};

/// Linear Rec. 709 radiance, reflectance, throughput, transmittance, extinction and the like.
///
/// A type of its own keeps light apart from places and directions:
///
/// ```compile_fail
/// let direction = glam::DVec3::Y;
/// let lit = gpt_scene::spectrum::Spectrum::WHITE + direction;
/// ```
///
/// Light alone can be added:
///
/// ```
/// # use gpt_scene::spectrum::Spectrum;
/// assert_eq!(Spectrum::WHITE + Spectrum::new(0.0, 1.0, 2.0), Spectrum::new(1.0, 2.0, 3.0));
/// ```
#[derive(Clone, Copy, PartialEq, Default)]
pub struct Spectrum(DVec3);

impl Spectrum {
    /// No light.
    pub const BLACK: Self = Self(DVec3::ZERO);
    /// 1 in all channels.
    pub const WHITE: Self = Self(DVec3::ONE);

    /// A colour by its channels.
    #[inline]
    pub const fn new(red: f64, green: f64, blue: f64) -> Self {
        Self(DVec3::new(red, green, blue))
    }

    /// One value in all channels.
    #[inline]
    pub const fn grey(value: f64) -> Self {
        Self(DVec3::splat(value))
    }

    /// A colour by an array of its channels.
    #[inline]
    pub const fn from_rgb(rgb: [f64; 3]) -> Self {
        Self(DVec3::from_array(rgb))
    }

    /// A colour of a film or of a picture.
    #[inline]
    pub fn from_f32(rgb: [f32; 3]) -> Self {
        Self::from_rgb(rgb.map(f64::from))
    }

    /// The channels.
    #[inline]
    pub const fn to_rgb(self) -> [f64; 3] {
        self.0.to_array()
    }

    /// The channels as films and devices keep them.
    #[inline]
    pub fn to_f32(self) -> [f32; 3] {
        self.0.as_vec3().to_array()
    }

    /// The channels and a fourth number, as tables of devices have them.
    #[inline]
    pub fn extend(self, fourth: f64) -> DVec4 {
        self.0.extend(fourth)
    }

    /// The only way from a colour to a vector: texels of normal maps, directions and tristimulus values travel as colours.
    #[inline]
    pub const fn to_vector(self) -> DVec3 {
        self.0
    }

    /// The red channel, which is also the value of a grey.
    #[inline]
    pub const fn r(self) -> f64 {
        self.0.x
    }

    /// The green channel.
    #[inline]
    pub const fn g(self) -> f64 {
        self.0.y
    }

    /// The blue channel.
    #[inline]
    pub const fn b(self) -> f64 {
        self.0.z
    }

    /// The luminance by the weights of Rec. 709.
    #[inline]
    pub fn luminance(self) -> f64 {
        self.0.dot(DVec3::new(0.2126, 0.7152, 0.0722))
    }

    /// The largest channel.
    #[inline]
    pub fn max_component(self) -> f64 {
        self.0.max_element()
    }

    /// The smallest channel.
    #[inline]
    pub fn min_component(self) -> f64 {
        self.0.min_element()
    }

    /// The sum of the channels.
    #[inline]
    pub fn sum(self) -> f64 {
        self.0.element_sum()
    }

    /// The mean of the channels.
    #[inline]
    pub fn mean(self) -> f64 {
        self.sum() / 3.0
    }

    /// True if all channels are 0.
    #[inline]
    pub fn is_black(self) -> bool {
        self == Self::BLACK
    }

    /// True if no channel is infinite or NaN.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.0.is_finite()
    }

    /// The exponential of each channel.
    #[inline]
    pub fn exp(self) -> Self {
        Self(self.0.exp())
    }

    /// The square root of each channel.
    #[inline]
    pub fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    /// The smaller of two colours, channel by channel.
    #[inline]
    pub fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }

    /// The larger of two colours, channel by channel.
    #[inline]
    pub fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    /// Each channel limited to those of two colours.
    #[inline]
    pub fn clamp(self, least: Self, most: Self) -> Self {
        Self(self.0.clamp(least.0, most.0))
    }

    /// Linear interpolation: this colour at 0, the other at 1.
    #[inline]
    pub fn lerp(self, other: Self, share: f64) -> Self {
        Self(self.0.lerp(other.0, share))
    }

    /// A function of each channel.
    #[inline]
    pub fn map(self, function: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(function))
    }

    /// The Euclidean distance to another colour.
    #[inline]
    pub fn distance(self, other: Self) -> f64 {
        self.0.distance(other.0)
    }
}

/// Prints as the vector that it holds, so that the digests of scenes, which are made of this text, stay what they were.
impl fmt::Debug for Spectrum {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        fmt::Debug::fmt(&self.0, formatter)
    }
}

impl fmt::Display for Spectrum {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        fmt::Display::fmt(&self.0, formatter)
    }
}

/// Implements operators with a colour on the left by those of the vector.
macro_rules! operators {
    ($($operator:ident $operation:ident $right:ty, |$other:ident| $vector:expr;)*) => {
        $(impl $operator<$right> for Spectrum {
            type Output = Self;

            #[inline]
            fn $operation(self, $other: $right) -> Self {
                Self(self.0.$operation($vector))
            }
        })*
    };
}

/// Implements the operators that change their left side.
macro_rules! assigning_operators {
    ($($operator:ident $operation:ident $right:ty, |$other:ident| $vector:expr;)*) => {
        $(impl $operator<$right> for Spectrum {
            #[inline]
            fn $operation(&mut self, $other: $right) {
                self.0.$operation($vector);
            }
        })*
    };
}

operators! {
    Add add Spectrum, |other| other.0;
    Sub sub Spectrum, |other| other.0;
    Mul mul Spectrum, |other| other.0;
    Mul mul f64, |factor| factor;
    Div div Spectrum, |other| other.0;
    Div div f64, |divisor| divisor;
}

assigning_operators! {
    AddAssign add_assign Spectrum, |other| other.0;
    MulAssign mul_assign Spectrum, |other| other.0;
    MulAssign mul_assign f64, |factor| factor;
    DivAssign div_assign f64, |divisor| divisor;
}

impl Mul<Spectrum> for f64 {
    type Output = Spectrum;

    #[inline]
    fn mul(self, color: Spectrum) -> Spectrum {
        Spectrum(self * color.0)
    }
}

impl Sum for Spectrum {
    fn sum<I: Iterator<Item = Self>>(colors: I) -> Self {
        Self(colors.map(|color| color.0).sum())
    }
}
