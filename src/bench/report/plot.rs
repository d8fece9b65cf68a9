//! Curves on logarithmic axes, as SVG.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::super::subject::BenchError;

/// Width and height in the SVG's own units: about as many pixels as a column of the page has, so that text is read at its size on a wide
/// screen and still is on a telephone.
const SIZE: (u32, u32) = (520, 380);
const TEXT: u32 = 16;
/// Colours that people with any colour vision tell apart (Okabe and Ito 2008), black last.
const COLORS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(140, 120, 40),
    RGBColor(0, 0, 0),
];

/// The colour of the series with this number, as CSS writes it.
pub fn css_color(series: usize) -> String {
    let RGBColor(r, g, b) = COLORS[series % COLORS.len()];
    format!("rgb({r},{g},{b})")
}

/// A point with the interval of its height.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    pub low: f64,
    pub high: f64,
}

impl Point {
    /// A point whose height is known.
    pub fn exact(x: f64, y: f64) -> Self {
        Self { x, y, low: y, high: y }
    }
}

/// One curve; points that have no place on logarithmic axes are left out.
#[derive(Debug, Clone)]
pub struct Series {
    /// Which colour.
    pub number: usize,
    pub points: Vec<Point>,
    /// A height that is marked across the chart.
    pub floor: Option<f64>,
}

/// Draws curves on logarithmic axes; an empty text where nothing can be drawn.
///
/// # Errors
/// Errors of the drawing library.
pub fn log_log(series: &[Series], x_label: &str, y_label: &str) -> Result<String, BenchError> {
    let positive = |value: &f64| *value > 0.0 && value.is_finite();
    let points = || series.iter().flat_map(|one| &one.points).filter(|point| positive(&point.x) && positive(&point.y));
    let floors = series.iter().filter_map(|one| one.floor).filter(positive);
    let Some(x_range) = padded(points().map(|point| point.x)) else { return Ok(String::new()) };
    let Some(y_range) = padded(points().map(|point| point.y).chain(floors)) else { return Ok(String::new()) };
    let mut svg = String::new();
    let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
    draw(&area, series, (x_range, y_range), (x_label, y_label))
        .map_err(|error| BenchError::Internal(format!("a chart cannot be drawn: {error}")))?;
    drop(area);
    Ok(scalable(&svg, &format!("{y_label} against {x_label}")))
}

/// The range of positive numbers, with some space on either side; to whole powers of ten where it would hold fewer than two of them, since
/// those are what is labelled.
fn padded(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let (least, largest) =
        values.fold((f64::INFINITY, 0.0_f64), |(least, largest), value| (least.min(value), largest.max(value)));
    let (low, high) = (least / 1.3, largest * 1.3);
    let [floor, ceiling] = [low.log10().floor(), high.log10().ceil()];
    let powers = high.log10().floor() - low.log10().ceil() + 1.0;
    let range = if powers >= 2.0 { (low, high) } else { (10.0_f64.powf(floor), 10.0_f64.powf(ceiling)) };
    (least <= largest).then_some(range)
}

type Range = (f64, f64);

fn draw<'a>(
    area: &DrawingArea<SVGBackend<'a>, Shift>,
    series: &[Series],
    (x_range, y_range): (Range, Range),
    (x_label, y_label): (&str, &str),
) -> Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>> {
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .margin_right(22)
        .x_label_area_size(48)
        .y_label_area_size(74)
        .build_cartesian_2d((x_range.0..x_range.1).log_scale(), (y_range.0..y_range.1).log_scale())?;
    chart
        .configure_mesh()
        .x_desc(x_label)
        .y_desc(y_label)
        .label_style(("sans-serif", TEXT))
        .axis_desc_style(("sans-serif", TEXT))
        .x_labels(6)
        .y_labels(6)
        .x_label_formatter(&|value| short(*value))
        .y_label_formatter(&|value| short(*value))
        .bold_line_style(RGBColor(210, 210, 210))
        .light_line_style(RGBColor(240, 240, 240))
        .draw()?;
    for one in series {
        let color = COLORS[one.number % COLORS.len()];
        let seen: Vec<&Point> = one.points.iter().filter(|point| point.x > 0.0 && point.y > 0.0).collect();
        chart.draw_series(LineSeries::new(seen.iter().map(|point| (point.x, point.y)), color.stroke_width(2)))?;
        chart.draw_series(seen.iter().map(|point| {
            let ends = [point.low, point.high].map(|end| (point.x, end.clamp(y_range.0, y_range.1)));
            PathElement::new(ends.to_vec(), color.stroke_width(1))
        }))?;
        chart.draw_series(seen.iter().map(|point| Circle::new((point.x, point.y), 4, color.filled())))?;
        if let Some(floor) = one.floor {
            let ends = vec![(x_range.0, floor), (x_range.1, floor)];
            chart.draw_series(DashedLineSeries::new(ends, 6, 4, color.stroke_width(1)))?;
        }
    }
    area.present()
}

/// A tick's label: plain where that is short, else a power of ten.
fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        let text = format!("{value:.3}");
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    format!("{value:.0e}")
}

/// Lets the page choose the size and tells readers of screens what is drawn.
fn scalable(svg: &str, title: &str) -> String {
    let (width, height) = SIZE;
    let fixed = format!("width=\"{width}\" height=\"{height}\" ");
    svg.replacen(&fixed, &format!("role=\"img\" aria-label=\"{title}\" "), 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_becomes_an_svg_that_scales() {
        let points = [1.0, 2.0, 4.0].map(|x| Point { x, y: 1.0 / x, low: 0.9 / x, high: 1.1 / x }).to_vec();
        let svg = log_log(&[Series { number: 0, points, floor: Some(0.2) }], "seconds", "relMSE").unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("viewBox") && svg.contains("seconds"), "{svg}");
        assert!(!svg.contains("width=\"520\" height=\"380\" viewBox"), "the size is the page's to choose");
        assert_eq!(svg.matches("<circle").count(), 3);
    }

    #[test]
    fn axes_hold_two_powers_of_ten() {
        assert_eq!(padded([0.2, 50.0].into_iter()), Some((0.2 / 1.3, 65.0)));
        let (low, high) = padded([1900.0, 4200.0].into_iter()).unwrap();
        assert!((low - 1e3).abs() < 1e-6 && (high - 1e4).abs() < 1e-6, "{low} {high}");
        assert_eq!(padded(std::iter::empty()), None);
    }

    #[test]
    fn what_has_no_place_is_left_out() {
        let bad = [0.0, -1.0, f64::NAN].map(|y| Point::exact(1.0, y)).to_vec();
        assert_eq!(log_log(&[Series { number: 0, points: bad, floor: None }], "x", "y").unwrap(), "");
        assert_eq!([short(0.25), short(100.0), short(2e-7), short(1e6)], ["0.25", "100", "2e-7", "1e6"]);
    }
}
