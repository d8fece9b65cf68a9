//! Speed as a page, as comma-separated values, and as lines for a terminal.

use std::fmt::Write;

use maud::{Markup, PreEscaped, html};

use super::super::growth::Growth;
use super::super::machine::Machine;
use super::super::speed::{Outcome, Speed, SpeedRow, SpeedTable};
use super::super::subject::BenchError;
use super::elements::{self, csv_text, number, page, ratio, ratio_text, spread, spread_text};
use super::plot::{Point, Series, log_log};

/// The label of a row: the scene, or the size.
fn label(row: &SpeedRow) -> String {
    row.count.map_or_else(|| row.scene.clone(), |count| count.to_string())
}

/// Every row with its medians.
///
/// # Errors
/// None but of memory.
pub fn speed_csv(tables: &[SpeedTable]) -> Result<Vec<u8>, BenchError> {
    let mut rows = Vec::new();
    for table in tables {
        for row in &table.rows {
            let mut cells = vec![
                table.growth.label().to_owned(),
                row.scene.clone(),
                row.count.map_or_else(String::new, |count| count.to_string()),
                row.width.to_string(),
                row.height.to_string(),
                row.spp.to_string(),
            ];
            match &row.outcome {
                Outcome::DoesNotFit(why) => {
                    cells.extend(std::iter::repeat_n(String::new(), 10));
                    cells.push(why.clone());
                }
                Outcome::Measured(speed) => {
                    cells.extend([speed.device.clone(), speed.stages.clone()]);
                    let numbers = [
                        speed.build_seconds,
                        speed.compile_seconds,
                        speed.first_picture_seconds,
                        speed.seconds.median,
                        speed.samples_per_second.median,
                        speed.rays_per_second.median,
                        speed.rays_per_sample,
                        speed.device_bytes as f64,
                    ];
                    cells.extend(numbers.map(|value| value.to_string()));
                    cells.push(String::new());
                }
            }
            rows.push(cells);
        }
    }
    let head = [
        "table",
        "scene",
        "count",
        "width",
        "height",
        "spp",
        "device",
        "stages",
        "build_seconds",
        "compile_seconds",
        "first_picture_seconds",
        "seconds",
        "samples_per_second",
        "rays_per_second",
        "rays_per_sample",
        "device_bytes",
        "does_not_fit",
    ];
    csv_text(&head, rows)
}

/// One table for a terminal.
pub fn speed_text(table: &SpeedTable) -> String {
    let mut text = format!("{}\n", table.growth.label());
    for row in &table.rows {
        let _ = write!(text, "  {:<28}", label(row));
        match &row.outcome {
            Outcome::DoesNotFit(why) => {
                let _ = writeln!(text, "does not fit: {why}");
            }
            Outcome::Measured(speed) => {
                let _ = write!(
                    text,
                    "{} Msample/s, {} Mray/s, {}; build {} s, compile {} s",
                    spread_text(&speed.samples_per_second.scaled(1e-6)),
                    number(speed.rays_per_second.median * 1e-6),
                    speed.stages,
                    number(speed.build_seconds),
                    number(speed.compile_seconds),
                );
                if let Some(ratio) = speed.time_per_sample {
                    let _ = write!(text, "; time per sample over the first {}", ratio_text(&ratio));
                }
                text.push('\n');
            }
        }
    }
    text
}

/// The whole report.
///
/// # Errors
/// Errors of charts.
pub fn speed_page(tables: &[SpeedTable], machine: &Machine) -> Result<String, BenchError> {
    let sections: Result<Vec<Markup>, BenchError> = tables.iter().map(section).collect();
    let content = html! {
        p {
            "The rows of a table were made ready and then rendered in turn, round after round, after one round that was thrown away. Figures are medians "
            "with least and largest; times per sample are compared round by round, and the range holds the true ratio with at least 95 % confidence. "
            "The first picture's time is from nothing to one sample of every pixel: packing, upload, kernels, the driver's compiler, or what the driver kept "
            "of an earlier one."
        }
        @for section in sections? { (section) }
    };
    Ok(page("Speed, and how it grows", machine, &content))
}

