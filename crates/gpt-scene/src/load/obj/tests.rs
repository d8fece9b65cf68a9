use super::*;
use crate::load::spelling::lines::trimmed;
use crate::scene::Mesh;

/// Reads a model of these bytes, as errors call `a.obj`.
fn read_bytes(bytes: &[u8]) -> Result<ModelFile, String> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("a.obj"), bytes).expect("it is written");
    let without_folder = |message: String| message.replace(&format!("{}/", folder.path().display()), "");
    let file = load(&Files::default(), &folder.path().join("a.obj"), true);
    let mut file = file.map_err(|error| without_folder(error.to_string()))?;
    file.warnings = file.warnings.into_iter().map(without_folder).collect();
    Ok(file)
}

/// All faces as one mesh, and what was mended.
fn mended(text: &str) -> (Mesh, Vec<(Option<usize>, String)>) {
    let file = read_bytes(text.as_bytes()).unwrap_or_else(|error| panic!("{error}: {text}"));
    let reported = file.substitutes.into_iter().map(|(_, mend)| (mend.line, mend.what)).collect();
    let mut mesh = Mesh::default();
    for mut part in file.parts {
        if part.mesh.normals.is_empty() {
            part.mesh.normals = vec![glam::Vec3::ZERO; part.mesh.positions.len()];
        }
        mesh.append(part.mesh);
    }
    (mesh, reported)
}

fn area(mesh: &Mesh) -> f32 {
    let corner = |index: u32| mesh.positions[index as usize];
    mesh.faces.iter().map(|&[a, b, c]| (corner(b) - corner(a)).cross(corner(c) - corner(a)).length() / 2.0).sum()
}

/// A quad of area 4.
const Q: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";

/// Statements of one meaning are read without a word.
#[test]
fn statements_are_spelled_in_many_ways() {
    let lines = |text: &str| format!("{Q}{text}\n");
    let cases: Vec<String> = vec![
        lines("f 1 2 3 4"),
        format!("f 1 2 3 4\n{Q}"),
        lines("# a comment \\\nf 1 2 3 4"),
        lines("f 1 2 3 4 # a comment \\"),
        lines("f 1 2 3 4#"),
        lines("f 1 2 \\\n3 4"),
        lines("f\\\n1\\\n2\\\n3\\\n4"),
        lines("g C:\\models\\\nf 1 2 3 4"),
        lines("o a \\\nf 1 2 3 4"),
        lines("s off\ns 1\ng\no\nF 1 2 3 4"),
        lines("fo 1 2 3 4"),
        lines("f -4 -3 -2 -1"),
        lines("f 1 2 3 4").replace('\n', "\r"),
        lines("f 1 2 3 4").replace('\n', "\r\n"),
        lines("f 1 2 3 4").replace('\n', "\u{85}"),
        lines("f 1 2 3 4").replace('\n', "\x0c"),
        lines("f 1 2 3 4").replace('\n', "\n\t \n"),
        lines("f 1 2 3 4").replace(' ', "\t"),
        lines("f 1 2 3 4").replace(' ', "  ").replace('\n', " \t\n"),
        lines("f 1 2 3 4").replace('\n', "\0\n"),
        format!("\u{feff}{}", lines("f 1 2 3 4\x1a")),
        "v -1. -1.0 +0\nv +1 -1e0 .0\nv 01 1 0e5\nv -1 1 -0\nf 1 2 3 4".to_owned(),
        Q.replace(" 0\n", " 0 1\n") + "f 1 2 3 4",
        Q.replace(" 0\n", " 0 1 nan 0\n") + "f 1 2 3 4",
        "v -2 -2 0 2\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4".to_owned(),
        lines("vt 0\nvt 1 0\nvt 0 1 0\nf 1/1 2/2 3/3 4/1"),
        lines("vn 0 0 1\nf 1//1 2//1 3//1 4//1"),
        lines("vn 0 0 1\nvt 0 0\nf 1//1 2/1 3/1/1 4"),
        lines("f 1/ 2/ 3/ 4/"),
        lines("f 1// 2// 3// 4//"),
        // Vertices that nobody uses may be anything.
        lines("v nan nan nan\nvn nan nan nan\nvt x\nv\nf 1 2 3 4"),
        lines("f 1 1 2 3 4 1"),
        lines("mg 1 2\nlod 3\nbevel on\nf 1 2 3 4"),
    ];
    for text in cases {
        let (mesh, reported) = mended(&text);
        assert!((area(&mesh) - 4.0).abs() < 1e-6 && reported.is_empty(), "{text:?}: {} {reported:?}", area(&mesh));
    }
    let wide: Vec<u8> = lines("f 1 2 3 4").encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(read_bytes(&wide).is_ok_and(|file| file.substitutes.is_empty()));
    assert!(read_bytes(b"g caf\xe9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").is_ok());
}

