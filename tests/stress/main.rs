//! Single precision pushed until it shows where it breaks: the device in f32 against the reference in f64.
//!
//! `cargo bench --bench stress` runs the same cases at full length and writes docs/stress.md.

mod grazing;
mod intersections;
mod random_scenes;
mod range;
mod scale;
mod self_intersection;
mod support;

use support::{Effort, assert_all};

#[test]
fn rooms_of_any_size_anywhere_look_the_same() {
    assert_all(&scale::findings(effort()));
}

/// `GPT_STRESS=full` runs what the page shows.
fn effort() -> Effort {
    match std::env::var("GPT_STRESS").as_deref() {
        Ok("full") => Effort::Full,
        _ => Effort::Bounded,
    }
}

#[test]
fn both_ends_of_the_range_are_right() {
    assert_all(&range::findings(effort()));
}

#[test]
fn grazing_and_critical_angles_are_right() {
    assert_all(&grazing::findings(effort()));
}

#[test]
fn random_scenes_make_no_number_that_is_not_finite() {
    assert_all(&random_scenes::findings(effort()));
}

#[test]
fn rays_leave_the_surface_they_start_on() {
    assert_all(&self_intersection::findings(effort()));
}

#[test]
fn rays_meet_what_is_hard_to_meet() {
    assert_all(&intersections::findings(effort()));
}
