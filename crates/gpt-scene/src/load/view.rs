//! How a model is shown that comes without camera, light and ground.

use std::path::PathBuf;

/// The view of a model; by default a three-quarter view on a grey ground.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ModelView {
    /// The axis of the model's file that points up.
    pub up: Up,
    /// Degrees by which the model is turned about the vertical, counter-clockwise seen from above.
    pub turn_degrees: f64,
    /// Degrees above the horizon from which the camera looks, -90 to 90.
    pub elevation_degrees: Option<f64>,
    /// A lat-long map that lights the scene in place of what does otherwise.
    pub environment: Option<PathBuf>,
    /// The name of a preset, or a `.toml` file whose last material is taken, for the whole model.
    pub material: Option<String>,
    /// Interpolation of normals; None: the file decides.
    pub smooth: Option<bool>,
    pub no_ground: bool,
    /// Width and height of the picture, if it is not the default one: the model fills it.
    pub size: Option<[u32; 2]>,
}

impl ModelView {
    /// Something is said that only models have.
    pub fn is_for_models(&self) -> bool {
        *self != Self { environment: self.environment.clone(), size: self.size, ..Self::default() }
    }
}

/// The axis that points up.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Up {
    #[default]
    Y,
    Z,
}
