use std::io::Write as _;

use super::*;

const HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n";

/// A unit square in text; `extra` follows the header's elements, and `data` all of them.
fn text(header: &str, data: &str) -> Vec<u8> {
    format!("ply\nformat ascii 1.0\ncomment by hand\n{header}end_header\n{data}").into_bytes()
}

const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

fn read_bytes(bytes: &[u8]) -> Result<ModelFile, String> {
    read("a.ply", &mut &*bytes, false).map_err(|error| error.to_string())
}

fn mesh(bytes: &[u8]) -> Mesh {
    let mut file = read_bytes(bytes).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(file.parts.len(), 1);
    file.parts.remove(0).mesh
}

fn area(mesh: &Mesh) -> f32 {
    let corner = |index: u32| mesh.positions[index as usize];
    mesh.faces.iter().map(|&[a, b, c]| (corner(b) - corner(a)).cross(corner(c) - corner(a)).length() / 2.0).sum()
}

/// The square with normals and texture coordinates in doubles, its indices in 16 bits, in one of the byte orders.
fn binary(big_endian: bool) -> Vec<u8> {
    let order = if big_endian { "big" } else { "little" };
    let mut bytes = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         property float nx\nproperty float ny\nproperty float nz\nproperty double s\nproperty double t\nproperty uchar red\n\
         element face 1\nproperty list uchar ushort vertex_index\nend_header\n"
    )
    .into_bytes();
    let mut write = |little: &[u8]| {
        if big_endian { bytes.extend(little.iter().rev()) } else { bytes.extend(little) }
    };
    for [x, y] in [[0.0_f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
        [x, y, 0.0, 0.0, 0.0, 2.0].iter().for_each(|number| write(&number.to_le_bytes()));
        [x, y].iter().for_each(|number| write(&f64::from(*number).to_le_bytes()));
        write(&[200]);
    }
    write(&[4]);
    (0..4_u16).for_each(|index| write(&index.to_le_bytes()));
    bytes
}

#[test]
fn text_and_both_byte_orders_say_the_same() {
    let plain = mesh(&text(HEADER, &format!("{SQUARE}4 0 1 2 3\n")));
    assert_eq!(plain.faces, [[0, 1, 2], [0, 2, 3]]);
    for big_endian in [false, true] {
        let mesh = mesh(&binary(big_endian));
        assert_eq!((&mesh.positions, &mesh.faces), (&plain.positions, &plain.faces));
        assert_eq!(mesh.normals, [Vec3::Z; 4]);
        assert_eq!(mesh.uvs, [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]);
    }
    assert!(plain.normals.is_empty() && plain.uvs.is_empty());
    // The control: in the wrong order it is another file.
    let mut swapped = binary(true);
    let format = swapped.windows(3).position(|word| word == b"big").expect("the header's format");
    swapped.splice(format..format + 3, *b"little");
    assert!(read_bytes(&swapped).is_err());
}

#[test]
fn packed_files_are_unpacked() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("square.ply.gz");
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(&binary(false)).expect("a vector takes everything");
    let packed = packer.finish().expect("a vector takes everything");
    std::fs::write(&path, &packed).expect("the folder can be written to");
    assert_eq!(area(&load(&Files::default(), &path).expect("it is valid").parts[0].mesh), 1.0);
    std::fs::write(&path, &packed[..packed.len() / 2]).expect("the folder can be written to");
    assert!(load(&Files::default(), &path).is_err());
}

#[test]
fn concave_polygons_are_cut_and_faces_may_come_first() {
    let header = "element face 1\nproperty list uchar uint vertex_indices\nelement vertex 6\nproperty double x\nproperty double y\nproperty double z\n";
    let data = "6 2 3 4 5 0 1\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n";
    let mesh = mesh(&text(header, data));
    assert_eq!((mesh.faces.len(), area(&mesh)), (4, 3.0));
}

#[test]
fn strips_turn_every_other_triangle() {
    let header = "element vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\nproperty list int int vertex_indices\n";
    let mesh = mesh(&text(header, "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 4 -1 0 1 3\n"));
    assert_eq!(mesh.faces, [[0, 1, 2], [2, 1, 3], [2, 3, 4], [0, 1, 3]]);
    let normal = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|index| mesh.positions[index as usize]);
        (b - a).cross(c - a).z
    };
    assert!(mesh.faces.iter().all(|face| normal(face) > 0.0));
}

