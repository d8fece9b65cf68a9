//! Animations: channels of samplers become keyframes of nodes.
//!
//! A node that moves becomes a `[[node]]`, whose keyframes are in seconds; what stands between two of them and does not move becomes one of its own
//! where it is no identity. What nodes take along stays where it is without a frame.

use std::collections::{HashMap, HashSet};

use glam::{DAffine3, DQuat, DVec3, DVec4};
use serde::Deserialize;

use super::importer::Importer;
use super::json::{Animation, Channel};
use super::made::{MovingNodes, WeightTrack};
use super::node::{Placed, local, unit};
use crate::load::file::keyframes::{InterpolationName, ScaleEntry, TransformKeyEntry};
use crate::load::file::node::NodeEntry;
use crate::load::file::shape::TransformEntry;
use crate::load::file::value::{Exactly, Located, Number};
use crate::load::place::Place;
use crate::scene::animation::Turn;

/// Most keyframes of a file.
const MOST_KEYS: usize = 50_000;
/// Straight pieces that a cubic between two keyframes becomes.
const PIECES: usize = 8;
/// Smallest scale: one of 0 leaves nothing of a shape.
const SMALLEST_SCALE: f64 = 1e-5;

/// A part of a transform, and how channels call it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum TargetPath {
    Scale,
    Rotation,
    Translation,
}

/// Values at times in seconds, each later than the one before.
#[derive(Debug, Clone)]
struct Track {
    keys: Vec<(f64, DVec4)>,
    is_step: bool,
}

/// By node, what moves of it.
type Tracks = HashMap<usize, HashMap<TargetPath, Track>>;

