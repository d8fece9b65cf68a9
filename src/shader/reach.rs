//! Leaves out of a kernel the functions, types, constants and bindings that its entry points do not reach, so that a file may import another one
//! for what it needs of it under some switches, and costs nothing under the others.

use std::collections::HashMap;

use super::fold::without_comment;

/// A declaration at the top level of WGSL text, with the comment in front of it.
struct Item<'a> {
    /// Its lines, counted from 0, the last one excluded.
    lines: std::ops::Range<usize>,
    /// None: the declaration has no name, as an assertion.
    name: Option<&'a str>,
    is_entry: bool,
}

/// By line: the line is part of what the entry points reach. Text without an entry point is kept whole.
pub fn reached_lines(text: &str) -> Vec<bool> {
    let lines: Vec<&str> = text.lines().collect();
    let items = items(&lines);
    if !items.iter().any(|item| item.is_entry) {
        return vec![true; lines.len()];
    }
    let mut by_name: HashMap<&str, Vec<usize>> = HashMap::new();
    for (index, name) in items.iter().enumerate().filter_map(|(index, item)| Some((index, item.name?))) {
        by_name.entry(name).or_default().push(index);
    }
    // Assertions hold of every kernel, so what they are about is there.
    let is_root = |item: &Item<'_>| item.is_entry || item.name.is_none();
    let mut pending: Vec<usize> = (0..items.len()).filter(|&index| is_root(&items[index])).collect();
    let mut kept = vec![false; lines.len()];
    while let Some(index) = pending.pop() {
        let own = items[index].lines.clone();
        kept[own.clone()].fill(true);
        // A name leads to its declaration once.
        pending.extend(
            lines[own].iter().flat_map(|line| words(without_comment(line))).filter_map(|word| by_name.remove(word)).flatten(),
        );
    }
    kept
}

fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

fn items<'a>(lines: &[&'a str]) -> Vec<Item<'a>> {
    let mut items = Vec::new();
    let (mut first, mut depth) = (0, 0_usize);
    for (index, line) in lines.iter().enumerate() {
        let code = without_comment(line).trim_end();
        for byte in code.bytes() {
            match byte {
                b'{' | b'(' | b'[' => depth += 1,
                b'}' | b')' | b']' => depth = depth.saturating_sub(1),
                _ => {}
            }
        }
        if depth == 0 && code.ends_with(['}', ';']) {
            items.push(item(lines, first..index + 1));
            first = index + 1;
        }
    }
    items.push(item(lines, first..lines.len()));
    items
}

fn item<'a>(lines: &[&'a str], own: std::ops::Range<usize>) -> Item<'a> {
    const NAMED: [&str; 6] = ["fn", "struct", "const", "alias", "override", "var"];
    // A variable's name follows the words of its address space and access.
    const OF_VARIABLES: [&str; 6] = ["private", "workgroup", "uniform", "storage", "read", "read_write"];
    let mut words = lines[own.clone()].iter().flat_map(|line| words(without_comment(line))).peekable();
    let is_entry = words.peek() == Some(&"compute");
    let name = words.skip_while(|word| !NAMED.contains(word)).skip(1).find(|word| !OF_VARIABLES.contains(word));
    Item { lines: own, name, is_entry }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(text: &str) -> String {
        let reached = reached_lines(text);
        text.lines().zip(reached).filter(|(_, reached)| *reached).map(|(line, _)| format!("{line}\n")).collect()
    }

    #[test]
    fn what_no_entry_point_reaches_is_left_out() {
        let text = "const SIZE: u32 = 4u;\n@group(0) @binding(1) var<storage, read> used: array<u32>;\n\
                    var<private> unused: f32;\n// Of no use.\nfn idle() {\n    other(SPARE);\n}\nconst SPARE: u32 = 1u;\n\
                    fn called() -> u32 {\n    return used[SIZE];\n}\n@compute @workgroup_size(1)\nfn main(\n    @builtin(x) id: u32\n) {\n    called();\n}\n";
        let left = kept(text);
        for there in ["SIZE: u32", "used: array", "fn called", "return used", "fn main", "    called();"] {
            assert!(left.contains(there), "{there}: {left}");
        }
        for gone in ["unused", "Of no use", "idle", "SPARE"] {
            assert!(!left.contains(gone), "{gone}: {left}");
        }
    }

    #[test]
    fn a_word_in_a_comment_reaches_nothing() {
        let text = "fn far() {}\n@compute @workgroup_size(1)\nfn main() {\n    // far()\n}\n";
        assert!(!kept(text).contains("fn far"));
        assert!(kept(&text.replace("// ", "")).contains("fn far"));
    }

    #[test]
    fn text_without_an_entry_point_is_kept_whole() {
        assert_eq!(kept("fn a() {}\nfn b() {}\n"), "fn a() {}\nfn b() {}\n");
    }
}
