//! Lights that are not surfaces, and the table of them.

mod model;
mod profile;
mod projected;

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3, DVec4};

use super::check::{Check, image, is_direction};
use super::image::ImageData;
use super::light_at::LightAt;
use super::texture::TextureId;
use crate::spectrum::Spectrum;
use model::{DeltaLight, SceneLight, amounts, placed, stands};
pub use model::{LightParameters, LightStrength};
pub use profile::{AimedProfile, LightProfile, MOST_ANGLES, ProfileFault, ProfileList};
pub use projected::{FALLOFF_LINEAR, FALLOFF_SQUARE, FalloffCurve, ProjectedTexture, Projector, SpotLight, picture_turn};

/// The table of lights: a row for each that is not a surface. From these rows every layer makes its list of modules and what chooses among
/// them, so a light is a row here, its parameters below, and a file of its module's name wherever it is represented: `load/file/light`
/// reads it, `reference/lights` samples it in f64, `shaders/shading/light` on the device.
///
/// A row: variant of [`Light`], type of its data, module, and the name of the switch that compiles its shader, which in shaders is also the
/// number of a delta light; then other switches that its shader needs. Scene files call it as its module.
#[doc(hidden)]
#[macro_export]
macro_rules! light_table {
    ($what:ident) => {
        $what! {
            // Radiance from outside the scene. Of their shaders one is compiled at most: what is the same from everywhere needs none.
            environment {
                Environment(Environment) environment ENVIRONMENT_MAP TEXELS,
                Sky(Sky) sky SKY,
            }
            // From one point, one direction leads to each: only light sampling finds them.
            delta {
                Point(PointLight) point POINT_LIGHT,
                Spot(SpotLight) spot SPOT_LIGHT,
                Projector(Projector) projector PROJECTOR_LIGHT,
                Directional(DirectionalLight) directional DIRECTIONAL_LIGHT,
            }
        }
    };
}
#[doc(hidden)]
pub use light_table;

/// Light from outside the scene.
trait OutsideLight {
    fn parameters(&self) -> OutsideParameters<'_>;
}

/// The light from outside the scene, as shaders read it.
#[derive(Debug, Clone, Copy)]
pub enum OutsideParameters<'a> {
    /// One radiance from all directions.
    Constant(Spectrum),
    /// Another one from each direction.
    Varying {
        /// Averaged over all directions; that of a map follows from the map.
        mean_luminance: f64,
        /// Texels that directions are drawn by as well.
        map: Option<(&'a ImageData, MapRows)>,
        /// Further words that its shader reads.
        words: [DVec4; 3],
    },
}

/// Radiance that arrives from outside the scene.
#[derive(Debug, Clone)]
pub struct Environment {
    pub radiance: EnvironmentRadiance,
    /// Rotation about +Y, counter-clockwise seen from above.
    pub rotation_degrees: f64,
    /// A rotation about any axis, after the one about +Y; [`Self::turn`] is free of its rounding.
    pub turn: Option<DMat3>,
    pub rows: MapRows,
    /// The columns of the map run the other way than its file has them.
    pub mirrored: bool,
}

/// The rows of a lat-long map between the poles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MapRows {
    /// The first and the last lie half a row within: each row covers as much of the angle.
    #[default]
    Inside,
    /// The first and the last lie on the poles, as in Mitsuba.
    ToPoles,
}

impl MapRows {
    /// The row at v is scale · v + offset; row 0 is the first.
    pub fn scale_and_offset(self, height: u32) -> (f64, f64) {
        match self {
            Self::Inside => (f64::from(height), -0.5),
            Self::ToPoles => (f64::from(height) - 1.0, 0.0),
        }
    }
}

#[derive(Debug, Clone)]
pub enum EnvironmentRadiance {
    Constant(Spectrum),
    /// Lat-long map: u = atan2(x, -z)/2π (mod 1), v = acos(y)/π from the top row, interpolated bilinearly; texels already multiplied by `scale`.
    Map(Arc<ImageData>),
}

/// Largest entry of M·Mᵀ − 1 up to which a matrix M counts as a rotation.
const ROTATION_TOLERANCE: f64 = 1e-6;

/// True of a matrix that turns and does nothing else, within the rounding of its numbers.
pub fn is_rotation(matrix: &DMat3) -> bool {
    let apart = *matrix * matrix.transpose() - DMat3::IDENTITY;
    let largest = apart.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
    matrix.is_finite() && largest <= ROTATION_TOLERANCE && matrix.determinant() > 0.0
}

impl Environment {
    /// The rotation from the map's space, which is turned about +Y already, to the world; None where it is the identity.
    pub fn turn(&self) -> Option<DMat3> {
        let turn = self.turn.filter(|turn| *turn != DMat3::IDENTITY)?;
        Some(DMat3::from_quat(DQuat::from_mat3(&turn).normalize()))
    }
}

