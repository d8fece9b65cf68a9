//! Statements of OBJ files by their names.

use crate::load::spelling::lines::{first_word, words};

/// Statements that say nothing about surfaces here: groups, smoothing, display attributes.
pub const HARMLESS: [&str; 12] =
    ["o", "g", "s", "mg", "usemap", "maplib", "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj"];
/// Statements of free-form curves and surfaces, and of what older versions had for them.
pub const FREE_FORM: [&str; 24] = [
    "vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp", "end", "con", "ctech",
    "stech", "bsp", "bzp", "cdc", "cdp", "res", "call", "csh",
];
const READ: [&str; 8] = ["v", "vt", "vn", "f", "fo", "l", "p", "usemtl"];

/// True where a line begins a statement, and is not the rest of the one before it: names may begin with any word.
pub fn is_statement(line: &str) -> bool {
    let (word, rest) = first_word(line);
    let is = |names: &[&str]| names.iter().any(|name| word.eq_ignore_ascii_case(name));
    let counts =
        ["v", "vt", "vn", "vp", "f", "fo", "l", "p", "s", "parm", "deg", "curv", "surf", "trim", "hole", "sp", "con", "res"];
    if is(&counts) {
        return words(rest)
            .next()
            .is_some_and(|word| word.starts_with(|start: char| start.is_ascii_digit() || "+-.uvo".contains(start)));
    }
    word.eq_ignore_ascii_case("mtllib") || is(&READ) || is(&HARMLESS) || is(&FREE_FORM)
}
