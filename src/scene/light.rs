//! Lights that are not surfaces, and the table of them.

use std::sync::Arc;

use glam::DVec3;

use super::check::{Check, image, is_amount, is_direction};
use super::texture::ImageData;

/// The table of lights: a row for each that is not a surface. From these rows every layer makes its list of modules and what chooses among
/// them, so a light is a row here and a file of its module's name wherever it is represented: `load/file/light` reads it,
/// `packed/light` packs it, `reference/lights` samples it in f64. On the device its kind is a case of `shaders/shading/light.wgsl`.
///
/// A row: variant of [`Light`], type of its data, module, and the switch that compiles its shader. Scene files call it as its module.
macro_rules! light_table {
    ($use:ident) => {
        $use! {
            // Radiance from outside the scene. Of their shaders one is compiled: the last whose switch is on, else the first.
            environment {
                Environment(Environment) environment "ENVIRONMENT_MAP",
                Sky(Sky) sky "SKY",
            }
            // From one point, one direction leads to each: only light sampling finds them.
            delta {
                Point(PointLight) point "POINT_LIGHTS",
                Spot(SpotLight) spot "SPOT_LIGHTS",
                Directional(DirectionalLight) directional "DIRECTIONAL_LIGHTS",
            }
        }
    };
}
pub(crate) use light_table;

/// What a scene needs to know of a light, whatever its kind.
trait SceneLight {
    /// What is wrong with it, in words.
    fn check(&self) -> Check;

    /// Moves it by an offset, with all of the scene.
    fn translate(&mut self, _offset: DVec3) {}

    /// Its picture, if it has one.
    fn image_mut(&mut self) -> Option<&mut Arc<ImageData>> {
        None
    }
}

/// Radiance that arrives from outside the scene.
#[derive(Debug, Clone)]
pub struct Environment {
    pub radiance: EnvironmentRadiance,
    /// Rotation about +Y, counter-clockwise seen from above.
    pub rotation_degrees: f64,
}

#[derive(Debug, Clone)]
pub enum EnvironmentRadiance {
    Constant(DVec3),
    /// Lat-long map: u = atan2(x, -z)/2π (mod 1), v = acos(y)/π from the top row, interpolated bilinearly; texels already multiplied by `scale`.
    Map(Arc<ImageData>),
}

impl SceneLight for Environment {
    fn check(&self) -> Check {
        placed(self.rotation_degrees.is_finite())?;
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
}

/// An environment: horizon + (zenith − horizon)·y over the upper half, y the direction's height, `ground` below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sky {
    pub zenith: DVec3,
    pub horizon: DVec3,
    pub ground: DVec3,
}

impl SceneLight for Sky {
    fn check(&self) -> Check {
        amounts(&[self.zenith, self.horizon, self.ground])
    }
}

/// Radiant intensity in W·sr⁻¹, the same in every direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointLight {
    pub position: DVec3,
    pub intensity: DVec3,
}

impl SceneLight for PointLight {
    fn check(&self) -> Check {
        placed(self.position.is_finite())?;
        amounts(&[self.intensity])
    }

    fn translate(&mut self, offset: DVec3) {
        self.position += offset;
    }
}

/// A point light cut to a cone: full `intensity` inside `falloff_degrees` of the axis, none past `angle_degrees`, between them
/// the smooth step t²(3 − 2t) in the cosine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpotLight {
    pub position: DVec3,
    pub direction: DVec3,
    pub intensity: DVec3,
    pub angle_degrees: f64,
    pub falloff_degrees: f64,
}

impl SceneLight for SpotLight {
    fn check(&self) -> Check {
        placed(self.position.is_finite() && is_direction(self.direction))?;
        let (falloff, angle) = (self.falloff_degrees, self.angle_degrees);
        if !(0.0 <= falloff && falloff <= angle && angle <= 180.0) {
            return Err(format!("its light falls off from {falloff} to {angle} degrees"));
        }
        amounts(&[self.intensity])
    }

    fn translate(&mut self, offset: DVec3) {
        self.position += offset;
    }
}

/// Parallel light; `irradiance` is on a surface facing it, `direction` the way the light travels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DirectionalLight {
    pub direction: DVec3,
    pub irradiance: DVec3,
}

impl SceneLight for DirectionalLight {
    fn check(&self) -> Check {
        placed(is_direction(self.direction))?;
        amounts(&[self.irradiance])
    }
}

macro_rules! lights {
    (environment { $($environment:ident($outside:ident) $environment_module:ident $_switch:literal,)* }
     delta { $($delta:ident($type:ident) $module:ident $_delta_switch:literal,)* }) => {
        /// A light that is not a surface.
        #[derive(Debug, Clone)]
        pub enum Light {
            $($environment($outside),)*
            $($delta($type),)*
        }

        impl Light {
            /// What scene files call its kind.
            pub fn kind_name(&self) -> &'static str {
                match self {
                    $(Self::$environment(_) => stringify!($environment_module),)*
                    $(Self::$delta(_) => stringify!($module),)*
                }
            }

            /// It is the radiance from outside the scene.
            pub fn is_environment(&self) -> bool {
                match self {
                    $(Self::$environment(_) => true,)*
                    $(Self::$delta(_) => false,)*
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

fn amounts(lights: &[DVec3]) -> Check {
    let possible = lights.iter().copied().all(is_amount);
    if possible { Ok(()) } else { Err("its light must be finite and not negative".to_owned()) }
}

fn placed(possible: bool) -> Check {
    if possible { Ok(()) } else { Err("its position must be finite and its direction of length 1".to_owned()) }
}

impl Light {
    /// What is wrong with it, in words.
    pub(super) fn check(&self) -> Check {
        self.model().check()
    }

    /// Moves it by an offset, with all of the scene.
    pub(super) fn translate(&mut self, offset: DVec3) {
        self.model_mut().translate(offset);
    }

    /// Its picture, if it has one.
    pub(super) fn image_mut(&mut self) -> Option<&mut Arc<ImageData>> {
        self.model_mut().image_mut()
    }
}
