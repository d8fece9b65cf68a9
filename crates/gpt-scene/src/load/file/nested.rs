//! Groups that hold instances of other groups, and the places where all that they hold stands.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use crate::load::memory;
use crate::load::place::Place;
use crate::scene::{Instances, MaterialId, MotionStep};

/// Most groups within each other.
const DEEPEST: usize = 64;
/// Most instances of a scene, which packed records have 28 bits to number.
const MOST_INSTANCES: u64 = 1 << 28;
/// Bytes that an instance takes until it is packed, on the host and on the device.
const INSTANCE_BYTES: u64 = 512;
/// Memory of one that turns about the origin of a group around its own: its motion is its own as well.
const TURNING_BYTES: u64 = 8192;

/// A group in one place or more of another group.
#[derive(Debug)]
pub struct NestedInstance {
    /// Among the groups of the file.
    pub group: usize,
    /// From the nested group's space to that of the group around, a map each.
    pub maps: Vec<DAffine3>,
    /// In place of the nested group's own materials.
    pub material: Option<MaterialId>,
    /// Place in the file where the nested group is named.
    pub named_at: Place,
}

/// A group as the file has it.
#[derive(Debug, Default)]
pub struct FileGroup {
    pub name: String,
    /// The scene's group of its own meshes; None where it has none.
    pub own: Option<usize>,
    pub nested: Vec<NestedInstance>,
}

/// The groups of a file. None contains itself.
#[derive(Debug, Default)]
pub struct Groups {
    groups: Vec<FileGroup>,
    /// How many groups with meshes each stands for: itself, and those that it holds, each in all of its places.
    counts: Vec<u64>,
}

/// A mistake in the content of a group, and its place.
pub type Mistake = (Place, String);

impl Groups {
    /// # Errors
    /// A group contains itself, or groups lie too deep within each other.
    pub fn new(groups: Vec<FileGroup>) -> Result<Self, Mistake> {
        let mut counter = Counter { groups: &groups, known: vec![None; groups.len()], chain: Vec::new() };
        for group in 0..groups.len() {
            counter.count(group)?;
        }
        let counts = counter.known.into_iter().map(|known| known.map_or(0, |(count, _)| count)).collect();
        Ok(Self { groups, counts })
    }

    pub fn name(&self, group: usize) -> &str {
        &self.groups[group].name
    }

    /// True, for each group, where it or a group around it is among `named`.
    pub fn reached_from(&self, named: &[bool]) -> Vec<bool> {
        let mut reached = named.to_vec();
        let mut to_visit: Vec<usize> = (0..reached.len()).filter(|&group| reached[group]).collect();
        while let Some(group) = to_visit.pop() {
            for nested in &self.groups[group].nested {
                if !std::mem::replace(&mut reached[nested.group], true) {
                    to_visit.push(nested.group);
                }
            }
        }
        reached
    }

    /// How many instances come of an entry, whose group is one of the file's.
    pub fn count(&self, entry: &Instances) -> u64 {
        self.counts[entry.group].saturating_mul(entry.places.len() as u64)
    }

    /// Checks that so many instances are possible beside `before` others.
    ///
    /// # Errors
    /// In words, that they are too many, or do not fit into memory.
    pub fn check_count(&self, entry: &Instances, before: u64) -> Result<(), String> {
        let (count, name) = (self.count(entry), self.name(entry.group));
        let all = before.saturating_add(count);
        let many = if count < u64::MAX { format!("{count} instances") } else { "more than 10^19 instances".to_owned() };
        if all > MOST_INSTANCES {
            let beside = if before > 0 { format!(" beside {before} others") } else { String::new() };
            return Err(format!("`{name}` and what it holds make {many}{beside}; at most {MOST_INSTANCES} are possible"));
        }
        let each = if turns(entry) { TURNING_BYTES } else { INSTANCE_BYTES };
        let (needed, available) = (all * each, memory::available());
        // A list of places that was read fits.
        if all > 1 << 16 && self.counts[entry.group] > 1 && needed > available {
            let (needed, available) = (needed >> 20, available >> 20);
            return Err(format!(
                "`{name}` and what it holds make {many}, which take about {needed} MiB; {available} MiB are free"
            ));
        }
        Ok(())
    }

    /// Instances of the scene's groups in place of an entry, whose group is one of the file's: of its own meshes, and of those of every group that it
    /// holds. The count has been checked.
    pub fn expanded(&self, entry: &Instances, is_pass: &dyn Fn(MaterialId) -> bool) -> Vec<Instances> {
        let mut all = Expansion { groups: self, is_pass, found: Vec::new(), known: HashMap::new() };
        let outer = entry.transform.to_affine();
        for place in entry.places.iter() {
            let pivot = if turns(entry) { Some(entry.pivot.unwrap_or((outer * *place).translation)) } else { entry.pivot };
            all.add(entry, entry.group, *place, entry.material, pivot);
        }
        all.found
            .into_iter()
            .map(|found| {
                let name = self.name(found.file_group);
                let is_outermost = found.file_group == entry.group;
                let label = if is_outermost { entry.label.clone() } else { format!("{}: `{name}`", entry.label) };
                // One that is not nested in another turns about its own origin anyway.
                let pivot = if is_outermost { entry.pivot } else { found.pivot };
                let (places, material) = (Arc::new(found.places), found.material);
                Instances { label, group: found.group, places, material, pivot, ..entry.clone() }
            })
            .collect()
    }
}

