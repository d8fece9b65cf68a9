//! Mitsuba's own format of meshes, versions 3 and 4: for each mesh a header and a stream packed by zlib; in the end a table of their places.

use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use flate2::bufread::ZlibDecoder;
use glam::{Vec2, Vec3};

use crate::load::files::Files;
use crate::load::model::FARTHEST;
use crate::scene::Mesh;

const IDENTIFIER: u16 = 0x041c;
const HAS_NORMALS: u32 = 0x0001;
const HAS_UVS: u32 = 0x0002;
const HAS_COLOURS: u32 = 0x0008;
const FACE_NORMALS: u32 = 0x0010;
const DOUBLE: u32 = 0x2000;
/// Elements that are read at a time, so that a header that lies takes no memory.
const CHUNK: usize = 1 << 16;
/// Most vertices or faces of a mesh.
const MOST: u64 = 1 << 28;

/// Reads one of the file's meshes. The error says what is wrong, without the file's name.
pub fn load(files: &Files, path: &Path, index: f64) -> Result<Mesh, String> {
    let unreadable = |error: std::io::Error| format!("cannot be read: {error}");
    let mut file = files.open(path).map_err(unreadable)?;
    let length = file.seek(SeekFrom::End(0)).map_err(unreadable)?;
    let mut numbers = |at: u64, count: usize| -> Result<Vec<u8>, String> {
        let mut bytes = vec![0; count];
        file.seek(SeekFrom::Start(at)).and_then(|_| file.read_exact(&mut bytes)).map_err(|_| ends())?;
        Ok(bytes)
    };
    let version_at = |bytes: &[u8]| -> Result<u16, String> {
        let [identifier, version] = [0, 2].map(|at| u16::from_le_bytes([bytes[at], bytes[at + 1]]));
        match (identifier, version) {
            (IDENTIFIER, 3 | 4) => Ok(version),
            (IDENTIFIER, version) => Err(format!("is a serialized mesh of version {version}; 3 and 4 are read")),
            _ => Err("is no serialized mesh of Mitsuba".to_owned()),
        }
    };
    if length < 8 {
        return Err(ends());
    }
    let version = version_at(&numbers(0, 4)?)?;
    let count = u64::from(u32::from_le_bytes(numbers(length - 4, 4)?.try_into().map_err(|_| ends())?));
    let entry: u64 = if version == 4 { 8 } else { 4 };
    if index.fract() != 0.0 || index < 0.0 || index >= count as f64 {
        return Err(format!("has {count} meshes, and no mesh {index} (counted from 0)"));
    }
    let table = length.checked_sub(4 + count * entry).ok_or_else(ends)?;
    let bytes = numbers(table + index as u64 * entry, entry as usize)?;
    let mut padded = [0; 8];
    padded[..bytes.len()].copy_from_slice(&bytes);
    let start = u64::from_le_bytes(padded);
    if start >= table {
        return Err("its table of meshes points outside of the file".to_owned());
    }
    let version = version_at(&numbers(start, 4)?)?;
    file.seek(SeekFrom::Start(start + 4)).map_err(unreadable)?;
    read(&mut Stream(ZlibDecoder::new(file)), version)
}

fn ends() -> String {
    "the file ends before its last mesh".to_owned()
}

struct Stream<R>(R);

impl<R: Read> Stream<R> {
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut bytes = [0; N];
        self.0.read_exact(&mut bytes).map_err(|_| ends())?;
        Ok(bytes)
    }

    /// So many numbers in single or double precision.
    fn floats(&mut self, count: usize, double: bool) -> Result<Vec<f32>, String> {
        let mut floats = Vec::new();
        let width = if double { 8 } else { 4 };
        let mut buffer = Vec::new();
        let mut left = count;
        while left > 0 {
            let some = left.min(CHUNK);
            buffer.resize(some * width, 0);
            self.0.read_exact(&mut buffer).map_err(|_| ends())?;
            let single = |bytes: &[u8]| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            if double {
                let chunks = buffer.as_chunks::<8>().0;
                floats.extend(chunks.iter().map(|bytes| f64::from_le_bytes(*bytes) as f32));
            } else {
                floats.extend(buffer.chunks_exact(4).map(single));
            }
            left -= some;
        }
        Ok(floats)
    }
}

