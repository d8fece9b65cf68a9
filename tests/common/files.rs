//! Files that tests of scenes write for themselves.

use std::io::Cursor;

use tempfile::TempDir;

/// An OBJ file of one triangle without uvs and normals.
pub const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A folder, removed in the end, with these files.
pub fn folder_with(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().expect("the system has a folder for temporary files");
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).expect("a new folder can be written to");
    }
    folder
}

/// A PNG of 2 × 1 pixels: the colour, then black.
pub fn png_bytes(colour: [u8; 3]) -> Vec<u8> {
    let mut image = image::RgbImage::new(2, 1);
    image.put_pixel(0, 0, image::Rgb(colour));
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("memory can be written to");
    bytes.into_inner()
}