/// True where the centre of its motion matters.
fn turns(entry: &Instances) -> bool {
    let steps = entry.motion.iter().flat_map(|motion| &motion.steps);
    steps.into_iter().any(|step| !matches!(step, MotionStep::Translate(_)))
}

/// A group, a material, and the bits of a pivot.
type Kind = (usize, Option<MaterialId>, Option<[u64; 3]>);

/// Instances that come of one entry.
struct Expansion<'a> {
    groups: &'a Groups,
    is_pass: &'a dyn Fn(MaterialId) -> bool,
    found: Vec<InstancesOfGroup>,
    /// Which of them are of a group, of a material, and move about a point.
    known: HashMap<Kind, usize>,
}

/// Instances of one group of the scene.
struct InstancesOfGroup {
    file_group: usize,
    group: usize,
    material: Option<MaterialId>,
    pivot: Option<DVec3>,
    places: Vec<DAffine3>,
}

impl Expansion<'_> {
    /// Adds an instance with all that lie within it; recursion is as deep as groups lie within each other.
    fn add(&mut self, entry: &Instances, group: usize, map: DAffine3, material: Option<MaterialId>, pivot: Option<DVec3>) {
        let groups = self.groups;
        if groups.counts[group] == 0 {
            return;
        }
        if let Some(own) = groups.groups[group].own {
            let pivot = if group == entry.group { None } else { pivot };
            let key = (group, material, pivot.map(|pivot| pivot.to_array().map(f64::to_bits)));
            let index = *self.known.entry(key).or_insert_with(|| {
                self.found.push(InstancesOfGroup { file_group: group, group: own, material, pivot, places: Vec::new() });
                self.found.len() - 1
            });
            self.found[index].places.push(map);
        }
        for nested in &groups.groups[group].nested {
            // A material of the outer instance replaces the inner one, except that null surfaces stay
            // openings.
            let within = nested.material.filter(|&id| material.is_none() || (self.is_pass)(id)).or(material);
            for own in &nested.maps {
                self.add(entry, nested.group, map * *own, within, pivot);
            }
        }
    }
}

/// Counts what groups stand for.
struct Counter<'a> {
    groups: &'a [FileGroup],
    /// Groups that have been visited: the number of instances that each stands for, and how many groups lie
    /// within each other from it on.
    known: Vec<Option<(u64, usize)>>,
    /// The groups around the one that is looked at, each in the one before.
    chain: Vec<usize>,
}

