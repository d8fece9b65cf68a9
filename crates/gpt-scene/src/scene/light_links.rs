//! Light links: which lamps light which objects. An object belongs to one group of receivers, and a lamp has a mask of those that it lights.

use std::collections::BTreeMap;

use super::light_groups::{REST, check_group_name};
use super::material::MaterialId;
use super::medium::MediumId;

/// Most groups of receivers, that of the [`REST`] among them: each is a bit of a mask.
pub const MOST_RECEIVERS: usize = 32;

/// The number of a group of receivers: 0 is that of the [`REST`], others are numbered as the scene names them first.
pub type ReceiverId = u32;

/// The receiver of paths that nothing has scattered yet: the camera sees every lamp.
pub const SEES_ALL: ReceiverId = MOST_RECEIVERS as u32;

/// The groups of receivers that a lamp lights, a bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LinkMask(pub u32);

impl LinkMask {
    /// Lamps that name no receivers light all.
    pub const ALL: Self = Self(u32::MAX);

    /// A lamp with this mask lights this receiver.
    pub fn lights(self, receiver: ReceiverId) -> bool {
        receiver >= SEES_ALL || self.0 >> receiver & 1 == 1
    }
}

/// The links of a scene. Objects say their receiver themselves; lamps and media that are not listed are as those of scenes without links.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LightLinks {
    /// The name of number 1 is the first.
    names: Vec<String>,
    lights: BTreeMap<usize, u32>,
    materials: BTreeMap<MaterialId, u32>,
    media: BTreeMap<MediumId, ReceiverId>,
}

impl LightLinks {
    /// The number of a name, which is added where it is new.
    ///
    /// # Errors
    /// A sentence about a name that cannot be one, or that is one too many.
    pub fn named(&mut self, name: &str) -> Result<ReceiverId, String> {
        if name == REST {
            return Ok(0);
        }
        check_group_name(name).map_err(|message| message.replace("a light group's name", "a receiver's name"))?;
        if let Some(index) = self.names.iter().position(|other| other == name) {
            return Ok(index as u32 + 1);
        }
        if self.names.len() + 1 == MOST_RECEIVERS {
            return Err(format!(
                "a scene has at most {MOST_RECEIVERS} groups of receivers, {REST:?} among them, and {name:?} is one more"
            ));
        }
        self.names.push(name.to_owned());
        Ok(self.names.len() as u32)
    }

    /// The name of a number.
    pub fn name(&self, number: ReceiverId) -> &str {
        (number as usize).checked_sub(1).and_then(|index| self.names.get(index)).map_or(REST, String::as_str)
    }

    /// The names of all groups of receivers, by their numbers.
    pub fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        (0..=self.names.len() as u32).map(|number| self.name(number)).collect::<Vec<_>>().into_iter()
    }

    /// Every lamp lights everything.
    pub fn is_empty(&self) -> bool {
        self.lights.is_empty() && self.materials.is_empty()
    }

    /// Says what a light lights, by its place in [`crate::scene::Scene::lights`].
    pub fn put_light(&mut self, light: usize, mask: LinkMask) {
        put(&mut self.lights, light, mask);
    }

    /// Says what surfaces of a material light. Of a blend, the mask holds for the light of all its parts.
    pub fn put_material(&mut self, material: MaterialId, mask: LinkMask) {
        put(&mut self.materials, material, mask);
    }

    /// Says to which receivers places belong where a medium scatters light.
    pub fn put_medium(&mut self, medium: MediumId, receiver: ReceiverId) {
        if receiver == 0 {
            self.media.remove(&medium);
        } else {
            self.media.insert(medium, receiver);
        }
    }

    pub fn of_light(&self, light: usize) -> LinkMask {
        LinkMask(self.lights.get(&light).copied().unwrap_or(u32::MAX))
    }

    pub fn of_material(&self, material: MaterialId) -> LinkMask {
        LinkMask(self.materials.get(&material).copied().unwrap_or(u32::MAX))
    }

    pub fn of_medium(&self, medium: MediumId) -> ReceiverId {
        self.media.get(&medium).copied().unwrap_or(0)
    }
}

fn put(masks: &mut BTreeMap<usize, u32>, place: usize, mask: LinkMask) {
    if mask == LinkMask::ALL {
        masks.remove(&place);
    } else {
        masks.insert(place, mask.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mask_lights_those_whose_bit_is_set_and_the_camera_sees_all() {
        let mask = LinkMask(0b10);
        assert_eq!([0, 1, 2, 31, SEES_ALL].map(|receiver| mask.lights(receiver)), [false, true, false, false, true]);
        assert!((0..=SEES_ALL).all(|receiver| LinkMask::ALL.lights(receiver)));
    }

    #[test]
    fn names_have_numbers_and_the_33rd_is_one_too_many() {
        let mut links = LightLinks::default();
        assert_eq!(
            (links.named("hero"), links.named(REST), links.named("set"), links.named("hero")),
            (Ok(1), Ok(0), Ok(2), Ok(1))
        );
        assert_eq!(links.names().collect::<Vec<_>>(), [REST, "hero", "set"]);
        assert!(links.named("A hero").unwrap_err().contains("a receiver's name is"));
        (3..32).for_each(|number| assert_eq!(links.named(&format!("r{number}")), Ok(number)));
        assert!(links.named("more").unwrap_err().contains("at most 32 groups of receivers"));
        assert!(links.named("hero").is_ok());
    }

    #[test]
    fn lamps_that_light_all_are_not_listed() {
        let mut links = LightLinks::default();
        links.put_light(2, LinkMask(5));
        links.put_material(1, LinkMask(1));
        assert!(!links.is_empty());
        assert_eq!((links.of_light(2), links.of_light(1), links.of_material(1)), (LinkMask(5), LinkMask::ALL, LinkMask(1)));
        links.put_light(2, LinkMask::ALL);
        links.put_material(1, LinkMask::ALL);
        assert!(links.is_empty());
    }
}
