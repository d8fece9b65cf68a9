use std::io::Write as _;

use super::*;

const HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n";

/// A unit square in text; `extra` follows the header's elements, and `data` all of them.
fn text(header: &str, data: &str) -> Vec<u8> {
    format!("ply\nformat ascii 1.0\ncomment by hand\n{header}end_header\n{data}").into_bytes()
}

const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

fn read_bytes(bytes: &[u8]) -> Result<ModelFile, String> {
    read::<false>("a.ply", &mut &*bytes).map_err(|error| error.to_string())
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
fn mistakes_are_named() {
    let faces = |faces: &str| text(HEADER, &format!("{SQUARE}{faces}\n"));
    let cases: [(Vec<u8>, &str); 10] = [
        (b"solid stl".to_vec(), "a.ply: is not a valid PLY file: "),
        (faces("3 0 1 4"), "a.ply: face 0 uses vertex 4, but there are only 4 (counted from 0)"),
        (faces("3 0 1 -1"), "a.ply: face 0 uses a vertex below 0, but there are only 4"),
        (faces("3 0 1 x"), "a.ply: is not a valid PLY file: line 15, `3 0 1 x`: "),
        (faces("3 0 0 1"), "a.ply: there is nothing to render in the model: none of its faces has an area"),
        (faces("2 0 1"), "a.ply: there is nothing to render in the model: it has points and no faces"),
        (text(HEADER, SQUARE), "a.ply: the file ends before the last of its 1 elements `face`"),
        (text(HEADER, "0 0 1e20\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n"), "a.ply: vertex 0 stands at "),
        (text(&HEADER.replace("float z", "float w"), ""), "a.ply: its vertices have no numbers x, y and z"),
        (text("element face 0\nproperty list uchar int vertex_indices\n", ""), "a.ply: it has no vertices"),
    ];
    for (bytes, expected) in cases {
        let error = read_bytes(&bytes).err().unwrap_or_default();
        assert!(error.starts_with(expected) && !error.contains('\n'), "`{error}` and not `{expected}`");
    }
}

/// A header may promise what no file holds; memory follows what is there.
#[test]
fn promises_cost_nothing() {
    let promised = HEADER.replace("vertex 4", "vertex 4000000000");
    let error = read_bytes(&text(&promised, SQUARE)).err().unwrap_or_default();
    assert!(error.contains("the file ends before the last of its 4000000000 elements `vertex`"), "{error}");
    let nothing = format!("element nothing 4000000000\n{HEADER}");
    assert_eq!(area(&mesh(&text(&nothing, &format!("{SQUARE}4 0 1 2 3\n")))), 1.0);
    let mut list = binary(false);
    let length = list.len();
    list[length - 9] = 255;
    assert!(read_bytes(&list).is_err());
}