impl Counter<'_> {
    fn count(&mut self, group: usize) -> Result<(u64, usize), Mistake> {
        if let Some(known) = self.known[group] {
            return Ok(known);
        }
        let (mut count, mut depth) = (u64::from(self.groups[group].own.is_some()), 1);
        self.chain.push(group);
        for nested in &self.groups[group].nested {
            if let Some(start) = self.chain.iter().position(|&around| around == nested.group) {
                return Err((nested.named_at.clone(), self.circle(start)));
            }
            let too_deep = || (nested.named_at.clone(), format!("groups lie more than {DEEPEST} deep within each other"));
            if self.chain.len() >= DEEPEST {
                return Err(too_deep());
            }
            let (of_one, below) = self.count(nested.group)?;
            depth = depth.max(below + 1);
            if depth > DEEPEST {
                return Err(too_deep());
            }
            count = count.saturating_add(of_one.saturating_mul(nested.maps.len() as u64));
        }
        self.chain.pop();
        self.known[group] = Some((count, depth));
        Ok((count, depth))
    }

    /// The chain from a group to itself, in words.
    fn circle(&self, start: usize) -> String {
        let name = |group: usize| &self.groups[group].name;
        let circle = &self.chain[start..];
        let first = name(circle[0]);
        let mut words = format!("the group `{first}` contains itself");
        if circle.len() > 1 {
            words += &format!(": `{first}` holds `{}`", name(circle[1]));
            circle[2..].iter().for_each(|&group| words += &format!(", which holds `{}`", name(group)));
            words += &format!(", which holds `{first}`");
        }
        words
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Motion, Transform};

    fn nested(group: usize, maps: Vec<DAffine3>) -> NestedInstance {
        NestedInstance { group, maps, material: None, named_at: (group..group + 1).into() }
    }

    fn group(own: Option<usize>, nested: Vec<NestedInstance>) -> FileGroup {
        FileGroup { name: "abcdefgh".chars().nth(own.unwrap_or(7)).map(String::from).unwrap_or_default(), own, nested }
    }

    fn entry(group: usize, places: Vec<DAffine3>) -> Instances {
        let (transform, places) = (Transform::default(), Arc::new(places));
        Instances {
            label: "instance[0]".into(),
            group,
            places,
            transform,
            material: None,
            motion: None,
            pivot: None,
            receiver: 0,
        }
    }

    fn at(x: f64) -> DAffine3 {
        DAffine3::from_translation(DVec3::X * x)
    }

    #[test]
    fn what_groups_hold_stands_in_all_of_their_places() {
        let two = vec![at(1.0), at(2.0)];
        let groups = Groups::new(vec![
            group(Some(0), vec![nested(1, two.clone()), nested(2, vec![at(100.0)])]),
            group(Some(1), vec![nested(2, two)]),
            group(Some(2), vec![]),
        ]);
        let groups = groups.expect("none contains itself");
        let found = groups.expanded(&entry(0, vec![at(10.0), at(20.0)]), &|_| false);
        let places: Vec<(usize, Vec<f64>)> =
            found.iter().map(|of| (of.group, of.places.iter().map(|place| place.translation.x).collect())).collect();
        let leaves = vec![12.0, 13.0, 13.0, 14.0, 110.0, 22.0, 23.0, 23.0, 24.0, 120.0];
        assert_eq!(places, [(0, vec![10.0, 20.0]), (1, vec![11.0, 12.0, 21.0, 22.0]), (2, leaves)]);
        assert_eq!(groups.count(&entry(0, vec![at(10.0), at(20.0)])), 16);
        assert_eq!(groups.reached_from(&[false, true, false]), [false, true, true]);
    }

    #[test]
    fn circles_are_named() {
        let groups = vec![
            group(Some(0), vec![nested(1, vec![])]),
            group(Some(1), vec![nested(2, vec![])]),
            group(Some(2), vec![nested(0, vec![])]),
        ];
        let (at, message) = Groups::new(groups).expect_err("a circle");
        assert_eq!(
            (at, &*message),
            ((0..1).into(), "the group `a` contains itself: `a` holds `b`, which holds `c`, which holds `a`")
        );
        let (_, message) = Groups::new(vec![group(Some(0), vec![nested(0, vec![])])]).expect_err("a circle");
        assert_eq!(message, "the group `a` contains itself");
    }

    /// 2³⁰ instances are refused before any is made; a thousand groups within each other as well, whichever stands first.
    #[test]
    fn what_grows_without_bound_is_refused() {
        let chain = |length: usize, times: usize| -> Vec<FileGroup> {
            let of = |index: usize| nested(index + 1, vec![DAffine3::IDENTITY; times]);
            (0..length).map(|index| group(Some(0), if index + 1 < length { vec![of(index)] } else { vec![] })).collect()
        };
        let doublings = Groups::new(chain(31, 2)).expect("none contains itself");
        let message = doublings.check_count(&entry(0, vec![DAffine3::IDENTITY]), 0).expect_err("too many");
        assert!(message.contains("make 2147483647 instances; at most 268435456 are possible"), "{message}");
        assert!(doublings.check_count(&entry(20, vec![DAffine3::IDENTITY]), 0).is_ok());
        let message = doublings.check_count(&entry(20, vec![DAffine3::IDENTITY]), 1 << 28).expect_err("too many");
        assert!(message.contains("beside 268435456 others"), "{message}");
        let endless = Groups::new(chain(60, 1000)).expect("none contains itself");
        assert!(endless.check_count(&entry(0, vec![DAffine3::IDENTITY]), 0).is_err());
        assert!(Groups::new(chain(DEEPEST, 1)).is_ok());
        assert!(Groups::new(chain(1000, 1)).is_err());
        // Inner groups come first.
        let reversed = (0..1000).map(|index| group(Some(0), if index > 0 { vec![nested(index - 1, vec![])] } else { vec![] }));
        let (_, message) = Groups::new(reversed.collect()).expect_err("too deep");
        assert_eq!(message, "groups lie more than 64 deep within each other");
    }

    /// A nested instance goes round the place of what holds it, which moves as a whole.
    #[test]
    fn what_turns_turns_about_the_outermost() {
        let groups = vec![group(Some(0), vec![nested(1, vec![at(1.0)])]), group(Some(1), vec![])];
        let groups = Groups::new(groups).expect("none contains itself");
        let moving = |step| Instances { motion: Some(Motion::new(vec![step])), ..entry(0, vec![at(10.0), at(20.0)]) };
        let turning = groups.expanded(&moving(MotionStep::Rotate { axis: DVec3::Y, degrees: 20.0 }), &|_| false);
        let pivots: Vec<Option<f64>> = turning.iter().map(|of| of.pivot.map(|pivot| pivot.x)).collect();
        assert_eq!(pivots, [None, Some(10.0), Some(20.0)]);
        let sliding = groups.expanded(&moving(MotionStep::Translate(DVec3::X)), &|_| false);
        assert!(sliding.len() == 2 && sliding.iter().all(|of| of.pivot.is_none()));
    }
}