impl Importer<'_> {
    /// Makes nodes of what moves. Gives, for each node of the file, the name of the node that takes it along.
    pub fn animate(&mut self, placed: &[Placed]) -> Result<MovingNodes, String> {
        let mut tracks = self.tracks();
        let keys = |tracks: &Tracks| tracks.values().flat_map(HashMap::values).map(|track| track.keys.len()).sum::<usize>();
        let of_weights = self.weight_tracks.values().flat_map(|track| &track.keys).map(|(_, weights)| weights.len());
        let count = keys(&tracks) + of_weights.sum::<usize>();
        if count > MOST_KEYS {
            let instead = format!("it has {count} keyframes, of which at most {MOST_KEYS} are taken: everything is at rest");
            self.drop("animation", "animations", &instead);
            tracks.clear();
            self.weight_tracks.clear();
        }
        let mut parents: Vec<Option<usize>> = vec![None; self.root.nodes.len()];
        for Placed { node, .. } in placed {
            self.root.nodes[*node].children.iter().for_each(|&child| parents[child] = Some(*node));
        }
        let (mut taken_along, mut moving) = (MovingNodes::new(), HashSet::new());
        // Parents come before their children.
        for &Placed { node, .. } in placed {
            let around = parents[node].and_then(|parent| taken_along.get(&parent)).cloned();
            let name = match tracks.remove(&node) {
                Some(tracks) => {
                    let name = self.moving_node(node, &parents, (around, &moving), tracks)?;
                    moving.insert(node);
                    Some(name)
                }
                None => around,
            };
            taken_along.extend(name.map(|name| (node, name)));
        }
        Ok(taken_along)
    }

    /// Adds a node that moves, within those `around` it; its name.
    fn moving_node(
        &mut self,
        index: usize,
        parents: &[Option<usize>],
        (around, moving): (Option<String>, &HashSet<usize>),
        tracks: HashMap<TargetPath, Track>,
    ) -> Result<String, String> {
        let node = &self.root.nodes[index];
        let of_node = |message: String| format!("nodes[{index}]: {message}");
        let rest = local(node).map_err(of_node)?;
        // Up to the next node that moves.
        let (mut between, mut next) = (DAffine3::IDENTITY, parents[index]);
        while let Some(parent) = next.filter(|parent| !moving.contains(parent)) {
            between = local(&self.root.nodes[parent]).map_err(of_node)? * between;
            next = parents[parent];
        }
        let wanted = node.name.clone().unwrap_or_else(|| format!("node-{index}"));
        let name = self.scene.free_node_name(&wanted);
        let place = self.place(&format!("nodes[{index}]"));
        let mut parent = around;
        let between = TransformEntry::of_map(&between, &place).map_err(of_node)?;
        if between.is_some() {
            let frame = place.at(self.scene.free_node_name(&format!("{wanted} (parent)")));
            let around = parent.replace(frame.value.clone()).map(|name| place.at(name));
            let node = NodeEntry { name: frame, parent: around, transform: between, keyframes: None, interpolation: None };
            self.scene.file.node.push(place.at(node));
        }
        let (keyframes, is_step) = keyframes(&rest, tracks, &place).map_err(of_node)?;
        let node = NodeEntry {
            name: place.at(name.clone()),
            parent: parent.map(|name| place.at(name)),
            transform: TransformEntry::of_map(&rest, &place).map_err(of_node)?,
            keyframes: Some(place.at(keyframes)),
            interpolation: is_step.then(|| place.at(InterpolationName::Step)),
        };
        self.scene.file.node.push(place.at(node));
        Ok(name)
    }

    /// Tracks of nodes by the channels of animations. If several animations move one property of a node, the
    /// first counts.
    fn tracks(&mut self) -> Tracks {
        let mut tracks = Tracks::new();
        for (index, value) in self.root.animations.iter().enumerate() {
            let key = format!("animations[{index}]");
            let animation = match Animation::deserialize(value) {
                Ok(animation) => animation,
                Err(error) => {
                    self.drop("animation", &key, &format!("it cannot be read: {error}"));
                    continue;
                }
            };
            for channel in &animation.channels {
                if let Err(reason) = self.channel(&animation, channel, &mut tracks, &key) {
                    self.drop("channel of an animation", &key, &format!("it has no effect: {reason}"));
                }
            }
        }
        tracks
    }

    fn channel(&mut self, animation: &Animation, channel: &Channel, tracks: &mut Tracks, key: &str) -> Result<(), String> {
        let Some(node) = channel.target.node else { return Err("it names no node".to_owned()) };
        if node >= self.root.nodes.len() {
            return Err(format!("there is no nodes[{node}]"));
        }
        let (part, kind) = match channel.target.path.as_str() {
            "translation" => (TargetPath::Translation, "VEC3"),
            "rotation" => (TargetPath::Rotation, "VEC4"),
            "scale" => (TargetPath::Scale, "VEC3"),
            "weights" => return self.weights_channel(animation, channel, node, key),
            other => return Err(format!("it moves the property `{other}`")),
        };
        let sampled = self.sampled(animation, channel, kind, None, key)?;
        let width = sampled.width;
        let value = |index: usize| {
            let of = |component: usize| if component < width { sampled.number(index, component) } else { 0.0 };
            DVec4::new(of(0), of(1), of(2), of(3))
        };
        let mut track = Track { keys: without_repeats(sampled.keys(&value)), is_step: sampled.interpolation == "STEP" };
        if part == TargetPath::Scale {
            let nothing = |scale: f64| scale.abs() < SMALLEST_SCALE;
            if track.keys.iter().any(|(_, scale)| scale.truncate().to_array().into_iter().any(nothing)) {
                self.scene.report.approximate("scale of 0", self.place(key).to_string(), "what it hides is small");
            }
            let least = |scale: f64| if nothing(scale) { SMALLEST_SCALE.copysign(scale) } else { scale };
            track.keys.iter_mut().for_each(|(_, scale)| *scale = DVec4::from_array(scale.to_array().map(least)));
        }
        let of_node = tracks.entry(node).or_default();
        if of_node.contains_key(&part) {
            return Err("an earlier one moves the same".to_owned());
        }
        of_node.insert(part, track);
        Ok(())
    }
}

