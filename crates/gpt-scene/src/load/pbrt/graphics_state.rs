//! The state that directives before a shape set for it: transforms, its material, its light, and the media on both of its sides.

use std::rc::Rc;

use glam::{DAffine3, DMat3, DMat4, DVec3, DVec4};

use super::color_space::RgbSpace;
use super::parameter::{Entity, Parameter};

/// Transforms at the start and at the end of motion.
pub type Maps = [DAffine3; 2];

/// The material in force.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum MaterialName {
    /// One that was written by `Material`, by its number.
    Written(usize),
    /// One that has a name.
    Named(String),
}

/// The things whose parameters `Attribute` sets.
pub const TARGETS: [&str; 5] = ["shape", "light", "material", "medium", "texture"];

/// The state that `AttributeBegin` keeps.
#[derive(Debug, Clone)]
pub struct GraphicsState {
    pub maps: Maps,
    /// The ones of the two transforms that the following directives change.
    pub active: [bool; 2],
    pub reverses: bool,
    pub material: MaterialName,
    pub light: Option<Rc<Entity>>,
    /// Names of media, empty where there is nothing.
    pub inside: Rc<str>,
    pub outside: Rc<str>,
    pub space: RgbSpace,
    /// Parameters of all that follows, in the order of [`TARGETS`].
    pub attributes: [Vec<Rc<Parameter>>; 5],
}

impl Default for GraphicsState {
    fn default() -> Self {
        Self {
            maps: [DAffine3::IDENTITY; 2],
            active: [true; 2],
            reverses: false,
            material: MaterialName::Written(0),
            light: None,
            inside: "".into(),
            outside: "".into(),
            space: RgbSpace::Srgb,
            attributes: Default::default(),
        }
    }
}

impl GraphicsState {
    /// Changes the transforms that are active.
    pub fn each_map(&mut self, change: impl Fn(DAffine3) -> DAffine3) {
        for (map, _) in self.maps.iter_mut().zip(self.active).filter(|(_, is_active)| *is_active) {
            *map = change(*map);
        }
    }

    /// The parameters that `Attribute` has set for what `target` names.
    pub fn around(&self, target: &str) -> Vec<Rc<Parameter>> {
        let index = TARGETS.iter().position(|known| *known == target);
        index.map(|index| self.attributes[index].clone()).unwrap_or_default()
    }
}

/// The map of sixteen numbers, column by column; None of one that is projective.
pub fn matrix(numbers: &[f64; 16]) -> Option<DAffine3> {
    let matrix = DMat4::from_cols_array(numbers);
    (matrix.row(3) == DVec4::W).then(|| DAffine3::from_mat4(matrix))
}

/// A turn by degrees about an axis, counter-clockwise seen from its tip; None where the axis has no length.
pub fn rotation(degrees: f64, axis: DVec3) -> Option<DAffine3> {
    Some(DAffine3::from_axis_angle(axis.try_normalize()?, degrees.to_radians()))
}

/// The map from the world to a camera, which looks along +Z and has +X to the right of its picture; None where which way is up is not known.
pub fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> Option<DAffine3> {
    let forward = (target - eye).try_normalize()?;
    let right = up.try_normalize()?.cross(forward).try_normalize()?;
    let matrix3 = DMat3::from_cols(right, forward.cross(right), forward);
    Some(DAffine3 { matrix3, translation: eye }.inverse())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_are_left_handed() {
        let map = look_at(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, DVec3::Y).expect("a frame");
        // Seen from +Z, the world's +X is to the left of a left-handed camera.
        assert!(map.transform_point3(DVec3::X).abs_diff_eq(DVec3::new(-1.0, 0.0, 4.0), 1e-12), "{map:?}");
        assert!(look_at(DVec3::ZERO, DVec3::Y, DVec3::Y).is_none() && look_at(DVec3::ONE, DVec3::ONE, DVec3::Y).is_none());
    }

    #[test]
    fn matrices_are_column_by_column() {
        let mut numbers = DMat4::IDENTITY.to_cols_array();
        numbers[12] = 5.0;
        assert_eq!(matrix(&numbers).map(|map| map.translation), Some(DVec3::new(5.0, 0.0, 0.0)));
        numbers[3] = 0.1;
        assert!(matrix(&numbers).is_none());
    }

    #[test]
    fn only_active_maps_change() {
        let mut state = GraphicsState { active: [false, true], ..GraphicsState::default() };
        state.each_map(|map| map * DAffine3::from_translation(DVec3::X));
        assert_eq!(state.maps.map(|map| map.translation.x), [0.0, 1.0]);
    }
}
