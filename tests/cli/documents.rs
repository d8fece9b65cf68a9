//! The documents name files, links, commands and flags that exist.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::text;

/// Folders whose files documents name by path.
const FOLDERS: [&str; 10] =
    ["src/", "crates/", "shaders/", "tests/", "scripts/", "benches/", "docs/", "scenes/", "examples/", ".ci/"];
/// Documents about the past: only their links are checked.
const HISTORY: [&str; 2] = ["docs/notes/", "CHANGELOG.md"];
/// Flags of cargo, openjd, docker, gh, curl, oiiotool and Blender that documents use.
const FLAGS_OF_OTHERS: [&str; 17] = [
    "--background",
    "--release",
    "--locked",
    "--path",
    "--bench",
    "--example",
    "--test",
    "--bin",
    "--step",
    "--run-dependencies",
    "--eraseattrib",
    "--info",
    "--repo",
    "--rm",
    "--user",
    "--proto",
    "--tlsv1",
];

/// The flags of each command of the program, from its help.
struct Help(BTreeMap<String, BTreeSet<String>>);

impl Help {
    fn read() -> Self {
        let mut flags = BTreeMap::new();
        let mut open = vec![String::new()];
        while let Some(command) = open.pop() {
            let output = Command::new(env!("CARGO_BIN_EXE_gpt")).args(command.split_whitespace()).arg("--help").output();
            let help = text(&output.expect("the program starts").stdout);
            let commands = help.split("\nCommands:\n").nth(1).and_then(|rest| rest.split("\n\n").next()).unwrap_or("");
            // Names stand two columns from the left; what follows them further to the right.
            let names = commands.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
            let names = names.filter_map(|line| line.split_whitespace().next()).filter(|&name| name != "help");
            open.extend(names.map(|name| format!("{command} {name}").trim().to_owned()));
            flags.insert(command, flags_of(&help).map(str::to_owned).collect());
        }
        Self(flags)
    }

    /// The mistakes of a command line that begins after `gpt`.
    fn check(&self, words: &[&str]) -> Vec<String> {
        let mut command = String::new();
        for word in words {
            let longer = format!("{command} {word}").trim().to_owned();
            if !self.0.contains_key(&longer) {
                break;
            }
            command = longer;
        }
        let placeholder = |word: &&str| word.starts_with('-') || word.starts_with('<') || *word == "…" || *word == "help";
        if command.is_empty() && !words.first().is_none_or(placeholder) {
            return vec![format!("there is no command `gpt {}`", words[0])];
        }
        let known = &self.0[&command];
        let flags = words.iter().flat_map(|word| flags_of(word));
        flags.filter(|&flag| !known.contains(flag)).map(|flag| format!("`gpt {command}` has no flag {flag}")).collect()
    }

    fn has(&self, flag: &str) -> bool {
        self.0.values().any(|flags| flags.contains(flag))
    }
}

/// Long flags in a text.
fn flags_of(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-'));
    words.filter(|word| word.strip_prefix("--").is_some_and(|name| name.starts_with(|c: char| c.is_ascii_lowercase())))
}

/// One document: prose without fenced blocks, and the lines of these that are commands.
struct Document {
    name: String,
    folder: PathBuf,
    prose: String,
    commands: Vec<String>,
}

impl Document {
    fn read(root: &Path, path: &Path) -> Self {
        let text = fs::read_to_string(path).expect("a document");
        let (mut prose, mut commands, mut block) = (String::new(), Vec::new(), None);
        for line in text.lines() {
            match (line.strip_prefix("```"), block) {
                // Words behind the language are for scripts/pages.
                (Some(language), None) => block = Some(language.split(' ').next().unwrap_or("")),
                (Some(_), Some(_)) => block = None,
                (None, Some("sh")) => commands.push(line.split(" #").next().unwrap_or(line).to_owned()),
                (None, Some(_)) => {}
                (None, None) => prose.extend([line, "\n"]),
            }
        }
        let name = path.strip_prefix(root).expect("within the root").to_string_lossy().into_owned();
        Self { name, folder: path.parent().expect("a folder").to_owned(), prose, commands }
    }

    fn code(&self) -> impl Iterator<Item = &str> {
        self.prose.split('`').skip(1).step_by(2)
    }

    fn links(&self) -> impl Iterator<Item = &str> {
        self.prose.split("](").skip(1).filter_map(|rest| rest.split(')').next()).filter(|link| !link.contains("://"))
    }

    /// The anchors that GitHub makes of the headings.
    fn anchors(&self) -> BTreeSet<String> {
        let headings = self.prose.lines().filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#').trim());
        let kept = |c: char| c.is_alphanumeric() || c == '-' || c == ' ' || c == '_';
        headings
            .map(|heading| heading.to_lowercase().chars().filter(|&c| kept(c)).collect::<String>().replace(' ', "-"))
            .collect()
    }
}

