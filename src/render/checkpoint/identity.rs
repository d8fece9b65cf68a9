//! The identity of a render: everything that decides its picture, by the names under which a person gave it.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::choice::Choice;
use crate::confidence::IntervalOptions;
use crate::film::RenderedLayer;
use crate::output::Provenance;

/// Number of the files' layout.
const LAYOUT: &str = "3";
const VERSION: &str = "version";
const SCENE: &str = "scene";
const BYTES: &str = "byte order";
const WAY: &str = "way";

/// The names and values that decide a picture. Two renders with equal ones can go on from each other's state.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity(Vec<(String, String)>);

/// The first thing in which two renders differ.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    name: String,
    theirs: String,
    ours: String,
}

impl Identity {
    /// The identity of a render of a film of so many pixels or of a region of it, in one batch or in steps.
    pub fn new(provenance: &Provenance, [width, height]: [u32; 2], crop: Option<[u32; 4]>, is_one_batch: bool) -> Self {
        let Provenance { scene_hash, settings, filter, first_sample, target_error, adaptive, interval, .. } = provenance;
        let order = if cfg!(target_endian = "little") { "little" } else { "big" };
        let mut entries = vec![
            (VERSION.to_owned(), format!("{}, layout {LAYOUT}", env!("CARGO_PKG_VERSION"))),
            (BYTES.to_owned(), order.to_owned()),
            (SCENE.to_owned(), scene_hash.clone()),
            ("--size".to_owned(), format!("{width}x{height}")),
            ("--crop".to_owned(), crop.map_or_else(|| "none".to_owned(), |crop| crop.map(|side| side.to_string()).join(","))),
            ("filter".to_owned(), filter.to_string()),
            ("--first-sample".to_owned(), first_sample.to_string()),
            ("--adaptive".to_owned(), adaptive.to_string()),
            ("--target-error".to_owned(), target_error.map_or_else(|| "none".to_owned(), |target| target.to_string())),
        ];
        if let Some(IntervalOptions { target, confidence, of, by, .. }) = interval {
            let none = || "none".to_owned();
            entries.extend([
                ("--confidence".to_owned(), confidence.to_string()),
                ("--target-interval".to_owned(), target.map_or_else(none, |target| target.to_string())),
                ("--interval-of".to_owned(), of.name().to_owned()),
                ("--interval-by".to_owned(), by.map_or_else(none, |by| by.name().to_owned())),
            ]);
        }
        entries.extend(settings.values().map(|(setting, value)| (setting.flag.to_owned(), value.to_string())));
        // Flags that decide this come first, for they say more.
        entries.push((WAY.to_owned(), if is_one_batch { "in one go" } else { "in steps" }.to_owned()));
        Self(entries)
    }

    /// The identity of the render of one of its layers.
    #[must_use]
    pub fn of_layer(mut self, layer: &RenderedLayer) -> Self {
        self.0.push(("--aov".to_owned(), layer.name()));
        self
    }

    /// The first thing in which `theirs` differs.
    pub fn difference(&self, theirs: &Self) -> Option<Difference> {
        let value = |identity: &Self, name: &str| {
            identity.0.iter().find(|entry| entry.0 == name).map_or_else(|| "nothing".to_owned(), |entry| entry.1.clone())
        };
        let names = self.0.iter().chain(&theirs.0).map(|entry| &entry.0);
        let differs = |name: &String| {
            let (ours, theirs) = (value(self, name), value(theirs, name));
            (ours != theirs).then(|| Difference { name: name.clone(), theirs, ours })
        };
        names.into_iter().find_map(differs)
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, theirs, ours } = self;
        let short = |digest: &str| digest.chars().take(12).collect::<String>();
        match name.as_str() {
            VERSION => write!(out, "it was made by gpt {theirs}, and this is gpt {ours}"),
            SCENE => write!(out, "it is of another scene (digest {}…, and this one's is {}…)", short(theirs), short(ours)),
            WAY => write!(
                out,
                "it was rendered {theirs}, and this one is {ours}: --time-limit decides it where memory holds no whole picture"
            ),
            _ => write!(out, "it was made with {name} {theirs}, and this render has {name} {ours}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::settings::SETTINGS;
    use crate::scene::{Filter, RenderSettings};

    fn provenance() -> Provenance {
        Provenance {
            scene: "a scene".to_owned(),
            scene_hash: "0123456789abcdef".to_owned(),
            settings: RenderSettings::default(),
            filter: Filter::default(),
            first_sample: 0,
            target_error: None,
            adaptive: false,
            interval: None,
            device: "a device".to_owned(),
        }
    }

    #[test]
    fn what_decides_the_picture_is_reported_by_name() {
        let ours = Identity::new(&provenance(), [4, 3], None, true);
        let difference =
            |theirs: Provenance| ours.difference(&Identity::new(&theirs, [4, 3], None, true)).map(|found| found.to_string());
        assert_eq!(difference(provenance()), None);
        // Neither of these does.
        assert_eq!(difference(Provenance { scene: "b".to_owned(), device: "c".to_owned(), ..provenance() }), None);
        let seed = RenderSettings { seed: 5, ..RenderSettings::default() };
        assert_eq!(
            difference(Provenance { settings: seed, ..provenance() }).as_deref(),
            Some("it was made with --seed 5, and this render has --seed 0")
        );
        let scene = difference(Provenance { scene_hash: "ff".to_owned(), ..provenance() });
        assert_eq!(scene.as_deref(), Some("it is of another scene (digest ff…, and this one's is 0123456789ab…)"));
        assert!(difference(Provenance { adaptive: true, ..provenance() }).is_some_and(|text| text.contains("--adaptive")));
        assert!(ours.difference(&Identity::new(&provenance(), [4, 4], None, true)).is_some());
        assert!(ours.difference(&Identity::new(&provenance(), [4, 3], None, false)).is_some());
        for setting in SETTINGS {
            assert!(ours.0.iter().any(|entry| entry.0 == setting.flag), "{}", setting.flag);
        }
        // A file of another version may have other entries.
        let mut older = ours.clone();
        older.0.pop();
        assert!(ours.difference(&older).is_some() && older.difference(&ours).is_some());
    }
}
