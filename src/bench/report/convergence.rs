//! Convergence as a page, as comma-separated values, and as lines for a terminal.

use std::fmt::Write;

use maud::{Markup, PreEscaped, html};

use super::super::analysis::{Comparison, Floor, METRICS, Trend};
use super::super::convergence::{SceneConvergence, SettingConvergence};
use super::super::machine::Machine;
use super::super::subject::BenchError;
use super::elements::{self, csv_text, interval, number, page, ratio, ratio_text, spread, spread_text, table};
use super::pictures;
use super::plot::{Point, Series, css_color, log_log};
use crate::compare::Metric;

/// The name that papers use.
fn metric_name(metric: Metric) -> &'static str {
    if metric == Metric::RelMse { "relMSE" } else { "MSE" }
}

/// Every picture that was measured, one a row.
///
/// # Errors
/// None but of memory.
pub fn convergence_csv(scenes: &[SceneConvergence]) -> Result<Vec<u8>, BenchError> {
    let mut rows = Vec::new();
    for scene in scenes {
        for setting in &scene.settings {
            for (level, seen) in setting.curve.levels.iter().zip(&setting.observations.by_level) {
                for (replication, one) in seen.iter().enumerate() {
                    rows.push(vec![
                        scene.scene.clone(),
                        setting.setting.clone(),
                        setting.device.clone(),
                        level.spp.to_string(),
                        replication.to_string(),
                        one.mse.to_string(),
                        one.relmse.to_string(),
                        one.seconds.to_string(),
                    ]);
                }
            }
        }
    }
    csv_text(&["scene", "setting", "device", "spp", "replication", "mse", "relmse", "seconds"], rows)
}

/// The summary of one scene for the terminal.
pub fn convergence_text(scene: &SceneConvergence) -> String {
    let mut text = format!(
        "{}  {}x{}, {} replications, reference of {} spp, own relMSE {}\n",
        scene.scene,
        scene.width,
        scene.height,
        scene.replications,
        scene.reference.spp.map_or_else(|| "unknown".to_owned(), |spp| spp.to_string()),
        scene.reference.own_error.map_or_else(|| "unknown".to_owned(), |own| number(own.relmse)),
    );
    for setting in &scene.settings {
        let Some(last) = setting.curve.levels.last() else { continue };
        let _ = write!(
            text,
            "  {:<28} {} spp: relMSE {} (±{}) in {} s",
            setting.setting,
            last.spp,
            number(last.relmse.estimate),
            number(last.relmse.high - last.relmse.estimate),
            spread_text(&last.seconds)
        );
        if let Some(trend) = setting.curve.trends.iter().find(|trend| trend.metric == Metric::RelMse) {
            let slope = trend.slope.map_or_else(|| "not fitted".to_owned(), |slope| format!("{:.2}", slope.estimate));
            let _ = write!(text, ", slope {slope}");
            if trend.floor.flagged {
                let _ = write!(text, "\n{:31}FLOOR: {}", "", floor_sentence(&trend.floor));
            }
        }
        text.push('\n');
        for comparison in setting.against_first.iter().filter(|one| one.metric == Metric::RelMse) {
            let equal_time = comparison.error_at_equal_time.map_or_else(|| "–".to_owned(), |at| ratio_text(&at.ratio));
            let equal_error = comparison.time_to_equal_error.map_or_else(|| "–".to_owned(), |at| ratio_text(&at.ratio));
            let _ =
                writeln!(text, "{:31}over the first: error at equal time {equal_time}, time to equal error {equal_error}", "");
        }
    }
    text
}

fn floor_sentence(floor: &Floor) -> String {
    let cause = if floor.may_be_the_references { "this setting's bias or the reference's own error" } else { "bias" };
    format!(
        "it does not converge to the reference: {} of squared error stays ({cause}), {} % of the last level's error",
        number(floor.squared_bias.estimate),
        number(100.0 * floor.share_of_last_error)
    )
}

