//! The costs of features as a page, as comma-separated values, and as lines for a terminal.

use std::fmt::Write;

use maud::{Markup, html};

use super::super::features::{FeatureCost, Variant};
use super::super::machine::Machine;
use super::super::subject::BenchError;
use super::elements::{csv_text, number, page, ratio, ratio_text, spread, table};

/// Every variant, one a row.
///
/// # Errors
/// None but of memory.
pub fn features_csv(costs: &[FeatureCost]) -> Result<Vec<u8>, BenchError> {
    let rows = costs.iter().flat_map(|cost| {
        variants(cost).map(|(name, variant)| {
            let mut cells = vec![cost.feature.clone(), name.to_owned()];
            let interval = variant.time.interval;
            let numbers = [
                variant.seconds.median,
                variant.first_picture_seconds,
                variant.rays_per_sample,
                interval.estimate,
                interval.low,
                interval.high,
            ];
            cells.extend(numbers.map(|value| value.to_string()));
            cells.push(variant.time.verdict.label().to_owned());
            cells
        })
    });
    let head = [
        "feature",
        "variant",
        "seconds",
        "first_picture_seconds",
        "rays_per_sample",
        "ratio",
        "ratio_low",
        "ratio_high",
        "verdict",
    ];
    csv_text(&head, rows)
}

fn variants(cost: &FeatureCost) -> impl Iterator<Item = (&'static str, &Variant)> {
    let compiled = cost.compiled_in.iter().map(|variant| ("compiled in", variant));
    std::iter::once(("off", &cost.off)).chain(compiled).chain(std::iter::once(("used", &cost.used)))
}

/// One feature for a terminal.
pub fn features_text(cost: &FeatureCost) -> String {
    let mut text = format!("{:<22}", cost.feature);
    for (name, variant) in variants(cost).skip(1) {
        let _ = write!(text, "  {name} {}", ratio_text(&variant.time));
    }
    if cost.compiled_in_agrees == Some(false) {
        text.push_str("  THE PICTURE CHANGES by compiling it in");
    }
    text.push('\n');
    text
}

/// The whole report.
///
/// # Errors
/// None today; charts may come.
pub fn features_page(costs: &[FeatureCost], machine: &Machine) -> Result<String, BenchError> {
    let content = html! {
        p {
            "Each feature in a room of two boxes and a lamp, beside the same room without it, in turn, after one round that was thrown away. "
            em { "Compiled in" } " renders the plain room by kernels that hold the feature's code though nothing needs it: what leaving it out saves. "
            em { "Used" } " renders a room that has it; its paths are other paths, as the rays per sample show. Ratios of times are taken round by "
            "round: the median, and the range that holds the true one with at least 95 % confidence."
        }
        (costs_table(costs))
        @for cost in costs.iter().filter(|cost| cost.compiled_in_agrees == Some(false)) {
            p class="flag" { (cost.feature) ": the plain room's picture changes when the feature is compiled in." }
        }
        h3 { "Switches" }
        ul { @for cost in costs { li { (cost.feature) ": " code { (cost.switches.join(" ")) } } } }
    };
    Ok(page("What features cost", machine, &content))
}

fn costs_table(costs: &[FeatureCost]) -> Markup {
    let rows: Vec<Vec<Markup>> = costs
        .iter()
        .map(|cost| {
            let time = |variant: Option<&Variant>| match variant {
                Some(variant) => ratio(&variant.time),
                None => html! { "–" },
            };
            let first = |variant: Option<&Variant>| variant.map_or_else(|| "–".to_owned(), |v| number(v.first_picture_seconds));
            vec![
                html! { (cost.feature) },
                time(cost.compiled_in.as_ref()),
                time(Some(&cost.used)),
                spread(&cost.off.seconds),
                html! { (number(cost.off.rays_per_sample)) " → " (number(cost.used.rays_per_sample)) },
                html! { (first(Some(&cost.off))) " / " (first(cost.compiled_in.as_ref())) " / " (first(Some(&cost.used))) },
            ]
        })
        .collect();
    table(
        &[
            "feature",
            "compiled in, time over off",
            "used, time over off",
            "off s",
            "rays a sample, off → used",
            "first picture s, off / compiled in / used",
        ],
        &rows,
    )
}
