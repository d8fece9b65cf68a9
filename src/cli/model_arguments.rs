//! How a model is shown that comes without camera and light.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use gpt::load::{ModelView, SceneSource, Up};

use super::exit::Failure;

/// The axis that points up, as it is typed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum UpName {
    /// The usual axis of OBJ files
    #[default]
    Y,
    /// The usual axis of CAD programs and scanners
    Z,
}

#[derive(Debug, Default, Args)]
#[command(next_help_heading = "A model without a scene (.obj, .ply)")]
pub struct ModelArguments {
    /// The axis of the model that points up
    #[arg(long, value_name = "AXIS", default_value = "y")]
    up: UpName,
    /// Degrees by which the model is turned about the vertical, counter-clockwise seen from above
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_degrees)]
    turn: f64,
    /// Degrees above the horizon from which the camera looks, -90 to 90 [default: 17.5]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, value_parser = parse_elevation)]
    elevation: Option<f64>,
    /// Material of the whole model: clay, white, plastic, ceramic, gold, copper, silver, aluminium, chrome, mirror, glass, frosted, or a .toml
    /// file whose last [[material]] is taken [default: the model's own]
    #[arg(long, value_name = "NAME|FILE")]
    material: Option<String>,
    /// Interpolate normals over the faces, even where the model has none
    #[arg(long)]
    smooth: bool,
    /// Leave out the ground
    #[arg(long)]
    no_ground: bool,
}

impl ModelArguments {
    /// The view that the arguments ask for.
    ///
    /// # Errors
    /// A usage error where something was said that a scene file decides.
    pub fn view(&self, source: &SceneSource, environment: Option<PathBuf>, size: Option<[u32; 2]>) -> Result<ModelView, Failure> {
        let view = ModelView {
            up: match self.up {
                UpName::Y => Up::Y,
                UpName::Z => Up::Z,
            },
            turn_degrees: self.turn,
            elevation_degrees: self.elevation,
            environment,
            material: self.material.clone(),
            smooth: self.smooth.then_some(true),
            no_ground: self.no_ground,
            size,
        };
        if view.is_for_models() && !source.is_model() {
            return Err(Failure::Usage {
                message:
                    "--up, --turn, --elevation, --material, --smooth and --no-ground are for models; a scene says these itself"
                        .to_owned(),
                help: Some("`gpt render model.obj … --save-scene scene.toml` makes a scene of a model, to go on with".to_owned()),
            });
        }
        Ok(view)
    }
}

fn parse_degrees(text: &str) -> Result<f64, String> {
    let degrees = text.parse().ok().filter(|degrees: &f64| degrees.abs() <= 36_000.0);
    degrees.ok_or_else(|| "expected an angle in degrees".to_owned())
}

fn parse_elevation(text: &str) -> Result<f64, String> {
    let degrees = text.parse().ok().filter(|degrees: &f64| degrees.abs() <= 90.0);
    degrees.ok_or_else(|| "expected an angle from -90 to 90 degrees".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_within_their_ranges() {
        assert_eq!((parse_degrees("-30"), parse_elevation("90")), (Ok(-30.0), Ok(90.0)));
        for bad in ["nan", "inf", "high", "1e9"] {
            assert!(parse_degrees(bad).is_err() && parse_elevation(bad).is_err(), "{bad}");
        }
        assert!(parse_elevation("90.5").is_err());
    }

    #[test]
    fn help_names_every_preset() {
        use clap::{Args as _, Command};
        let command = ModelArguments::augment_args(Command::new("gpt"));
        let argument = command.get_arguments().find(|argument| argument.get_id() == "material").expect("there is --material");
        let help = argument.get_help().expect("it has help").to_string();
        for name in gpt::load::preset_names() {
            assert!(help.contains(name), "{name}");
        }
    }
}