impl Importer<'_> {
    fn weights_channel(&mut self, animation: &Animation, channel: &Channel, node: usize, key: &str) -> Result<(), String> {
        let mesh = self.root.nodes[node].mesh.and_then(|mesh| self.root.meshes.get(mesh));
        let count = mesh.map_or(0, |mesh| mesh.primitives.iter().map(|primitive| primitive.targets.len()).max().unwrap_or(0));
        if count == 0 {
            return Err(format!("nodes[{node}] has no morph targets"));
        }
        if self.weight_tracks.contains_key(&node) {
            return Err("an earlier one moves the same".to_owned());
        }
        let sampled = self.sampled(animation, channel, "SCALAR", Some(count), key)?;
        let of_target = |target: usize| sampled.keys(&|index| DVec4::splat(sampled.number(index, target)));
        let mut keys: Vec<(f64, Vec<f64>)> =
            of_target(0).into_iter().map(|(time, _)| (time, Vec::with_capacity(count))).collect();
        for target in 0..count {
            keys.iter_mut().zip(of_target(target)).for_each(|((_, weights), (_, value))| weights.push(value.x));
        }
        self.weight_tracks.insert(node, WeightTrack { keys, is_step: sampled.interpolation == "STEP" });
        Ok(())
    }

    /// The numbers of a channel. `width`: of a key, where it is not that of the type.
    fn sampled(
        &mut self,
        animation: &Animation,
        channel: &Channel,
        kind: &str,
        width: Option<usize>,
        key: &str,
    ) -> Result<Sampled, String> {
        let sampler =
            animation.samplers.get(channel.sampler).ok_or_else(|| format!("there is no samplers[{}]", channel.sampler))?;
        let (times, _) = self.buffers.numbers(sampler.input, &["SCALAR"])?;
        let (values, own_width) = self.buffers.numbers(sampler.output, &[kind])?;
        let width = width.unwrap_or(own_width);
        let interpolation = sampler.interpolation.clone().unwrap_or_else(|| "LINEAR".to_owned());
        let per_key = match interpolation.as_str() {
            "LINEAR" | "STEP" => 1,
            "CUBICSPLINE" => 3,
            other => return Err(format!("there is no interpolation {other}")),
        };
        if values.len() != times.len() * width * per_key {
            return Err(format!("it has {} times and {} values", times.len(), values.len() / own_width));
        }
        let is_finite = times.iter().chain(&values).all(|number| number.is_finite() && number.abs() < 1e18);
        if !is_finite || times.windows(2).any(|pair| pair[0] >= pair[1]) || times.is_empty() {
            return Err("its times do not go forward, or its numbers are out of range".to_owned());
        }
        if per_key == 3 {
            self.scene.report.approximate("cubic of an animation", self.place(key).to_string(), "straight pieces are taken");
        }
        Ok(Sampled { times: times.into_iter().map(f64::from).collect(), values, width, interpolation })
    }
}

/// The numbers of a channel.
struct Sampled {
    times: Vec<f64>,
    values: Vec<f32>,
    /// Numbers of a value.
    width: usize,
    interpolation: String,
}

impl Sampled {
    fn number(&self, index: usize, component: usize) -> f64 {
        self.values[index * self.width + component].into()
    }

    /// Values at times, of cubics at those of their pieces. `value` gives the value of an index.
    fn keys(&self, value: &dyn Fn(usize) -> DVec4) -> Vec<(f64, DVec4)> {
        if self.interpolation == "CUBICSPLINE" {
            return cubic(&self.times, value);
        }
        self.times.iter().enumerate().map(|(index, &time)| (time, value(index))).collect()
    }
}

