//! Damage to files, and what bounds their readers keep.

use std::time::{Duration, Instant};

use crate::common::effort::{announce, in_full};
use crate::counting::{Peak, take_turn};
use crate::random::SplitMix64;
use crate::seeds::{Answer, Seeds};
use gpt::load::SceneError;
use gpt::scene::Scene;

/// Most memory for a text of a few thousand bytes.
pub const MOST_FOR_TEXTS: usize = 64 << 20;

/// The outcome of the files of one kind.
pub struct Tally {
    kind: &'static str,
    most_memory: usize,
    longest: Duration,
    /// The longest time and the most memory that a file took.
    extremes: (Duration, usize),
    accepted: usize,
    refused: usize,
    /// Files that were accepted with a warning: readers mend what is wrong with a model or a material.
    warned: usize,
    /// Ways in which files were answered.
    answers: usize,
}

impl Tally {
    pub fn new(kind: &'static str, most_memory: usize) -> Self {
        // A file of a few thousand bytes is answered within this time, on a busy machine and with 16,384² texels to fill.
        let longest = Duration::from_secs(60);
        Self { kind, most_memory, longest, extremes: (Duration::ZERO, 0), accepted: 0, refused: 0, warned: 0, answers: 0 }
    }

    /// The positive control: a file that is refused for another reason would hide what the damage does.
    pub fn undamaged(&mut self, bytes: &[u8], read: impl Fn(&[u8]) -> Answer) {
        let answer = self.bounded(bytes, read);
        assert!(matches!(answer, Ok(Ok(_))), "{}: the undamaged file is refused: {answer:?}", self.kind);
    }

    /// Reads the files that are kept of this kind, and then `count` that `damage` makes of these, of `whole`, and of what is answered anew. `damage`
    /// is given the number of each.
    pub fn hunt(
        &mut self,
        whole: &[u8],
        count: usize,
        random: &mut SplitMix64,
        damage: impl Fn(&[u8], usize, &mut SplitMix64) -> Vec<u8>,
        read: impl Fn(&[u8]) -> Answer,
    ) {
        let mut seeds = Seeds::new(self.kind, whole);
        for (index, bytes) in seeds.kept().iter().enumerate() {
            let answer = self.damaged(bytes, &read);
            seeds.know(index, &answer);
        }
        for round in 0..count {
            let bytes = damage(&seeds.choose(random), round, random);
            let answer = self.damaged(&bytes, &read);
            seeds.learn(&bytes, &answer);
        }
        self.answers += seeds.answers();
        seeds.keep();
    }

    /// Reads a damaged file, and fails where that panics or takes too long or too much memory. Leaves the file that did it.
    fn damaged(&mut self, bytes: &[u8], read: impl Fn(&[u8]) -> Answer) -> Answer {
        match self.bounded(bytes, read) {
            Ok(answer) => {
                let counter = if answer.is_ok() { &mut self.accepted } else { &mut self.refused };
                *counter += 1;
                self.warned += usize::from(answer.as_ref().is_ok_and(|warnings| !warnings.is_empty()));
                answer
            }
            Err(complaint) => {
                let evidence = std::env::temp_dir().join(format!("gpt-hostile-{}", self.kind.replace(' ', "-")));
                let kept = std::fs::write(&evidence, bytes).is_ok();
                panic!("{}: {complaint}; the file is kept ({kept}): {}", self.kind, evidence.display());
            }
        }
    }

    /// The reader's answer; an error where reading the file broke a bound.
    fn bounded(&mut self, bytes: &[u8], read: impl Fn(&[u8]) -> Answer) -> Result<Answer, String> {
        let peak = Peak::from_now();
        let start = Instant::now();
        let ended = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| read(bytes)));
        let (took, used) = (start.elapsed(), peak.bytes());
        self.extremes = (self.extremes.0.max(took), self.extremes.1.max(used));
        let answer = ended.map_err(|_| "it panics".to_owned())?;
        if took > self.longest || used > self.most_memory {
            return Err(format!("it takes {took:?} and {used} bytes"));
        }
        if answer.as_ref().is_err_and(String::is_empty) {
            return Err("it is refused without a word".to_owned());
        }
        Ok(answer)
    }

    /// Damage that is never noticed, or always fatal, would exercise half of a reader.
    pub fn judge(&self) {
        let (Self { kind, accepted, refused, warned, answers, .. }, (took, used)) = (self, self.extremes);
        let mebibytes = used as f64 / f64::from(1 << 20);
        let extremes = format!("at most {took:.1?} and {mebibytes:.1} MiB");
        announce(&format!("{kind}: {accepted} accepted, {refused} refused, {answers} different answers, {extremes}"));
        assert!(*accepted > 0 && refused + warned > 0, "{kind}: {accepted} accepted, {refused} refused, {warned} with a warning");
    }
}