impl SceneLight for Environment {
    fn set(&mut self, at: &LightAt) {
        if let (EnvironmentRadiance::Constant(radiance), Some(strength)) = (&mut self.radiance, at.strength) {
            *radiance = strength;
        }
        self.rotation_degrees = at.rotation_degrees.unwrap_or(self.rotation_degrees);
    }

    fn check(&self) -> Check {
        placed(self.rotation_degrees.is_finite())?;
        if self.turn.as_ref().is_some_and(|turn| !is_rotation(turn)) {
            return Err("its map is turned by a matrix that is no rotation".to_owned());
        }
        match &self.radiance {
            EnvironmentRadiance::Constant(radiance) => amounts(&[*radiance]),
            EnvironmentRadiance::Map(map) => image(map),
        }
    }

    fn image_mut(&mut self) -> Option<&mut Arc<ImageData>> {
        match &mut self.radiance {
            EnvironmentRadiance::Map(image) => Some(image),
            EnvironmentRadiance::Constant(_) => None,
        }
    }

    fn image(&self) -> Option<&ImageData> {
        match &self.radiance {
            EnvironmentRadiance::Map(image) => Some(image),
            EnvironmentRadiance::Constant(_) => None,
        }
    }
}

/// Words of a map: (the three axes of a map that is turned about any axis, or nothing; first, its rotation about +Y in turns).
impl OutsideLight for Environment {
    fn parameters(&self) -> OutsideParameters<'_> {
        match &self.radiance {
            EnvironmentRadiance::Constant(radiance) => OutsideParameters::Constant(*radiance),
            EnvironmentRadiance::Map(image) => {
                let turns = (self.rotation_degrees / 360.0).rem_euclid(1.0);
                let axes = self.turn().unwrap_or(DMat3::ZERO);
                let words = [axes.x_axis.extend(turns), axes.y_axis.extend(0.0), axes.z_axis.extend(0.0)];
                OutsideParameters::Varying { mean_luminance: 0.0, map: Some((image, self.rows)), words }
            }
        }
    }
}

/// An environment: horizon + (zenith − horizon)·y over the upper half, y the direction's height, `ground` below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sky {
    pub zenith: Spectrum,
    pub horizon: Spectrum,
    pub ground: Spectrum,
}

impl SceneLight for Sky {
    fn check(&self) -> Check {
        amounts(&[self.zenith, self.horizon, self.ground])
    }
}

/// Words: (radiance at the horizon; -), (at the zenith; the share of the upper half), (below; 1 over the integral of its luminance).
impl OutsideLight for Sky {
    fn parameters(&self) -> OutsideParameters<'_> {
        let (upper, lower) = (PI * (self.zenith.luminance() + self.horizon.luminance()), 2.0 * PI * self.ground.luminance());
        let integral = (upper + lower).max(f64::MIN_POSITIVE);
        OutsideParameters::Varying {
            mean_luminance: (upper + lower) / (4.0 * PI),
            map: None,
            words: [self.horizon.extend(0.0), self.zenith.extend(upper / integral), self.ground.extend(1.0 / integral)],
        }
    }
}

/// Radiant intensity in W·sr⁻¹, the same in every direction unless it has a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct PointLight {
    pub position: DVec3,
    /// With a profile, for each candela of it.
    pub intensity: Spectrum,
    pub profile: Option<AimedProfile>,
}

impl PointLight {
    /// The intensity averaged over all directions.
    pub fn mean_intensity(&self) -> Spectrum {
        let mean = |aimed: &AimedProfile| aimed.profile.integral(|_| 1.0, &[]) / (4.0 * PI);
        self.intensity * self.profile.as_ref().map_or(1.0, mean)
    }
}

impl SceneLight for PointLight {
    fn check(&self) -> Check {
        stands(self.position)?;
        if let Some(aimed) = &self.profile {
            placed(is_direction(aimed.nadir))?;
            aimed.check(self.intensity)?;
        }
        amounts(&[self.intensity])
    }

    fn translate(&mut self, offset: DVec3) {
        self.position += offset;
    }

    fn set(&mut self, at: &LightAt) {
        at.place(&mut self.position);
        self.intensity = at.strength.unwrap_or(self.intensity);
        if let Some(aimed) = &mut self.profile {
            at.take_along(&mut aimed.nadir);
            at.take_along(&mut aimed.front);
        }
    }

    fn profile(&self) -> Option<&AimedProfile> {
        self.profile.as_ref()
    }
}

impl DeltaLight for PointLight {
    fn parameters(&self) -> LightParameters {
        let power = 4.0 * PI * self.mean_intensity().luminance();
        let cone = self.profile.as_ref().and_then(AimedProfile::cone).map(|(axis, end)| (axis, [end; 2]));
        LightParameters { cone, ..LightParameters::new(LightStrength::Power(power), self.intensity, self.position) }
    }
}

