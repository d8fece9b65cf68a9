//! Scenes with several mistakes, which are all reported at once.

use super::error_of;

#[test]
fn all_mistakes_of_all_tables_are_reported_in_the_order_of_the_file() {
    let text = "[film]
size = \"large\"
filter = { type = \"tent\", radius = -1, width = 2 }
[camera]
position = \"here\"
look_at = [0, 0]
vfov = -1
angle = 40
[[material]]
name = [\"a\"]
type = \"diffuse\"
reflectance = \"red\"
[[shape]]
type = \"sphere\"
radius = { of = 1 }
material = 3
[[material]]
name = \"b\"
type = \"difuse\"
[[material]]
name = \"c\"
[[shape]]
type = \"sphere\"
material = \"b\"
";
    let error = error_of(text);
    let all = std::iter::once(&error).chain(error.others());
    let found: Vec<_> = all.map(|error| (error.line().unwrap_or(0), error.key().unwrap_or_default(), error.message())).collect();
    // Line, key, and how the message begins.
    let expected = [
        (2, "film.size", "invalid type: string \"large\", expected an array"),
        (3, "film.filter.radius", "expected a number from 0.5 to 16"),
        (3, "film.filter.width", "unknown key `width`"),
        (5, "camera.position", "invalid type: string \"here\", expected an array"),
        (6, "camera.look_at", "wrong number of values: 2"),
        (7, "camera.vfov", "expected an angle from 0.001 to 179"),
        (8, "camera.angle", "unknown key `angle`"),
        (10, "material[0].name", "invalid type: array"),
        (12, "material[0].reflectance", "expected a colour such as"),
        (15, "shape[0].radius", "invalid type: table"),
        (16, "shape[0].material", "invalid type: integer `3`"),
        (19, "material[1].type", "`difuse` is not a valid choice"),
        (20, "material[2]", "the key `type` is missing"),
        (22, "shape[1]", "the key `center` is missing"),
    ];
    let is_expected = |((line, key, message), (at, of, start)): (&(usize, &str, &str), &(usize, &str, &str))| {
        (line, key) == (at, of) && message.starts_with(start)
    };
    assert!(found.len() == expected.len() && found.iter().zip(&expected).all(is_expected), "{found:#?}");
}

#[test]
fn a_key_that_is_misspelt_is_not_reported_as_missing_too() {
    let error = error_of("[[shape]]\ntype = \"sphere\"\nradios = 1\nmaterial = \"a\"\n");
    assert!(error.others().is_empty() && error.message().starts_with("unknown key `radios`"), "{error} {:?}", error.others());
}

#[test]
fn no_more_mistakes_are_reported_than_a_person_reads() {
    let shapes = "[[shape]]\ntype = \"sphere\"\nradius = -1\nmaterial = \"a\"\n".repeat(200);
    let error = error_of(&shapes);
    let lines: Vec<_> = std::iter::once(&error).chain(error.others()).map(gpt::load::SceneError::line).collect();
    let first: Vec<_> = (0..20).map(|shape| Some(4 * shape + 3)).collect();
    assert_eq!(lines, first);
}
