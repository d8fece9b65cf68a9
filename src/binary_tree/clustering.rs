//! Parallel locally-ordered clustering (Meister and Bittner 2018): boxes in Morton order; round after round, each looks for the neighbour with
//! which it makes the smallest box, and those that choose each other are joined.
//!
//! The trees are those of obvhs, but for rounds in which hardly any two choose each other, because many neighbours fit equally well: in a row
//! of equal boxes each chooses the next. Such a round joins neighbours in their order instead, so that there are few rounds whatever the boxes.

use glam::DVec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::ploc::morton::morton_encode_u64_unorm;
use rayon::prelude::*;

/// Neighbours that are looked at, on either side.
const REACH: usize = 14;
/// A round that joins fewer than one in so many nodes joins neighbours in order.
const FEWEST_JOINED: usize = 32;
/// Nodes that one thread looks at in a row.
const CHUNK: usize = 4096;
/// So many boxes with one Morton code are sorted by their size: they lie in each other.
const FEW: usize = 8;

/// A tree with a box in each leaf, and whether many boxes fitted equally well. The first `quick_rounds` look at the next neighbours alone.
pub fn cluster(boxes: &[Aabb], quick_rounds: usize) -> (Bvh2, bool) {
    let mut nodes: Vec<Bvh2Node> =
        in_morton_order(boxes).into_iter().map(|index| Bvh2Node::new(boxes[index as usize], 1, index)).collect();
    let mut tree = vec![Bvh2Node::default(); 2 * boxes.len() - 1];
    let mut free = tree.len();
    let mut rounds = 0;
    let mut tied = false;
    while nodes.len() > 1 {
        let mut partners = if rounds < quick_rounds { better_neighbours(&nodes) } else { best_partners(&nodes) };
        if count_pairs(&partners) < (nodes.len() / FEWEST_JOINED).max(1) {
            tied = true;
            partners = (0..nodes.len()).map(|index| if index % 2 == 0 && index + 1 < nodes.len() { 1 } else { -1 }).collect();
        }
        nodes = join(&nodes, &partners, &mut tree, &mut free);
        rounds += 1;
    }
    tree[0] = nodes[0];
    let tree = Bvh2 {
        nodes: tree,
        primitive_indices: (0..boxes.len() as u32).collect(),
        max_depth: Bvh2::default().max_depth.max(rounds + 1),
        children_are_ordered_after_parents: true,
        ..Bvh2::default()
    };
    (tree, tied)
}

/// Places of the boxes, in the Morton order of their centres.
fn in_morton_order(boxes: &[Aabb]) -> Vec<u32> {
    let all = boxes.iter().fold(Aabb::empty(), |all, bounds| all.union(bounds));
    let scale: DVec3 = 1.0 / all.diagonal().as_dvec3();
    let offset = -all.min.as_dvec3() * scale;
    let code = |bounds: &Aabb| morton_encode_u64_unorm(bounds.center().as_dvec3() * scale + offset);
    let mut codes: Vec<(u64, u32)> =
        boxes.par_iter().zip(0..boxes.len() as u32).map(|(bounds, index)| (code(bounds), index)).collect();
    codes.par_sort_unstable_by_key(|(code, _)| *code);
    for crowd in codes.chunk_by_mut(|a, b| a.0 == b.0).filter(|crowd| crowd.len() > FEW) {
        let size = |index: u32| boxes[index as usize].half_area();
        crowd.sort_by(|(_, a), (_, b)| size(*a).total_cmp(&size(*b)).then(a.cmp(b)));
    }
    codes.into_iter().map(|(_, index)| index).collect()
}

fn cost(a: &Bvh2Node, b: &Bvh2Node) -> f32 {
    a.aabb().union(b.aabb()).half_area()
}

/// For each node, the way to the better one of its two neighbours.
fn better_neighbours(nodes: &[Bvh2Node]) -> Vec<i8> {
    let with_next = |index: usize| if index + 1 < nodes.len() { cost(&nodes[index], &nodes[index + 1]) } else { f32::INFINITY };
    let way =
        |index: usize| if index > 0 && (with_next(index - 1) < with_next(index) || index + 1 == nodes.len()) { -1 } else { 1 };
    (0..nodes.len()).into_par_iter().with_min_len(CHUNK).map(way).collect()
}

/// For each node, the way to the one within reach with which it makes the smallest box; of several, the last.
fn best_partners(nodes: &[Bvh2Node]) -> Vec<i8> {
    let mut partners = vec![0; nodes.len()];
    partners.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, partners)| {
        let first = chunk * CHUNK;
        // Costs of pairs whose first node was looked at, by the remainders of both.
        let mut known = [[0.0_f32; REACH]; REACH];
        for (step, partner) in partners.iter_mut().enumerate() {
            let index = first + step;
            let (mut best, mut lowest) = (index, f32::INFINITY);
            for other in index.saturating_sub(REACH)..index {
                let cost = if other < first { cost(&nodes[index], &nodes[other]) } else { known[other % REACH][index % REACH] };
                if cost <= lowest {
                    (best, lowest) = (other, cost);
                }
            }
            for other in index + 1..(index + REACH + 1).min(nodes.len()) {
                let cost = cost(&nodes[index], &nodes[other]);
                known[index % REACH][other % REACH] = cost;
                if cost <= lowest {
                    (best, lowest) = (other, cost);
                }
            }
            *partner = (best as i64 - index as i64) as i8;
        }
    });
    partners
}

/// Which node a node chose.
fn chosen(partners: &[i8], index: usize) -> usize {
    index.wrapping_add_signed(isize::from(partners[index]))
}

fn count_pairs(partners: &[i8]) -> usize {
    (0..partners.len())
        .filter(|&index| chosen(partners, index) > index && chosen(partners, chosen(partners, index)) == index)
        .count()
}

/// The nodes of the next round. Pairs become children, which fill the tree from its end.
fn join(nodes: &[Bvh2Node], partners: &[i8], tree: &mut [Bvh2Node], free: &mut usize) -> Vec<Bvh2Node> {
    let mut next = Vec::with_capacity(nodes.len());
    for (index, node) in nodes.iter().enumerate() {
        let partner = chosen(partners, index);
        if partner == index || chosen(partners, partner) != index {
            next.push(*node);
        } else if partner < index {
            *free -= 2;
            tree[*free] = *node;
            tree[*free + 1] = nodes[partner];
            next.push(Bvh2Node::new(node.aabb().union(nodes[partner].aabb()), 0, *free as u32));
        }
    }
    next
}
