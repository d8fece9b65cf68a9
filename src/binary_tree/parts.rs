//! Trees over what moves in parts, frame after frame: each part has a tree of its own, which follows it, and one over all of them is built anew.
//!
//! A part is moved as a whole, by one affine map, so that what is close together in it stays so: its tree is built once, in a pose for reference,
//! and its boxes are fitted to where the part is. Parts that go through each other do not make each other's trees worse.
//!
//! Translations and uniform scales keep how large the boxes are beside each other. Turns keep it roughly: sides stay along the axes, so a box grows or
//! shrinks as what is in it turns, but its diagonal by no more than a factor of the root of three. (Its area may grow by more, where something thin
//! lay along an axis; it does so in a tree built anew too.) What is squashed or drawn out has other neighbours: where the map from the pose for
//! reference stretches one direction more than [`UNEVEN`] times as much as another, the part's tree is built of the boxes as they are.
//!
//! The result depends on the boxes and the poses for reference alone. [`KeptTrees`] remembers what was built
//! of equal boxes before, and so saves time and changes nothing.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hasher};
use std::sync::{Arc, Mutex, PoisonError};

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use rayon::prelude::*;

use super::depth::{self, top_down};

/// A tree is fitted to what is stretched in one direction up to so many times as much as in another.
pub const UNEVEN: f64 = 2.0;
/// The tree over all parts goes down to so many boxes of a part: enough for it to tell apart what of two parts is near, and a hundredth of the nodes.
const TREELET: usize = 64;

/// A part that is moved as a whole.
#[derive(Debug, Clone, Default)]
pub struct MovingPart {
    /// Places of its boxes among all.
    pub members: Vec<u32>,
    /// The pose in which its tree is built; None for the boxes as they are.
    pub reference: Option<Pose>,
}

/// A pose for reference.
#[derive(Debug, Clone)]
pub struct Pose {
    /// The part's boxes in it.
    pub boxes: Vec<Aabb>,
    /// By what factor the map from it stretches one direction more than another at most; not finite, or not a number, where that cannot be told.
    pub unevenness: f64,
}

/// Trees that were built before, by their boxes.
#[derive(Default)]
pub struct KeptTrees(Mutex<HashMap<u64, Kept>>);

struct Kept {
    boxes: Vec<Aabb>,
    tree: Arc<Bvh2>,
    is_used: bool,
}

impl KeptTrees {
    /// The tree that `build` makes of the boxes.
    pub fn tree(&self, boxes: &[Aabb], build: Build<'_>) -> Arc<Bvh2> {
        let mut hasher = DefaultHasher::new();
        boxes.iter().flat_map(bits).for_each(|word| hasher.write_u32(word));
        let key = hasher.finish();
        if let Some(kept) = self.lock().get_mut(&key)
            && are_same(&kept.boxes, boxes)
        {
            kept.is_used = true;
            return Arc::clone(&kept.tree);
        }
        let tree = Arc::new(build(boxes));
        self.lock().insert(key, Kept { boxes: boxes.to_vec(), tree: Arc::clone(&tree), is_used: true });
        tree
    }

