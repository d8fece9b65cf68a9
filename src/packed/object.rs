//! Places of shapes, for the layer of places in the space of objects: primitives are kept in the world's space, whatever their shape's own is.
//!
//! First, four to a vec4, a word for each primitive in the order of the packed ones: the place in the same array of the three rows that take
//! points of the world at rest to its shape's space. Then those rows, of each shape. Primitives of groups need none: instances know the way back.

use glam::DAffine3;

use super::tree::Slot;
use super::world::WorldGeometry;
use crate::film::KernelLayer;
use crate::scene::Scene;

/// The words; none where the scene was made ready for something else.
pub fn words(scene: &Scene, world: &WorldGeometry, order: &[Slot]) -> Vec<[f32; 4]> {
    if scene.ready_for != Some(KernelLayer::ObjectPosition) || scene.shapes.is_empty() {
        return Vec::new();
    }
    let first_row = order.len().div_ceil(4);
    let row_of = |slot: &Slot| match *slot {
        Slot::Primitive(index) => first_row + 3 * world.primitives[index as usize].shape,
        Slot::Instance(_) | Slot::InGroup(..) => first_row,
    };
    let rows: Vec<u32> = order.iter().map(|slot| row_of(slot) as u32).collect();
    let mut words: Vec<[f32; 4]> = rows
        .chunks(4)
        .map(|four| std::array::from_fn(|place| f32::from_bits(four.get(place).copied().unwrap_or(first_row as u32))))
        .collect();
    for shape in &scene.shapes {
        let DAffine3 { matrix3, translation } = shape.transform.to_affine().inverse();
        words.extend([0, 1, 2].map(|row| matrix3.row(row).as_vec3().extend(translation[row] as f32).to_array()));
    }
    words
}

/// Every primitive of so many names three rows that are there.
///
/// # Errors
/// The first that does not, in words.
pub fn check(words: &[[f32; 4]], primitives: usize) -> Result<(), String> {
    if words.is_empty() {
        return Ok(());
    }
    let first_row = primitives.div_ceil(4);
    let named = words.iter().take(first_row).flatten().map(|word| word.to_bits() as usize);
    match named.clone().find(|row| *row < first_row || row + 3 > words.len()) {
        Some(row) => Err(format!("a primitive is said to stand by rows {row} to {} of {}", row + 2, words.len())),
        None if named.count() < primitives => Err("there are fewer places of shapes than primitives".to_owned()),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_are_not_there_are_refused() {
        let words = |row: u32| {
            let mut words = vec![[f32::from_bits(row); 4]];
            words.extend([[0.0; 4]; 3]);
            words
        };
        assert!(check(&words(1), 4).is_ok());
        assert!(check(&[], 4).is_ok());
        assert!(check(&words(2), 4).is_err());
        assert!(check(&words(0), 4).is_err());
        assert!(check(&words(1), 5).is_err());
    }
}
