//! A binary bounding volume hierarchy of bounded depth over any boxes.
//!
//! The clusters are made here (`clustering`), since obvhs takes quadratic time over boxes that stand in a row or coincide; obvhs improves them.

mod clustering;
pub mod depth;
pub mod parts;

use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;

/// Builds a tree over finite boxes. Its leaves hold indices of boxes by way of `primitive_indices`.
pub fn build(boxes: &[Aabb], parameters: &BvhBuildParams) -> Bvh2 {
    if boxes.is_empty() {
        return Bvh2::default();
    }
    let (mut tree, tied) = clustering::cluster(boxes, parameters.search_depth_threshold);
    improve(&mut tree, parameters.reinsertion_batch_ratio);
    // Leaves are joined where testing their primitives costs less than another node. Fewer nodes are worth another attempt to move them.
    collapse(&mut tree, parameters.max_prims_per_leaf, parameters.collapse_traversal_cost);
    improve(&mut tree, parameters.reinsertion_batch_ratio * parameters.post_collapse_reinsertion_batch_ratio_multiplier);
    // Reinsertion makes chains of boxes that coincide, since one place is as good as another.
    depth::limit_depth(&mut tree, if tied { depth::nearly_balanced(boxes.len()) } else { depth::DEEPEST });
    tree
}

/// The numbers of nodes that obvhs tries to move at a time, one after the other, as shares of a ratio of all
/// nodes.
const SHARES: [f32; 4] = [1.0, 0.6, 0.4, 0.3];
/// obvhs looks for better places by a stack of 192 entries at least, and panics where a deeper tree needs more.
const DEEPEST_TO_IMPROVE: usize = 190;

/// Moves nodes to where boxes become smaller (Meister and Bittner 2018), as long as the tree is not too deep. Slivers that lie across each other make
/// it so: chains of them then grow at every turn, take ever more time, and are balanced in the end.
fn improve(tree: &mut Bvh2, ratio: f32) {
    let mut optimizer = ReinsertionOptimizer::default();
    for share in SHARES {
        if depth::reached(&tree.nodes) > DEEPEST_TO_IMPROVE {
            return;
        }
        optimizer.run(tree, ratio, Some(vec![share]));
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use glam::Vec3A;
    use obvhs::ploc::PlocBuilder;

    use super::depth::tests::chain;
    use super::depth::top_down;
    use super::*;

    fn parameters() -> BvhBuildParams {
        BvhBuildParams { max_prims_per_leaf: 4, collapse_traversal_cost: 1.0, ..BvhBuildParams::medium_build() }
    }

    pub fn around(centre: Vec3A, radius: f32) -> Aabb {
        Aabb::new(centre - radius, centre + radius)
    }

    /// The depth, having checked that every box stands in one leaf, inside all boxes above it.
    pub fn checked_depth(tree: &Bvh2, boxes: &[Aabb]) -> usize {
        let mut seen = vec![false; boxes.len()];
        let order = top_down(&tree.nodes);
        for &(index, _) in &order {
            let node = &tree.nodes[index];
            let first = node.first_index as usize;
            let inside = |inner: &Aabb| inner.min.cmpge(node.aabb().min).all() && inner.max.cmple(node.aabb().max).all();
            if node.is_leaf() {
                for &index in &tree.primitive_indices[first..first + node.prim_count as usize] {
                    assert!(!std::mem::replace(&mut seen[index as usize], true), "box {index} stands twice");
                    assert!(inside(&boxes[index as usize]));
                }
            } else {
                assert!(inside(tree.nodes[first].aabb()) && inside(tree.nodes[first + 1].aabb()));
            }
        }
        assert!(seen.iter().all(|&seen| seen));
        order.iter().map(|(_, depth)| *depth).max().unwrap_or(0)
    }

    #[test]
    fn boxes_that_fit_equally_well_make_a_shallow_tree() {
        let count = 20_000;
        let copies = vec![around(Vec3A::ONE, 1.0); count];
        let concentric: Vec<Aabb> = (1..=count).map(|radius| around(Vec3A::ZERO, radius as f32)).collect();
        let nested: Vec<Aabb> = (1..=count).map(|radius| around(Vec3A::X * radius as f32, radius as f32)).collect();
        let row: Vec<Aabb> = (0..count).map(|index| around(Vec3A::X * index as f32, 0.4)).collect();
        let pairs_in_a_row: Vec<Aabb> = row.iter().flat_map(|bounds| [*bounds; 2]).collect();
        let mut among_others = copies.clone();
        among_others.extend((0..count).map(|index| around(Vec3A::new(index as f32, (index * 7 % 101) as f32, 0.0), 0.3)));
        for (name, boxes) in [
            ("copies", copies),
            ("concentric", concentric),
            ("nested", nested),
            ("row", row),
            ("pairs in a row", pairs_in_a_row),
            ("among others", among_others),
        ] {
            let reached = checked_depth(&build(&boxes, &parameters()), &boxes);
            assert!(reached <= depth::nearly_balanced(boxes.len()), "{name}: {reached}");
        }
    }

    fn as_obvhs_builds(boxes: &[Aabb]) -> Bvh2 {
        let BvhBuildParams { ploc_search_distance, sort_precision, search_depth_threshold, reinsertion_batch_ratio, .. } =
            parameters();
        let indices = (0..boxes.len() as u32).collect();
        let mut tree = PlocBuilder::new().build(ploc_search_distance, boxes, indices, sort_precision, search_depth_threshold);
        let mut optimizer = ReinsertionOptimizer::default();
        optimizer.run(&mut tree, reinsertion_batch_ratio, Some(SHARES.to_vec()));
        collapse(&mut tree, parameters().max_prims_per_leaf, parameters().collapse_traversal_cost);
        let ratio = reinsertion_batch_ratio * parameters().post_collapse_reinsertion_batch_ratio_multiplier;
        optimizer.run(&mut tree, ratio, Some(SHARES.to_vec()));
        tree
    }

    #[test]
    fn a_tree_that_is_too_deep_for_obvhs_is_left_as_it_is() {
        let places =
            |count: u32| (0..count).map(|index| around(Vec3A::X * (index * 7919 % count) as f32, 0.4)).collect::<Vec<_>>();
        for (count, is_left) in [(100, false), (3000, true)] {
            let mut tree = chain(&places(count));
            let before: Vec<(u32, Aabb)> = tree.nodes.iter().map(|node| (node.first_index, *node.aabb())).collect();
            improve(&mut tree, 0.3);
            let same = tree.nodes.iter().map(|node| (node.first_index, *node.aabb())).eq(before);
            assert_eq!(same, is_left, "a chain of {count}");
        }
    }

    #[test]
    fn other_trees_are_as_obvhs_builds_them() {
        for count in [1, 2, 3, 500, 9000_u32] {
            let fraction = |index: u32, factor: u32| (index.wrapping_mul(factor) % 10_007) as f32 / 100.0;
            let boxes: Vec<Aabb> = (0..count)
                .map(|index| around(Vec3A::new(fraction(index, 7919), fraction(index, 104_729), fraction(index, 1_299_709)), 0.4))
                .collect();
            let ours = build(&boxes, &parameters());
            let theirs = as_obvhs_builds(&boxes);
            assert_eq!(ours.primitive_indices, theirs.primitive_indices);
            assert_eq!(ours.nodes.len(), theirs.nodes.len());
            assert!(ours.nodes.iter().zip(&theirs.nodes).all(|(a, b)| a.first_index == b.first_index && a.aabb() == b.aabb()));
            checked_depth(&ours, &boxes);
        }
    }
}
