//! The lights of a tree that can send most to a place, nothing being in between.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::cluster::{LEAF, LightNode, NUMBER_MASK};

/// A cluster by what it can send at most.
struct Candidate {
    most: f64,
    link: u32,
}

impl Ord for Candidate {
    /// The first in the tree is the greater of equal ones.
    fn cmp(&self, other: &Self) -> Ordering {
        self.most.total_cmp(&other.most).then_with(|| other.link.cmp(&self.link))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

/// The `count` strongest lights of the tree with these nodes that are wanted, by the most light that they can
/// send to a point within `radius` of `center`, the strongest first.
pub fn strongest(nodes: &[LightNode], (center, radius): (DVec3, f64), count: usize, is_wanted: impl Fn(u32) -> bool) -> Vec<u32> {
    let (mut found, mut open) = (Vec::new(), BinaryHeap::from([Candidate { most: f64::INFINITY, link: 0 }]));
    while let Some(Candidate { link, .. }) = open.pop() {
        let number = link & NUMBER_MASK;
        if link & LEAF == 0 {
            let clusters = nodes[number as usize].clusters;
            let candidates = clusters.map(|cluster| Candidate { most: cluster.most(center, radius), link: cluster.link });
            open.extend(candidates.into_iter().filter(|candidate| candidate.most > 0.0));
        } else if is_wanted(number) {
            found.push(number);
            if found.len() == count {
                break;
            }
        }
    }
    found
}
