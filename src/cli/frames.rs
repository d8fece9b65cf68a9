//! `--frame`, `--frames` and `--time`: which frames, and what their files are called.

use std::path::{Path, PathBuf};

use clap::Args;
pub use gpt::render::frames::{FrameList, parse_frame};
use gpt::scene::Animation;

use super::exit::Failure;
use super::pictures::is_stdout;

/// Stands for a frame's number in the name of a file. The number has at least as many digits as there are of
/// these.
const PLACE: char = '#';

/// Which frames of the scene's keyframes are rendered.
#[derive(Debug, Default, Args)]
pub struct FrameArguments {
    /// Render frame N of the scene's keyframes; #### in the names of files stands for N
    #[arg(long, value_name = "N", value_parser = parse_frame)]
    pub frame: Option<u32>,
    /// Render several frames, such as 1-100, 1-100x5 (every fifth) or 1,5,20-30, each to files of its own: #### in their names stands for its number
    #[arg(long, value_name = "FRAMES", value_parser = FrameList::parse, conflicts_with = "frame")]
    pub frames: Option<FrameList>,
    /// Render the moment so many seconds after frame 0
    #[arg(long, value_name = "SECONDS", value_parser = parse_time, allow_negative_numbers = true, conflicts_with_all = ["frame", "frames"])]
    pub time: Option<f64>,
}

/// A frame as one of several.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    /// Its number in the scene's keyframes.
    pub frame: u32,
    /// Its place among those that are rendered, from 0.
    pub index: usize,
    pub count: usize,
}

/// The moment of a scene that is rendered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FrameTime {
    /// The scene as it is without a frame.
    Rest,
    Frame(u32),
    /// A frame that has no number.
    Between(f64),
}

impl FrameTime {
    /// The number that names its files.
    pub fn number(self) -> Option<u32> {
        match self {
            Self::Frame(number) => Some(number),
            Self::Rest | Self::Between(_) => None,
        }
    }

    /// The frame, where there is one.
    pub fn frame(self) -> Option<f64> {
        match self {
            Self::Rest => None,
            Self::Frame(number) => Some(f64::from(number)),
            Self::Between(frame) => Some(frame),
        }
    }
}

impl FrameArguments {
    /// True if several frames may be asked for, so that each needs files of its own.
    pub fn is_sequence(&self) -> bool {
        self.frames.is_some()
    }

    /// The moments that are rendered of a scene with these keyframes.
    ///
    /// # Errors
    /// A usage error where there are none.
    pub fn times(&self, animation: &Animation) -> Result<Vec<FrameTime>, Failure> {
        let times = match (self.frame, &self.frames, self.time) {
            (Some(frame), ..) => vec![FrameTime::Frame(frame)],
            (_, Some(FrameList(frames)), _) => frames.iter().map(|&frame| FrameTime::Frame(frame)).collect(),
            (_, _, Some(time)) => vec![FrameTime::Between(time * animation.frames_per_second)],
            (None, None, None) => return Ok(vec![FrameTime::Rest]),
        };
        if animation.is_empty() {
            let flag = if self.frame.is_some() {
                "--frame"
            } else if self.frames.is_some() {
                "--frames"
            } else {
                "--time"
            };
            return Err(Failure::Usage {
                message: format!("{flag}: the scene has no keyframes, so all of its frames would be the same"),
                help: Some(
                    "`keyframes` of [camera], of a [[shape]] or of a [[node]] move things; see docs/animation.md".to_owned(),
                ),
            });
        }
        Ok(times)
    }

    /// The first number for the names of files, before the scene is read.
    pub fn first_number(&self) -> Option<u32> {
        self.frame.or_else(|| self.frames.as_ref().and_then(|FrameList(frames)| frames.first().copied()))
    }

    /// Checks that the files of all frames have names of their own.
    ///
    /// # Errors
    /// A usage error that names the first file that has not.
    pub fn check_names<'p>(&self, flag: &str, mut paths: impl Iterator<Item = &'p Path>) -> Result<(), Failure> {
        if !self.is_sequence() {
            return Ok(());
        }
        if let Some(path) = paths.find(|path| is_stdout(path) || !has_place(path)) {
            return Err(Failure::Usage {
                message: format!("{flag} {}: several frames would be written to one file", path.display()),
                help: Some("#### in the file's name stands for the number of the frame, as in picture.####.exr".to_owned()),
            });
        }
        Ok(())
    }
}

/// True if a file's name has a place for the number of a frame.
pub fn has_place(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().contains(PLACE))
}

/// A path with the number of the frame in the last run of `#` of its file's name, with as many digits at least; as it is without a number.
pub fn named(path: &Path, number: Option<u32>) -> PathBuf {
    let (Some(number), Some(name)) = (number, path.file_name()) else { return path.to_owned() };
    let name = name.to_string_lossy();
    let Some(last) = name.rfind(PLACE) else { return path.to_owned() };
    let first = name[..=last].trim_end_matches(PLACE).len();
    let digits = last + 1 - first;
    path.with_file_name(format!("{}{number:0digits$}{}", &name[..first], &name[last + 1..]))
}

fn parse_time(text: &str) -> Result<f64, String> {
    let time = text.parse().ok().filter(|time: &f64| time.abs() <= 1e9);
    time.ok_or_else(|| "expected a number of seconds".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_in_the_last_run_of_places() {
        let name = |path: &str, number| named(Path::new(path), number).display().to_string();
        assert_eq!(name("a/picture.####.exr", Some(7)), "a/picture.0007.exr");
        assert_eq!(name("#1/p-##.exr", Some(123)), "#1/p-123.exr");
        assert_eq!(name("c#-##-#.png", Some(5)), "c#-##-5.png");
        assert_eq!(name("é####.exr", Some(5)), "é0005.exr");
        assert_eq!(name("plain.exr", Some(5)), "plain.exr");
        assert_eq!(name("as#is.exr", None), "as#is.exr");
        assert!(has_place(Path::new("a/b#.exr")) && !has_place(Path::new("a#/b.exr")));
    }
}
