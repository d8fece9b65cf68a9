//! Files in which much names the same, and long ones: time follows their length.

use std::fmt::Write;

use super::{Folder, refusal};

/// A sphere of the last of these BSDFs.
fn scene(bsdfs: &str, last: &str) -> Folder {
    let text = format!(
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><bsdf type=\"diffuse\" id=\"b0\"/>{bsdfs}\
         <shape type=\"sphere\"><ref id=\"{last}\"/></shape><emitter type=\"constant\"/></scene>"
    );
    Folder::new(&[("a.xml", text.as_bytes())])
}

/// Blends, each of two.
fn blends(count: usize, other: impl Fn(usize) -> String) -> String {
    (1..=count).fold(String::new(), |mut text, i| {
        let before = i - 1;
        let _ = write!(
            text,
            "<bsdf type=\"blendbsdf\" id=\"b{i}\"><float name=\"weight\" value=\"0.5\"/><ref id=\"b{before}\"/>{}</bsdf>",
            other(before)
        );
        text
    })
}

#[test]
fn blends_that_double_are_walked_once_each() {
    let doubling = |count| scene(&blends(count, |before| format!("<ref id=\"b{before}\"/>")), &format!("b{count}"));
    assert_eq!(doubling(10).valid("a.xml").materials.len(), 11);
    // Whoever walks all leaves meets 2³² of them.
    let said = refusal(doubling(32).load("a.xml"));
    assert!(said.contains("the blend `b17` is of more than 65536 materials"), "{said}");
}

#[test]
fn references_nest_as_deep_as_elements_may() {
    let chain = |count| scene(&blends(count, |_| "<bsdf type=\"diffuse\"/>".to_owned()), &format!("b{count}"));
    assert!(chain(20).load("a.xml").is_ok());
    // Nothing may recurse so deep.
    let said = refusal(chain(65_000).load("a.xml"));
    assert!(said.contains("more than 100 deep within each other, references followed"), "{said}");
}

/// An error at the end of a long file names its line; to count lines from the beginning for each element
/// would take minutes here.
#[test]
fn places_in_long_files_are_found_at_once() {
    let shape = "<shape type=\"sphere\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.5\"/></bsdf></shape>\n";
    let text = format!(
        "<scene version=\"3.0.0\">\n{}<shape type=\"sphere\"><ref id=\"none\"/></shape>\n</scene>",
        shape.repeat(100_000)
    );
    let said = refusal(Folder::new(&[("a.xml", text.as_bytes())]).load("a.xml"));
    assert!(said.contains("a.xml:100002") && said.contains("no plugin with the id `none`"), "{said}");
}