#[test]
fn what_has_no_effect_is_named_once() {
    let header = HEADER
        .replace("element face", "property uchar red\nproperty float quality\nelement face")
        .replace("vertex_indices\n", "vertex_indices\nproperty list uchar float texcoord\nelement edge 1\nproperty int a\n");
    let data = "0 0 0 255 1\n1 0 0 255 1\n1 1 0 255 1\n0 1 0 255 1\n4 0 1 2 3 2 0.5 0.5\n7\n";
    let file = read_bytes(&text(&header, data)).expect("it is valid");
    assert_eq!(file.warnings, ["a.ply: left out: vertex red, vertex quality, face texcoord, the element edge"]);
}

#[test]
fn what_leaves_nothing_to_render_is_refused() {
    let faces = |faces: &str| text(HEADER, &format!("{SQUARE}{faces}\n"));
    let nothing = "a.ply: there is nothing to render in the model: ";
    let cases: [(Vec<u8>, &str, &str); 12] = [
        (b"solid stl".to_vec(), "a.ply: is not a PLY file", ""),
        (b"".to_vec(), "a.ply: is not a PLY file", ""),
        (b"ply\nformat ascii 1.0\n".to_vec(), "a.ply: is not a valid PLY file: it ends before its header does", ""),
        (b"ply\nformat c64 1.0\nend_header\n".to_vec(), "a.ply: is not a valid PLY file: line 2, `format c64 1.0`", ""),
        (faces("3 0 1 4"), nothing, "face 0 uses vertex 4, but there are only 4 (counted from 0)"),
        (faces("3 0 1 -1"), nothing, "face 0 uses a vertex below 0"),
        (faces("3 0 0 1"), nothing, "none of its faces has an area"),
        (faces("2 0 1"), nothing, "faces of fewer than three corners are left out: face 0"),
        (text(HEADER, SQUARE), nothing, "the file ends too early, and what is there of it is taken: 0 of its 1 elements `face`"),
        (text(HEADER, "0 0 1e20\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), nothing, "face 0 uses vertex 0"),
        (text(&HEADER.replace("float z", "float w"), ""), "a.ply: its vertices have no numbers x, y and z", ""),
        (text("element face 0\nproperty list uchar int vertex_indices\n", ""), "a.ply: it has no vertices", ""),
    ];
    for (bytes, start, part) in cases {
        let error = read_bytes(&bytes).err().unwrap_or_default();
        assert!(
            error.starts_with(start) && error.contains(part) && !error.contains('\n'),
            "`{error}` and not `{start} … {part}`"
        );
    }
}

/// The mesh, and what was mended.
fn mended(bytes: &[u8]) -> (Mesh, Vec<(Option<usize>, String)>) {
    let mut file = read_bytes(bytes).unwrap_or_else(|error| panic!("{error}"));
    let reported = file.substitutes.into_iter().map(|(_, mend)| (mend.line, mend.what)).collect();
    (file.parts.remove(0).mesh, reported)
}

/// Data of one meaning are read without a word.
#[test]
fn text_may_lie_in_any_lines() {
    let plain = mesh(&text(HEADER, &format!("{SQUARE}4 0 1 2 3\n")));
    let header = |extra: &str| format!("ply\n{extra}format ascii 1.0\n{HEADER}end_header\n");
    let whole = |data: &str| (header("") + data).into_bytes();
    let cases: Vec<Vec<u8>> = vec![
        whole("\n\n0 0 0\n\n1 0 0\n1 1 0\n0 1 0\n\n4 0 1 2 3\n\n"),
        whole("0\n0 0\n1 0\n0\n1 1 0\n0 1 0\n4 0 1\n2 3\n"),
        whole("0 0 0 1 0 0 1 1 0\n0 1 0 4 0 1 2 3"),
        whole("0 0 0\ncomment a\n1 0 0\n# b\n1 1 0\nobj_info 7\n0 1 0\n4 0 1 2 3"),
        whole("\t0\t0 0 \r1 0 0\r1 1 0\r0 1 0\r4 0 1 2 3\r"),
        (header("comment a\nobj_info b\n\ncomment\n") + SQUARE + "4 0 1 2 3").replace('\n', "\r").into_bytes(),
        (header("") + SQUARE + "4 0 1 2 3\n").replace('\n', "\r\n").into_bytes(),
        (header("") + SQUARE + "4 0 1 2 3\n").replace('\n', " \n").into_bytes(),
        [&[0xef, 0xbb, 0xbf][..], &whole("0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3")].concat(),
        whole("+0. .0 -0\n1e0 0 0\n1.0 1 0E5\n0 01 0\n4 0 1 2 3"),
        String::from_utf8_lossy(&whole("0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3"))
            .replace("float", "FLOAT64")
            .replace("uchar", "uint8")
            .into_bytes(),
        String::from_utf8_lossy(&whole("0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3"))
            .replace("vertex_indices", "vertex_index")
            .into_bytes(),
        format!("ply\nformat ascii 1.0\n{HEADER}end_header\n{SQUARE}4 0 1 2 3\n")
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect(),
    ];
    for bytes in cases {
        let (mesh, reported) = mended(&bytes);
        let of = String::from_utf8_lossy(&bytes);
        assert_eq!((&mesh.positions, &mesh.faces), (&plain.positions, &plain.faces), "{of}");
        assert!(reported.is_empty(), "{reported:?} {of}");
    }
}

#[test]
fn one_odd_number_is_mended_and_reported_with_its_line() {
    let of_vertices = "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nelement face";
    let header = HEADER.replace("element face", of_vertices);
    let data = |second: &str, face: &str| {
        text(&header, &format!("0 0 0 0 0 1 0 0\n{second}\n1 1 0 0 0 1 1 1\n0 1 0 0 0 1 0 1\n{face}\n"))
    };
    let good = "1 0 0 0 0 1 1 0";
    assert!(mended(&data(good, "4 0 1 2 3")).1.is_empty(), "the control");
    // The second vertex is in line 17, the face in line 20.
    let cases: [(&str, &str, usize, usize, &str); 9] = [
        ("1 0 0 nan 0 1 1 0", "4 0 1 2 3", 2, 17, "normals"),
        ("1 0 0 -1.#IND 0 1 1 0", "4 0 1 2 3", 2, 17, "normals"),
        ("1 0 0 0 0 1 nan inf", "4 0 1 2 3", 2, 17, "texture coordinates"),
        ("1 0 0 0 0 1 1", "4 0 1 2 3", 2, 17, "texture coordinates"),
        ("1,0 0 0 0 0 1 1 0", "4 0 1 2 3", 2, 17, "odd spelling"),
        ("1 0 0 0 0 1 1 0 7", "4 0 1 2 3", 2, 17, "what follows"),
        ("nan 0 0 0 0 1 1 0", "3 0 2 3", 1, 0, ""),
        (good, "4 0 1 2 3 9 9", 2, 20, "what follows"),
        (good, "4 0 1 2 3\n1 2 3", 2, 21, "what follows the last element"),
    ];
    for (second, face, faces, line, said) in cases {
        let (mesh, reported) = mended(&data(second, face));
        assert_eq!(mesh.faces.len(), faces, "{second}, {face}: {reported:?}");
        let as_expected = match reported.as_slice() {
            [] => said.is_empty(),
            [(at, what)] => *at == Some(line) && what.contains(said),
            _ => false,
        };
        assert!(as_expected, "{second}, {face}: {reported:?}");
        assert!(mesh.positions.iter().all(|position| position.is_finite()));
        assert!(mesh.uvs.iter().all(|uv| uv.is_finite()) && mesh.normals.iter().all(|normal| normal.is_finite()));
        assert_eq!(mesh.normals.len(), mesh.positions.len());
    }
}

#[test]
fn faces_that_cannot_be_are_left_out_and_counted() {
    let header = HEADER.replace("face 1", "face 6");
    let faces = "3 0 1 2\n2 0 1\n3 0 1 9\n3 0 1 -1\n3 0 1\n1 3";
    let (mesh, reported) = mended(&text(&header, &format!("{SQUARE}{faces}\n")));
    assert_eq!(mesh.faces, [[0, 1, 2]]);
    let said: Vec<String> = reported.iter().map(|(_, what)| what.clone()).collect();
    assert_eq!(
        said,
        [
            "faces of fewer than three corners are left out: face 1; 2 in all",
            "faces with a corner that is no vertex of the file are left out: face 2 uses vertex 9, but there are only 4 (counted from 0); 2 in all",
            "faces that are not whole are left out: `3 0 1`",
        ]
    );
}

#[test]
fn vertices_that_cannot_be_read_go_with_their_faces() {
    let header = HEADER.replace("vertex 4", "vertex 5").replace("face 1", "face 2");
    let (mesh, reported) = mended(&text(&header, "0 0 0\nnan nan nan\n1 0 0\n1 1 0\n0 1 0\n4 0 2 3 4\n3 0 1 2\n"));
    assert_eq!((mesh.positions.len(), area(&mesh)), (4, 1.0));
    let what =
        "faces with a corner whose position is no three numbers within 1e18 are left out: face 1 uses vertex 1 (counted from 0)";
    assert_eq!(reported, [(None, what.to_owned())]);
}

#[test]
fn what_is_there_of_a_file_that_ends_early_is_taken() {
    let header = HEADER.replace("face 1", "face 2");
    let (mesh, reported) = mended(&text(&header, &format!("{SQUARE}3 0 1 2\n3 0")));
    assert_eq!(mesh.faces.len(), 1);
    assert!(reported.iter().any(|(_, what)| what.contains("elements `face`") || what.contains("not whole")), "{reported:?}");
    let (mesh, reported) = mended(&text(&header, &format!("{SQUARE}3 0 1 2\n")));
    assert_eq!((mesh.faces.len(), reported[0].1.contains("1 of its 2 elements `face`")), (1, true), "{reported:?}");
    for big_endian in [false, true] {
        let whole = binary(big_endian);
        let more = [&whole[..], b"more"].concat();
        let (mesh, reported) = mended(&more);
        assert_eq!((mesh.faces.len(), reported.len()), (2, 1), "{reported:?}");
        let (_, reported) = mended(&[&whole[..], b"\n\0"].concat());
        assert!(reported.is_empty(), "{reported:?}");
    }
}

#[test]
fn odd_lines_of_a_header_are_left_out() {
    let data = format!("{SQUARE}4 0 1 2 3\n");
    let plain = format!("ply\nformat ascii 1.0\n{HEADER}end_header\n{data}");
    for (from, to) in [
        ("element face", "Created by somebody\nelement face"),
        ("format ascii 1.0\n", ""),
        ("face 1", "face"),
        ("face 1", "face -1"),
    ] {
        let changed = plain.replacen(from, to, 1);
        let (mesh, reported) = mended(changed.as_bytes());
        assert_eq!((area(&mesh), reported.len()), (1.0, 1), "{changed}: {reported:?}");
    }
    // Text needs no types.
    assert!(mended(plain.replace("float", "real").as_bytes()).1.is_empty());
    let binary = String::from_utf8_lossy(&binary(false)).replace("property double s", "property real s");
    assert!(read_bytes(binary.as_bytes()).is_err_and(|error| error.contains("the type is not known")));
}

#[test]
fn names_of_properties_have_variants() {
    let of_vertices = "property float normal_x\nproperty float normal_y\nproperty float normal_z\nproperty float texture_u\nproperty float texture_v\nelement face";
    let header = HEADER.replace("element face", of_vertices).replace("float x", "float X");
    let row = |x: u32, y: u32| format!("{x} {y} 0 0 0 1 {x} {y}\n");
    let (mesh, reported) = mended(&text(&header, &[row(0, 0), row(1, 0), row(1, 1), row(0, 1), "4 0 1 2 3\n".into()].concat()));
    assert!(reported.is_empty(), "{reported:?}");
    assert_eq!((mesh.normals, mesh.uvs), (vec![Vec3::Z; 4], vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]));
}

#[test]
fn strips_lose_the_triangles_of_a_wrong_index() {
    let header = "element vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\nproperty list int int vertex_indices\n";
    let (mesh, reported) = mended(&text(header, "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 9 3 -1 0 1 3\n"));
    assert_eq!(mesh.faces, [[0, 1, 2], [0, 1, 3]]);
    assert!(reported.len() == 1 && reported[0].1.ends_with("2 in all"), "{reported:?}");
}

/// A header may promise what no file holds; memory follows what is there.
#[test]
fn promises_cost_nothing() {
    let promised = HEADER.replace("vertex 4", "vertex 4000000000");
    let error = read_bytes(&text(&promised, SQUARE)).err().unwrap_or_default();
    assert!(error.contains("4 of its 4000000000 elements `vertex`"), "{error}");
    let nothing = format!("element nothing 4000000000\n{HEADER}");
    assert_eq!(area(&mesh(&text(&nothing, &format!("{SQUARE}4 0 1 2 3\n")))), 1.0);
    let mut list = binary(false);
    let length = list.len();
    list[length - 9] = 255;
    assert!(read_bytes(&list).is_err());
}
