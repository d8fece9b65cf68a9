//! Joins WGSL files: `#import file`, `#export file` (an import whose names are passed on), `#if SWITCH` / `#if !SWITCH` / `#else` / `#endif`, and a map from lines back to files.
//!
//! A file is included once, where it is first imported; lines that `enable` an extension go to the front, where WGSL wants them. Switches
//! and constants come from the plan, so that a scene's kernels hold only what the scene uses; what their entry points do not reach is left
//! out ([`super::reach`]). Code may also read the switch `X` as a constant, `HAS_X`. A statement `if HAS_X { … }` costs no more than `#if`,
//! since its block is left out where the switch is off (`fold.rs`), and reads better.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::PathBuf;

use super::fold::{Line, SWITCH_PREFIX, folded, without_comment};
use super::switches;

/// Compile-time choices: which `#if`s hold, and constants that are declared before the first line.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Switches {
    pub enabled: BTreeSet<&'static str>,
    pub constants: BTreeMap<&'static str, u32>,
    /// Generated files that may be imported like those of `shaders/`.
    pub generated: BTreeMap<&'static str, String>,
}

impl Switches {
    pub fn enable(&mut self, name: &'static str, on: bool) {
        if on {
            self.enabled.insert(name);
        }
    }
}

/// WGSL text, and where each of its lines came from.
#[derive(Debug, Clone, Default)]
pub struct ComposedShader {
    pub text: String,
    /// File and line (from 1) of every line of `text`.
    pub origin: Vec<(&'static str, u32)>,
}

impl ComposedShader {
    /// `file:line` of a line (from 1) of the composed text.
    pub fn locate(&self, line: u32) -> String {
        match self.origin.get(line.saturating_sub(1) as usize) {
            Some((file, line)) => format!("shaders/{file}:{line}"),
            None => format!("line {line}"),
        }
    }

    /// Parses and validates with naga, and says in the words of the source files what is wrong.
    pub fn validate(&self) -> Result<(naga::Module, naga::valid::ModuleInfo), ComposeError> {
        let module = naga::front::wgsl::parse_str(&self.text).map_err(|error| {
            let line = error.location(&self.text).map_or(0, |location| location.line_number);
            ComposeError::Invalid { place: self.locate(line), message: error.emit_to_string(&self.text) }
        })?;
        let mut validator = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all());
        let info = validator.validate(&module).map_err(|error| {
            let line = error.location(&self.text).map_or(0, |location| location.line_number);
            ComposeError::Invalid { place: self.locate(line), message: error.emit_to_string(&self.text) }
        })?;
        Ok((module, info))
    }
}

/// A mistake in the shader sources.
#[derive(Debug, thiserror::Error)]
pub enum ComposeError {
    #[error("shaders/{file}:{line}: {message}")]
    Directive { file: &'static str, line: u32, message: String },
    #[error("{place}: {message}")]
    Invalid { place: String, message: String },
    #[error("GPT_SHADERS names {}, which is no folder; without it, the shaders of the program are used", .0.display())]
    NoFolder(PathBuf),
}

/// The name of the source of constants that stand in no file.
const PLAN_CONSTANTS: &str = "(constants of the plan)";

/// Composes the file `root` with all that it imports.
pub fn compose(root: &'static str, switches: &Switches) -> Result<ComposedShader, ComposeError> {
    if let Some(folder) = own_folder().filter(|folder| !folder.is_dir()) {
        return Err(ComposeError::NoFolder(folder));
    }
    let mut composer = Composer {
        switches,
        included: BTreeSet::new(),
        read: BTreeSet::new(),
        enables: ComposedShader::default(),
        out: ComposedShader::default(),
    };
    for (name, value) in &switches.constants {
        composer.push(PLAN_CONSTANTS, 1, &format!("const {name}: u32 = {value}u;"));
    }
    composer.include(root, root, 0)?;
    if let Some(name) = composer.read.iter().find(|name| switches::find(name).is_none()) {
        let message = format!("there is no switch {name} for {SWITCH_PREFIX}{name}");
        return Err(ComposeError::Directive { file: root, line: 1, message });
    }
    Ok(composer.finish())
}

/// The switches that a line of code reads as constants.
fn switches_read(line: &str) -> impl Iterator<Item = &str> {
    without_comment(line)
        .split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .filter_map(|word| word.strip_prefix(SWITCH_PREFIX))
}

/// The embedded text, or that of the same file in the folder that `GPT_SHADERS` names: for work on kernels without compiling Rust.
fn current_text(name: &str, embedded: &str) -> String {
    let own = own_folder().and_then(|folder| std::fs::read_to_string(folder.join(name)).ok());
    own.unwrap_or_else(|| embedded.to_owned())
}

/// The folder that `GPT_SHADERS` names.
fn own_folder() -> Option<PathBuf> {
    std::env::var_os("GPT_SHADERS").map(PathBuf::from)
}

struct Composer<'a> {
    switches: &'a Switches,
    included: BTreeSet<&'static str>,
    /// Switches that are read as constants.
    read: BTreeSet<String>,
    /// Lines that enable extensions.
    enables: ComposedShader,
    out: ComposedShader,
}

