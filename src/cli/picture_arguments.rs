//! Arguments that decide how picture files show a render.

use clap::Args;
use gpt::film::Layer;
use gpt::output::{Display, Exposure, ExrCompression, ExrForm, ExrOptions, ToneCurve};

use super::choice::by_name;

/// How previews show radiance.
#[derive(Debug, Args)]
pub struct DisplayArguments {
    /// Stops by which previews are brightened, or auto: their geometric mean becomes middle grey
    #[arg(long, value_name = "EV|auto", default_value = "0", allow_negative_numbers = true, value_parser = parse_exposure)]
    pub exposure: Exposure,
    /// How previews bring bright colours into the range of a screen
    #[arg(long, value_name = "CURVE", default_value = "agx", value_parser = by_name::<ToneCurve>())]
    pub tonemap: ToneCurve,
    /// Temperature of the light that looks white in previews, 1000 to 40000 [default: radiance with equal channels does]
    #[arg(long, value_name = "KELVIN", value_parser = parse_kelvin)]
    pub white_balance: Option<f64>,
}

impl DisplayArguments {
    pub fn display(&self) -> Display {
        Display { exposure: self.exposure, white_kelvin: self.white_balance, tone_curve: self.tonemap }
    }
}

/// How OpenEXR files hold the picture.
#[derive(Debug, Args)]
pub struct ExrArguments {
    /// Red, green and blue of .exr files in half precision: half the size, 11 bits, up to 65504
    #[arg(long)]
    pub half: bool,
    /// Layers that .exr files hold beside the picture, of the same samples; each is a render of its own
    #[arg(long, value_name = "LAYER,…", value_delimiter = ',', value_parser = by_name::<Layer>())]
    pub aov: Vec<Layer>,
    /// How .exr files are compressed
    #[arg(long, value_name = "METHOD", default_value = "piz", value_parser = by_name::<ExrCompression>())]
    pub compression: ExrCompression,
    /// How .exr files lie [default: as one part of scan lines]
    #[arg(long, value_name = "FORM,…", value_delimiter = ',', value_parser = by_name::<ExrForm>())]
    pub exr: Vec<ExrForm>,
}

impl ExrArguments {
    pub fn options(&self) -> ExrOptions {
        ExrOptions {
            half: self.half,
            compression: self.compression,
            tiled: self.exr.contains(&ExrForm::Tiled),
            parts: self.exr.contains(&ExrForm::Parts),
        }
    }
}

fn parse_exposure(text: &str) -> Result<Exposure, String> {
    if text == "auto" {
        return Ok(Exposure::Auto);
    }
    let stops: f32 = text.parse().map_err(|_| "expected a number of stops, or auto".to_owned())?;
    if stops.abs() <= 100.0 { Ok(Exposure::Stops(stops)) } else { Err("expected a number from -100 to 100, or auto".to_owned()) }
}

fn parse_kelvin(text: &str) -> Result<f64, String> {
    let kelvin = text.parse().ok().filter(|kelvin: &f64| (1000.0..=40_000.0).contains(kelvin));
    kelvin.ok_or_else(|| "expected a temperature from 1000 to 40000 kelvin".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposures_and_temperatures_are_read() {
        assert_eq!(parse_exposure("-1.5"), Ok(Exposure::Stops(-1.5)));
        assert_eq!(parse_exposure("auto"), Ok(Exposure::Auto));
        for bad in ["nan", "inf", "1e9", "bright"] {
            assert!(parse_exposure(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_kelvin("3200"), Ok(3200.0));
        for bad in ["nan", "999", "1e9", "warm"] {
            assert!(parse_kelvin(bad).is_err(), "{bad}");
        }
    }
}
