//! The elements of reports: the page, tables, numbers with their spread.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::bench::interval::{Interval, IntervalVerdict, Ratio, Spread};
use crate::bench::machine::Machine;
use crate::bench::subject::BenchError;

/// The page around a report's content.
pub(super) fn page(title: &str, machine: &Machine, content: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(include_str!("page.css"))) }
            }
            body {
                h1 { (title) }
                dl {
                    dt { "made" } dd { (machine.date) ", gpt " (machine.version) }
                    dt { "by" } dd { code { (machine.command) } }
                    dt { "on" } dd { (machine.processor) ", " (machine.threads) " threads, " (machine.system) }
                    @for device in &machine.devices { dt { "device" } dd { (device) } }
                }
                (content)
                script { (PreEscaped(include_str!("page.js"))) }
            }
        }
    }
    .into_string()
}

/// A table that scrolls by itself where it is wider than the page.
pub(super) fn table(head: &[&str], rows: &[Vec<Markup>]) -> Markup {
    html! {
        div class="scroll" {
            table {
                thead { tr { @for cell in head { th { (cell) } } } }
                tbody { @for row in rows { tr { @for cell in row { td { (cell) } } } } }
            }
        }
    }
}

/// Three digits, plain where that is short.
pub(super) fn number(value: f64) -> String {
    let magnitude = value.abs();
    if !value.is_finite() {
        "–".to_owned()
    } else if value == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e5).contains(&magnitude) {
        format!("{value:.2e}")
    } else {
        let digits = (2 - magnitude.log10().floor() as i32).clamp(0, 5) as usize;
        format!("{value:.digits$}")
    }
}

pub(super) fn interval(interval: &Interval) -> Markup {
    // A dash between negative numbers reads like one more minus.
    let between = if interval.low < 0.0 { " to " } else { "–" };
    html! { (number(interval.estimate)) " " span class="range" { "(" (number(interval.low)) (between) (number(interval.high)) ")" } }
}

pub(super) fn spread(spread: &Spread) -> Markup {
    html! { (number(spread.median)) " " span class="range" { "(" (number(spread.least)) "–" (number(spread.largest)) ")" } }
}

pub(super) fn ratio(ratio: &Ratio) -> Markup {
    let class = match ratio.verdict {
        IntervalVerdict::Less => "less",
        IntervalVerdict::More => "more",
        IntervalVerdict::InsideTheNoise | IntervalVerdict::TooFewRuns => "noise",
    };
    html! {
        span class=(class) { (number(ratio.interval.estimate)) } " "
        span class="range" { "(" (number(ratio.interval.low)) "–" (number(ratio.interval.high)) ")" }
        @if !matches!(ratio.verdict, IntervalVerdict::Less | IntervalVerdict::More) { " " em { (ratio.verdict.label()) } }
    }
}

/// The ratio for a terminal.
pub(super) fn ratio_text(ratio: &Ratio) -> String {
    let Interval { estimate, low, high, .. } = ratio.interval;
    let verdict = match ratio.verdict {
        IntervalVerdict::Less | IntervalVerdict::More => String::new(),
        other => format!(", {}", other.label()),
    };
    format!("{} ({}–{}{verdict})", number(estimate), number(low), number(high))
}

pub(super) fn spread_text(spread: &Spread) -> String {
    format!("{} ({}–{})", number(spread.median), number(spread.least), number(spread.largest))
}

/// Rows under a header, as comma-separated values.
pub(super) fn csv_text(head: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> Result<Vec<u8>, BenchError> {
    let failure = |error: String| BenchError::Internal(format!("the table cannot be written: {error}"));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(head).map_err(|error| failure(error.to_string()))?;
    for row in rows {
        writer.write_record(row).map_err(|error| failure(error.to_string()))?;
    }
    writer.into_inner().map_err(|error| failure(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let shown = [0.0, 1.0, 12.345, 123.45, 0.012_34, 1.5e-6, 2.5e7, f64::NAN].map(number);
        assert_eq!(shown, ["0", "1.00", "12.3", "123", "0.0123", "1.50e-6", "2.50e7", "–"]);
    }

    #[test]
    fn a_ratio_inside_the_noise_says_so() {
        let inside = Ratio::of_pairs([(1.0, 1.1), (1.1, 1.0), (1.0, 1.0), (1.0, 1.05), (1.05, 1.0), (1.0, 1.02)]);
        assert!(ratio(&inside).into_string().contains("inside the noise"));
        let outside = Ratio::of_pairs([(2.0, 1.0); 6]);
        assert!(!ratio(&outside).into_string().contains("noise\u{20}"));
        assert_eq!(ratio_text(&outside), "2.00 (2.00–2.00)");
    }

    #[test]
    fn what_scenes_are_called_cannot_break_the_page() {
        let machine = Machine::here(&[], "gpt bench <script>".to_owned());
        let page = page("a & b", &machine, &html! {});
        assert!(page.contains("gpt bench &lt;script&gt;") && page.contains("a &amp; b"));
        assert!(!page.contains("http://") && !page.contains("https://"), "the page asks for nothing");
    }
}
