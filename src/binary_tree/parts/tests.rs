use glam::{Affine3A, Mat3, Quat, Vec3, Vec3A};
use obvhs::BvhBuildParams;

use super::*;
use crate::binary_tree;
use crate::binary_tree::tests::checked_depth;
use crate::scene::animation::unevenness;

fn build(boxes: &[Aabb]) -> Bvh2 {
    let parameters = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
    binary_tree::build(boxes, &parameters)
}

fn fraction(index: u32, factor: u32) -> f32 {
    (index.wrapping_mul(factor) % 10_007) as f32 / 10_007.0
}

fn point(index: u32) -> Vec3A {
    Vec3A::new(fraction(index, 7919), fraction(index, 104_729), fraction(index, 1_299_709)) - 0.5
}

/// Small triangles about the origin.
fn soup(count: u32) -> Vec<[Vec3A; 3]> {
    (0..count).map(|index| [0, 7, 13].map(|corner| point(index + 1) + 0.1 * point(31 * index + corner))).collect()
}

fn moved(triangles: &[[Vec3A; 3]], map: Affine3A) -> Vec<[Vec3A; 3]> {
    triangles.iter().map(|corners| corners.map(|corner| map.transform_point3a(corner))).collect()
}

fn boxes_of(triangles: &[[Vec3A; 3]]) -> Vec<Aabb> {
    let of_one = |corners: &[Vec3A; 3]| {
        let low = corners[0].min(corners[1]).min(corners[2]);
        let high = corners[0].max(corners[1]).max(corners[2]);
        Aabb::new(low - 1e-5, high + 1e-5)
    };
    triangles.iter().map(of_one).collect()
}

