//! The modules of `src/` and of `crates/gpt-scene/src/` depend on each other in one direction only; between the two the compiler sees to it.
//!
//! Every folder is looked at by itself: its files, its subfolders as one node each, and its own `mod.rs`. An import is an arrow. A `mod.rs`
//! that re-exports a file has an arrow to it, so a file that imports from its own folder's `mod.rs` closes a circle; a file imports from the
//! file where the item stands. `mod child;` alone is no arrow, nor is what only tests import.

mod comments;
mod ignored_tests;
mod imports;
mod source;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use imports::imported_modules;
use source::without_tests;

/// Modules by their path in the crate (`plan::memory`; the root is empty), with their text.
type Modules = BTreeMap<Vec<String>, String>;
/// Nodes of one folder with what each imports from, and by which import.
type Graph = BTreeMap<String, BTreeMap<String, String>>;

/// The node of a folder that is its own `mod.rs`.
const FACADE: &str = "mod.rs";

/// Reads all files that are compiled into the program or the library.
fn read_modules(folder: &Path, path: &[String], modules: &mut Modules) {
    for entry in fs::read_dir(folder).expect("src can be listed") {
        let file = entry.expect("src can be listed").path();
        let stem = file.file_stem().expect("entries have names").to_string_lossy().into_owned();
        let inner = |name: &str| path.iter().cloned().chain([name.to_owned()]).collect::<Vec<_>>();
        if file.is_dir() {
            read_modules(&file, &inner(&stem), modules);
        } else if file.extension().is_some_and(|ending| ending == "rs") {
            let text = fs::read_to_string(&file).expect("sources are UTF-8");
            let module = if stem == "mod" || stem == "lib" { path.to_vec() } else { inner(&stem) };
            modules.entry(module).or_default().push_str(&text);
        }
    }
}

/// The rest of each module's text without comments, strings and tests; modules that are only compiled for
/// tests are left out.
fn product_modules(modules: &Modules) -> Modules {
    let mut product = Modules::new();
    let mut of_tests = BTreeSet::new();
    for (path, text) in modules {
        let (text, test_modules) = without_tests(text);
        of_tests.extend(test_modules.into_iter().map(|name| path.iter().cloned().chain([name]).collect::<Vec<_>>()));
        product.insert(path.clone(), text);
    }
    product.retain(|path, _| !of_tests.iter().any(|test: &Vec<String>| path.starts_with(test)));
    product
}

/// The graphs of all folders, by the folder's path.
fn graphs(modules: &Modules) -> BTreeMap<Vec<String>, Graph> {
    let mut graphs: BTreeMap<Vec<String>, Graph> = BTreeMap::new();
    for (module, text) in modules {
        for (target, import) in imported_modules(module, text, |path| modules.contains_key(path)) {
            let common = module.iter().zip(&target).take_while(|(a, b)| a == b).count();
            let node = |path: &[String]| path.get(common).map_or(FACADE, String::as_str).to_owned();
            let (from, to) = (node(module), node(&target));
            if from != to {
                let arrows = graphs.entry(module[..common].to_vec()).or_default().entry(from).or_default();
                arrows.entry(to).or_insert_with(|| format!("{} imports {import}", module.join("::")));
            }
        }
    }
    graphs
}

/// A circle: the imports that lead from a node back to it.
fn circle(graph: &Graph) -> Option<Vec<&str>> {
    let mut finished = BTreeSet::new();
    graph.keys().find_map(|node| circle_from(graph, node, &mut Vec::new(), &mut finished))
}

fn circle_from<'a>(
    graph: &'a Graph,
    node: &'a str,
    way: &mut Vec<(&'a str, &'a str)>,
    finished: &mut BTreeSet<&'a str>,
) -> Option<Vec<&'a str>> {
    if let Some(start) = way.iter().position(|(earlier, _)| *earlier == node) {
        return Some(way[start..].iter().map(|(_, import)| *import).collect());
    }
    if finished.contains(node) {
        return None;
    }
    for (next, import) in graph.get(node).into_iter().flatten() {
        way.push((node, import));
        let found = circle_from(graph, next, way, finished);
        way.pop();
        if found.is_some() {
            return found;
        }
    }
    finished.insert(node);
    None
}

