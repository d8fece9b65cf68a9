//! The losses of an import: parts of a file that it could not take over as they were written.

use serde::Serialize;

/// Everything of an imported file that is not rendered exactly as it says.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct ImportReport {
    /// Parts that have no effect.
    pub dropped: Vec<ReportItem>,
    /// Parts that something similar stands in for.
    pub approximated: Vec<ReportItem>,
}

/// One kind of thing, however often it occurs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ReportItem {
    /// The key, extension, node or plugin.
    pub what: String,
    /// The place of its first occurrence.
    #[serde(rename = "where")]
    pub place: String,
    /// How often it occurs.
    pub count: usize,
    /// The substitute.
    pub instead: String,
}

impl ImportReport {
    /// Everything is rendered as it is written.
    pub fn is_empty(&self) -> bool {
        self.dropped.is_empty() && self.approximated.is_empty()
    }

    /// Notes something that has no effect.
    pub fn drop(&mut self, what: impl Into<String>, place: impl Into<String>, instead: impl Into<String>) {
        note(&mut self.dropped, what.into(), place.into(), instead.into());
    }

    /// Notes something that has something else in its place.
    pub fn approximate(&mut self, what: impl Into<String>, place: impl Into<String>, instead: impl Into<String>) {
        note(&mut self.approximated, what.into(), place.into(), instead.into());
    }

    /// Adds what another file's import left.
    pub fn append(&mut self, other: Self) {
        for (mine, theirs) in [(&mut self.dropped, other.dropped), (&mut self.approximated, other.approximated)] {
            for item in theirs {
                match find(mine, &item.what, &item.instead) {
                    Some(known) => known.count += item.count,
                    None => mine.push(item),
                }
            }
        }
    }

    /// One line for people who render; None where everything is as it was written.
    pub fn summary(&self) -> Option<String> {
        let count = |items: &[ReportItem]| items.iter().map(|item| item.count).sum::<usize>();
        let (dropped, approximated) = (count(&self.dropped), count(&self.approximated));
        let part = |count: usize, words: &str| match count {
            0 => None,
            1 => Some(format!("1 thing is {words}")),
            many => Some(format!("{many} things are {words}")),
        };
        let parts: Vec<String> = [part(dropped, "dropped"), part(approximated, "approximated")].into_iter().flatten().collect();
        (!parts.is_empty()).then(|| format!("the import is not exact: {}; `gpt check` lists them", parts.join(" and ")))
    }
}

fn note(items: &mut Vec<ReportItem>, what: String, place: String, instead: String) {
    match find(items, &what, &instead) {
        Some(known) => known.count += 1,
        None => items.push(ReportItem { what, place, count: 1, instead }),
    }
}

fn find<'i>(items: &'i mut [ReportItem], what: &str, instead: &str) -> Option<&'i mut ReportItem> {
    items.iter_mut().find(|item| item.what == what && item.instead == instead)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_are_counted_with_their_first_place() {
        let mut report = ImportReport::default();
        assert_eq!(report.summary(), None);
        for line in 1..4 {
            report.drop("medium", format!("a.xml:{line}"), "nothing");
        }
        report.approximate("spot falloff", "a.xml:9", "smooth step");
        let mut other = ImportReport::default();
        other.drop("medium", "b.xml:1", "nothing");
        report.append(other);
        assert_eq!((report.dropped[0].count, report.dropped[0].place.as_str()), (4, "a.xml:1"));
        let summary = report.summary().expect("something is not exact");
        assert!(summary.contains("4 things are dropped and 1 thing is approximated"), "{summary}");
    }
}
