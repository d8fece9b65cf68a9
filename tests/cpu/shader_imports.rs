//! Each WGSL file imports the names that it uses, and no import leads back to where it began. No device is
//! needed.
//!
//! Composed shaders have one name space, so a file could use what another one happens to bring along; it would then break where that one
//! changes. A file sees the names of those it imports, and of those that these pass on (`#export`). Conditions (`#if`) are ignored: what is
//! imported or defined in any branch counts.

use std::collections::{BTreeMap, BTreeSet};

use gpt::plan::chunks::{ATTRIBUTES, Chunks, INSTANCES, NODES, PRIMITIVES, TEXELS};
use gpt::shader::sources;

/// A file as far as names go.
#[derive(Debug, Default)]
struct Names {
    /// At the top level.
    defined: BTreeSet<String>,
    /// Neither local to a function nor a member.
    used: BTreeSet<String>,
    imports: BTreeSet<String>,
    /// Imported names that are passed on.
    exports: BTreeSet<String>,
}

/// Words and signs of the code, without comments and directives.
fn tokens(code: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    let mut in_word = false;
    for c in code.chars() {
        let is_word = c.is_ascii_alphanumeric() || c == '_';
        match tokens.last_mut() {
            Some(last) if is_word && in_word => last.push(c),
            _ if !c.is_whitespace() => tokens.push(c.to_string()),
            _ => {}
        }
        in_word = is_word;
    }
    tokens
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

impl Names {
    fn of(text: &str) -> Self {
        let mut names = Self::default();
        let mut code = String::new();
        for line in text.lines() {
            let line = line.split("//").next().unwrap_or_default();
            match line.trim_start().split_once(' ') {
                Some((directive @ ("#import" | "#export"), file)) => {
                    names.imports.insert(file.trim().to_owned());
                    if directive == "#export" {
                        names.exports.insert(file.trim().to_owned());
                    }
                }
                _ if line.trim_start().starts_with(['#']) || line.starts_with("enable ") => {}
                _ => code.extend([line, "\n"]),
            }
        }
        let tokens = tokens(&code);
        let mut first = 0;
        let mut depth = 0;
        // Top-level items end with `;` or the brace that closes them.
        for (index, token) in tokens.iter().enumerate() {
            depth += i32::from(token == "{") - i32::from(token == "}");
            assert!(depth >= 0, "braces do not match when conditions are ignored");
            if depth == 0 && (token == ";" || token == "}") {
                names.add_item(&tokens[first..=index]);
                first = index + 1;
            }
        }
        assert_eq!(first, tokens.len(), "the last item does not end");
        names
    }

    fn add_item(&mut self, item: &[String]) {
        let at = |index: usize| item.get(index).map_or("", String::as_str);
        let is_local = |index: usize| index > 0 && ["let", "var", "const"].contains(&at(index - 1));
        let declares = |index: usize| {
            let in_case = item[..index]
                .iter()
                .rev()
                .take_while(|token| !["{", "}", ";"].contains(&token.as_str()))
                .any(|token| token == "case");
            is_local(index) || (at(index + 1) == ":" && !in_case)
        };
        let Some(keyword) = item.iter().position(|token| ["fn", "struct", "const", "var", "alias"].contains(&token.as_str()))
        else {
            return;
        };
        // `var<storage, read> name`
        let mut name = keyword + 1;
        if at(name) == "<" {
            name += item[name..].iter().position(|token| token == ">").map_or(0, |end| end + 1);
        }
        self.defined.insert(at(name).to_owned());
        let names = || item.iter().enumerate().skip(name + 1).filter(|(_, token)| is_name(token));
        let locals: BTreeSet<&str> = match at(keyword) {
            "fn" | "struct" => names().filter(|(index, _)| declares(*index)).map(|(_, token)| token.as_str()).collect(),
            _ => BTreeSet::new(),
        };
        let used = names().filter(|(index, token)| ![".", "@"].contains(&at(index - 1)) && !locals.contains(token.as_str()));
        // Attributes, `@binding(NAME)`, stand before the keyword as well.
        let attributes =
            item[..keyword].iter().enumerate().filter(|(index, token)| is_name(token) && *index > 0 && at(index - 1) == "(");
        self.used.extend(used.chain(attributes).map(|(_, token)| token.clone()));
    }
}

type Files = BTreeMap<String, Names>;

/// The embedded files, and those that plans write.
fn all_files() -> Files {
    let mut texts: BTreeMap<String, String> = sources::files().map(|(name, text)| (name.to_owned(), text.to_owned())).collect();
    for array in [PRIMITIVES, NODES, ATTRIBUTES, INSTANCES, TEXELS] {
        let chunks = Chunks::new(array, 2500 * array.record_bytes(), 1000 * array.record_bytes());
        texts.insert(array.file.to_owned(), chunks.wgsl());
    }
    let scene = gpt::load::load(Some("spheres")).expect("it is built in");
    let packed = gpt::packed::PackedScene::new(&scene).expect("it packs");
    texts.extend(gpt::plan::generated::files().into_iter().map(|(name, text)| (name.to_owned(), text)));
    texts.insert("geometry/constants.wgsl".to_owned(), gpt::plan::unroll::constants(&packed, 0, false));
    texts.into_iter().map(|(name, text)| (name, Names::of(&text))).collect()
}

/// The files whose names a file sees.
fn visible<'a>(files: &'a Files, file: &str) -> BTreeSet<&'a str> {
    let mut seen = BTreeSet::new();
    let mut waiting: Vec<&str> = files[file].imports.iter().map(String::as_str).collect();
    while let Some(next) = waiting.pop() {
        if seen.insert(next) {
            waiting.extend(files[next].exports.iter().map(String::as_str));
        }
    }
    seen
}

