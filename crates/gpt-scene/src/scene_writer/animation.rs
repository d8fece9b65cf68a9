//! `[animation]`, `[[node]]`, and the keyframes of whatever has some.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec3};

use super::shape::transform_step;
use crate::load::file::strength_key;
use crate::load::file::writer::{Names, colour, direction, line, list, number, table, text, vector};
use crate::scene::animation::{
    CameraTrack, Curve, FRAMES_PER_SECOND, Interpolation, LightTrack, MaterialTrack, Node, ShapeTrack, TransformTrack,
};
use crate::scene::{Animation, Light, Material, Projection, TransformStep};

/// A value that keyframes state under a key, by the frames at which they do.
struct Written {
    key: String,
    at: Vec<(f64, String)>,
}

impl Written {
    fn of<T>(key: &str, curve: &Curve<T>, value: impl Fn(&T) -> String) -> Self {
        Self { key: key.to_owned(), at: curve.keys.iter().map(|key| (key.frame, value(&key.value))).collect() }
    }
}

/// `[animation]` and the nodes.
pub fn animation(animation: &Animation, nodes: &Names) -> String {
    let mut out = String::new();
    if animation.frames_per_second != FRAMES_PER_SECOND {
        out += &format!("\n[animation]\n{}", line("fps", &number(animation.frames_per_second)));
    }
    for (index, node) in animation.nodes.iter().enumerate() {
        out += &format!("\n[[node]]\n{}", line("name", &nodes.quoted(index)));
        out += &node_keys(node, nodes);
    }
    out
}

fn node_keys(node: &Node, nodes: &Names) -> String {
    let mut out = taken_along("parent", node.parent, nodes);
    if node.rest != DAffine3::IDENTITY {
        out += &line("transform", &list([transform_step(&TransformStep::Matrix(node.rest))]));
    }
    out + &node.track.as_ref().map_or_else(String::new, transform)
}

/// The keys of a shape that say where it is at frames.
pub fn shape(track: &ShapeTrack, nodes: &Names) -> String {
    taken_along("node", track.node, nodes) + &track.track.as_ref().map_or_else(String::new, transform)
}

/// Keyframes of the camera.
pub fn camera(track: &CameraTrack, projection: Projection, nodes: &Names) -> String {
    let opening = match projection {
        Projection::Orthographic { .. } => "height",
        // Others have no keys for it, so none are written.
        _ => "vfov",
    };
    let place = |key, curve: &Curve<DVec3>| Written::of(key, curve, |value| vector(*value));
    let written = vec![
        place("position", &track.position),
        place("look_at", &track.look_at),
        place("up", &track.up),
        Written::of(opening, &track.opening, |value| number(*value)),
        Written::of("focus_distance", &track.focus_distance, |value| number(*value)),
    ];
    taken_along("node", track.node, nodes) + &keyframes(&written, track.position.interpolation)
}

/// Keyframes of a light.
pub fn light(track: &LightTrack, light: &Light, nodes: &Names) -> String {
    let strength = strength_key(light);
    let written = vec![
        Written::of("position", &track.position, |value| vector(*value)),
        Written::of("direction", &track.direction, |value| direction(*value)),
        Written::of(strength, &track.strength, |value| colour(*value)),
        Written::of("rotate", &track.rotation, |value| number(*value)),
    ];
    taken_along("node", track.node, nodes) + &keyframes(&written, track.position.interpolation)
}

/// Keyframes of a material. `keyed` writes the keys that keyframes may state, each with its value.
pub fn material(track: &MaterialTrack, rest: &Material, keyed: impl Fn(&Material) -> BTreeMap<String, String>) -> String {
    let form = track.with_all_numbers(rest);
    let mut written: BTreeMap<String, Vec<(f64, String)>> = BTreeMap::new();
    let mut frames: Vec<f64> = track.frames().collect();
    frames.sort_by(f64::total_cmp);
    frames.dedup();
    for frame in frames {
        let mut numbers = form.numbers();
        let mut nudged = numbers.clone();
        for (number, curve) in &track.numbers {
            if let Some(key) = curve.keys.iter().find(|key| key.frame == frame) {
                (numbers[*number], nudged[*number]) = (key.value, nudge(key.value));
            }
        }
        let at = keyed(&form.with_numbers(&numbers));
        // Keys that stand for numbers with a key at this frame change with them. One that has its default is not written, so it is a little off.
        for (key, other) in keyed(&form.with_numbers(&nudged)) {
            if at.get(&key) != Some(&other) {
                let value = at.get(&key).unwrap_or(&other).clone();
                written.entry(key).or_default().push((frame, value));
            }
        }
    }
    let interpolation = track.numbers.first().map_or(Interpolation::default(), |(_, curve)| curve.interpolation);
    let written: Vec<Written> = written.into_iter().map(|(key, at)| Written { key, at }).collect();
    keyframes(&written, interpolation)
}

/// A number that is hardly another, in the ranges of shares and amounts.
fn nudge(value: f64) -> f64 {
    if value.abs() < 0.5 { value + 1e-13 } else { value * (1.0 - 1e-13) }
}

fn taken_along(key: &str, node: Option<usize>, nodes: &Names) -> String {
    node.map_or_else(String::new, |node| line(key, &nodes.quoted(node)))
}

fn transform(track: &TransformTrack) -> String {
    let written = vec![
        Written::of("scale", &track.scale, |value| vector(*value)),
        Written::of("rotate", &track.rotation, |turn| direction(turn.axis)),
        Written::of("degrees", &track.rotation, |turn| number(turn.degrees)),
        Written::of("translate", &track.translation, |value| vector(*value)),
    ];
    keyframes(&written, track.scale.interpolation)
}

/// A table for each frame at which something is stated.
fn keyframes(written: &[Written], interpolation: Interpolation) -> String {
    let mut frames: Vec<f64> = written.iter().flat_map(|written| written.at.iter().map(|(frame, _)| *frame)).collect();
    frames.sort_by(f64::total_cmp);
    frames.dedup();
    if frames.is_empty() {
        return String::new();
    }
    let keyframe = |frame: &f64| {
        let stated = written.iter().flat_map(|written| written.at.iter().map(|(at, value)| (written.key.as_str(), at, value)));
        let values = stated.filter(|(_, at, _)| *at == frame).map(|(key, _, value)| (key, value.clone()));
        table(std::iter::once(("frame", number(*frame))).chain(values))
    };
    let name = match interpolation {
        Interpolation::Linear => String::new(),
        Interpolation::Smooth => line("interpolation", &text("smooth")),
        Interpolation::Step => line("interpolation", &text("step")),
    };
    line("keyframes", &list(frames.iter().map(keyframe))) + &name
}
