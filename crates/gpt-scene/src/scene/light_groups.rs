//! Light groups: names under which a render keeps the light of some emitters apart, so that it can be weighed anew in a finished picture.

use std::collections::BTreeMap;

use super::material::MaterialId;
use super::medium::MediumId;

/// The group of all light that names none.
pub const REST: &str = "rest";

/// Most groups that a scene names: each is a render of its own.
pub const MOST_LIGHT_GROUPS: usize = 16;

/// Most characters of a group's name.
pub const LONGEST_GROUP_NAME: usize = 31;

/// The number of a group: 0 is that of the [`REST`], others are numbered as the scene names them first.
pub type LightGroupId = usize;

/// The groups of a scene's light. Emitters that are not listed are in the group of the [`REST`].
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LightGroups {
    /// The name of number 1 is the first.
    pub(super) names: Vec<String>,
    lights: BTreeMap<usize, LightGroupId>,
    materials: BTreeMap<MaterialId, LightGroupId>,
    media: BTreeMap<MediumId, LightGroupId>,
    /// The one whose light alone is to be seen; None: all light is.
    shown: Option<LightGroupId>,
}

/// Says in words what is wrong with the name of a group.
///
/// # Errors
/// A sentence about a name that is not `a` to `z`, followed by letters, digits, `_` and `-`, or that is too long.
pub fn check_group_name(name: &str) -> Result<(), String> {
    let begins = name.starts_with(|first: char| first.is_ascii_lowercase());
    let goes_on = name.chars().all(|letter| letter.is_ascii_alphanumeric() || matches!(letter, '_' | '-'));
    if begins && goes_on && name.len() <= LONGEST_GROUP_NAME {
        return Ok(());
    }
    Err(format!(
        "a light group's name is a letter from a to z, then letters from a to z and A to Z, digits, _ and -, at most \
         {LONGEST_GROUP_NAME} in all, not {name:?}"
    ))
}

impl LightGroups {
    /// The number of a name, which is added where it is new.
    ///
    /// # Errors
    /// A sentence about a name that cannot be one, or that is one too many.
    pub fn named(&mut self, name: &str) -> Result<LightGroupId, String> {
        check_group_name(name)?;
        if let Some(number) = self.number(name) {
            return Ok(number);
        }
        if self.names.len() == MOST_LIGHT_GROUPS {
            return Err(format!("a scene has at most {MOST_LIGHT_GROUPS} light groups, {name:?} is one more"));
        }
        self.names.push(name.to_owned());
        Ok(self.names.len())
    }

    /// The number of a name; None of one that nothing has.
    pub fn number(&self, name: &str) -> Option<LightGroupId> {
        if name == REST {
            return Some(0);
        }
        self.names.iter().position(|other| other == name).map(|index| index + 1)
    }

    /// The name of a number.
    pub fn name(&self, number: LightGroupId) -> &str {
        number.checked_sub(1).and_then(|index| self.names.get(index)).map_or(REST, String::as_str)
    }

    /// No emitter names a group.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Puts a light, by its place in [`crate::scene::Scene::lights`], into a group.
    pub fn put_light(&mut self, light: usize, group: LightGroupId) {
        put(&mut self.lights, light, group);
    }

    /// Puts the emission of a material, not of those that it is made of, into a group.
    pub fn put_material(&mut self, material: MaterialId, group: LightGroupId) {
        put(&mut self.materials, material, group);
    }

    /// Puts what a medium gives off into a group.
    pub fn put_medium(&mut self, medium: MediumId, group: LightGroupId) {
        put(&mut self.media, medium, group);
    }

    /// A material that has moved to another place takes its group along.
    pub fn move_material(&mut self, from: MaterialId, to: MaterialId) {
        if let Some(group) = self.materials.remove(&from) {
            self.materials.insert(to, group);
        }
    }

    pub fn of_light(&self, light: usize) -> LightGroupId {
        self.lights.get(&light).copied().unwrap_or(0)
    }

    pub fn of_material(&self, material: MaterialId) -> LightGroupId {
        self.materials.get(&material).copied().unwrap_or(0)
    }

    pub fn of_medium(&self, medium: MediumId) -> LightGroupId {
        self.media.get(&medium).copied().unwrap_or(0)
    }

    /// Light of this group is to be seen.
    pub fn shows(&self, group: LightGroupId) -> bool {
        self.shown.is_none_or(|shown| shown == group)
    }

    /// Light of one group alone is to be seen, or of all of them again. Paths and what is learned about them stay what they are.
    pub fn show_only(&mut self, group: Option<LightGroupId>) {
        self.shown = group;
    }
}

fn put(groups: &mut BTreeMap<usize, LightGroupId>, place: usize, group: LightGroupId) {
    if group == 0 {
        groups.remove(&place);
    } else {
        groups.insert(place, group);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_have_numbers_and_the_rest_has_0() {
        let mut groups = LightGroups::default();
        assert_eq!((groups.named("key"), groups.named("fill"), groups.named("key")), (Ok(1), Ok(2), Ok(1)));
        assert_eq!((groups.named(REST), groups.name(0), groups.name(2)), (Ok(0), REST, "fill"));
        groups.put_material(3, 2);
        groups.move_material(3, 7);
        assert_eq!((groups.of_material(3), groups.of_material(7)), (0, 2));
        assert!(groups.shows(0) && groups.shows(2));
        groups.show_only(Some(2));
        assert!(!groups.shows(0) && groups.shows(2));
    }

    #[test]
    fn names_that_channels_cannot_have_are_refused() {
        for bad in ["", "Key", "a b", "a.R", "-a", "ä", &"a".repeat(LONGEST_GROUP_NAME + 1)] {
            assert!(check_group_name(bad).is_err(), "{bad:?}");
        }
        assert!(check_group_name(&"a".repeat(LONGEST_GROUP_NAME)).is_ok());
        let mut groups = LightGroups::default();
        let names = (0..MOST_LIGHT_GROUPS).map(|number| format!("g{number}"));
        names.for_each(|name| assert!(groups.named(&name).is_ok()));
        assert!(groups.named("more").unwrap_err().contains("at most 16"));
        assert!(groups.named("g0").is_ok());
    }
}
