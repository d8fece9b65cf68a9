//! A binary bounding volume hierarchy of bounded depth over any boxes.
//!
//! The clusters are made here (`clustering`), since obvhs takes quadratic time over boxes that stand in a row or coincide; obvhs improves them.

mod clustering;
mod depth;
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
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut tree, parameters.reinsertion_batch_ratio, None);
    // Leaves are joined where testing their primitives costs less than another node. Fewer nodes are worth another attempt to move them.
    collapse(&mut tree, parameters.max_prims_per_leaf, parameters.collapse_traversal_cost);
    let ratio = parameters.reinsertion_batch_ratio * parameters.post_collapse_reinsertion_batch_ratio_multiplier;
    optimizer.run(&mut tree, ratio, None);
    // Reinsertion makes chains of boxes that coincide, since one place is as good as another.
    depth::limit_depth(&mut tree, if tied { depth::nearly_balanced(boxes.len()) } else { depth::DEEPEST });
    tree
}

#[cfg(test)]
pub(crate) mod tests {
    use glam::Vec3A;

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

    #[test]
    fn other_trees_are_as_obvhs_builds_them() {
        struct Bounds(Aabb);
        impl obvhs::Boundable for Bounds {
            fn aabb(&self) -> Aabb {
                self.0
            }
        }
        for count in [1, 2, 3, 500, 9000_u32] {
            let fraction = |index: u32, factor: u32| (index.wrapping_mul(factor) % 10_007) as f32 / 100.0;
            let boxes: Vec<Aabb> = (0..count)
                .map(|index| around(Vec3A::new(fraction(index, 7919), fraction(index, 104_729), fraction(index, 1_299_709)), 0.4))
                .collect();
            let bounds: Vec<Bounds> = boxes.iter().map(|bounds| Bounds(*bounds)).collect();
            let ours = build(&boxes, &parameters());
            let theirs = obvhs::bvh2::builder::build_bvh2(&bounds, parameters(), &mut std::time::Duration::default());
            assert_eq!(ours.primitive_indices, theirs.primitive_indices);
            assert_eq!(ours.nodes.len(), theirs.nodes.len());
            assert!(ours.nodes.iter().zip(&theirs.nodes).all(|(a, b)| a.first_index == b.first_index && a.aabb() == b.aabb()));
            checked_depth(&ours, &boxes);
        }
    }
}
