//! Which modules a module's text names.

/// The modules that `text`, that of `module`, names, each with the path by which it does. `exists` says which modules there are.
pub fn imported_modules(module: &[String], text: &str, exists: impl Fn(&[String]) -> bool) -> Vec<(Vec<String>, String)> {
    let mut found = Vec::new();
    // Modules within the file, from outside in, each with the depth of braces at which it ends.
    let mut inner: Vec<(String, usize)> = Vec::new();
    let mut depth = 0;
    let mut tokens = Tokens { rest: text };
    let (mut before, mut previous) = ("", "");
    while let Some(token) = tokens.next() {
        match token {
            "{" => depth += 1,
            "}" => {
                depth -= 1;
                inner.retain(|(_, end)| *end <= depth);
            }
            // `use<>` of a type names no module.
            "use" if !tokens.rest.trim_start().starts_with('<') => {
                let here = place(module, &inner);
                for path in tree(&mut tokens) {
                    found.extend(resolve(&here, &path, &exists).map(|target| (target, path.join("::"))));
                }
            }
            word if previous == "mod" && is_word(word) && tokens.rest.trim_start().starts_with('{') => {
                inner.push((word.to_owned(), depth + 1));
            }
            // `pub(in path)` is no import.
            word if is_word(word) && !matches!(previous, "::" | "." | "mod") && (before, previous) != ("(", "in") => {
                let path = tokens.path_from(word);
                if path.len() > 1 {
                    found.extend(resolve(&place(module, &inner), &path, &exists).map(|target| (target, path.join("::"))));
                }
            }
            _ => {}
        }
        (before, previous) = (previous, token);
    }
    found.retain(|(target, _)| target != module);
    found
}

fn place(module: &[String], inner: &[(String, usize)]) -> Vec<String> {
    module.iter().cloned().chain(inner.iter().map(|(name, _)| name.clone())).collect()
}

/// The deepest module on a path; None for paths into other crates.
fn resolve(here: &[String], path: &[String], exists: &impl Fn(&[String]) -> bool) -> Option<Vec<String>> {
    let (mut base, mut rest) = (here.to_vec(), path);
    match path.first().map(String::as_str) {
        Some("crate") => (base, rest) = (Vec::new(), &path[1..]),
        Some("self") => rest = &path[1..],
        Some("super") => {
            while rest.first().is_some_and(|part| part == "super") {
                base.pop();
                rest = &rest[1..];
            }
        }
        // A module below this one may be named without `self`.
        Some(first) => {
            base.push(first.to_owned());
            if !exists(&base) {
                return None;
            }
            base.pop();
        }
        None => return None,
    }
    let full: Vec<String> = base.into_iter().chain(rest.iter().cloned()).collect();
    (0..=full.len()).rev().map(|length| &full[..length]).find(|module| exists(module)).map(<[String]>::to_vec)
}

/// All paths of a `use`, whose keyword was read.
fn tree(tokens: &mut Tokens<'_>) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    let mut path: Vec<String> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    // How much of the path every part of the innermost braces begins with.
    let mut common = 0;
    let mut names_something = false;
    while let Some(token) = tokens.next() {
        match token {
            "{" => {
                open.push(common);
                common = path.len();
                names_something = false;
            }
            "," | "}" | ";" => {
                if names_something {
                    paths.push(path.clone());
                }
                names_something = false;
                path.truncate(common);
                if token == "}" {
                    common = open.pop().unwrap_or(0);
                    path.truncate(common);
                } else if token == ";" {
                    break;
                }
            }
            "as" => {
                tokens.next();
            }
            word if is_word(word) => {
                // `self` at a list's end means what the list is of.
                if word != "self" || path.is_empty() {
                    path.push(word.to_owned());
                }
                names_something = true;
            }
            "*" => names_something = true,
            _ => {}
        }
    }
    paths
}

fn is_word(token: &str) -> bool {
    token.starts_with(|letter: char| letter.is_alphabetic() || letter == '_')
}

/// Words, `::`, and single other characters.
struct Tokens<'a> {
    rest: &'a str,
}

impl<'a> Iterator for Tokens<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        let rest = self.rest.trim_start();
        let first = rest.chars().next()?;
        let in_word = |letter: char| letter.is_alphanumeric() || letter == '_';
        let length = if in_word(first) {
            rest.find(|letter| !in_word(letter)).unwrap_or(rest.len())
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        let (token, rest) = rest.split_at(length);
        self.rest = rest;
        Some(token)
    }
}

impl Tokens<'_> {
    /// The path that begins with `first`, which was read.
    fn path_from(&mut self, first: &str) -> Vec<String> {
        let mut path = vec![first.to_owned()];
        loop {
            let mut ahead = Tokens { rest: self.rest };
            match (ahead.next(), ahead.next()) {
                (Some("::"), Some(word)) if is_word(word) => path.push(word.to_owned()),
                _ => return path,
            }
            self.rest = ahead.rest;
        }
    }
}