fn measured(table: &SpeedTable) -> impl Iterator<Item = (&SpeedRow, &Speed)> {
    table.rows.iter().filter_map(|row| match &row.outcome {
        Outcome::Measured(speed) => Some((row, &**speed)),
        Outcome::DoesNotFit(_) => None,
    })
}

fn section(table: &SpeedTable) -> Result<Markup, BenchError> {
    let name = table.growth.label();
    Ok(html! {
        h2 { (if table.growth == Growth::Scenes { "Scenes".to_owned() } else { format!("Growth with {name}") }) }
        @if table.growth != Growth::Scenes {
            div class="charts" {
                div { (chart(table, name, "ns per sample", &|row, speed| 1e9 * speed.seconds.median / samples(row))?) }
                div { (chart(table, name, "build s", &|_, speed| speed.build_seconds)?) }
            }
        }
        (speeds(table))
        @for (row, speed) in measured(table).filter(|(_, speed)| speed.stage_times.len() > 1) {
            h3 { "Stages: " (label(row)) @if row.count.is_some() { " " (name) } }
            (stages(speed))
        }
    })
}

fn samples(row: &SpeedRow) -> f64 {
    f64::from(row.width) * f64::from(row.height) * f64::from(row.spp)
}

fn chart(
    table: &SpeedTable,
    x_label: &str,
    y_label: &str,
    height: &dyn Fn(&SpeedRow, &Speed) -> f64,
) -> Result<Markup, BenchError> {
    let points = measured(table).filter_map(|(row, speed)| Some(Point::exact(row.count? as f64, height(row, speed)))).collect();
    Ok(PreEscaped(log_log(&[Series { number: 0, points, floor: None }], x_label, y_label)?))
}

fn speeds(table: &SpeedTable) -> Markup {
    let rows: Vec<Vec<Markup>> = table
        .rows
        .iter()
        .map(|row| {
            let size = html! { (row.width) " × " (row.height) ", " (row.spp) " spp" };
            let mut cells = vec![html! { (label(row)) }, size];
            match &row.outcome {
                Outcome::DoesNotFit(why) => cells.push(html! { span class="flag" { "does not fit: " (why) } }),
                Outcome::Measured(speed) => cells.extend([
                    html! { (speed.stages) },
                    spread(&speed.samples_per_second.scaled(1e-6)),
                    spread(&speed.rays_per_second.scaled(1e-6)),
                    html! { (number(speed.rays_per_sample)) },
                    speed.time_per_sample.as_ref().map_or_else(|| html! { "–" }, ratio),
                    html! { (number(speed.build_seconds)) },
                    html! { (number(speed.compile_seconds)) },
                    html! { (number(speed.first_picture_seconds)) },
                    html! { (speed.bytes_per_path.map_or_else(|| "registers".to_owned(), |bytes| bytes.to_string())) },
                    html! { (number(speed.device_bytes as f64 / f64::from(1 << 20))) },
                ]),
            }
            cells
        })
        .collect();
    elements::table(
        &[
            if table.growth == Growth::Scenes { "scene" } else { table.growth.label() },
            "picture",
            "stages",
            "Msample/s",
            "Mray/s",
            "rays a sample",
            "time per sample over the first",
            "build s",
            "compile s",
            "first picture s",
            "bytes a path",
            "device MiB",
        ],
        &rows,
    )
}

fn stages(speed: &Speed) -> Markup {
    let rows: Vec<Vec<Markup>> = speed
        .stage_times
        .iter()
        .map(|stage| {
            vec![
                html! { (stage.stage) },
                spread(&stage.seconds.scaled(1e3)),
                html! { (number(100.0 * stage.share)) " %" },
                html! { (stage.dispatches) },
            ]
        })
        .collect();
    html! {
        (elements::table(&["stage", "ms a pass", "share", "dispatches"], &rows))
        @if !speed.occupancy.is_empty() {
            p {
                "Paths alive, as shares of the pool, edge by edge: "
                (speed.occupancy.iter().map(|share| format!("{:.1} %", 100.0 * share)).collect::<Vec<_>>().join(", ")) "."
            }
        }
    }
}