#[test]
fn one_odd_statement_is_mended_and_reported_with_its_line() {
    // Statements after the quad's four vertices, the line that is reported, and a part of what is said; the quad is there with all of its area.
    let whole: [(&str, usize, &str); 22] = [
        ("vn nan 0 1\nf 1//1 2//1 3//1 4//1", 5, "normals"),
        ("vn 0 1\nf 1//1 2//1 3//1 4//1", 5, "normals"),
        ("vn -1.#IND 0 1\nf 1//1 2//1 3//1 4//1", 5, "normals"),
        ("f 1//1 2//1 3//1 4//1", 5, "normals that are not there"),
        ("vn 0 0 1\nf 1//0 2//1 3//1 4//1", 6, "normals that are not there"),
        ("f 1/1 2/1 3/1 4/1", 5, "texture coordinates that are not there"),
        ("vt nan 0\nf 1/1 2/1 3/1 4/1", 5, "texture coordinates"),
        ("vt\nf 1/1 2/1 3/1 4/1", 5, "texture coordinates"),
        ("f 1 2\nf 1 2 3 4", 5, "fewer than three corners"),
        ("f 1\nf 1 2 3 4", 5, "fewer than three corners"),
        ("f\nf 1 2 3 4", 5, "fewer than three corners"),
        ("f 0 1 2\nf 1 2 3 4", 5, "no vertex of the file"),
        ("f 1 2 9\nf 1 2 3 4", 5, "no vertex of the file"),
        ("f -9 1 2\nf 1 2 3 4", 5, "no vertex of the file"),
        ("f 1 2 x\nf 1 2 3 4", 5, "no vertex of the file"),
        ("v nan 0 0\nf 1 2 5\nf 1 2 3 4", 5, "whose position"),
        ("v 1e400 0 0\nf 1 2 5\nf 1 2 3 4", 5, "whose position"),
        ("f 1.0 2 3 4/1/1/7", 5, ""),
        ("f 1 / 1 2 /1 3/ 1 4/1\nvt 0 0", 5, "blanks or commas"),
        ("f 1, 2, 3, 4", 5, "blanks or commas"),
        ("usemtl\nf 1 2 3 4", 5, "`usemtl` names no material"),
        ("surf 0 1 0 1 1 2 3 4\nf 1 2 3 4", 5, "free-form"),
    ];
    for (text, line, said) in whole {
        let (mesh, reported) = mended(&format!("{Q}{text}\n"));
        assert!((area(&mesh) - 4.0).abs() < 1e-6, "{text:?}: {}", area(&mesh));
        let is_reported = reported.first().is_some_and(|(at, what)| *at == Some(line) && what.contains(said));
        assert!(is_reported, "{text:?}: {reported:?}");
        assert!(mesh.normals.iter().all(|normal| normal.is_finite()) && mesh.uvs.iter().all(|uv| uv.is_finite()));
    }
    for text in ["call a.obj", "csh ls", "xyzzy 1 2", "curv 0 1 1 2", "p x y\nmtllib"] {
        let (mesh, reported) = mended(&format!("{Q}f 1 2 3 4\n{text}\n"));
        assert!(area(&mesh) == 4.0 && reported.len() == 1, "{text}: {reported:?}");
    }
    for (text, expected) in [
        ("v -1,0 -1,0 0,0\nv 1,0 -1,0 0,0\nv 1,0 1,0 0,0\nv -1,0 1,0 0,0", "odd spelling"),
        ("v -1,-1,0\nv 1,-1,0\nv 1,1,0\nv -1,1,0", "odd spelling"),
        ("v -1.0f -1.0f 0.0f\nv 1D0 -1 0\nv 0x1 1 0\nv -1 1 0", "odd spelling"),
        ("v -1 -1\nv 1 -1\nv 1 1\nv -1 1", "two numbers"),
        ("v -1 -1 0 0\nv 1 -1 0 0\nv 1 1 0 nan\nv -1 1 0", "weight"),
        ("v -1 -1 0 1 2\nv 1 -1 0\nv 1 1 0\nv -1 1 0 1 1 1 1 1 1", "numbers behind"),
    ] {
        let (mesh, reported) = mended(&format!("{text}\nf 1 2 3 4\n"));
        assert!((area(&mesh) - 4.0).abs() < 1e-6, "{text}: {}", area(&mesh));
        assert!(reported.len() == 1 && reported[0].0.is_some() && reported[0].1.contains(expected), "{text}: {reported:?}");
    }
}

