//! Decides statements `if HAS_X && … {` by the switches of a plan: a block that never runs is left out of the text. So the names in a block need to
//! exist only in kernels whose switches are on. A block that always runs and returns leaves out the statements behind it.

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
        let holds = condition(line).and_then(|condition| value(condition, enabled));
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
            let body = folded(&lines[at + 1..end], enabled);
            let returns = ends_with_return(&body);
            // A block beside another branch, or that returns, stands alone, because a function that ends with it has to return.
            let stands_alone = last != end || returns;
            kept.push((*number, if stands_alone { format!("{indent}{{").into() } else { line.clone() }));
            kept.extend(body);
            kept.push((lines[last].0, format!("{indent}}}").into()));
            if returns {
                // Nothing runs behind it, up to the end of the block around it.
                last = end_of_block(lines, last).unwrap_or(lines.len()) - 1;
            }
        } else if let Some(otherwise) = code(&lines[end].1).strip_prefix("} else ") {
            let mut rest = vec![(lines[end].0, format!("{indent}{otherwise}").into())];
            rest.extend_from_slice(&lines[end + 1..=last]);
            kept.extend(folded(&rest, enabled));
        }
        at = last + 1;
    }
    kept
}

/// The line without its comment.
pub fn without_comment(line: &str) -> &str {
    // Most lines have no slash at all.
    line.find('/').and_then(|first| Some(&line[..first + line[first..].find("//")?])).unwrap_or(line)
}

/// The line without its comment and the spaces around it.
fn code(line: &str) -> &str {
    without_comment(line).trim()
}

/// The condition of a statement that the line begins.
fn condition(line: &str) -> Option<&str> {
    let statement = line.trim_start();
    if !statement.starts_with("if ") {
        return None;
    }
    code(statement).strip_prefix("if ")?.strip_suffix(" {")
}

/// True if the last statement of a block is a return, whose lines behind the first are indented further or close a bracket.
fn ends_with_return(body: &[Line<'_>]) -> bool {
    let depth = |line: &str| line.len() - line.trim_start().len();
    let least = body.iter().filter(|(_, line)| !code(line).is_empty()).map(|(_, line)| depth(line)).min();
    let last = body
        .iter()
        .rfind(|(_, line)| Some(depth(line)) == least && !code(line).starts_with([')', '}']) && !code(line).is_empty());
    last.is_some_and(|(_, line)| code(line).starts_with("return"))
}

/// Value of a condition under the switches; None where it depends on more.
fn value(condition: &str, enabled: &BTreeSet<&'static str>) -> Option<bool> {
    // `decides` is the value of a part that is the value of the whole.
    for (operator, decides) in [(" || ", true), (" && ", false)] {
        let parts = parts(condition, operator);
        if parts.len() > 1 {
            let values: Vec<Option<bool>> = parts.into_iter().map(|part| value(part, enabled)).collect();
            let decided = values.contains(&Some(decides));
            return if decided { Some(decides) } else { (!values.contains(&None)).then_some(!decides) };
        }
    }
    let (name, wanted) = condition.strip_prefix('!').map_or((condition, true), |name| (name, false));
    let name = name.strip_prefix(SWITCH_PREFIX)?;
    name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_').then(|| enabled.contains(name) == wanted)
}

/// The parts of a condition between an operator, outside of parentheses.
fn parts<'a>(condition: &'a str, operator: &str) -> Vec<&'a str> {
    let (mut parts, mut begin, mut depth) = (Vec::new(), 0, 0);
    for (index, c) in condition.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            ' ' if depth == 0 && condition[index..].starts_with(operator) => {
                parts.push(&condition[begin..index]);
                begin = index + operator.len();
            }
            _ => {}
        }
    }
    parts.push(&condition[begin..]);
    parts
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
        // A lone `|` ends a line.
        let text = text.replace("||", "or");
        let lines = (1..).zip(text.split('|').map(|line| Cow::Owned(line.replace(" or ", " || "))));
        let lines = folded(&lines.collect::<Vec<Line<'_>>>(), &enabled);
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
    fn nothing_runs_behind_a_return() {
        assert_eq!(
            kept("fn f() {|  if HAS_ON {|    return 1;|  }|  b|}|fn g() {|c|}"),
            "fn f() {|  {|    return 1;|  }|}|fn g() {|c|}"
        );
        assert_eq!(
            kept("if x {|  if !HAS_OFF {|    return g(|      1|    );|  }|  b|}|c"),
            "if x {|  {|    return g(|      1|    );|  }|}|c"
        );
        assert_eq!(kept("fn f() {|  if HAS_OFF {|    return 1;|  }|  b|}"), "fn f() {|  b|}");
        let goes_on = "if HAS_ON {|  if x {|    return 1;|  }|}|b";
        assert_eq!(kept(goes_on), goes_on);
    }

    #[test]
    fn conditions_are_decided_as_far_as_switches_go() {
        assert_eq!(kept("if HAS_OFF || !HAS_ON {|a|}|b"), "b");
        assert_eq!(kept("if (x || HAS_ON) && HAS_OFF {|a|}|b"), "b");
        assert_eq!(kept("if HAS_ON || x {|a|} else {|b|}"), "{|a|}");
        assert_eq!(kept("if HAS_OFF || HAS_ON {|a|}"), "if HAS_OFF || HAS_ON {|a|}");
        assert_eq!(kept("if !HAS_ON || (HAS_OFF && x) {|a|}|b"), "if !HAS_ON || (HAS_OFF && x) {|a|}|b");
    }

    #[test]
    fn what_a_kernel_decides_stays() {
        for text in ["if x {|a|} else {|b|}", "if HAS_ON && x {|a|}", "if HAS_OFF || x {|a|}", "let y = select(1, 2, HAS_OFF);"] {
            assert_eq!(kept(text), text);
        }
    }
}