fn documents(root: &Path) -> Vec<Document> {
    let (mut folders, mut found) = (vec![root.to_owned()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            if path.is_dir() && !name.starts_with('.') && name != "target" && name != "shared" {
                folders.push(path);
            } else if name.ends_with(".md") {
                found.push(Document::read(root, &path));
            }
        }
    }
    found.sort_by(|a, b| a.name.cmp(&b.name));
    found
}

/// The files in the folders beside the documents.
#[derive(Default)]
struct Sources {
    /// Every file's name.
    names: BTreeSet<String>,
    /// Flags that scripts mention.
    flags: BTreeSet<String>,
    /// Documents that code cites, each with the file that does.
    cited: Vec<(String, PathBuf)>,
}

fn sources(root: &Path) -> Sources {
    let mut sources = Sources::default();
    let mut folders: Vec<PathBuf> = FOLDERS.iter().map(|folder| root.join(folder)).filter(|folder| folder.is_dir()).collect();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            let ending = path.extension().unwrap_or_default();
            let text = fs::read_to_string(&path).unwrap_or_default();
            if path.starts_with(root.join("scripts")) || ending == "py" {
                sources.flags.extend(flags_of(&text).map(str::to_owned));
            }
            // This file's own examples are no citations.
            if (ending == "rs" || ending == "wgsl") && name != "documents.rs" {
                let words = text.split(|c: char| !(c.is_alphanumeric() || "/-_.".contains(c))).map(|word| word.trim_matches('.'));
                let cited = words.filter(|word| word.starts_with("docs/") && word.ends_with(".md"));
                sources.cited.extend(cited.map(|word| (word.to_owned(), path.clone())));
            }
            sources.names.insert(name);
        }
    }
    sources
}

/// Everything that is wrong with the documents below a folder, one line each.
fn faults(root: &Path, help: &Help) -> Vec<String> {
    let documents = documents(root);
    let sources = sources(root);
    let lost = sources.cited.iter().filter(|(cited, _)| !root.join(cited).exists());
    let mut faults: Vec<String> = lost.map(|(cited, by)| format!("{} cites {cited}, which is not there", by.display())).collect();
    for document in &documents {
        let mut fault = |what: String| faults.push(format!("{}: {what}", document.name));
        if document.prose.matches('`').count() % 2 == 1 {
            fault("a ` without its partner".into());
        }
        for link in document.links() {
            let (file, anchor) = link.split_once('#').map_or((link, None), |(file, anchor)| (file, Some(anchor)));
            let path = if file.is_empty() { root.join(&document.name) } else { document.folder.join(file) };
            if !path.exists() {
                fault(format!("the link to {link} leads nowhere"));
            } else if anchor.is_some_and(|anchor| !Document::read(root, &within(root, &path)).anchors().contains(anchor)) {
                fault(format!("no heading for the link to {link}"));
            }
        }
        if HISTORY.iter().any(|history| document.name.starts_with(history)) {
            continue;
        }
        for line in document.code().chain(document.commands.iter().map(String::as_str)) {
            for part in line.split(['|', ';', '\n']).flat_map(|part| part.split("&&")) {
                check_command(part, root, help, &sources.flags).into_iter().for_each(&mut fault);
            }
        }
        for code in document.code().filter(|code| !code.contains(|c: char| c.is_whitespace() || "*…<".contains(c))) {
            let in_folder = FOLDERS.iter().any(|folder| code.starts_with(folder));
            if in_folder && !root.join(code).exists() {
                fault(format!("there is no {code}"));
            } else if !in_folder
                && (code.ends_with(".rs") || code.ends_with(".wgsl"))
                && !names_end_with(root, &sources.names, code)
            {
                fault(format!("there is no file {code}"));
            }
        }
    }
    faults
}

/// The path without `..`, so that it can be told from the root.
fn within(root: &Path, path: &Path) -> PathBuf {
    let root = root.canonicalize().expect("the root");
    let path = path.canonicalize().expect("a file that exists");
    path.strip_prefix(&root).map_or_else(|_| path.clone(), |inside| root.join(inside))
}

fn names_end_with(root: &Path, names: &BTreeSet<String>, code: &str) -> bool {
    let name = code.rsplit('/').next().unwrap_or(code);
    names.contains(name) && (name == code || FOLDERS.iter().any(|folder| root.join(folder).join(code).exists()))
}