/// The mistakes, in words.
fn mistakes(files: &Files) -> Vec<String> {
    let mut found = Vec::new();
    for (file, names) in files {
        found.extend(
            names
                .imports
                .iter()
                .filter(|import| !files.contains_key(*import))
                .map(|import| format!("{file} imports {import}, which is no file")),
        );
    }
    if !found.is_empty() {
        return found;
    }
    for (file, names) in files {
        let visible = visible(files, file);
        for name in names.used.difference(&names.defined) {
            let homes: Vec<&str> =
                files.iter().filter(|(_, other)| other.defined.contains(name)).map(|(home, _)| home.as_str()).collect();
            if !homes.is_empty() && !homes.iter().any(|home| visible.contains(home)) {
                found.push(format!("{file} uses `{name}` of {} without importing it", homes.join(" or ")));
            }
        }
        for import in names.imports.difference(&names.exports) {
            let mut passed_on = BTreeSet::from([import.as_str()]);
            let mut waiting = vec![import.as_str()];
            while let Some(next) = waiting.pop() {
                waiting.extend(files[next].exports.iter().map(String::as_str).filter(|export| passed_on.insert(export)));
            }
            if passed_on.iter().all(|home| files[*home].defined.is_disjoint(&names.used)) {
                found.push(format!("{file} imports {import} and uses nothing of it"));
            }
        }
    }
    found.extend(circle(files).map(|circle| format!("imports form a circle: {}", circle.join(" → "))));
    found
}

/// Files each of which imports the next, the last one the first.
fn circle(files: &Files) -> Option<Vec<&str>> {
    fn follow<'a>(files: &'a Files, file: &'a str, way: &mut Vec<&'a str>, done: &mut BTreeSet<&'a str>) -> bool {
        if let Some(start) = way.iter().position(|earlier| *earlier == file) {
            way.drain(..start);
            return true;
        }
        if done.contains(file) {
            return false;
        }
        way.push(file);
        if files[file].imports.iter().any(|import| follow(files, import, way, done)) {
            return true;
        }
        way.pop();
        done.insert(file);
        false
    }
    let (mut way, mut done) = (Vec::new(), BTreeSet::new());
    files.keys().any(|file| follow(files, file, &mut way, &mut done)).then_some(way)
}

#[test]
fn files_import_what_they_use_and_nothing_else_and_in_no_circle() {
    let files = all_files();
    assert!(files.len() > 50 && files.values().map(|names| names.defined.len()).sum::<usize>() > 300);
    let mistakes = mistakes(&files);
    assert!(mistakes.is_empty(), "{}", mistakes.join("\n"));
}

#[test]
fn mistakes_in_imports_are_found() {
    let found = |texts: &[(&str, &str)]| {
        let files = texts.iter().map(|(name, text)| ((*name).to_owned(), Names::of(text))).collect();
        mistakes(&files)
    };
    let thing = ("thing", "struct Thing {\n    size: f32,\n}\nconst KIND: u32 = 1u;\nvar<private> here: Thing;\n");
    let none: [&str; 0] = [];
    // Locals, members, comments and attributes use nothing.
    assert_eq!(
        found(&[thing, ("a", "fn f(here: f32) -> f32 {\n    let KIND = a.Thing; // Thing\n    return KIND + here;\n}\n")]),
        none
    );
    assert_eq!(found(&[thing, ("a", "fn f(x: Thing) {}\n")]), ["a uses `Thing` of thing without importing it"]);
    let in_case = "fn f(x: u32) {\n    switch x {\n        case KIND: { return; }\n    }\n}\n";
    assert_eq!(found(&[thing, ("a", in_case)]), ["a uses `KIND` of thing without importing it"]);
    assert_eq!(found(&[thing, ("a", "#if X\n#import thing\n#endif\nfn f() { here.size = 1.0; }\n")]), none);
    // Only `#export` passes names on.
    let user = ("user", "#import a\nfn f() -> Thing { return g(); }\n");
    let a = "thing\nfn g() -> Thing { return here; }\n";
    assert_eq!(found(&[thing, ("a", &format!("#import {a}")), user]), ["user uses `Thing` of thing without importing it"]);
    assert_eq!(found(&[thing, ("a", &format!("#export {a}")), user]), none);
    assert_eq!(found(&[thing, ("a", "#import thing\nfn f() {}\n")]), ["a imports thing and uses nothing of it"]);
    assert_eq!(found(&[("a", "#import thing\n")]), ["a imports thing, which is no file"]);
    let circle =
        [("a", "#import b\nfn f() { g(); }\n"), ("b", "#import c\nfn g() { h(); }\n"), ("c", "#import b\nfn h() { g(); }\n")];
    assert_eq!(found(&circle), ["imports form a circle: b → c"]);
}
