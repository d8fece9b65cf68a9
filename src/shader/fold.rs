//! Decides statements `if HAS_X && … {` by the switches of a plan: a block that never runs is left out of the text. So the names in a block need to
//! exist only in kernels whose switches are on.

use std::borrow::Cow;
use std::collections::BTreeSet;

/// The beginning of a switch's name where code reads it as a constant.
pub const SWITCH_PREFIX: &str = "HAS_";

/// A line and its number in its file.
pub type Line<'a> = (u32, Cow<'a, str>);

/// The lines of a file as they stand in the kernel. Statements begin and end as formatted code has them: `if condition {`,
/// `} else if condition {`, `} else {` and `}` each have a line of their own.
pub fn folded<'a>(lines: &[Line<'a>], enabled: &BTreeSet<&'static str>) -> Vec<Line<'a>> {
    let mut kept = Vec::with_capacity(lines.len());
    let mut at = 0;
    while let Some((number, line)) = lines.get(at) {
        let holds = condition(code(line)).and_then(|condition| value(condition, enabled));
        let (Some(holds), Some(end)) = (holds, end_of_block(lines, at)) else {
            kept.push(lines[at].clone());
            at += 1;
            continue;
        };
        let indent = &line[..line.len() - line.trim_start().len()];
        let mut last = end;
        while let Some(next) = code(&lines[last].1).starts_with("} else ").then(|| end_of_block(lines, last)).flatten() {
            last = next;
        }
        if holds {
            // Beside another branch the block stands alone, because a function that ends with it has to return.
            kept.push((*number, if last == end { line.clone() } else { format!("{indent}{{").into() }));
            kept.extend(folded(&lines[at + 1..end], enabled));
            kept.push((lines[last].0, format!("{indent}}}").into()));
        } else if let Some(otherwise) = code(&lines[end].1).strip_prefix("} else ") {
            let mut rest = vec![(lines[end].0, format!("{indent}{otherwise}").into())];
            rest.extend_from_slice(&lines[end + 1..=last]);
            kept.extend(folded(&rest, enabled));
        }
        at = last + 1;
    }
    kept
}

/// The line without its comment and the spaces around it.
fn code(line: &str) -> &str {
    line.split("//").next().unwrap_or_default().trim()
}

fn condition(code: &str) -> Option<&str> {
    code.strip_prefix("if ")?.strip_suffix(" {")
}

/// Value of a condition under the switches; None where it depends on more.
fn value(condition: &str, enabled: &BTreeSet<&'static str>) -> Option<bool> {
    if condition.contains("||") {
        return None;
    }
    let terms = condition.split(" && ").map(|term| {
        let (name, wanted) = term.strip_prefix('!').map_or((term, true), |name| (name, false));
        let name = name.strip_prefix(SWITCH_PREFIX)?;
        name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_').then(|| enabled.contains(name) == wanted)
    });
    let terms: Vec<Option<bool>> = terms.collect();
    if terms.contains(&Some(false)) {
        return Some(false);
    }
    (!terms.contains(&None)).then_some(true)
}

/// The line that closes the block which the line `first` opens.
fn end_of_block(lines: &[Line<'_>], first: usize) -> Option<usize> {
    let mut depth = 1;
    for (index, (_, line)) in lines.iter().enumerate().skip(first + 1) {
        for c in code(line).chars() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                return Some(index);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(text: &str) -> String {
        let enabled = BTreeSet::from(["ON"]);
        let lines: Vec<Line<'_>> = (1..).zip(text.split('|').map(Cow::Borrowed)).collect();
        let lines = folded(&lines, &enabled);
        lines.iter().map(|(_, line)| &**line).collect::<Vec<_>>().join("|")
    }

    #[test]
    fn blocks_are_left_out_by_switches() {
        assert_eq!(kept("a|if HAS_OFF {|  b|}|c"), "a|c");
        assert_eq!(kept("a|  if HAS_ON {|    b|  }|c"), "a|  if HAS_ON {|    b|  }|c");
        assert_eq!(kept("if !HAS_OFF && HAS_ON {|b|}"), "if !HAS_OFF && HAS_ON {|b|}");
        assert_eq!(kept("if x > 0 && HAS_OFF {|b|}|c"), "c");
        assert_eq!(kept("if HAS_OFF { // why|if y {|b|}|}|c"), "c");
    }

    #[test]
    fn other_branches_take_their_place() {
        assert_eq!(kept("if HAS_OFF {|a|} else {|b|}"), "{|b|}");
        assert_eq!(kept("if HAS_ON {|a|} else {|b|}|c"), "{|a|}|c");
        assert_eq!(kept("if HAS_OFF {|a|} else if x {|b|} else {|c|}"), "if x {|b|} else {|c|}");
        assert_eq!(kept("if HAS_OFF {|a|} else if HAS_ON {|b|} else {|c|}|d"), "{|b|}|d");
        assert_eq!(kept("if HAS_ON {|if HAS_OFF {|a|}|b|}"), "if HAS_ON {|b|}");
    }

    #[test]
    fn what_a_kernel_decides_stays() {
        for text in ["if x {|a|} else {|b|}", "if HAS_ON && x {|a|}", "if HAS_OFF || x {|a|}", "let y = select(1, 2, HAS_OFF);"] {
            assert_eq!(kept(text), text);
        }
    }
}