    /// Forgets what was not asked for since the last time.
    pub fn forget_unused(&mut self) {
        self.lock().retain(|_, kept| std::mem::replace(&mut kept.is_used, false));
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, HashMap<u64, Kept>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A function that builds a tree with a box in each leaf.
pub type Build<'b> = &'b (dyn Fn(&[Aabb]) -> Bvh2 + Sync);

fn bits(bounds: &Aabb) -> impl Iterator<Item = u32> {
    bounds.min.to_array().into_iter().chain(bounds.max.to_array()).map(f32::to_bits)
}

fn are_same(some: &[Aabb], others: &[Aabb]) -> bool {
    some.len() == others.len() && some.iter().zip(others).all(|(one, other)| bits(one).eq(bits(other)))
}

/// A tree over boxes that move in parts, which together have each box once.
pub fn build_of_parts(boxes: &[Aabb], parts: &[MovingPart], kept: &KeptTrees, build: Build<'_>) -> Bvh2 {
    let of_part = |part: &MovingPart| {
        let own: Vec<Aabb> = part.members.iter().map(|&index| boxes[index as usize]).collect();
        fitted(&own, part.reference.as_ref(), kept, build)
    };
    let (parts, trees): (Vec<&MovingPart>, Vec<Arc<Bvh2>>) =
        parts.par_iter().filter(|part| !part.members.is_empty()).map(|part| (part, of_part(part))).unzip();
    let treelets: Vec<(usize, usize)> = match trees.len() {
        // Nothing has to be told apart.
        0 | 1 => (0..trees.len()).map(|part| (part, 0)).collect(),
        _ => trees.iter().enumerate().flat_map(|(part, tree)| cut(tree).into_iter().map(move |node| (part, node))).collect(),
    };
    if treelets.is_empty() {
        return Bvh2::default();
    }
    let roots: Vec<Aabb> = treelets.iter().map(|&(part, node)| *trees[part].nodes[node].aabb()).collect();
    let mut tree = join(&build(&roots), &treelets, &trees);
    for (part, of_part) in parts.iter().zip(&trees) {
        tree.primitive_indices.extend(of_part.primitive_indices.iter().map(|&index| part.members[index as usize]));
    }
    depth::limit_depth(&mut tree, depth::DEEPEST);
    tree
}

/// A part's own tree.
fn fitted(boxes: &[Aabb], reference: Option<&Pose>, kept: &KeptTrees, build: Build<'_>) -> Arc<Bvh2> {
    let Some(pose) = reference.filter(|pose| pose.unevenness <= UNEVEN && pose.boxes.len() == boxes.len()) else {
        return kept.tree(boxes, build);
    };
    let built = kept.tree(&pose.boxes, build);
    if are_same(&pose.boxes, boxes) {
        return built;
    }
    let mut tree = Bvh2::clone(&built);
    fit(&mut tree, boxes);
    Arc::new(tree)
}

/// Puts a tree's boxes around what stands in its leaves now.
fn fit(tree: &mut Bvh2, boxes: &[Aabb]) {
    for (index, _) in top_down(&tree.nodes).into_iter().rev() {
        let node = &tree.nodes[index];
        let first = node.first_index as usize;
        let bounds = if node.is_leaf() {
            let leaf = &tree.primitive_indices[first..first + node.prim_count as usize];
            leaf.iter().fold(Aabb::empty(), |bounds, &index| bounds.union(&boxes[index as usize]))
        } else {
            tree.nodes[first].aabb().union(tree.nodes[first + 1].aabb())
        };
        tree.nodes[index].set_aabb(bounds);
    }
}

/// The topmost nodes that hold up to [`TREELET`] boxes, which have all boxes between them.
fn cut(tree: &Bvh2) -> Vec<usize> {
    let order = top_down(&tree.nodes);
    let mut counts = vec![0_usize; tree.nodes.len()];
    for &(index, _) in order.iter().rev() {
        let node = &tree.nodes[index];
        let first = node.first_index as usize;
        counts[index] = if node.is_leaf() { node.prim_count as usize } else { counts[first] + counts[first + 1] };
    }
    let (mut found, mut pending) = (Vec::new(), vec![0]);
    while let Some(index) = pending.pop() {
        if counts[index] <= TREELET || tree.nodes[index].is_leaf() {
            found.push(index);
        } else {
            let first = tree.nodes[index].first_index as usize;
            pending.extend([first + 1, first]);
        }
    }
    found
}

/// The nodes of a tree whose leaves are nodes of others, which hold boxes one tree behind the other.
fn join(top: &Bvh2, treelets: &[(usize, usize)], trees: &[Arc<Bvh2>]) -> Bvh2 {
    let mut nodes = vec![Bvh2Node::default()];
    let mut firsts = vec![0];
    firsts.extend(trees.iter().scan(0, |count, tree| {
        *count += tree.primitive_indices.len() as u32;
        Some(*count)
    }));
    // A node's slot, the tree that it is of (None: the top one), and its place there.
    let mut pending = vec![(0, None::<usize>, 0_usize)];
    while let Some((slot, part, index)) = pending.pop() {
        let (part, node) = match part {
            None if top.nodes[index].is_leaf() => {
                let (part, node) = treelets[top.primitive_indices[top.nodes[index].first_index as usize] as usize];
                (Some(part), trees[part].nodes[node])
            }
            None => (None, top.nodes[index]),
            Some(part) => (Some(part), trees[part].nodes[index]),
        };
        nodes[slot] = node;
        if let Some(part) = part.filter(|_| node.is_leaf()) {
            nodes[slot].first_index += firsts[part];
            continue;
        }
        let (from, to) = (node.first_index as usize, nodes.len());
        nodes[slot].first_index = to as u32;
        nodes.extend([Bvh2Node::default(); 2]);
        pending.extend([(to + 1, part, from + 1), (to, part, from)]);
    }
    // Nothing is known of the depth.
    Bvh2 { nodes, max_depth: 2 * depth::DEEPEST + 2, ..Bvh2::default() }
}

#[cfg(test)]
mod tests;
