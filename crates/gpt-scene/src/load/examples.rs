//! A scene of the examples of every material, shape and light, so that a new kind is in a built-in scene with no other edit.

use std::fmt::Write;
use std::path::Path;

use super::file::{EXAMPLE_PARTS, light_examples_of, material_examples, shape_examples};
use super::scene_file::load_toml_str;

/// Spheres in a row; they stand this far apart.
const ROW: usize = 8;
const SPACING: f64 = 1.15;
/// Distance between the shapes, which stand behind the spheres.
const SHAPE_SPACING: f64 = 1.5;

const STAGE: &str = r#"# Every example of a material on a sphere, of a shape as a surface and as a light, and of a light that shines from a point or in a direction.

[film]
size = [480, 320]

[render]
max_depth = 8

[camera]
position = [0, 6.5, 11]
look_at  = [0, 0.3, -0.6]
vfov     = 36
shutter  = [0, 1]

[[material]]
name = "floor"
type = "diffuse"
reflectance = [0.4, 0.45, 0.5]

[[material]]
name = "surface"
type = "diffuse"
reflectance = [0.8, 0.5, 0.2]

[[material]]
name = "light"
type = "diffuse"
reflectance = [0.4, 0.45, 0.5]
emission = [3, 2.4, 1.8]

[[shape]]
type = "rectangle"
corner = [-9, 0, 9]
edge_u = [18, 0, 0]
edge_v = [0, 0, -18]
material = "floor"
"#;

/// The scene file.
pub fn scene() -> String {
    let mut text = format!("{STAGE}{EXAMPLE_PARTS}");
    // A string takes all that is written. Stacks of layers have a scene of their own, `paints`: beside blends, drivers that copy a function to each of
    // its calls compile their kernel for minutes.
    let materials = material_examples().filter(|(name, _)| name.split_once(' ').map_or(*name, |(kind, _)| kind) != "layered");
    for (place, (_, keys)) in materials.enumerate() {
        let (column, row) = ((place % ROW) as f64, (place / ROW) as f64);
        let center = [(column - 0.5 * (ROW - 1) as f64) * SPACING, 3.4 - row * SPACING];
        let _ = write!(text, "\n[[material]]\nname = \"{place}\"\n{keys}");
        let [x, z] = center;
        let _ =
            write!(text, "\n[[shape]]\ntype = \"sphere\"\ncenter = [{x}, 0.46, {z}]\nradius = 0.45\nmaterial = \"{place}\"\n");
    }
    let count = shape_examples().count();
    for (place, (_, keys)) in shape_examples().enumerate() {
        let x = (place as f64 - 0.5 * (count - 1) as f64) * SHAPE_SPACING;
        // Infinite shapes are seen beyond the ground.
        let places: &[_] =
            if is_infinite(&keys) { &[("surface", -1.5, -12.0)] } else { &[("surface", 0.6, -3.5), ("light", 2.2, -4.5)] };
        for (material, y, z) in places {
            let placed = format!("transform = [{{ scale = 0.5 }}, {{ translate = [{x}, {y}, {z}] }}]");
            let _ = write!(text, "\n{keys}material = \"{material}\"\n{placed}\n");
        }
    }
    // A scene has one light from outside it: those have scenes of their own.
    for (_, keys) in light_examples_of("delta") {
        let _ = write!(text, "\n{keys}");
    }
    text
}

fn is_infinite(shape: &str) -> bool {
    let text = format!(
        "camera = {{ position = [0, 0, 1], look_at = [0, 0, 0], vfov = 40 }}\n[[material]]\nname = \"m\"\ntype = \"emissive\"\nradiance = 1\n\
         {shape}material = \"m\"\n"
    );
    let scene = load_toml_str(&text, "example", Path::new(""));
    scene.is_ok_and(|scene| scene.shapes.iter().any(|shape| shape.geometry.is_infinite()))
}