/// The negative controls: what panics, takes too long or allocates more than its bound is noticed.
#[test]
fn readers_that_break_a_bound_are_noticed() {
    let _turn = take_turn();
    let mut tally = Tally::new("control", 1 << 20);
    let fine = |_: &[u8]| Ok(String::new());
    let greedy = |_: &[u8]| Ok(char::from(std::hint::black_box(vec![b'a'; 4 << 20])[7]).to_string());
    assert!(tally.bounded(&[], greedy).is_err());
    let quiet = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let panics = tally.bounded(&[], |_| panic!("as a reader would"));
    std::panic::set_hook(quiet);
    assert!(panics.is_err());
    assert!(tally.bounded(&[], |_| Err(String::new())).is_err());
    assert_eq!(tally.bounded(&[], |_| Err("no".to_owned())), Ok(Err("no".to_owned())));
    assert!(tally.bounded(&[], fine).is_ok());
    tally.longest = Duration::ZERO;
    assert!(tally.bounded(&[], fine).is_err());
}

/// How many files of each kind are damaged: as many as `GPT_FUZZ_CASES` says, else so many in the long form and so many in the short one.
pub fn cases(normally: usize, full: usize) -> usize {
    let asked = std::env::var("GPT_FUZZ_CASES").ok().and_then(|count| count.parse().ok());
    asked.unwrap_or_else(|| {
        let left_out = format!("{full} damaged files of each kind instead of {normally}");
        if in_full(&left_out) { full } else { normally }
    })
}

/// The answer of a reader: the scene's warnings, or the error.
pub fn answer_of(loaded: Result<Scene, SceneError>) -> Answer {
    loaded.map(|scene| scene.warnings.join(" ")).map_err(|error| error.to_string())
}

/// Some bytes or words replaced, cut out, or doubled.
pub fn damaged(whole: &[u8], random: &mut SplitMix64, text: bool) -> Vec<u8> {
    const WORDS: [&str; 14] =
        ["-1", "nan", "inf", "1e308", "0", "[", "]]", "\"", "=", "99999999999", "-9223372036854775809", "\n", "\u{0}", "/"];
    let mut bytes = whole.to_vec();
    let below = |count: usize, random: &mut SplitMix64| (random.uniform() * count as f64) as usize;
    for _ in 0..1 + below(6, random) {
        if bytes.is_empty() {
            break;
        }
        // Headers say how large a picture is: half of the damage goes there.
        let reach = if !text && random.uniform() < 0.5 { bytes.len().min(64) } else { bytes.len() };
        let start = below(reach, random);
        let end = (start + below(12, random)).min(bytes.len());
        let piece: Vec<u8> = match below(5, random) {
            0 if text => WORDS[below(WORDS.len(), random)].bytes().collect(),
            0 | 1 => vec![[0, 1, 0x7f, 0x80, 0xff][below(5, random)]; end - start],
            2 => bytes[start..end].repeat(2),
            3 => Vec::new(),
            _ => (start..end).map(|_| random.next_u64() as u8).collect(),
        };
        bytes.splice(start..end, piece);
    }
    if random.uniform() < 0.1 {
        bytes.truncate(below(bytes.len() + 1, random));
    }
    bytes
}

/// One or two bits turned over, anywhere.
pub fn with_bits_turned(whole: &[u8], random: &mut SplitMix64) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    for _ in 0..1 + random.next_u64() % 2 {
        let place = random.next_u64() as usize % bytes.len();
        bytes[place] ^= 1 << (random.next_u64() % 8);
    }
    bytes
}