/// The cubics of a channel as straight pieces (glTF 2.0, appendix C).
fn cubic(times: &[f64], value: &dyn Fn(usize) -> DVec4) -> Vec<(f64, DVec4)> {
    let mut keys = Vec::new();
    for (index, pair) in times.windows(2).enumerate() {
        let width = pair[1] - pair[0];
        let (a, leaving) = (value(3 * index + 1), value(3 * index + 2) * width);
        let (arriving, b) = (value(3 * index + 3) * width, value(3 * index + 4));
        for piece in 0..PIECES {
            let t = piece as f64 / PIECES as f64;
            let (t2, t3) = (t * t, t * t * t);
            let at = a * (2.0 * t3 - 3.0 * t2 + 1.0)
                + leaving * (t3 - 2.0 * t2 + t)
                + b * (3.0 * t2 - 2.0 * t3)
                + arriving * (t3 - t2);
            keys.push((pair[0] + width * t, at));
        }
    }
    keys.extend(times.last().map(|&last| (last, value(3 * (times.len() - 1) + 1))));
    keys
}

/// Keys between two others of the same value say nothing.
fn without_repeats(keys: Vec<(f64, DVec4)>) -> Vec<(f64, DVec4)> {
    let says = |at: usize| at == 0 || at + 1 == keys.len() || keys[at - 1].1 != keys[at].1 || keys[at].1 != keys[at + 1].1;
    (0..keys.len()).filter(|&at| says(at)).map(|at| keys[at]).collect()
}

/// Keyframes of a node that is at rest there, and whether they jump.
fn keyframes(
    rest: &DAffine3,
    mut tracks: HashMap<TargetPath, Track>,
    place: &Place,
) -> Result<(Vec<Located<TransformKeyEntry>>, bool), String> {
    let is_step = tracks.values().all(|track| track.is_step);
    if !is_step {
        // Jumps among what moves evenly: the old value stays up to just before the next.
        for track in tracks.values_mut().filter(|track| track.is_step) {
            let steps = track.keys.windows(2).flat_map(|pair| {
                let just_before = pair[1].0 - (1e-3 * (pair[1].0 - pair[0].0)).min(1e-4);
                [pair[0], (just_before, pair[0].1)]
            });
            let last = track.keys.last().copied();
            track.keys = steps.chain(last).filter(|(time, _)| time.is_finite()).collect();
        }
    }
    let first = tracks.values().map(|track| track.keys[0].0).fold(f64::INFINITY, f64::min);
    let (scale, rotation, translation) = rest.to_scale_rotation_translation();
    let still = [
        (TargetPath::Scale, scale.extend(0.0), scale == DVec3::ONE),
        (TargetPath::Rotation, DVec4::from(rotation), rotation == DQuat::IDENTITY),
        (TargetPath::Translation, translation.extend(0.0), translation == DVec3::ZERO),
    ];
    for (part, value, is_nothing) in still {
        if !is_nothing {
            tracks.entry(part).or_insert_with(|| Track { keys: vec![(first, value)], is_step });
        }
    }
    let mut times: Vec<f64> = tracks.values().flat_map(|track| track.keys.iter().map(|key| key.0)).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let keyframe = |time: f64| {
        let at = |part: TargetPath| {
            let keys = &tracks.get(&part)?.keys;
            keys.binary_search_by(|key| key.0.total_cmp(&time)).ok().map(|place| keys[place].1)
        };
        let vector = |value: DVec3| Exactly::<Number, 3>::of(value.to_array());
        let turn = at(TargetPath::Rotation).map(|rotation| Turn::of(unit(rotation)));
        let scale = at(TargetPath::Scale).map(|scale| vector(scale.truncate()).map(|_| ScaleEntry(scale.truncate())));
        Ok(place.at(TransformKeyEntry {
            frame: None,
            time: Some(Number::of(time)?),
            scale: scale.transpose()?.map(|scale| place.at(scale)),
            rotate: turn.map(|turn| vector(turn.axis)).transpose()?.map(|axis| place.at(axis)),
            degrees: turn.map(|turn| Number::of(turn.degrees)).transpose()?.map(|degrees| place.at(degrees)),
            translate: at(TargetPath::Translation).map(|offset| vector(offset.truncate())).transpose()?,
        }))
    };
    Ok((times.into_iter().map(keyframe).collect::<Result<_, String>>()?, is_step))
}