/// The mistakes of a line that may be a command.
fn check_command(line: &str, root: &Path, help: &Help, script_flags: &BTreeSet<String>) -> Vec<String> {
    let words: Vec<&str> = line.split_whitespace().skip_while(|word| word.contains('=') && !word.starts_with('-')).collect();
    let missing = |folder: &str, name: &str| {
        let at = root.join(folder);
        let here = at.join(format!("{name}.rs")).exists() || at.join(name).join("main.rs").exists();
        (!here).then(|| format!("{folder} has no {name}"))
    };
    match words.as_slice() {
        ["gpt" | "target/release/gpt", rest @ ..] => help.check(rest),
        ["cargo", "run", "--release", "--", rest @ ..] => help.check(rest),
        ["cargo", rest @ ..] => rest
            .windows(2)
            .filter_map(|pair| match pair {
                ["--bench", name] => missing("benches", name),
                ["--example", name] => missing("examples", name),
                ["--test", name] => missing("tests", name),
                _ => None,
            })
            .collect(),
        [script, ..] if script.starts_with("scripts/") && !root.join(script).exists() => vec![format!("there is no {script}")],
        _ => flags_of(line)
            .filter(|flag| !help.has(flag) && !script_flags.contains(*flag) && !FLAGS_OF_OTHERS.contains(flag))
            .map(|flag| format!("nothing has the flag {flag}"))
            .collect(),
    }
}

fn project() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn documents_name_what_exists() {
    let faults = faults(project(), &Help::read());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_readmes_scene_is_the_file_it_names() {
    let readme = fs::read_to_string(project().join("README.md")).expect("the README");
    let scene =
        readme.split("```toml hello.toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a scene in the README");
    assert_eq!(scene, fs::read_to_string(project().join("docs/hello.toml")).expect("the scene's file"));
    let check = Command::new(env!("CARGO_BIN_EXE_gpt")).args(["check", "docs/hello.toml"]).current_dir(project()).output();
    let check = check.expect("the program starts");
    assert!(check.status.success(), "{}", text(&check.stderr));
}

/// The badge of the README and its words are those of one run of the referee, whose result the table has too.
#[test]
fn the_badge_says_what_the_readme_says() {
    let readme = fs::read_to_string(project().join("README.md")).expect("the README");
    let badge = fs::read_to_string(project().join("docs/referee/gpt.svg")).expect("the badge");
    let agree = badge.split_once("gpt referee: ").and_then(|(_, rest)| rest.split_once(" agree")).expect("what the badge says").0;
    let (agreeing, judged) = agree.split_once(" of ").expect("two numbers");
    assert!(readme.contains(&format!("The referee: {agree} tests agree")), "{agree}");
    let (agreeing, judged): (u32, u32) = (agreeing.parse().expect("a number"), judged.parse().expect("a number"));
    let row = format!("| gpt, CPU reference and llvmpipe | {agreeing} | {} |", judged - agreeing);
    assert!(readme.contains(&row), "{row}");
}

#[test]
fn a_document_with_faults_is_noticed() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    for name in ["docs/notes", "src"] {
        fs::create_dir_all(folder.path().join(name)).expect("a folder");
    }
    write("src/cites.rs", "// docs/page.md says why (docs/lost.md).\n");
    write("README.md", "A line.\n");
    write("docs/notes/old.md", "`src/gone.rs` and `gpt gone` are history; [this](gone.md) is not.\n");
    write(
        "docs/page.md",
        "# A heading, with `code`\n\n[good](../README.md), [good](#a-heading-with-code), [bad](gone.png), [bad](#nothing)\n\n\
         `docs/page.md`, `src/gone.rs`, `gone.wgsl`, `gpt render --spp 4`, `gpt render --gone`, `gpt gone`, `--adaptive`, `--lost`\n\n\
         ```sh\ngpt check --schema   # fine\ngpt bench speed --depth 2 --ghost\ncargo bench --bench gone\nscripts/gone\n```\n",
    );
    let lost = format!("{} cites docs/lost.md, which is not there", folder.path().join("src/cites.rs").display());
    let expected = [
        &lost,
        "docs/notes/old.md: the link to gone.md leads nowhere",
        "docs/page.md: the link to gone.png leads nowhere",
        "docs/page.md: no heading for the link to #nothing",
        "docs/page.md: `gpt render` has no flag --gone",
        "docs/page.md: there is no command `gpt gone`",
        "docs/page.md: nothing has the flag --lost",
        "docs/page.md: `gpt bench speed` has no flag --ghost",
        "docs/page.md: benches has no gone",
        "docs/page.md: there is no scripts/gone",
        "docs/page.md: there is no src/gone.rs",
        "docs/page.md: there is no file gone.wgsl",
    ];
    assert_eq!(faults(folder.path(), &Help::read()), expected);
}
