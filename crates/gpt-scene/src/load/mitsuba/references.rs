//! Plugins as they are read, before it is known what `<ref>` names: that may stand further down.

use std::cell::Cell;
use std::collections::HashMap;
use std::rc::Rc;

use super::nesting::DEEPEST;
use super::plugin::{Child, Plugin, error_at};
use crate::load::error::SceneError;
use crate::load::place::Origin;

/// A plugin without the plugins within, and what names those.
#[derive(Debug)]
pub struct Draft {
    pub plugin: Plugin,
    pub parts: Vec<NestedPlugin>,
}

/// A plugin within another one.
#[derive(Debug)]
pub struct NestedPlugin {
    /// The name that the plugin around gives it; empty where there is none.
    pub name: String,
    pub target: Target,
}

/// The elements within a plugin.
#[derive(Debug)]
pub enum Target {
    /// The plugin itself.
    Written(Box<Draft>),
    /// The id of another plugin, and where it is asked for.
    Named(String, Origin),
}

/// A name for another id.
#[derive(Debug)]
struct Alias {
    of: String,
    place: Origin,
}

/// All ids of a scene.
#[derive(Debug, Default)]
pub struct References {
    written: HashMap<String, Draft>,
    aliases: HashMap<String, Alias>,
    finished: HashMap<String, Rc<Plugin>>,
    /// Ids whose plugins are being put together, the outermost first.
    within: Vec<String>,
}

impl References {
    /// Notes a plugin that has an id, and what names it from where it stood.
    ///
    /// # Errors
    /// The id is another plugin's.
    pub fn note(&mut self, draft: Draft) -> Result<Target, SceneError> {
        let (id, place) = (draft.plugin.id.clone(), draft.plugin.place.clone());
        if id.is_empty() {
            return Ok(Target::Written(Box::new(draft)));
        }
        self.check_new(&id, &place)?;
        self.written.insert(id.clone(), draft);
        Ok(Target::Named(id, Origin::clone(&place)))
    }

    /// Gives a plugin a second id.
    ///
    /// # Errors
    /// The id is another plugin's.
    pub fn alias(&mut self, new: String, of: String, place: Origin) -> Result<(), SceneError> {
        self.check_new(&new, &place)?;
        // Chains of aliases that are written in their order stay one step long.
        let of = self.aliases.get(&of).map_or(of, |alias| alias.of.clone());
        self.aliases.insert(new, Alias { of, place });
        Ok(())
    }

    fn check_new(&self, id: &str, place: &Origin) -> Result<(), SceneError> {
        let is_known = self.written.contains_key(id) || self.aliases.contains_key(id);
        if is_known { Err(error_at(place, format!("a second plugin has the id `{id}`"))) } else { Ok(()) }
    }

    /// The plugin with all that lies within it.
    ///
    /// # Errors
    /// A `<ref>` that names nothing, one that leads back to itself, or plugins that lie too deep within each other.
    pub fn resolve(mut self, root: Draft) -> Result<Rc<Plugin>, SceneError> {
        // Elements that nothing could name are in error as well.
        let unsound =
            self.aliases.values().find(|alias| !self.written.contains_key(&alias.of) && !self.aliases.contains_key(&alias.of));
        if let Some(Alias { of, place }) = unsound {
            return Err(unknown(of, place));
        }
        self.put_together(root, 0)
    }

    fn put_together(&mut self, draft: Draft, depth: usize) -> Result<Rc<Plugin>, SceneError> {
        let Draft { mut plugin, parts } = draft;
        let too_deep = |plugin: &Plugin| {
            plugin.error(format!("plugins lie more than {DEEPEST} deep within each other, references followed"))
        };
        if depth > DEEPEST {
            return Err(too_deep(&plugin));
        }
        for NestedPlugin { name, target } in parts {
            let part = match target {
                Target::Written(draft) => self.put_together(*draft, depth + 1)?,
                Target::Named(id, place) => self.named(id, &place, depth + 1)?,
            };
            plugin.children.push(Child { name, plugin: part, used: Cell::new(false) });
        }
        plugin.summarize();
        if plugin.within.depth > DEEPEST { Err(too_deep(&plugin)) } else { Ok(Rc::new(plugin)) }
    }

    fn named(&mut self, mut id: String, place: &Origin, depth: usize) -> Result<Rc<Plugin>, SceneError> {
        // An alias of an alias; a chain without an end is longer than all of them.
        for _ in 0..=self.aliases.len() {
            match self.aliases.get(&id) {
                Some(alias) => id = alias.of.clone(),
                None => break,
            }
        }
        if let Some(known) = self.finished.get(&id) {
            return Ok(known.clone());
        }
        if self.within.contains(&id) {
            return Err(error_at(place, format!("the plugin with the id `{id}` lies within itself: {}", self.circle(&id))));
        }
        let draft = self.written.remove(&id).ok_or_else(|| unknown(&id, place))?;
        self.within.push(id.clone());
        let plugin = self.put_together(draft, depth)?;
        self.within.pop();
        self.finished.insert(id, plugin.clone());
        Ok(plugin)
    }

    /// The ids that lead back to this one.
    fn circle(&self, id: &str) -> String {
        let from = self.within.iter().position(|one| one == id).unwrap_or(0);
        let mut ids: Vec<&str> = self.within[from..].iter().map(String::as_str).collect();
        ids.push(id);
        ids.join(", ")
    }
}

fn unknown(id: &str, place: &Origin) -> SceneError {
    error_at(place, format!("there is no plugin with the id `{id}`"))
}
