//! Files to damage, and what is learned from the answers: a damaged file that is answered in a way not seen before is damaged further. So the
//! damage reaches what no single blow to a right file does, as a fuzzer that watches branches does; here answers are watched, which are a
//! reader's errors and warnings without names and numbers.
//!
//! `tests/memory/corpus` keeps such files, one folder for each kind, and every run starts from them. `GPT_FUZZ_KEEP=DIR` writes what a run learned.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crate::random::SplitMix64;

/// A reader's answer to a file: its warnings, or its error.
pub type Answer = Result<String, String>;

/// Most files of one kind, and most bytes of one, that are damaged further.
const MOST_FILES: usize = 400;
const MOST_BYTES: usize = 16 << 10;
/// Largest files that are kept for later runs.
const MOST_BYTES_KEPT: usize = 6 << 10;

pub struct Seeds {
    kind: &'static str,
    whole: Vec<u8>,
    /// Kept ones first.
    files: Vec<Vec<u8>>,
    kept: usize,
    /// The shortest file for each answer, by its index among the files.
    answers: HashMap<String, usize>,
}

/// The name of a kind in names of files.
fn folder_name(kind: &str) -> String {
    kind.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '-' }).collect()
}

impl Seeds {
    /// One right file, and those that are kept of its kind.
    pub fn new(kind: &'static str, whole: &[u8]) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/memory/corpus").join(folder_name(kind));
        let entries = std::fs::read_dir(folder).into_iter().flatten();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("the folder is readable").path()).collect();
        paths.sort();
        let files: Vec<Vec<u8>> = paths.iter().map(|path| std::fs::read(path).expect("the file is readable")).collect();
        Self { kind, whole: whole.to_vec(), kept: files.len(), files, answers: HashMap::new() }
    }

    /// The seeds that are kept, unchanged.
    pub fn kept(&self) -> Vec<Vec<u8>> {
        self.files[..self.kept].to_vec()
    }

    /// A file to damage: half of the time the right one, and now and then with a piece of another.
    pub fn choose(&self, random: &mut SplitMix64) -> Vec<u8> {
        let any = |random: &mut SplitMix64| match self.files.len() {
            0 => &self.whole,
            count => &self.files[below(count, random)],
        };
        let mut chosen = if random.uniform() < 0.5 { self.whole.clone() } else { any(random).clone() };
        if random.uniform() < 0.05 {
            let other = any(random);
            let start = below(other.len() + 1, random);
            let end = (start + below(200, random)).min(other.len());
            let place = below(chosen.len() + 1, random);
            chosen.splice(place..place, other[start..end].iter().copied());
        }
        if chosen.is_empty() { self.whole.clone() } else { chosen }
    }

    /// Takes a file up whose answer is new, or in place of a longer one with the same answer.
    pub fn learn(&mut self, bytes: &[u8], answer: &Answer) {
        if bytes.is_empty() || bytes.len() > MOST_BYTES {
            return;
        }
        let count = self.files.len();
        match self.answers.get(&sketch(answer)) {
            Some(&index) if index >= self.kept && self.files[index].len() > bytes.len() => self.files[index] = bytes.to_vec(),
            Some(_) => {}
            None if count < MOST_FILES => {
                self.answers.insert(sketch(answer), count);
                self.files.push(bytes.to_vec());
            }
            None => {}
        }
    }

    /// Notes what a kept file is answered, so that only other answers are new.
    pub fn know(&mut self, index: usize, answer: &Answer) {
        self.answers.entry(sketch(answer)).or_insert(index);
    }

    /// How many answers are known.
    pub fn answers(&self) -> usize {
        self.answers.len()
    }

    /// Writes what was learned, where `GPT_FUZZ_KEEP` says.
    pub fn keep(&self) {
        let Some(folder) = std::env::var_os("GPT_FUZZ_KEEP") else { return };
        let folder = Path::new(&folder).join(folder_name(self.kind));
        std::fs::create_dir_all(&folder).expect("the folder can be made");
        for (answer, &index) in &self.answers {
            let bytes = &self.files[index];
            if index >= self.kept && bytes.len() <= MOST_BYTES_KEPT {
                let answered = if answer.starts_with("true") { "accepted" } else { "refused" };
                std::fs::write(folder.join(format!("{answered}-{index:03}")), bytes).expect("the folder can be written to");
            }
        }
    }
}

fn below(count: usize, random: &mut SplitMix64) -> usize {
    (random.uniform() * count as f64) as usize
}

/// An answer without what differs from file to file: numbers, what is quoted, paths.
fn sketch(answer: &Answer) -> String {
    let (Ok(text) | Err(text)) = answer;
    let mut bare = String::new();
    // Pieces at odd places are quoted.
    for piece in text.split(['`', '"', '\'']).step_by(2) {
        let words = piece.split_whitespace().filter(|word| !word.contains(['/', '\\']));
        let words = words.filter(|word| !word.contains(|letter: char| letter.is_ascii_digit() || !letter.is_ascii()));
        words.for_each(|word| {
            bare.push_str(word);
            bare.push(' ');
        });
    }
    let bare: String = bare.chars().take(200).collect();
    format!("{}: {bare}", answer.is_ok())
}

#[test]
fn answers_that_differ_in_names_and_numbers_are_the_same() {
    let says = |text: &str| sketch(&Err(text.to_owned()));
    assert_eq!(says("/tmp/.a1/b.obj:4:1: `x` is not an index"), says("/tmp/.c2/b.obj:17:30: `y1` is not an index"));
    assert_ne!(says("`x` is not an index"), says("`x` is not a number"));
    assert_ne!(says("a"), sketch(&Ok("a".to_owned())));
}

/// New answers are learned, shorter files take the place of longer ones, and known answers bring nothing.
#[test]
fn what_is_answered_anew_is_damaged_further() {
    let mut seeds = Seeds::new("control", b"whole");
    let mut random = SplitMix64::new(1);
    let of_the_whole = |bytes: Vec<u8>| bytes.iter().all(|byte| b"whole".contains(byte));
    assert!((0..50).all(|_| of_the_whole(seeds.choose(&mut random))), "there is only the whole file");
    seeds.learn(b"first", &Err("no".to_owned()));
    seeds.learn(b"second", &Err("no".to_owned()));
    assert_eq!((seeds.answers(), seeds.files.as_slice()), (1, [b"first".to_vec()].as_slice()));
    seeds.learn(b"1st", &Err("no".to_owned()));
    seeds.learn(b"third", &Ok(String::new()));
    assert_eq!((seeds.answers(), seeds.files.as_slice()), (2, [b"1st".to_vec(), b"third".to_vec()].as_slice()));
    assert!((0..50).any(|_| seeds.choose(&mut random) == b"1st"));
}
