//! The keys of light links: `lights_only` and `lights_all_but` of lamps, and `receiver` of what they light.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer};

use super::resolver::Resolver;
use super::value::Located;
use super::writer::{Writer, line, list, text};
use crate::load::error::SceneError;
use crate::scene::light_links::{LinkMask, ReceiverId};

/// The name of a group of receivers, or "rest".
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReceiverName(pub String);

impl<'de> Deserialize<'de> for ReceiverName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer).map(Self)
    }
}

impl JsonSchema for ReceiverName {
    fn schema_name() -> Cow<'static, str> {
        "ReceiverName".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "pattern": "^[a-z][A-Za-z0-9_-]{0,30}$" })
    }
}

/// Names of groups of receivers, as a lamp lists them.
pub type ReceiverNames = Located<Vec<Located<ReceiverName>>>;

/// The keys by which a lamp says what it lights; all where neither is written.
#[derive(Debug, Clone, Copy, Default)]
pub struct WrittenLink<'a> {
    pub only: Option<&'a ReceiverNames>,
    pub all_but: Option<&'a ReceiverNames>,
}

impl Resolver<'_> {
    /// The number of the receivers that an object names; that of the rest where it names none.
    pub(super) fn receiver(&mut self, written: Option<&Located<ReceiverName>>) -> Result<ReceiverId, SceneError> {
        let Some(written) = written else { return Ok(0) };
        let number = self.scene.light_links.named(&written.value.0);
        number.map_err(|message| self.error(&written.place, message))
    }

    /// The mask of a lamp.
    pub(super) fn link_mask(&mut self, written: WrittenLink<'_>) -> Result<LinkMask, SceneError> {
        match (written.only, written.all_but) {
            (None, None) => Ok(LinkMask::ALL),
            (Some(_), Some(but)) => Err(self.error(&but.place, "a lamp has `lights_only` or `lights_all_but`, not both")),
            (Some(names), None) => self.bits(names).map(LinkMask),
            (None, Some(names)) => self.bits(names).map(|bits| LinkMask(!bits)),
        }
    }

    fn bits(&mut self, names: &ReceiverNames) -> Result<u32, SceneError> {
        let mut bits = 0;
        for name in &names.value {
            bits |= 1 << self.receiver(Some(name))?;
            self.linked_receivers.push(Located { value: name.value.0.clone(), place: name.place.clone() });
        }
        Ok(bits)
    }

    /// Names that lamps list have to be those of something, or a slip of the pen would leave a lamp dark.
    pub(super) fn check_linked_receivers(&mut self) {
        // Objects that are wrong themselves have no receiver yet.
        if !self.errors.is_empty() {
            return;
        }
        let scene = &self.scene;
        let mut used = vec![false; scene.light_links.names().len()];
        used[0] = true;
        let of_media = (0..scene.media.len()).map(|id| scene.light_links.of_medium(id));
        let of_shapes = scene.shapes.iter().map(|shape| shape.receiver);
        let of_instances = scene.instances.iter().map(|instances| instances.receiver);
        of_media.chain(of_shapes).chain(of_instances).for_each(|receiver| used[receiver as usize] = true);
        let known: Vec<String> =
            scene.light_links.names().zip(&used).filter(|(_, used)| **used).map(|(name, _)| name.to_owned()).collect();
        for written in std::mem::take(&mut self.linked_receivers) {
            let name = &written.value;
            if !known.contains(name) {
                let message =
                    format!("no shape, instance, import or medium has `receiver = {name:?}`; there are: {}", known.join(", "));
                let error = self.error(&written.place, message);
                self.note::<()>(Err(error));
            }
        }
    }
}

/// The line of a lamp's link, as a scene file has it; nothing where it lights all.
pub fn write_link(mask: LinkMask, writer: &Writer<'_>) -> String {
    if mask == LinkMask::ALL {
        return String::new();
    }
    let links = &writer.scene.light_links;
    let names = |lit: bool| {
        let of = (0u32..).zip(links.names()).filter(|(number, _)| mask.lights(*number) == lit);
        list(of.map(|(_, name)| text(name)))
    };
    // Numbers without a name are those that `lights_all_but` leaves lit.
    if mask.0 >> 31 == 1 && links.names().len() < 32 {
        line("lights_all_but", &names(false))
    } else {
        line("lights_only", &names(true))
    }
}

/// The line of an object's receiver; nothing for that of the rest.
pub fn write_receiver(receiver: ReceiverId, writer: &Writer<'_>) -> String {
    if receiver == 0 { String::new() } else { line("receiver", &text(writer.scene.light_links.name(receiver))) }
}