impl Composer<'_> {
    fn push(&mut self, file: &'static str, line: u32, text: &str) {
        let part = if text.starts_with("enable ") { &mut self.enables } else { &mut self.out };
        let _ = writeln!(part.text, "{text}");
        part.origin.push((file, line));
    }

    fn push_all(&mut self, file: &'static str, lines: Vec<Line<'_>>) {
        // A name in a block that is left out has to be that of a switch as well.
        let reading = lines.iter().filter(|(_, line)| line.contains(SWITCH_PREFIX));
        self.read.extend(reading.flat_map(|(_, line)| switches_read(line)).map(str::to_owned));
        for (number, line) in folded(&lines, &self.switches.enabled) {
            self.push(file, number, &line);
        }
    }

    fn finish(self) -> ComposedShader {
        let Self { switches, mut enables, out, read, .. } = self;
        for name in read {
            let _ = writeln!(enables.text, "const {SWITCH_PREFIX}{name}: bool = {};", switches.enabled.contains(name.as_str()));
            enables.origin.push((PLAN_CONSTANTS, 1));
        }
        enables.text.push_str(&out.text);
        enables.origin.extend(out.origin);
        let reached = super::reach::reached_lines(&enables.text);
        let lines = enables.text.lines().zip(enables.origin).zip(reached).filter(|(_, reached)| *reached);
        let mut composed = ComposedShader::default();
        for ((line, origin), _) in lines {
            composed.text.extend([line, "\n"]);
            composed.origin.push(origin);
        }
        composed
    }

    fn find(&self, name: &str) -> Option<(&'static str, String)> {
        let generated = self.switches.generated.get_key_value(name).map(|(name, text)| (*name, text.clone()));
        generated.or_else(|| {
            super::sources::files().find(|(file, _)| *file == name).map(|(name, text)| (name, current_text(name, text)))
        })
    }

    fn include(&mut self, name: &str, from: &'static str, from_line: u32) -> Result<(), ComposeError> {
        let Some((file, text)) = self.find(name) else {
            return Err(ComposeError::Directive { file: from, line: from_line, message: format!("no file {name} to import") });
        };
        if !self.included.insert(file) {
            return Ok(());
        }
        // One entry per open #if: whether its present branch holds.
        let mut conditions: Vec<bool> = Vec::new();
        let mut lines: Vec<Line<'_>> = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let number = index as u32 + 1;
            let fail = |message: &str| Err(ComposeError::Directive { file, line: number, message: message.to_owned() });
            let holds = conditions.iter().all(|&holds| holds);
            let trimmed = line.trim_start();
            if let Some(condition) = trimmed.strip_prefix("#if ") {
                let condition = condition.trim();
                let (name, wanted) = condition.strip_prefix('!').map_or((condition, true), |name| (name, false));
                // A misspelt name would be false for ever.
                if switches::find(name).is_none() {
                    return fail(&format!("there is no switch {name}"));
                }
                conditions.push(self.switches.enabled.contains(name) == wanted);
            } else if trimmed.starts_with("#else") {
                match conditions.last_mut() {
                    Some(holds) => *holds = !*holds,
                    None => return fail("#else without #if"),
                }
            } else if trimmed.starts_with("#endif") {
                if conditions.pop().is_none() {
                    return fail("#endif without #if");
                }
            } else if let Some(import) = trimmed.strip_prefix("#import ").or_else(|| trimmed.strip_prefix("#export ")) {
                if holds {
                    self.push_all(file, std::mem::take(&mut lines));
                    self.include(import.trim(), file, number)?;
                }
            } else if trimmed.starts_with('#') {
                return fail("unknown directive");
            } else if holds {
                lines.push((number, Cow::Borrowed(line)));
            }
        }
        self.push_all(file, lines);
        match conditions.is_empty() {
            true => Ok(()),
            false => {
                Err(ComposeError::Directive { file, line: text.lines().count() as u32, message: "#if without #endif".into() })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn switches(files: &[(&'static str, &str)]) -> Switches {
        Switches { generated: files.iter().map(|(name, text)| (*name, (*text).to_owned())).collect(), ..Switches::default() }
    }

    #[test]
    fn conditions_nest_and_files_are_included_once() {
        let mut switches = switches(&[
            ("a", "#import b\n#import b\n#if MIRROR\nx\n#if GLASS\nxy\n#else\nx only\n#endif\n#else\nno x\n#endif"),
            ("b", "b"),
        ]);
        assert_eq!(compose("a", &switches).unwrap().text, "b\nno x\n");
        switches.enable("MIRROR", true);
        let composed = compose("a", &switches).unwrap();
        assert_eq!(composed.text, "b\nx\nx only\n");
        assert_eq!(composed.locate(3), "shaders/a:8");
    }

    #[test]
    fn extensions_are_enabled_first() {
        let mut switches = switches(&[("a", "a\n#import b"), ("b", "// b\nenable x;\nb")]);
        switches.constants.insert("C", 1);
        let composed = compose("a", &switches).unwrap();
        assert_eq!(composed.text, "enable x;\nconst C: u32 = 1u;\na\n// b\nb\n");
        assert_eq!([1, 3, 5].map(|line| composed.locate(line)), ["shaders/b:2", "shaders/a:1", "shaders/b:3"]);
    }

    /// Once each, wherever they are read; a comment reads nothing.
    #[test]
    fn switches_are_constants_where_code_reads_them() {
        let mut switches =
            switches(&[("a", "enable x;\nif HAS_GLASS && !HAS_MIRROR {}\n// HAS_Z\n#import b"), ("b", "HAS_GLASS")]);
        switches.enable("GLASS", true);
        let composed = compose("a", &switches).unwrap();
        let constants = "const HAS_GLASS: bool = true;\nconst HAS_MIRROR: bool = false;\n";
        assert_eq!(composed.text, format!("enable x;\n{constants}if HAS_GLASS && !HAS_MIRROR {{}}\n// HAS_Z\nHAS_GLASS\n"));
        assert_eq!([1, 4, 6].map(|line| composed.locate(line)), ["shaders/a:1", "shaders/a:2", "shaders/b:1"]);
    }

    #[test]
    fn mistakes_name_file_and_line() {
        let message = |files| compose("a", &switches(files)).unwrap_err().to_string();
        assert_eq!(message(&[("a", "\n#import c")]), "shaders/a:2: no file c to import");
        assert_eq!(message(&[("a", "HAS_MIRORR")]), "shaders/a:1: there is no switch MIRORR for HAS_MIRORR");
        assert_eq!(message(&[("a", "#if MIRROR")]), "shaders/a:1: #if without #endif");
        assert_eq!(message(&[("a", "\n#if !MIRORR\n#endif")]), "shaders/a:2: there is no switch MIRORR");
        assert_eq!(message(&[("a", "#endif")]), "shaders/a:1: #endif without #if");
        let invalid = compose("a", &switches(&[("a", "\nfn f() -> u32 { return missing; }")])).unwrap();
        assert!(invalid.validate().unwrap_err().to_string().starts_with("shaders/a:2: "));
    }
}
