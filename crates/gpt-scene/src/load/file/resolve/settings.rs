//! `[film]`, `[render]` and `[output]`

use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::syntax::{FilterEntry, SceneFile};
use crate::scene::settings::BadSetting;
use crate::scene::{Filter, FilterKind};

impl Resolver<'_> {
    pub(super) fn settings(&mut self, file: &SceneFile) -> Result<(), SceneError> {
        if let Some(size) = file.film.size {
            self.scene.film.size = size.map(|side| side.get());
        }
        if let Some(filter) = &file.film.filter {
            self.scene.film.filter = resolve_filter(filter);
        }
        for setting in &file.render.0 {
            setting.apply(&mut self.scene.render);
        }
        self.scene.layers = file.output.aov.iter().map(|name| name.0).collect();
        self.scene.film.check().map_err(|bad| self.bad_setting("film", bad))?;
        self.scene.render.check().map_err(|bad| self.bad_setting("render", bad))
    }

    fn bad_setting(&self, table: &str, bad: BadSetting) -> SceneError {
        let error = self.error(&self.document.place_of(table, bad.setting), bad.message);
        match bad.help {
            Some(help) => error.with_help(help),
            None => error,
        }
    }
}

fn resolve_filter(entry: &FilterEntry) -> Filter {
    let (kind, keys) = match entry {
        FilterEntry::Box(keys) => (FilterKind::Box, keys),
        FilterEntry::Tent(keys) => (FilterKind::Tent, keys),
        FilterEntry::Gaussian(keys) => (FilterKind::Gaussian, keys),
        FilterEntry::BlackmanHarris(keys) => (FilterKind::BlackmanHarris, keys),
    };
    Filter { kind, radius: keys.radius.map_or(kind.default_radius(), |radius| radius.0) }
}
