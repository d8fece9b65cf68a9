//! Files with bytes changed at random are read or refused; nothing panics and nothing hangs. The long form (`scripts/test --all`) makes 100,000 of
//! each kind, and `GPT_FUZZ=N` makes N.

use std::panic::catch_unwind;
use std::time::{Duration, Instant};

use super::Folder;
use super::gltf::File;
use super::mitsuba::PAINTED;
use crate::common::effort::in_full;

const NORMALLY: usize = 150;
const IN_FULL: usize = 100_000;

/// Xorshift (Marsaglia 2003).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % bound.max(1) as u64) as usize
    }
}

fn damage(bytes: &mut Vec<u8>, random: &mut Random) {
    const PIECES: [&[u8]; 8] = [b"-1", b"1e300", b"nan", b"\"", b"<", b"99999999999", b"null", b"$x"];
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(5) {
            0 => bytes.truncate(at),
            1 => {
                let piece = PIECES[random.below(PIECES.len())];
                bytes.splice(at..at, piece.iter().copied());
            }
            2 => {
                let end = (at + random.below(20)).min(bytes.len());
                bytes.drain(at..end);
            }
            _ => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte ^= 1 << random.below(8);
                }
            }
        }
    }
}

/// Damages the file `name` and loads `scene`, which is that file or names it.
fn try_many(name: &str, whole: &[u8], others: &[(&str, &[u8])], scene: &str) {
    let normally = if in_full("most damaged files") { IN_FULL } else { NORMALLY };
    let count = std::env::var("GPT_FUZZ").ok().and_then(|text| text.parse().ok()).unwrap_or(normally);
    let folder = Folder::new(others);
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut read, mut slowest) = (0, Duration::ZERO);
    for round in 0..count {
        let mut bytes = whole.to_vec();
        if round > 0 {
            damage(&mut bytes, &mut random);
        }
        std::fs::write(folder.path(name), &bytes).expect("it is written");
        let start = Instant::now();
        let result = catch_unwind(|| folder.load(scene).map(|_| ()));
        slowest = slowest.max(start.elapsed());
        match result {
            Ok(Ok(())) => read += 1,
            Ok(Err(error)) => assert!(!error.to_string().is_empty()),
            Err(_) => {
                let kept = std::env::temp_dir().join(format!("gpt-fuzz-{round}-{name}"));
                std::fs::write(&kept, &bytes).expect("it is written");
                panic!("round {round} of {name} panicked: {}", kept.display());
            }
        }
    }
    assert!(slowest < Duration::from_secs(20), "{name}: {slowest:?}");
    // Some stay as they mean, and the first is whole.
    assert!(read > 0 && (count == 1 || read < count), "{name}: {read} of {count}");
}

#[test]
fn damaged_gltf() {
    let mut file = File::new();
    file.paint();
    try_many("a.gltf", &file.text(), &[], "a.gltf");
}

#[test]
fn damaged_binary_gltf() {
    try_many("a.glb", &File::new().binary(), &[], "a.glb");
}

#[test]
fn damaged_mitsuba_scenes() {
    let scene = r#"<scene version="3.0.0"><default name="r" value="1"/><integrator type="path"><integer name="max_depth" value="4"/></integrator>
        <sensor type="thinlens"><float name="fov" value="40"/><float name="aperture_radius" value="0.1"/><float name="focus_distance" value="4"/>
        <transform name="to_world"><lookat origin="0,0,4" target="0,0,0" up="0,1,0"/></transform><film type="hdrfilm"/></sensor>
        <bsdf type="mask" id="m"><float name="opacity" value="0.5"/><bsdf type="roughconductor"><string name="material" value="W"/></bsdf></bsdf>
        <shape type="sphere"><float name="radius" value="$r"/><ref id="m"/></shape>
        <shape type="cylinder"><bsdf type="plastic"><spectrum name="diffuse_reflectance" value="400:0.1, 600:0.5"/></bsdf></shape>
        <bsdf type="bumpmap" id="bumps"><texture type="checkerboard"/><float name="scale" value="0.1"/><bsdf type="diffuse"/></bsdf>
        <shape type="rectangle"><ref id="bumps"/></shape>
        <emitter type="spot"><texture name="texture" type="checkerboard"/></emitter>
        <emitter type="projector"><texture name="irradiance" type="checkerboard"/><float name="fov" value="30"/></emitter></scene>"#;
    try_many("a.xml", scene.as_bytes(), &[], "a.xml");
}

const PAINTED_SCENE: &str = r#"<scene version="3.0.0"><shape type="ply"><string name="filename" value="b.ply"/><bsdf type="diffuse">
    <texture name="reflectance" type="mesh_attribute"><string name="name" value="vertex_color"/></texture></bsdf></shape></scene>"#;

#[test]
fn damaged_ply_models() {
    try_many("b.ply", PAINTED.as_bytes(), &[("a.xml", PAINTED_SCENE.as_bytes())], "a.xml");
}

#[test]
fn damaged_models_and_their_materials() {
    let model = "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/1/1\n";
    let materials =
        "newmtl m\nKd 0.5 0.4 0.3\nPr 0.4\nPm 0.7\nPc 0.2\nPcr 0.1\naniso 0.5\nanisor 0.2\nNi 1.4\nd 0.9\nillum 2\nKe 1 0 0\n";
    try_many("a.obj", model.as_bytes(), &[("b.mtl", materials.as_bytes())], "a.obj");
    try_many("b.mtl", materials.as_bytes(), &[("a.obj", model.as_bytes())], "a.obj");
}
