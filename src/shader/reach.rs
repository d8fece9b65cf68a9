//! Leaves out of a kernel the functions, types, constants and bindings that its entry points do not reach, so that a file may import another one
//! for what it needs of it under some switches, and costs nothing under the others.

use std::collections::{BTreeMap, BTreeSet};

/// A declaration at the top level of WGSL text, with the comment in front of it.
struct Item<'a> {
    /// Its lines, counted from 0, the last one excluded.
    lines: std::ops::Range<usize>,
    name: Option<&'a str>,
    /// The words of its code.
    words: BTreeSet<&'a str>,
    is_entry: bool,
}

/// By line: the line is part of what the entry points reach. Text without an entry point is kept whole.
pub fn reached_lines(text: &str) -> Vec<bool> {
    let lines: Vec<&str> = text.lines().collect();
    let items = items(&lines);
    let mut by_name: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (index, item) in items.iter().enumerate() {
        by_name.entry(item.name.unwrap_or_default()).or_default().push(index);
    }
    if !items.iter().any(|item| item.is_entry) {
        return vec![true; lines.len()];
    }
    // Assertions hold of every kernel, so what they are about is there.
    let mut pending: Vec<usize> =
        (0..items.len()).filter(|&index| items[index].is_entry || items[index].name.is_none()).collect();
    let mut reached = vec![false; items.len()];
    while let Some(index) = pending.pop() {
        if !std::mem::replace(&mut reached[index], true) {
            pending.extend(items[index].words.iter().filter_map(|word| by_name.get(word)).flatten());
        }
    }
    let mut kept = vec![false; lines.len()];
    for (item, reached) in items.iter().zip(reached) {
        kept[item.lines.clone()].fill(reached);
    }
    kept
}

fn items<'a>(lines: &[&'a str]) -> Vec<Item<'a>> {
    let mut items = Vec::new();
    let (mut first, mut depth, mut words) = (0, 0, Vec::new());
    for (index, line) in lines.iter().enumerate() {
        let code = line.split("//").next().unwrap_or_default().trim_end();
        words.extend(code.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| !word.is_empty()));
        depth += code.matches(['{', '(', '[']).count();
        depth -= code.matches(['}', ')', ']']).count().min(depth);
        if depth == 0 && code.ends_with(['}', ';']) {
            items.push(item(first..index + 1, std::mem::take(&mut words)));
            first = index + 1;
        }
    }
    items.push(item(first..lines.len(), words));
    items
}

fn item(lines: std::ops::Range<usize>, words: Vec<&str>) -> Item<'_> {
    const NAMED: [&str; 5] = ["fn", "struct", "const", "alias", "override"];
    // A variable's name follows the words of its address space and access.
    const OF_VARIABLES: [&str; 7] = ["var", "private", "workgroup", "uniform", "storage", "read", "read_write"];
    let start = words.iter().position(|word| NAMED.contains(word) || *word == "var");
    let name = start.and_then(|start| words[start + 1..].iter().find(|word| !OF_VARIABLES.contains(word))).copied();
    let is_entry = words.first() == Some(&"compute");
    Item { lines, name, words: words.into_iter().collect(), is_entry }
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