/// Parallel light; `irradiance` is on a surface facing it, `direction` the way the light travels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DirectionalLight {
    pub direction: DVec3,
    pub irradiance: Spectrum,
}

impl SceneLight for DirectionalLight {
    fn check(&self) -> Check {
        placed(is_direction(self.direction))?;
        amounts(&[self.irradiance])
    }

    fn set(&mut self, at: &LightAt) {
        at.turn(&mut self.direction);
        self.irradiance = at.strength.unwrap_or(self.irradiance);
    }
}

/// Vectors: the direction to the light.
impl DeltaLight for DirectionalLight {
    fn parameters(&self) -> LightParameters {
        LightParameters {
            vectors: [-self.direction, DVec3::ZERO],
            ..LightParameters::new(LightStrength::Irradiance(self.irradiance.luminance()), self.irradiance, DVec3::ZERO)
        }
    }
}

macro_rules! lights {
    (environment { $($environment:ident($outside:ident) $environment_module:ident $switch:ident $($needed:ident)*,)* }
     delta { $($delta:ident($type:ident) $module:ident $delta_switch:ident $($delta_needed:ident)*,)* }) => {
        /// A light that is not a surface.
        #[derive(Debug, Clone)]
        pub enum Light {
            $($environment($outside),)*
            $($delta($type),)*
        }

        impl Light {
            /// The name of its kind in scene files.
            pub fn kind_name(&self) -> &'static str {
                match self {
                    $(Self::$environment(_) => stringify!($environment_module),)*
                    $(Self::$delta(_) => stringify!($module),)*
                }
            }

            /// True for the radiance from outside the scene.
            pub fn is_environment(&self) -> bool {
                match self {
                    $(Self::$environment(_) => true,)*
                    $(Self::$delta(_) => false,)*
                }
            }

            /// The parameters for samplers and shaders, if it is a delta light.
            pub fn delta(&self) -> Option<LightParameters> {
                match self {
                    $(Self::$environment(_) => None,)*
                    $(Self::$delta(light) => Some(light.parameters()),)*
                }
            }

            /// The parameters for shaders and the switch of its own shader, if it is light from outside the
            /// scene.
            pub fn outside(&self) -> Option<(OutsideParameters<'_>, &'static str)> {
                match self {
                    $(Self::$environment(light) => Some((light.parameters(), stringify!($switch))),)*
                    $(Self::$delta(_) => None,)*
                }
            }

            fn model(&self) -> &dyn SceneLight {
                match self {
                    $(Self::$environment(light) => light,)*
                    $(Self::$delta(light) => light,)*
                }
            }

            fn model_mut(&mut self) -> &mut dyn SceneLight {
                match self {
                    $(Self::$environment(light) => light,)*
                    $(Self::$delta(light) => light,)*
                }
            }
        }
    };
}
light_table!(lights);

impl Light {
    /// Checks its numbers; the error is the mistake, in words.
    pub(super) fn check(&self) -> Check {
        self.model().check()
    }

    /// Makes it what it is at a frame.
    pub(super) fn set(&mut self, at: &LightAt) {
        self.model_mut().set(at);
    }

    /// True if it gives the light that another does.
    pub(super) fn shines_as(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Environment(a), Self::Environment(b)) => {
                let same_radiance = match (&a.radiance, &b.radiance) {
                    (EnvironmentRadiance::Constant(a), EnvironmentRadiance::Constant(b)) => a == b,
                    (EnvironmentRadiance::Map(a), EnvironmentRadiance::Map(b)) => Arc::ptr_eq(a, b),
                    _ => false,
                };
                same_radiance && a.rotation_degrees == b.rotation_degrees && a.turn == b.turn && a.rows == b.rows
            }
            (Self::Sky(a), Self::Sky(b)) => a == b,
            _ => {
                let same_look = self.texture() == other.texture() && self.profile() == other.profile();
                self.delta().is_some() && self.delta() == other.delta() && same_look
            }
        }
    }

    /// Moves it by an offset, with all of the scene.
    pub(super) fn translate(&mut self, offset: DVec3) {
        self.model_mut().translate(offset);
    }

    /// Its picture, if it has one.
    pub(super) fn image_mut(&mut self) -> Option<&mut Arc<ImageData>> {
        self.model_mut().image_mut()
    }

    /// The texture that it projects, if it does.
    pub fn texture(&self) -> Option<TextureId> {
        self.model().texture()
    }

    /// Its picture, if it has one, to read.
    pub fn image(&self) -> Option<&ImageData> {
        self.model().image()
    }

    /// The profile by which its intensity differs from direction to direction, if it has one.
    pub fn profile(&self) -> Option<&AimedProfile> {
        self.model().profile()
    }
}
