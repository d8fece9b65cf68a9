//! A scene's light by groups: which there are, and the scene in the light of one alone.

use super::light_groups::REST;
use super::material::Material;
use super::medium::Medium;
use super::model::Scene;

impl Scene {
    /// The names of the groups that the scene's light is in: those that it names, in that order, and [`REST`] where some light names none.
    pub fn light_group_names(&self) -> Vec<&str> {
        let groups = &self.light_groups;
        let of_lights = (0..self.lights.len()).map(|light| groups.of_light(light));
        let emits = |(id, material): (usize, &Material)| material.emission.is_some().then(|| groups.of_material(id));
        let of_materials = self.materials.iter().enumerate().filter_map(emits);
        let glows = |(id, medium): (usize, &Medium)| (!medium.emission.is_black()).then(|| groups.of_medium(id));
        let of_media = self.media.iter().enumerate().filter_map(glows);
        let rest = of_lights.chain(of_materials).chain(of_media).any(|group| group == 0);
        groups.names.iter().map(String::as_str).chain(rest.then_some(REST)).collect()
    }

    /// The scene in which light of one group alone is seen, on the same paths. None where nothing has this name.
    #[must_use]
    pub fn in_light_of(&self, group: &str) -> Option<Self> {
        let number = self.light_groups.number(group)?;
        let mut scene = self.clone();
        scene.light_groups.show_only(Some(number));
        Some(scene)
    }

    /// The light from outside the scene is to be seen.
    pub fn shows_outside(&self) -> bool {
        let mut outside = self.lights.iter().enumerate().filter(|(_, light)| light.is_environment());
        outside.all(|(index, _)| self.light_groups.shows(self.light_groups.of_light(index)))
    }

    /// The light from outside the scene is all in one group.
    pub(super) fn check_light_groups(&self) -> Result<(), String> {
        let mut outside = self.lights.iter().enumerate().filter(|(_, light)| light.is_environment());
        let of_light = |(index, _)| self.light_groups.of_light(index);
        let first = outside.next().map(of_light);
        if outside.map(of_light).any(|group| Some(group) != first) {
            return Err("light from outside the scene is in one light group".to_owned());
        }
        Ok(())
    }
}