#[test]
fn mends_are_counted() {
    let (mesh, reported) = mended(&format!("{Q}v nan 0 0\nf 1 2 3 4\nf 1 2\nf 1 2 5\nf 5 1 2\nf 3 4\n"));
    assert_eq!(area(&mesh), 4.0);
    let expected = [
        "faces with a corner whose position is no three numbers within 1e18 are left out: `v nan 0 0`; 2 in all",
        "faces of fewer than three corners are left out: `f 1 2`; 2 in all",
    ];
    assert_eq!(reported.iter().map(|(_, what)| what.as_str()).collect::<Vec<_>>(), expected);
}

#[test]
fn what_only_some_corners_have_is_made_for_the_others() {
    // Normals of both objects stay, though the second one has some corners without.
    let text = format!("{Q}vn 0 0 1\nvn 1 0 0\no a\nf 1//1 2//1 3//1\no b\nf 1//2 3//2 4\n");
    let (mesh, reported) = mended(&text);
    assert!(reported.is_empty());
    let normals: Vec<glam::Vec3> = mesh.faces.iter().flatten().map(|&corner| mesh.normals[corner as usize]).collect();
    let (x, z) = (glam::Vec3::X, glam::Vec3::Z);
    assert_eq!(normals, [z, z, z, x, x, glam::Vec3::ZERO]);
}

#[test]
fn what_leaves_nothing_to_render_is_refused() {
    for (text, said) in [
        ("", "it has no faces"),
        (Q, "it has no faces"),
        ("v 0 0 0\nv 1 0 0\nl 1 2\np 1", "it has no faces, but points or lines, which have no surface"),
        (
            "f 1 2 3",
            "none of its faces can be read: line 1: faces with a corner that is no vertex of the file are left out: `f 1 2 3`",
        ),
        ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3", "none of its faces has an area"),
    ] {
        let error = read_bytes(text.as_bytes()).err().unwrap_or_default();
        assert_eq!(error, format!("a.obj: there is nothing to render in the model: {said}"), "{text}");
    }
}

#[test]
fn what_is_not_rendered_is_said() {
    let file = read_bytes(format!("{}f 1 2 3 4\nl 1 2\np 1\nf 1 2 4 3\n", Q.replace(" 0\n", " 0 1 0 0\n")).as_bytes());
    let warnings = file.map(|file| file.warnings).unwrap_or_default();
    let expected = [
        "a.obj: 2 points and lines are left out: they have no surface",
        "a.obj: the colours of 4 vertices are left out: a material gives the colour",
        "a.obj: polygons that cross themselves may be filled in wrongly: line 8",
    ];
    assert_eq!(warnings, expected);
}

#[test]
fn concave_polygons_are_cut() {
    let text = "v 0 0 0\nv 2 2 0\nv 0 1 0\nv -2 2 0\nvn 0 0 1\nf 2//1 3//1 4//1 1//1\n";
    let (mesh, reported) = mended(text);
    assert_eq!((area(&mesh), mesh.faces.len(), reported.len()), (2.0, 2, 0));
    assert!(mesh.normals.iter().all(|normal| *normal == glam::Vec3::Z));
}

#[test]
fn names_are_trimmed() {
    assert_eq!(trimmed("\tred \0"), "red");
}