/// All folders' circles, in words.
fn circles(modules: &Modules) -> Vec<String> {
    let graphs = graphs(&product_modules(modules));
    let in_words = |(folder, graph): (&Vec<String>, &Graph)| {
        circle(graph).map(|imports| format!("in src/{}:\n  {}", folder.join("/"), imports.join("\n  ")))
    };
    graphs.iter().filter_map(in_words).collect()
}

#[test]
fn no_module_depends_on_itself_through_others() {
    let mut modules = Modules::new();
    // The library has the rooms of the crate of scenes under their own names, so both are one tree.
    for folder in ["src", "crates/gpt-scene/src"] {
        read_modules(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &[], &mut modules);
    }
    assert!(modules.len() > 150, "only {} modules were found", modules.len());
    let circles = circles(&modules);
    assert!(circles.is_empty(), "modules that depend on themselves:\n{}", circles.join("\n"));
}

/// Modules as `(path, text)`.
fn modules(files: &[(&str, &str)]) -> Modules {
    let path = |name: &str| name.split("::").filter(|part| !part.is_empty()).map(str::to_owned).collect();
    files.iter().map(|(name, text)| (path(name), (*text).to_owned())).collect()
}

#[test]
fn circles_are_found() {
    let cases: &[&[(&str, &str)]] = &[
        // Two files of a folder, by an import and by a path within the code.
        &[("a", ""), ("a::b", "use super::c::X;"), ("a::c", "fn f() { crate::a::b::g() }")],
        // Two folders, through files that know nothing of each other.
        &[("a", ""), ("a::x", "use crate::b::{self, y::Y};"), ("b", ""), ("b::y", ""), ("b::z", "use crate::a::x::X;")],
        // A file and its folder, which re-exports it.
        &[("a", "mod b;\npub use b::B;\npub struct A;"), ("a::b", "use super::A;")],
        // Three files, one of them through a list over several lines.
        &[("a", "use crate::{\n    b::B, c,\n};"), ("b", "use crate::c::*;"), ("c", "use crate::a as other;")],
        // A module within a file stands one level deeper.
        &[("a", ""), ("a::b", "mod inner { use super::super::c::X; }"), ("a::c", "use super::b::Y;")],
    ];
    for files in cases {
        assert_eq!(circles(&modules(files)).len(), 1, "{files:?}");
    }
    let named = circles(&modules(&[("a", "use crate::b::B;"), ("b", "use crate::a::A;")]));
    assert_eq!(named, ["in src/:\n  a imports crate::b::B\n  b imports crate::a::A"]);
}

#[test]
fn what_is_no_import_makes_no_circle() {
    let cases: &[&[(&str, &str)]] = &[
        // Comments, strings of all kinds, and characters that look like their beginning.
        &[("a", "use crate::b::B;"), ("b", "// crate::a\n/* crate::a /* */ crate::a */ const S: &str = \"\\\" crate::a::A\";")],
        &[
            ("a", "use crate::b::B;"),
            ("b", "const Q: char = '\"'; const R: &str = r#\"\" crate::a::A\"#; fn f<'a>(x: &'a str) {}"),
        ],
        // Tests, inline and in files of their own.
        &[("a", "use crate::b::B;"), ("b", "#[cfg(test)]\nmod tests { use crate::a::A; fn f() { {} } }")],
        &[("a", "use crate::b::B;"), ("b", "#[cfg(test)]\nmod tests;"), ("b::tests", "use crate::a::A;")],
        &[("a", "use crate::b::B;"), ("b", "#[cfg(test)]\nuse crate::a::A;\nfn f() {}")],
        // A folder that declares and re-exports, and files that import from each other.
        &[("a", "mod b;\nmod c;\npub use b::B;\npub use c::C;"), ("a::b", "use super::c::C;"), ("a::c", "")],
        // A visibility.
        &[("a", "mod b;\npub use b::B;"), ("a::b", "pub(in crate::a) struct B;")],
        // An item that is called like a module elsewhere.
        &[("a", "use crate::b::B;"), ("b", "fn f() { let a = 1; other::a::b(); }")],
    ];
    for files in cases {
        assert_eq!(circles(&modules(files)), [""; 0], "{files:?}");
    }
}