/// The whole report.
///
/// # Errors
/// Errors of charts and pictures.
pub fn convergence_page(scenes: &[SceneConvergence], machine: &Machine) -> Result<String, BenchError> {
    let sections: Result<Vec<Markup>, BenchError> =
        scenes.iter().enumerate().map(|(index, scene)| section(index, scene)).collect();
    let content = html! {
        p {
            "Errors are means over independent pictures against a reference, whose own error is taken off; the ranges beside them hold the truth "
            "with 95 % confidence (Student's t). Times are of the render alone, and of layers and denoiser where it is denoised: medians with least "
            "and largest. Settings took turns at every step, after a picture of each that was thrown away. Ratios are taken replication by "
            "replication: their median, and the range that holds the true one with at least 95 % confidence whatever the distribution. A range "
            "that holds 1 says “inside the noise”."
        }
        @for section in sections? { (section) }
    };
    Ok(page("Error against samples and time", machine, &content))
}

fn section(index: usize, scene: &SceneConvergence) -> Result<Markup, BenchError> {
    let depth = if scene.max_depth == 0 { "no limit".to_owned() } else { scene.max_depth.to_string() };
    Ok(html! {
        h2 { (scene.scene) }
        @if scene.interrupted { p class="flag" { "Stopped early: only whole replications are counted." } }
        p {
            (scene.width) " × " (scene.height) " pixels, path edges at most: " (depth) ", " (scene.replications) " replications. "
            (reference_sentence(scene))
        }
        ul class="legend" {
            @for (number, setting) in scene.settings.iter().enumerate() {
                li { i style=(format!("background:{}", css_color(number))) {} (setting.setting) }
            }
        }
        @for metric in METRICS.into_iter().rev() {
            div class="charts" {
                div { (chart(scene, metric, true)?) }
                div { (chart(scene, metric, false)?) }
            }
        }
        h3 { "At the last level" }
        (last_levels(scene))
        @for setting in &scene.settings {
            @for trend in setting.curve.trends.iter().filter(|trend| trend.floor.flagged) {
                p class="flag" { (setting.setting) ", " (metric_name(trend.metric)) ": " (floor_sentence(&trend.floor)) "." }
            }
        }
        @if scene.settings.len() > 1 {
            h3 { "Against “" (scene.settings[0].setting) "”" }
            p { "Below 1 is better, but for efficiency = 1 / (error × time)." }
            (ratios(scene))
        }
        h3 { "Pictures of " (number(scene.equal_time)) " s" }
        @if scene.settings.iter().filter_map(|setting| setting.at_equal_time.as_ref()).any(|at| at.seconds > 1.5 * scene.equal_time) {
            p { "A setting that takes longer for its fewest samples is shown with those." }
        }
        (equal_time_pictures(index, scene)?)
    })
}

fn reference_sentence(scene: &SceneConvergence) -> String {
    let reference = &scene.reference;
    let spp = reference.spp.map_or_else(String::new, |spp| format!(" of {spp} samples per pixel"));
    match reference.own_error {
        Some(own) => format!(
            "Reference{spp} ({}); its own error by the scatter of its parts: MSE {}, relMSE {}.",
            reference.origin,
            number(own.mse),
            number(own.relmse)
        ),
        None => format!("Reference{spp}: {}; its own error is not known and not taken off.", reference.origin),
    }
}

fn chart(scene: &SceneConvergence, metric: Metric, over_time: bool) -> Result<Markup, BenchError> {
    let series: Vec<Series> = scene
        .settings
        .iter()
        .enumerate()
        .map(|(number, setting)| Series {
            number,
            points: setting
                .curve
                .levels
                .iter()
                .map(|level| {
                    let error = level.error(metric);
                    let x = if over_time { level.seconds.median } else { f64::from(level.spp) };
                    Point { x, y: error.estimate, low: error.low, high: error.high }
                })
                .collect(),
            floor: trend(setting, metric).filter(|trend| trend.floor.flagged).map(|trend| trend.floor.squared_bias.estimate),
        })
        .collect();
    let x_label = if over_time { "seconds" } else { "samples per pixel" };
    Ok(PreEscaped(log_log(&series, x_label, metric_name(metric))?))
}

fn trend(setting: &SettingConvergence, metric: Metric) -> Option<&Trend> {
    setting.curve.trends.iter().find(|trend| trend.metric == metric)
}