/// Distance to a triangle.
fn distance([a, b, c]: &[Vec3A; 3], origin: Vec3A, direction: Vec3A) -> Option<f32> {
    let (ab, ac) = (*b - *a, *c - *a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    let t = origin - *a;
    let q = t.cross(ab);
    let (u, v, distance) = (t.dot(p) / determinant, direction.dot(q) / determinant, ac.dot(q) / determinant);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some(distance)
}

/// The closest hits of random rays, and how many nodes they enter.
fn hits(tree: &Bvh2, triangles: &[[Vec3A; 3]]) -> (Vec<Option<u32>>, usize) {
    let mut entered = 0;
    let of_ray = |ray: u32| {
        let origin = 4.0 * point(3 * ray + 5000);
        let direction = (2.0 * point(17 * ray + 900) - origin).normalize();
        let mut closest: Option<(f32, u32)> = None;
        let mut pending = vec![0_usize];
        while let Some(index) = pending.pop() {
            let node = &tree.nodes[index];
            let (to_low, to_high) = ((node.aabb().min - origin) / direction, (node.aabb().max - origin) / direction);
            let (near, far) = (to_low.min(to_high).max_element(), to_low.max(to_high).min_element());
            if near.max(0.0) > far || closest.is_some_and(|(limit, _)| near > limit) {
                continue;
            }
            entered += 1;
            let first = node.first_index as usize;
            if !node.is_leaf() {
                pending.extend([first, first + 1]);
                continue;
            }
            for &index in &tree.primitive_indices[first..first + node.prim_count as usize] {
                let found = distance(&triangles[index as usize], origin, direction).map(|distance| (distance, index));
                closest = [closest, found].into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            }
        }
        closest.map(|(_, index)| index)
    };
    let found = (0..2000).map(of_ray).collect();
    (found, entered)
}

/// Two parts that go through each other, and one that rests.
struct MovingModel {
    rest: Vec<[Vec3A; 3]>,
    count: u32,
}

impl MovingModel {
    fn at(&self, angle: f32, offset: f32) -> Vec<[Vec3A; 3]> {
        let turn = |angle: f32, offset: f32| {
            Affine3A::from_rotation_translation(Quat::from_axis_angle(Vec3::new(0.6, 0.8, 0.0), angle), offset * Vec3::X)
        };
        let maps = [turn(angle, offset), turn(-angle, -offset), Affine3A::IDENTITY];
        maps.iter().flat_map(|map| moved(&self.rest, *map)).collect()
    }

    fn parts(&self) -> Vec<MovingPart> {
        let reference = boxes_of(&self.rest);
        let part = |part: u32| MovingPart {
            members: (part * self.count..(part + 1) * self.count).collect(),
            reference: (part < 2).then(|| Pose { boxes: reference.clone(), unevenness: 1.0 }),
        };
        (0..3).map(part).collect()
    }
}

fn stage() -> MovingModel {
    MovingModel { rest: soup(700), count: 700 }
}

fn are_equal(a: &Bvh2, b: &Bvh2) -> bool {
    let node = |node: &Bvh2Node| (node.prim_count, node.first_index, *node.aabb());
    a.primitive_indices == b.primitive_indices && a.nodes.iter().map(node).eq(b.nodes.iter().map(node))
}

#[test]
fn a_fitted_tree_holds_everything_and_finds_the_same_hits_as_one_built_anew() {
    let stage = stage();
    let kept = KeptTrees::default();
    let before = build_of_parts(&boxes_of(&stage.at(0.0, 2.0)), &stage.parts(), &kept, &build);
    for (angle, offset) in [(0.3, 1.0), (0.7, 0.1), (2.0, 0.0), (3.0, -1.5)] {
        let triangles = stage.at(angle, offset);
        let boxes = boxes_of(&triangles);
        let tree = build_of_parts(&boxes, &stage.parts(), &kept, &build);
        checked_depth(&tree, &boxes);
        let anew = build(&boxes);
        let ((of_fitted, steps), (of_anew, least)) = (hits(&tree, &triangles), hits(&anew, &triangles));
        assert!(of_fitted.iter().flatten().count() > 200, "rays meet something");
        assert_eq!(of_fitted, of_anew);
        assert!(steps as f64 <= 1.5 * least as f64, "{steps} nodes against {least}, where shapes cross");
        // The control: the tree of another frame as it is.
        assert_ne!(hits(&before, &triangles).0, of_anew);
    }
}

#[test]
fn a_tree_does_not_depend_on_those_before_it() {
    let stage = stage();
    let mut kept = KeptTrees::default();
    for offset in [2.0, 0.1, 0.0, 2.0] {
        let boxes = boxes_of(&stage.at(offset, offset));
        let one_of_several = build_of_parts(&boxes, &stage.parts(), &kept, &build);
        kept.forget_unused();
        let alone = build_of_parts(&boxes, &stage.parts(), &KeptTrees::default(), &build);
        assert!(are_equal(&one_of_several, &alone));
        // The control: without poses for reference it is another.
        let rest = [MovingPart { members: (0..boxes.len() as u32).collect(), reference: None }];
        assert!(!are_equal(&alone, &build_of_parts(&boxes, &rest, &kept, &build)));
    }
}

#[test]
fn what_is_kept_is_not_built_again_until_it_is_forgotten() {
    let builds = std::sync::atomic::AtomicUsize::new(0);
    let counted = |boxes: &[Aabb]| {
        builds.fetch_add(usize::from(boxes.len() == 700), std::sync::atomic::Ordering::Relaxed);
        build(boxes)
    };
    let stage = stage();
    let mut kept = KeptTrees::default();
    // How often a tree of so many boxes is built where the first part is in one pose, and was in another for reference.
    let mut built_for = |reference: Mat3, now: Affine3A| {
        let before = builds.load(std::sync::atomic::Ordering::Relaxed);
        let mut triangles = stage.at(0.5, 0.0);
        triangles.splice(..700, moved(&stage.rest, now));
        let mut parts = stage.parts();
        let boxes = boxes_of(&moved(&stage.rest, Affine3A::from_mat3(reference)));
        let unevenness = unevenness((Mat3::from(now.matrix3) * reference.inverse()).as_dmat3());
        parts[0].reference = Some(Pose { boxes, unevenness });
        let tree = build_of_parts(&boxes_of(&triangles), &parts, &kept, &counted);
        kept.forget_unused();
        checked_depth(&tree, &boxes_of(&triangles));
        builds.load(std::sync::atomic::Ordering::Relaxed) - before
    };
    let rest = Mat3::IDENTITY;
    let turn = |angle: f32| Affine3A::from_axis_angle(Vec3::new(0.6, 0.8, 0.0), angle);
    // All three parts are the same soup, and may be built side by side before one of them is kept.
    assert!((1..=3).contains(&built_for(rest, Affine3A::IDENTITY)));
    for similar in [turn(0.8), Affine3A::from_translation(Vec3::X), Affine3A::from_scale(Vec3::splat(5.0)) * turn(2.0)] {
        assert_eq!(built_for(rest, similar), 0, "{similar}");
    }
    assert_eq!(built_for(rest, Affine3A::from_scale(Vec3::new(1.0, 1.9, 1.0))), 0, "it is drawn out a little");
    let line = Vec3::new(1e-4, 1e-4, 1.0);
    for squashed in [Affine3A::from_scale(line), turn(0.7) * Affine3A::from_scale(Vec3::new(1.0, 0.4, 1.0))] {
        assert_eq!(built_for(rest, squashed), 1, "{squashed}");
        assert_eq!(built_for(rest, squashed), 0, "it stands there again");
    }
    // A pose for reference that is thin or flat gives trees that only help poses as thin.
    for (thin, angle) in [(line, 0.5), (Vec3::new(1.0, 1.0, 0.0), 0.6)] {
        assert_eq!(built_for(Mat3::from_diagonal(thin), turn(angle)), 1, "{thin}");
    }
    assert_eq!(built_for(Mat3::from_diagonal(line), turn(0.3) * Affine3A::from_scale(line)), 1, "the thin one");
    assert_eq!(built_for(Mat3::from_diagonal(line), turn(0.4) * Affine3A::from_scale(line)), 0, "it turns");
    kept.forget_unused();
    assert!(kept.lock().is_empty());
}

#[test]
fn nothing_and_little_have_trees() {
    let kept = KeptTrees::default();
    assert!(build_of_parts(&[], &[MovingPart::default()], &kept, &build).nodes.is_empty());
    let boxes = boxes_of(&soup(2));
    let parts =
        [0, 1].map(|index| MovingPart { members: vec![index], reference: Some(Pose { boxes: vec![boxes[0]], unevenness: 1.0 }) });
    checked_depth(&build_of_parts(&boxes, &parts, &kept, &build), &boxes);
}
