//! Files with bytes changed at random are read or refused; nothing panics and nothing hangs. `GPT_FUZZ=100000` makes that many of each kind.

use std::panic::catch_unwind;
use std::time::{Duration, Instant};

use super::Folder;
use super::gltf::File;

const NORMALLY: usize = 150;

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

fn try_many(name: &str, whole: &[u8], others: &[(&str, &[u8])]) {
    let count = std::env::var("GPT_FUZZ").ok().and_then(|text| text.parse().ok()).unwrap_or(NORMALLY);
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
        let result = catch_unwind(|| folder.load(&name.replace("b.serialized", "a.xml")).map(|_| ()));
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
    try_many("a.gltf", &File::new().text(), &[]);
}

#[test]
fn damaged_binary_gltf() {
    try_many("a.glb", &File::new().binary(), &[]);
}

#[test]
fn damaged_mitsuba_scenes() {
    let scene = r#"<scene version="3.0.0"><default name="r" value="1"/><integrator type="path"><integer name="max_depth" value="4"/></integrator>
        <sensor type="thinlens"><float name="fov" value="40"/><float name="aperture_radius" value="0.1"/><float name="focus_distance" value="4"/>
        <transform name="to_world"><lookat origin="0,0,4" target="0,0,0" up="0,1,0"/></transform><film type="hdrfilm"/></sensor>
        <bsdf type="mask" id="m"><float name="opacity" value="0.5"/><bsdf type="roughconductor"><string name="material" value="W"/></bsdf></bsdf>
        <shape type="sphere"><float name="radius" value="$r"/><ref id="m"/></shape>
        <shape type="cylinder"><bsdf type="plastic"><spectrum name="diffuse_reflectance" value="400:0.1, 600:0.5"/></bsdf></shape>
        <emitter type="spot"/></scene>"#;
    try_many("a.xml", scene.as_bytes(), &[]);
}
