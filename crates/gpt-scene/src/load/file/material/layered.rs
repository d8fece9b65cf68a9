//! `type = "layered"`

use std::collections::HashSet;

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::{MaterialKeys, material_keys};
use crate::load::error::SceneError;
use crate::load::file::colour::Scalar;
use crate::load::file::reference::NamesTextures;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Located, NonNegative};
use crate::load::file::writer::{Writer, line, list, table};
use crate::scene::{LayerModel, LayerStack, MaterialKind, Slab};

material_keys! {
    /// Interfaces one above the other, with slabs between them: paint below varnish, a metal below a frosted foil. Light is carried between the layers.
    {
        /// The materials of its interfaces, by their names, from the front to the back. One that is `layered` itself stands for all of its interfaces.
        interfaces: Interfaces,
        /// The slab between each two interfaces, from the front to the back; none when left out: nothing lies between them.
        slabs: Option<Located<Slabs>>,
        /// How light is carried between layers; by random walks when left out.
        model: Option<LayerModelEntry>,
        /// The back looks as the front does: the first interface is on the side from which the surface is seen.
        mirrored: Option<bool>,
    }
}

/// Names of materials, at least one.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(extend("minItems" = 1, "maxItems" = 64))]
pub struct Interfaces(pub Vec<Located<String>>);

/// Slabs, one fewer than interfaces.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Slabs(pub Vec<SlabEntry>);

/// The slab between two interfaces.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(extend("dependentRequired" = { "medium": ["thickness"] }))]
pub struct SlabEntry {
    /// Along the normal, in scene units; 0 when left out.
    pub thickness: Option<Scalar<NonNegative>>,
    /// The `[[medium]]` in it, by its name, which is the same everywhere and gives off no light; none when left out.
    pub medium: Option<Located<String>>,
}

/// How light is carried between layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LayerModelEntry {
    /// By random walks that take account of all reflections and scattering between layers.
    Walk,
    /// Straight down to each layer and up again, as Weidlich and Wilkie do: light between layers is lost.
    WeidlichWilkie,
}

impl NamesTextures for Interfaces {}
impl NamesTextures for LayerModelEntry {}

impl NamesTextures for Slabs {
    fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
        self.0.iter_mut().for_each(|slab| slab.thickness.each_texture(visit));
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "interfaces = [\"varnish\", \"red\"]",
        "interfaces = [\"frost\", \"mirror\"]\nslabs = [{ thickness = 0.1, medium = \"pigment\" }]",
        "interfaces = [\"frost\", \"varnish\"]\nslabs = [{ thickness = 0.3, medium = \"pigment\" }]\nmirrored = true",
        "interfaces = [\"frost\", \"red\"]\nmodel = \"weidlich-wilkie\"",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        let Interfaces(names) = &self.interfaces;
        let interfaces = names.iter().map(|name| resolver.material_id(name)).collect::<Result<Vec<_>, _>>()?;
        if interfaces.is_empty() {
            return Err(resolver.error(&self.name.place, "`interfaces` names no material").with_help("name one or more"));
        }
        let between = interfaces.len() - 1;
        let slabs = match &self.slabs {
            None => vec![Slab::NOTHING; between],
            Some(slabs) if slabs.value.0.len() == between => {
                slabs.value.0.iter().map(|slab| slab.resolve(resolver)).collect::<Result<Vec<_>, _>>()?
            }
            Some(slabs) => {
                let written = slabs.value.0.len();
                let message = format!("between {} interfaces are {between} slabs, and {written} are written", interfaces.len());
                let help = "write one slab between each two interfaces, `{}` where there is nothing";
                return Err(resolver.error(&slabs.place, message).with_help(help));
            }
        };
        let model = match self.model {
            Some(LayerModelEntry::WeidlichWilkie) => LayerModel::Straight,
            Some(LayerModelEntry::Walk) | None => LayerModel::Walk,
        };
        Ok(MaterialKind::Layered(Box::new(LayerStack { interfaces, slabs, model, mirrored: self.mirrored.unwrap_or(false) })))
    }

    /// A stack ends in interfaces that are no stacks. Other rules are checked by the scene.
    fn check_parts(&self, resolver: &Resolver<'_>) -> Result<(), SceneError> {
        let id = resolver.material_id(&self.name)?;
        let error = |message: String| resolver.error(&self.name.place, message);
        resolver.scene.flat_layers(id).map_err(error)?;
        for name in self.slabs.iter().flat_map(|slabs| &slabs.value.0).filter_map(|slab| slab.medium.as_ref()) {
            resolver.scene.check_slab(resolver.medium_id(name)?).map_err(|message| resolver.error(&name.place, message))?;
        }
        let mut checked = HashSet::new();
        for name in self.interfaces.0.iter() {
            let id = resolver.material_id(name)?;
            if checked.insert(id) {
                resolver.scene.check_interface(id).map_err(|message| resolver.error(&name.place, message))?;
            }
        }
        Ok(())
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Layered(layers) = kind else { return String::new() };
        let mut out = line("interfaces", &list(layers.interfaces.iter().map(|&id| writer.materials.quoted(id))));
        if layers.slabs.iter().any(|slab| *slab != Slab::NOTHING) {
            let written = |slab: &Slab| {
                let thickness =
                    (slab.thickness != Slab::NOTHING.thickness).then(|| ("thickness", writer.value_of(slab.thickness)));
                let medium = slab.medium.map(|id| ("medium", writer.media.quoted(id)));
                table(thickness.into_iter().chain(medium))
            };
            out += &line("slabs", &list(layers.slabs.iter().map(written)));
        }
        if layers.model == LayerModel::Straight {
            out += &line("model", "\"weidlich-wilkie\"");
        }
        if layers.mirrored {
            out += &line("mirrored", "true");
        }
        out
    }
}

impl SlabEntry {
    fn resolve(&self, resolver: &Resolver<'_>) -> Result<Slab, SceneError> {
        let thickness = self.thickness.as_ref().map_or(Ok(Slab::NOTHING.thickness), |thickness| resolver.scalar(thickness))?;
        let medium = self.medium.as_ref().map(|name| resolver.medium_id(name)).transpose()?;
        if let (Some(name), None) = (&self.medium, &self.thickness) {
            return Err(resolver.error(&name.place, "the medium of a slab needs a `thickness`"));
        }
        Ok(Slab { thickness, medium })
    }
}
