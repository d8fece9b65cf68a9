//! Scenes of many files.

use std::time::Instant;

use crate::common::effort::{announce, in_full};
use crate::counting::{Peak, take_turn};
use gpt::load;
use gpt::scene::{Geometry, Shape};

/// A scene of as many files and triangles as a large one has: each file is read once, and no more is held than three times what the scene holds.
#[test]
fn a_scene_of_many_files_is_read_in_a_few_times_its_memory() {
    let (files, across) = if in_full("2 million triangles in 439 files") { (439, 48) } else { (40, 48) };
    let folder = tempfile::tempdir().expect("the system has a folder for temporary files");
    let mut scene = r#"<scene version="3.0.0"><sensor type="perspective"/>"#.to_owned();
    for number in 0..files {
        let name = format!("{number}.ply");
        std::fs::write(folder.path().join(&name), lattice(across, number)).expect("the folder can be written to");
        scene += &format!(r#"<shape type="ply"><string name="filename" value="{name}"/><bsdf type="diffuse"/></shape>"#);
    }
    std::fs::write(folder.path().join("a.xml"), scene + "</scene>").expect("the folder can be written to");
    let _turn = take_turn();
    let (peak, start) = (Peak::from_now(), Instant::now());
    let scene = load::load(folder.path().join("a.xml").to_str()).unwrap_or_else(|error| panic!("{error}"));
    let (took, most, kept) = (start.elapsed(), peak.bytes(), peak.bytes_now());
    let triangles: usize = scene.shapes.iter().map(triangles_of).sum();
    assert_eq!(triangles, files * across * across * 2);
    let mebibytes = |bytes: usize| bytes as f64 / f64::from(1 << 20);
    announce(&format!(
        "{triangles} triangles in {files} files: {took:.1?}, {:.1} MiB at most, {:.1} MiB kept",
        mebibytes(most),
        mebibytes(kept)
    ));
    assert!(most <= 3 * kept, "{:.1} MiB for a scene of {:.1} MiB", mebibytes(most), mebibytes(kept));
}

fn triangles_of(shape: &Shape) -> usize {
    match &shape.geometry {
        Geometry::Mesh(mesh) => mesh.faces.len(),
        _ => 0,
    }
}

/// A binary PLY of a bumpy square of so many quads across, each two triangles.
fn lattice(across: usize, number: usize) -> Vec<u8> {
    let points = across + 1;
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        points * points,
        across * across * 2
    )
    .into_bytes();
    for index in 0..points * points {
        let (x, y) = ((index % points) as f32, (index / points) as f32);
        let place = [x + 50.0 * number as f32, y, (x * 0.7).sin() * (y * 0.9).cos()];
        place.into_iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    }
    for quad in 0..across * across {
        let first = quad / across * points + quad % across;
        for corners in [[first, first + 1, first + points + 1], [first, first + points + 1, first + points]] {
            bytes.push(3);
            corners.into_iter().for_each(|corner| bytes.extend((corner as i32).to_le_bytes()));
        }
    }
    bytes
}