fn read<R: Read>(stream: &mut Stream<R>, version: u16) -> Result<Mesh, String> {
    let flags = u32::from_le_bytes(stream.bytes()?);
    if version == 4 {
        // A name that ends with 0.
        let mut length = 0;
        while stream.bytes::<1>()? != [0] {
            length += 1;
            if length > 4096 {
                return Err("the name of its mesh does not end".to_owned());
            }
        }
    }
    let vertices = u64::from_le_bytes(stream.bytes()?);
    let triangles = u64::from_le_bytes(stream.bytes()?);
    if vertices > MOST || triangles > MOST {
        return Err(format!("says it has {vertices} vertices and {triangles} triangles; at most {MOST} are read"));
    }
    // Single precision is the default, as in Mitsuba.
    let double = flags & DOUBLE != 0;
    let count = vertices as usize;
    let triples =
        |floats: Vec<f32>| -> Vec<Vec3> { floats.as_chunks::<3>().0.iter().map(|xyz| Vec3::from_array(*xyz)).collect() };
    let mut mesh = Mesh { positions: triples(stream.floats(3 * count, double)?), ..Mesh::default() };
    if mesh.positions.iter().any(|position| !position.is_finite() || position.abs().max_element() > FARTHEST) {
        return Err("has a vertex that does not stand within 1e18".to_owned());
    }
    if flags & HAS_NORMALS != 0 {
        mesh.normals = triples(stream.floats(3 * count, double)?).iter().map(|n| n.try_normalize().unwrap_or_default()).collect();
    }
    if flags & HAS_UVS != 0 {
        let floats = stream.floats(2 * count, double)?;
        mesh.uvs = floats.as_chunks::<2>().0.iter().map(|uv| Vec2::from_array(*uv)).collect();
        if mesh.uvs.iter().any(|uv| !uv.is_finite()) {
            return Err("has texture coordinates that are not finite".to_owned());
        }
    }
    if flags & HAS_COLOURS != 0 {
        stream.floats(3 * count, double)?;
    }
    let mut left = triangles as usize;
    while left > 0 {
        let some = left.min(CHUNK);
        let mut buffer = vec![0; some * 12];
        stream.0.read_exact(&mut buffer).map_err(|_| ends())?;
        for corners in buffer.as_chunks::<12>().0 {
            let corner = |at: usize| u32::from_le_bytes([corners[at], corners[at + 1], corners[at + 2], corners[at + 3]]);
            let face = [corner(0), corner(4), corner(8)];
            if let Some(index) = face.iter().find(|index| u64::from(**index) >= vertices) {
                return Err(format!("a face uses vertex {index}, but there are only {vertices} (counted from 0)"));
            }
            mesh.faces.push(face);
        }
        left -= some;
    }
    if flags & FACE_NORMALS != 0 {
        mesh.normals.clear();
    }
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    const SINGLE: u32 = 0x1000;

    /// Two meshes: a triangle of single and one of double precision.
    pub fn example(version: u16) -> Vec<u8> {
        example_of(version, SINGLE)
    }

    /// An example with a flag of single precision.
    fn example_of(version: u16, single: u32) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut places = Vec::new();
        for double in [false, true] {
            places.push(bytes.len() as u64);
            bytes.extend(IDENTIFIER.to_le_bytes());
            bytes.extend(version.to_le_bytes());
            let mut body = Vec::new();
            body.extend((HAS_UVS | if double { DOUBLE } else { single }).to_le_bytes());
            if version == 4 {
                body.extend(b"name\0");
            }
            body.extend(3_u64.to_le_bytes());
            body.extend(1_u64.to_le_bytes());
            for number in [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5_f64] {
                if double { body.extend(number.to_le_bytes()) } else { body.extend((number as f32).to_le_bytes()) }
            }
            [0_u32, 1, 2].iter().for_each(|corner| body.extend(corner.to_le_bytes()));
            let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
            packed.write_all(&body).unwrap();
            bytes.extend(packed.finish().unwrap());
        }
        for place in places {
            if version == 4 { bytes.extend(place.to_le_bytes()) } else { bytes.extend((place as u32).to_le_bytes()) }
        }
        bytes.extend(2_u32.to_le_bytes());
        bytes
    }

    fn load_bytes(bytes: &[u8], index: f64) -> Result<Mesh, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.serialized");
        std::fs::write(&path, bytes).unwrap();
        load(&Files::default(), &path, index)
    }

    #[test]
    fn both_versions_and_precisions_are_read() {
        // Some exporters write no flag of single precision.
        for (version, single) in [(3, SINGLE), (4, SINGLE), (3, 0), (4, 0)] {
            for index in [0.0, 1.0] {
                let mesh = load_bytes(&example_of(version, single), index).unwrap();
                assert_eq!((mesh.positions[1], mesh.uvs[2], mesh.faces[0]), (Vec3::X, Vec2::new(0.0, 0.5), [0, 1, 2]));
            }
            assert!(load_bytes(&example_of(version, single), 2.0).unwrap_err().contains("2 meshes"));
        }
    }

    #[test]
    fn every_file_that_ends_early_is_refused() {
        let bytes = example(4);
        for length in 0..bytes.len() {
            assert!(load_bytes(&bytes[..length], 0.0).is_err(), "{length}");
        }
        assert!(load_bytes(b"PK\x03\x04 not a mesh at all", 0.0).unwrap_err().contains("no serialized mesh"));
    }
}
