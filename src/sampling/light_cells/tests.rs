use glam::DVec3;

use super::list::slots;
use super::table::{LIGHT_CELL_SLOTS, LIGHT_SLOT_COUNT_SHIFT, LIGHT_SLOT_MASK};
use super::*;
use crate::compare::sidak;
use crate::sampling::hash::{dimension_bits, mix};
use crate::statistics::chi_squared_test;

const LIGHTS: u32 = 40;

fn number(key: u32, dimension: u32) -> f64 {
    f64::from(dimension_bits(mix(key + 1), dimension)) / 4_294_967_296.0
}

/// Points on the floor and the ceiling of a room of 10 × 3 × 10.
fn points() -> Vec<LightSampleContext> {
    let point = |key: u32| {
        let is_floor = key.is_multiple_of(2);
        let at = DVec3::new(10.0 * number(key, 0), if is_floor { 0.0 } else { 3.0 }, 10.0 * number(key, 1));
        LightSampleContext::new(at, if is_floor { DVec3::Y } else { DVec3::NEG_Y })
    };
    (0..2000).map(point).collect()
}

/// Each cell is reached by some lights.
fn choice() -> LightCellChoice {
    let power: Vec<f64> = (0..LIGHTS).map(|light| 0.1 + number(light, 7)).collect();
    let mut choice = LightCellChoice::new(AliasTable::new(&power));
    let division = Division::new(&points());
    let reaching = |cell: u32| {
        let reaches = |light: &u32| number(cell, 10 + light) < 0.3;
        let of = |light: u32| Reaching { light, worth: number(cell, 100 + light), by_power: choice.by_power()[light as usize] };
        (0..LIGHTS).filter(reaches).map(of).collect()
    };
    let cells: Vec<Vec<Reaching>> = (0..division.cells().len() as u32).map(reaching).collect();
    choice.cells = Arc::new(division.table(&cells));
    choice
}

/// Points that were learned from, and others far away and outside.
fn asked() -> impl Iterator<Item = LightSampleContext> {
    let others = [DVec3::new(1e4, 1.0, 0.0), DVec3::splat(-1e9), DVec3::new(5.0, 1.5, 5.0)];
    points().into_iter().step_by(50).chain(others.map(|point| LightSampleContext::new(point, DVec3::Y)))
}

#[test]
fn probabilities_sum_to_one_everywhere_and_are_never_0() {
    let choice = choice();
    assert!(choice.cells.count() > 50);
    for from in asked() {
        let all: Vec<f64> = (0..LIGHTS as usize).map(|light| choice.probability(from, light)).collect();
        assert!((all.iter().sum::<f64>() - 1.0).abs() < 1e-12 && all.iter().all(|probability| *probability > 0.0), "{all:?}");
    }
}

/// Random bits choose each light as often as its probability says; one light's share given to another is
/// noticed.
#[test]
fn lights_are_chosen_as_often_as_their_probabilities_say() {
    let (choice, draws) = (choice(), 40_000);
    let level = sidak(0.01, 43);
    for (from, key) in asked().zip(0_u32..) {
        let probabilities = (0..LIGHTS as usize).map(|light| choice.probability(from, light));
        let expected: Vec<f64> = probabilities.map(|probability| f64::from(draws) * probability).collect();
        let mut counts = vec![0_u64; expected.len()];
        for draw in 0..draws {
            let (light, probability) = choice.choose(from, dimension_bits(mix(key), draw));
            assert!((probability * f64::from(draws) - expected[light]).abs() < 1e-9);
            counts[light] += 1;
        }
        assert!(chi_squared_test(&counts, &expected).p_value > level, "at {from:?}");
        let mut wrong = expected.clone();
        let most = (1..wrong.len()).fold(1, |most, light| if wrong[light] > wrong[most] { light } else { most });
        let moved = 0.3 * wrong[most];
        wrong[most] -= moved;
        wrong[0] += moved;
        assert!(chi_squared_test(&counts, &wrong).p_value < level, "what was moved at {from:?} goes unseen");
    }
}

/// The mean of what is chosen over its probability is the sum over all lights; with the probability of the slots alone it is not.
#[test]
fn a_light_counts_by_both_ways_to_choose_it() {
    let choice = choice();
    let draws = 1 << 16;
    let [mut right, mut wrong, mut all] = [0.0; 3];
    for from in asked().take(10) {
        let value = |light: usize| 1.0 + light as f64;
        all += (0..LIGHTS as usize).map(value).sum::<f64>();
        for draw in 0..draws {
            // Evenly spread bits.
            let (light, probability) = choice.choose(from, draw << 16 | 0x5a5a);
            right += value(light) / probability / f64::from(draws);
            let by_slots = choice.cells.cell(from).map_or(0, |cell| cell.slots_of(light as u32));
            if by_slots > 0 {
                wrong += value(light) * f64::from(LIGHT_CELL_SLOTS) / f64::from(by_slots) / f64::from(draws);
            }
        }
    }
    assert!((right / all - 1.0).abs() < 0.01, "{right} {all}");
    assert!((wrong / all - 1.0).abs() > 0.1, "{wrong} {all}");
}

#[test]
fn slots_follow_worth_and_stand_in_order() {
    let reaching = |worths: &[f64]| -> Vec<Reaching> {
        worths.iter().zip(0..).map(|(&worth, light)| Reaching { light: 100 - light, worth, by_power: 0.01 }).collect()
    };
    let slots_of = |worths: &[f64]| slots(&reaching(worths)).expect("some light reaches it");
    let all = slots_of(&[1.0, 3.0, 0.0, 1e-9]);
    assert!(all.is_sorted_by_key(|slot| slot & LIGHT_SLOT_MASK));
    let count = |light: u32| all.iter().filter(|slot| **slot & LIGHT_SLOT_MASK == light).count() as u32;
    for slot in all {
        assert_eq!(slot >> LIGHT_SLOT_COUNT_SHIFT, count(slot & LIGHT_SLOT_MASK));
    }
    assert_eq!([98, 97].map(count), [0, 0]);
    assert!(count(99).abs_diff(3 * count(100)) <= 3 && count(99) + count(100) == LIGHT_CELL_SLOTS);
    // More lights than slots.
    let many = slots_of(&(0..300).map(|light| 1.0 + f64::from(light)).collect::<Vec<f64>>()[..90]);
    assert!(many.iter().all(|slot| slot >> LIGHT_SLOT_COUNT_SHIFT > 0));
    assert_eq!(slots(&reaching(&[0.0, 0.0])), None);
    assert_eq!(slots(&[]), None);
}

/// Nothing was seen, or nothing reaches anything: lights are chosen by power.
#[test]
fn where_nothing_is_known_power_decides() {
    let empty = Division::new(&[]);
    assert_eq!(empty.table(&[]), LightCells::default());
    let division = Division::new(&points());
    assert_eq!(division.table(&vec![Vec::new(); division.cells().len()]), LightCells::default());
    let choice = LightCellChoice::new(AliasTable::new(&[1.0, 3.0]));
    for from in asked() {
        assert_eq!([0, 1].map(|light| choice.probability(from, light)), [0.25, 0.75]);
    }
    // One point, and all in one place.
    for points in [vec![points()[0]], vec![points()[0]; 1000]] {
        let division = Division::new(&points);
        assert!(division.cells().iter().map(Vec::len).sum::<usize>() <= points.len());
    }
}