fn last_levels(scene: &SceneConvergence) -> Markup {
    let rows: Vec<Vec<Markup>> = scene
        .settings
        .iter()
        .filter_map(|setting| Some((setting, setting.curve.levels.last()?)))
        .map(|(setting, last)| {
            let slope = |metric| match trend(setting, metric).and_then(|trend| trend.slope) {
                Some(slope) => interval(&slope),
                None => html! { "not fitted" },
            };
            vec![
                html! { (setting.setting) },
                html! { (last.spp) },
                spread(&last.seconds),
                interval(&last.mse),
                interval(&last.relmse),
                slope(Metric::Mse),
                slope(Metric::RelMse),
                html! { (number(setting.build_seconds)) " + " (number(setting.compile_seconds)) },
                html! { (setting.curve.non_finite_samples) },
                html! { (setting.device) },
            ]
        })
        .collect();
    table(
        &[
            "setting",
            "spp",
            "seconds",
            "MSE",
            "relMSE",
            "slope, MSE",
            "slope, relMSE",
            "build + compile s",
            "not finite",
            "device",
        ],
        &rows,
    )
}

fn ratios(scene: &SceneConvergence) -> Markup {
    let row = |setting: &SettingConvergence, comparison: &Comparison| {
        let at = |found: &Option<super::super::analysis::RatioAt>, unit: &str| match found {
            Some(found) => html! { (ratio(&found.ratio)) span class="range" { " at " (number(found.at)) (unit) } },
            None => html! { "the curves do not meet" },
        };
        vec![
            html! { (setting.setting) },
            html! { (metric_name(comparison.metric)) },
            at(&comparison.error_at_equal_time, " s"),
            at(&comparison.time_to_equal_error, ""),
            ratio(&comparison.efficiency),
            ratio(&comparison.error_at_equal_samples),
            ratio(&comparison.time_at_equal_samples),
        ]
    };
    let rows: Vec<Vec<Markup>> = scene
        .settings
        .iter()
        .flat_map(|setting| setting.against_first.iter().map(|comparison| row(setting, comparison)).collect::<Vec<_>>())
        .collect();
    table(
        &[
            "setting",
            "metric",
            "error at equal time",
            "time to equal error",
            "efficiency",
            "error, equal samples",
            "time, equal samples",
        ],
        &rows,
    )
}

fn equal_time_pictures(index: usize, scene: &SceneConvergence) -> Result<Markup, BenchError> {
    let mut shown = vec![(
        format!("p{index}-reference"),
        "reference".to_owned(),
        pictures::picture_address(&scene.reference_picture)?,
        None,
        String::new(),
    )];
    for (number, setting) in scene.settings.iter().enumerate() {
        if let Some(at) = &setting.at_equal_time {
            shown.push((
                format!("p{index}-{number}"),
                setting.setting.clone(),
                pictures::picture_address(&at.picture)?,
                Some(pictures::heat_address(&at.picture, &scene.reference_picture)?),
                format!("{} spp, {} s, relMSE {}", at.spp, elements::number(at.seconds), elements::number(at.relmse)),
            ));
        }
    }
    let choice = |chosen: usize, label: &str| {
        html! {
            select aria-label=(label) {
                @for (place, (id, name, ..)) in shown.iter().enumerate() {
                    option value=(id) selected[place == chosen.min(shown.len() - 1)] { (name) }
                }
            }
        }
    };
    Ok(html! {
        div class="slider" hidden {
            div class="choice" { (choice(1, "picture on the left")) (choice(if shown.len() > 2 { 2 } else { 0 }, "picture on the right")) }
            div class="frame" { img alt="left picture"; img class="over" alt="right picture"; }
            input type="range" min="0" max="100" value="50" aria-label="where the right picture begins";
        }
        p {
            "Maps of the relative error: "
            @for (label, [r, g, b]) in pictures::HEAT_STOPS {
                span style=(format!("border-left:1.2em solid rgb({r},{g},{b});padding:0 .8em 0 .3em;white-space:nowrap")) { (label) }
            }
        }
        div class="pictures" {
            @for (id, name, picture, heat, caption) in &shown {
                figure {
                    img id=(id) src=(picture) alt=(name);
                    @if let Some(heat) = heat { img src=(heat) alt=(format!("relative error of {name}")); }
                    figcaption { strong { (name) } " " (caption) }
                }
            }
        }
    })
}
