//! Mends of a model's file: wrong statements that have something else in their place, so that one of them does not refuse a whole model.

use std::collections::BTreeMap;

use super::model::Substitute;

/// Most characters of a statement that is quoted.
const LONGEST_QUOTE: usize = 40;

/// Mends of one file, each kind once.
#[derive(Debug, Default)]
pub struct Mends {
    kinds: BTreeMap<&'static str, Mend>,
}

#[derive(Debug)]
struct Mend {
    /// The first one; counts from 1.
    line: Option<usize>,
    example: String,
    count: usize,
}

impl Mends {
    /// Counts a mend: what is wrong and what is done instead, the line, and what stands there.
    pub fn add(&mut self, what: &'static str, line: usize, written: &str) {
        self.count(what, Some(line), || quote(written));
    }

    /// Counts a mend that stands in no line; `example` says where it is.
    pub fn add_at(&mut self, what: &'static str, example: impl FnOnce() -> String) {
        self.count(what, None, example);
    }

    fn count(&mut self, what: &'static str, line: Option<usize>, example: impl FnOnce() -> String) {
        self.kinds.entry(what).or_insert_with(|| Mend { line, example: example(), count: 0 }).count += 1;
    }

    /// In the order in which they first came.
    pub fn into_substitutes(self) -> Vec<Substitute> {
        let mut mends: Vec<_> = self.kinds.into_iter().collect();
        mends.sort_by_key(|(_, mend)| mend.line);
        let sentence = |(what, Mend { line, example, count }): (&str, Mend)| {
            let in_all = if count > 1 { format!("; {count} in all") } else { String::new() };
            let example = if example.is_empty() { String::new() } else { format!(": {example}") };
            Substitute { line, what: format!("{what}{example}{in_all}") }
        };
        mends.into_iter().map(sentence).collect()
    }
}

/// The start of a statement between backquotes.
fn quote(written: &str) -> String {
    match written.char_indices().nth(LONGEST_QUOTE) {
        _ if written.is_empty() => String::new(),
        Some((end, _)) => format!("`{}…`", &written[..end]),
        None => format!("`{written}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_is_reported_once_with_its_first_line_and_how_many_there_are() {
        let mut mends = Mends::default();
        mends.add("b is left out", 7, "b 1");
        mends.add("a is left out", 9, &"x".repeat(50));
        mends.add("b is left out", 8, "b 2");
        mends.add_at("no more", String::new);
        let reported: Vec<_> = mends.into_substitutes().into_iter().map(|one| (one.line, one.what)).collect();
        let long = format!("a is left out: `{}…`", "x".repeat(40));
        assert_eq!(reported, [(None, "no more".into()), (Some(7), "b is left out: `b 1`; 2 in all".into()), (Some(9), long)]);
    }
}
