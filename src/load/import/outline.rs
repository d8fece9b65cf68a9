//! Points around shapes, by which a camera is placed.

use glam::DVec3;

use super::keys::{Keys, Value};

/// The corners of boxes around round shapes, and those of flat ones; none of what is infinite or a mesh. In the shape's own coordinates.
pub fn outline(shape: &Keys) -> Vec<DVec3> {
    let point = |key: &str| shape.get(key).and_then(vector);
    let around = |center: DVec3| {
        let half = DVec3::splat(shape.get("radius").and_then(number).unwrap_or(0.0));
        corners(&[center - half, center + half])
    };
    match shape.text("type") {
        Some("sphere" | "disk") => point("center").map(around).unwrap_or_default(),
        Some("cylinder") => [point("from"), point("to")].into_iter().flatten().flat_map(around).collect(),
        Some("box") => match (point("min"), point("max")) {
            (Some(min), Some(max)) => corners(&[min, max]),
            _ => Vec::new(),
        },
        Some("rectangle") => match (point("corner"), point("edge_u"), point("edge_v")) {
            (Some(corner), Some(u), Some(v)) => vec![corner, corner + u, corner + v, corner + u + v],
            _ => Vec::new(),
        },
        _ => Vec::new(),
    }
}

/// The corners of the box around points.
pub fn corners(points: &[DVec3]) -> Vec<DVec3> {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let corner = |index: usize| DVec3::select(glam::BVec3::new(index & 1 != 0, index & 2 != 0, index & 4 != 0), high, low);
    (0..8).map(corner).collect()
}

fn number(value: &Value) -> Option<f64> {
    if let Value::Number(number) = value { Some(*number) } else { None }
}

fn vector(value: &Value) -> Option<DVec3> {
    let Value::List(numbers) = value else { return None };
    let numbers: Vec<f64> = numbers.iter().filter_map(number).collect();
    <[f64; 3]>::try_from(numbers).ok().map(DVec3::from_array)
}
