//! Numbers of frames, as people write them.

/// Most frames of one render.
const MOST_FRAMES: usize = 1_000_000;
/// Largest number of a frame.
const LAST_FRAME: u32 = 100_000_000;

/// Numbers of frames in the order in which they are rendered, each once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameList(pub Vec<u32>);

impl FrameList {
    /// Reads `1-100`, `1-100x5`, `1,5,20-30`.
    ///
    /// # Errors
    /// A sentence on what is wrong with the text.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut frames: Vec<u32> = Vec::new();
        let mut seen = std::collections::HashSet::new();
        for part in text.split(',') {
            let (range, step) = match part.split_once(['x', 'X']) {
                Some((range, step)) => (range, parse_step(step)?),
                None => (part, 1),
            };
            let (first, last) = match range.split_once('-') {
                Some((first, last)) => (parse_frame(first)?, parse_frame(last)?),
                None if step == 1 => (parse_frame(range)?, parse_frame(range)?),
                None => return Err(format!("`{part}`: a step belongs to a range, as in 1-100x5")),
            };
            if last < first {
                return Err(format!("`{part}`: the range ends before it begins"));
            }
            if ((last - first) / step) as usize + frames.len() >= MOST_FRAMES {
                return Err(format!("these are more than {MOST_FRAMES} frames"));
            }
            frames.extend((first..=last).step_by(step as usize).filter(|frame| seen.insert(*frame)));
        }
        Ok(Self(frames))
    }

    /// The shortest list that names these frames: runs with one step between their numbers.
    pub fn words(frames: &[u32]) -> String {
        let mut parts: Vec<String> = Vec::new();
        let mut rest = frames;
        while let Some((&first, after)) = rest.split_first() {
            let step = after.first().and_then(|next| next.checked_sub(first)).filter(|step| *step > 0);
            let run =
                step.map_or(1, |step| rest.windows(2).take_while(|pair| pair[1].checked_sub(pair[0]) == Some(step)).count() + 1);
            let (run, last) = if run < 3 { (1, first) } else { (run, rest[run - 1]) };
            parts.push(match step {
                _ if run == 1 => first.to_string(),
                Some(step) if step > 1 => format!("{first}-{last}x{step}"),
                _ => format!("{first}-{last}"),
            });
            rest = &rest[run..];
        }
        parts.join(",")
    }
}

/// The number of a frame, as people write it.
///
/// # Errors
/// A sentence: it is no whole number, or too large.
pub fn parse_frame(text: &str) -> Result<u32, String> {
    let frame = text.trim().parse().ok().filter(|frame| *frame <= LAST_FRAME);
    frame.ok_or_else(|| format!("`{text}` is no frame: expected a whole number from 0 to {LAST_FRAME}"))
}

fn parse_step(text: &str) -> Result<u32, String> {
    let step = text.trim().parse().ok().filter(|step| *step > 0);
    step.ok_or_else(|| format!("`{text}` is no step: expected a whole number above 0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_frames_are_read_and_said() {
        let list = |text: &str| FrameList::parse(text).map(|FrameList(frames)| frames);
        assert_eq!(list("3"), Ok(vec![3]));
        assert_eq!(list("1-4"), Ok(vec![1, 2, 3, 4]));
        assert_eq!(list("1-10x4, 0, 5-6,5"), Ok(vec![1, 5, 9, 0, 6]));
        for bad in ["", "a", "1-", "-1", "5-1", "1x2", "1-9x0", "1--2", "1.5", "0-99999999", "1,,2"] {
            assert!(list(bad).is_err(), "{bad}");
        }
        for words in ["3", "1-4", "1-9x4", "1,2", "7,1-3", "10-30x10,31,33", "0-2,10-12"] {
            let frames = list(words).expect("it is a list");
            assert_eq!(list(&FrameList::words(&frames)), Ok(frames), "{words}");
        }
        assert_eq!(FrameList::words(&[1, 2, 3, 4, 10, 20, 30]), "1-4,10-30x10");
    }
}
