//! Comments begin with their subject. A fragment such as "Of those that …" has to be read together with the line above it, or with the name below.

use std::fs;
use std::path::Path;

/// Openings of fragments.
const OPENINGS: [&str; 8] = ["Of ", "What ", "Where ", "The same ", "As ", "Those ", "Whether ", "It "];

/// The text of a line that is a comment.
fn comment(line: &str) -> Option<&str> {
    Some(line.trim_start().strip_prefix("//")?.trim_start_matches(['/', '!']).trim())
}

/// The numbers of lines, from 1, at which a comment begins with one of the openings.
fn fragments(text: &str) -> Vec<usize> {
    let lines: Vec<&str> = text.lines().collect();
    let ends = |before: &str| before.is_empty() || before.starts_with('#');
    let begins = |index: usize| index == 0 || comment(lines[index - 1]).is_none_or(ends);
    let is_fragment = |index: usize| {
        comment(lines[index]).is_some_and(|text| OPENINGS.iter().any(|opening| text.starts_with(opening))) && begins(index)
    };
    (0..lines.len()).filter(|&index| is_fragment(index)).map(|index| index + 1).collect()
}

/// The places of all fragments in the files of a folder.
fn places(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("the folder can be listed") {
        let path = entry.expect("the folder can be listed").path();
        if path.is_dir() {
            places(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs" || ending == "wgsl") {
            let text = fs::read_to_string(&path).expect("sources are UTF-8");
            found.extend(fragments(&text).into_iter().map(|line| format!("{}:{line}", path.display())));
        }
    }
}

#[test]
fn comments_begin_with_their_subject() {
    let mut found = Vec::new();
    for folder in ["src", "crates", "shaders"] {
        places(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut found);
    }
    found.sort();
    assert!(found.is_empty(), "comments begin with one of {OPENINGS:?}:\n{}", found.join("\n"));
}

/// The control: openings count at the beginning of a comment alone.
#[test]
fn fragments_are_found() {
    let text = "/// Of a lamp.\nfn a() {}\n// The sum\n// Of two.\n\n//! Title.\n//!\n//! What it is.\n    // It ends; as such.\n/// Ofen\nlet a = 1; // Of it\n";
    assert_eq!(fragments(text), [1, 8]);
}
