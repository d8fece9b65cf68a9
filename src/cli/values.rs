//! Values that several commands read.

use std::time::Duration;

use gpt::renderer::DeviceChoice;
use gpt::scene::settings::FilmSettings;

pub fn parse_device(text: &str) -> Result<DeviceChoice, String> {
    match text {
        "" => Err("name a device; `gpt devices` lists them".to_owned()),
        "auto" => Ok(DeviceChoice::Auto),
        "gpu" => Ok(DeviceChoice::Gpu),
        "cpu" => Ok(DeviceChoice::Cpu),
        name => Ok(DeviceChoice::Named(name.to_owned())),
    }
}

pub fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let parts = text.split_once(['x', 'X']).ok_or("expected WIDTHxHEIGHT, for example 640x480")?;
    let side = |part: &str| part.parse::<u32>().map_err(|_| format!("`{part}` is no number of pixels"));
    let film = FilmSettings { size: [side(parts.0)?, side(parts.1)?], ..FilmSettings::default() };
    film.check().map_err(|bad| bad.help.unwrap_or(bad.message))?;
    Ok(film.size)
}

pub fn parse_pixel(text: &str) -> Result<[u32; 2], String> {
    let parts = text.split_once(',').ok_or("expected COLUMN,ROW, for example 64,48")?;
    let place = |part: &str| part.trim().parse::<u32>().map_err(|_| format!("`{part}` is no column or row"));
    Ok([place(parts.0)?, place(parts.1)?])
}

pub fn parse_region(text: &str) -> Result<[u32; 4], String> {
    let expected = || "expected COLUMN,ROW,WIDTH,HEIGHT in pixels, for example 64,48,128,96".to_owned();
    let numbers = text.split(',').map(|part| part.trim().parse::<u32>()).collect::<Result<Vec<_>, _>>();
    let region: [u32; 4] = numbers.ok().and_then(|numbers| numbers.try_into().ok()).ok_or_else(expected)?;
    if region[2] == 0 || region[3] == 0 { Err(expected()) } else { Ok(region) }
}

pub fn parse_seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| *seconds > 0.0);
    let duration = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    duration.ok_or_else(|| "expected a number of seconds above 0".to_owned())
}

/// A share such as `1%` or `0.01`.
pub fn parse_share(text: &str) -> Result<f64, String> {
    let (number, whole) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 100.0));
    let share = number.trim().parse().ok().map(|number: f64| number / whole);
    share
        .filter(|share| share.is_finite() && *share > 0.0)
        .ok_or_else(|| "expected a share above 0, for example 1% or 0.01".to_owned())
}

/// A probability such as `99%`.
pub fn parse_confidence(text: &str) -> Result<f64, String> {
    let share = parse_share(text).ok().filter(|share| (0.5..1.0).contains(share));
    share.ok_or_else(|| "expected a probability from 50% to below 100%, for example 99%".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_two_numbers_within_limits() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        assert_eq!(parse_size("16384X16384"), Ok([16384, 16384]));
        for bad in ["640", "0x0", "0x5", "5x0", "-1x5", "x", "4.5x3", "32769x1", "32768x32768", "99999999999x1", "3x3x3"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn pixels_are_two_numbers() {
        assert_eq!(parse_pixel("3,0"), Ok([3, 0]));
        for bad in ["3", "3,", "-1,2", "1,2,3", "1.5,2", "3x4"] {
            assert!(parse_pixel(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn regions_are_four_numbers() {
        assert_eq!(parse_region("3,0, 5,6"), Ok([3, 0, 5, 6]));
        for bad in ["3,0", "1,2,3,4,5", "0,0,0,4", "0,0,4,0", "-1,0,2,2", "a,b,c,d", ""] {
            assert!(parse_region(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn shares_may_be_percentages() {
        assert_eq!(["1%", "0.25", "250 %"].map(parse_share), [Ok(0.01), Ok(0.25), Ok(2.5)]);
        assert_eq!(["95%", "0.999"].map(parse_confidence), [Ok(0.95), Ok(0.999)]);
        assert!(["0", "-1%", "x", "%", "inf"].iter().all(|bad| parse_share(bad).is_err()));
        assert!(["100%", "20%", "1"].iter().all(|bad| parse_confidence(bad).is_err()));
    }

    #[test]
    fn devices_are_words_or_names() {
        assert_eq!(parse_device("cpu"), Ok(DeviceChoice::Cpu));
        assert_eq!(parse_device("GeForce"), Ok(DeviceChoice::Named("GeForce".to_owned())));
        assert!(parse_device("").is_err());
    }
}
