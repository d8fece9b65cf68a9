//! Scenes that grow: triangles, lights, leaves of a blend. And a room in which one thing at a time is changed.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3, Vec2, Vec3};

use crate::load::{SceneError, load_toml_str};
use crate::sampling::hash::mix;
use crate::scene::{ColorInput, Emission, Geometry, Group, Instances, Material, MaterialKind, Mesh, Scene, Shape, Transform};

/// Camera, floor and a ball that several of the scenes share.
const STAGE: &str = r#"
[render]
max_depth = 4
[camera]
position = [0, 2, 7]
look_at = [0, 0.6, 0]
vfov = 40
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.7
[[shape]]
type = "rectangle"
material = "white"
corner = [-6, 0, 6]
edge_u = [12, 0, 0]
edge_v = [0, 0, -12]
"#;

/// A grid of quadrilaterals, cut into two triangles each, over the unit square.
fn grid(columns: u32, rows: u32, position: impl Fn(f32, f32) -> Vec3) -> Mesh {
    let corner = |x: u32, y: u32| (x as f32 / columns as f32, y as f32 / rows as f32);
    let corners = || (0..=rows).flat_map(|y| (0..=columns).map(move |x| (x, y))).map(|(x, y)| corner(x, y));
    let faces = (0..rows)
        .flat_map(|y| (0..columns).map(move |x| y * (columns + 1) + x))
        .flat_map(|a| [[a, a + 1, a + columns + 2], [a, a + columns + 2, a + columns + 1]]);
    Mesh {
        positions: corners().map(|(u, v)| position(u, v)).collect(),
        uvs: corners().map(|(u, v)| Vec2::new(u, v)).collect(),
        faces: faces.collect(),
        ..Mesh::default()
    }
}

fn mesh_shape(mesh: Mesh, material: usize) -> Shape {
    Shape {
        label: "mesh".into(),
        geometry: Geometry::Mesh(Arc::new(mesh)),
        material,
        transform: Transform::default(),
        motion: None,
        portal: false,
        receiver: 0,
    }
}

/// Hills of about this many triangles under a sky, which fill the lower half of the picture whatever their number.
///
/// # Errors
/// None that a test would not find.
pub fn hills(triangles: u32) -> Result<Scene, SceneError> {
    let light = "[[light]]\ntype = \"sky\"\nzenith = [0.4, 0.7, 1.6]\nhorizon = [1.5, 1.4, 1.2]\nground = [0.2, 0.2, 0.15]\n";
    let mut scene = load_toml_str(&format!("{STAGE}{light}"), "hills", Path::new(""))?;
    scene.shapes.clear();
    let side = (f64::from(triangles.max(2)) / 2.0).sqrt().round().max(1.0) as u32;
    let height = |x: f32, z: f32| 0.4 * (1.3 * x).sin() * (1.7 * z).cos() + 0.1 * (5.0 * x + 2.0).sin() * (6.0 * z).sin();
    let mut mesh = grid(side, side, |u, v| {
        let (x, z) = (12.0 * u - 6.0, 6.0 - 12.0 * v);
        Vec3::new(x, height(x, z), z)
    });
    // Without coordinates the triangles need no attributes, as in most models that are measured.
    mesh.uvs.clear();
    scene.shapes.push(mesh_shape(mesh, 0));
    Ok(scene)
}

/// A panel of 10,000 triangles over a floor, of which so many emit; their power together is the same whatever their number.
///
/// # Errors
/// None that a test would not find.
pub fn panel(emitting: u32) -> Result<Scene, SceneError> {
    // A scene without light is refused, and the panel comes later.
    let light = "[[light]]\ntype = \"point\"\nposition = [0, 9, 0]\nintensity = 1\n";
    let mut scene = load_toml_str(&format!("{STAGE}{light}"), "panel", Path::new(""))?;
    scene.lights.clear();
    let first = scene.materials.len();
    let emitting = emitting.clamp(1, 10_000);
    let radiance = 20_000.0 / f64::from(emitting);
    let material = |name: &str, emission| Material {
        name: name.into(),
        kind: MaterialKind::Emissive,
        normal_map: None,
        emission,
        two_sided: true,
        interior: None,
    };
    scene.materials.push(material("dark", None));
    scene.materials.push(material("bright", Some(Emission { radiance: ColorInput::grey(radiance), two_sided: false })));
    let mut mesh = grid(100, 50, |u, v| Vec3::new(4.0 * u - 2.0, 3.0, 2.0 * v - 1.0));
    mesh.uvs.clear();
    // Emitting faces are spread over the panel, so that the shadows stay alike.
    let count = mesh.faces.len() as u64;
    let bright = |face: u64| (face * u64::from(emitting)) / count != ((face + 1) * u64::from(emitting)) / count;
    mesh.face_materials = (0..count).map(|face| first + usize::from(bright(face))).collect();
    scene.shapes.push(mesh_shape(mesh, first));
    Ok(scene)
}

/// A ball whose material is a blend of so many glossy leaves, each of its own sharpness; one leaf is no blend.
///
/// # Errors
/// None that a test would not find.
pub fn leaves(count: u32) -> Result<Scene, SceneError> {
    let count = count.max(1);
    let mut text = format!("{STAGE}[[light]]\ntype = \"environment\"\nradiance = 1\n");
    for leaf in 0..count {
        let exponent = 2.0 + f64::from(leaf);
        let _ =
            write!(text, "[[material]]\nname = \"leaf {leaf}\"\ntype = \"glossy\"\nreflectance = 0.8\nexponent = {exponent}\n");
    }
    let mut last = "leaf 0".to_owned();
    for leaf in 1..count {
        let _ = write!(
            text,
            "[[material]]\nname = \"blend {leaf}\"\ntype = \"blend\"\nmaterials = [\"{last}\", \"leaf {leaf}\"]\n\
             weight = {{ type = \"constant\", value = {} }}\n",
            f64::from(leaf) / f64::from(leaf + 1)
        );
        last = format!("blend {leaf}");
    }
    let _ = write!(text, "[[shape]]\ntype = \"sphere\"\nmaterial = \"{last}\"\ncenter = [0, 1.2, 2]\nradius = 1.2\n");
    load_toml_str(&text, "leaves", Path::new(""))
}

/// Triangles of the tree of a [`forest`].
pub const TREE_TRIANGLES: usize = 10_000;

/// So many instances of one tree of [`TREE_TRIANGLES`] on rolling ground under a sky, each of a size and a turn of its own.
///
/// # Errors
/// None that a test would not find.
pub fn forest(trees: u32) -> Result<Scene, SceneError> {
    let mut scene = load_toml_str(FOREST, "forest", Path::new(""))?;
    let height = |x: f64, z: f64| 3.0 * (0.05 * x).sin() * (0.04 * z + 1.0).cos();
    // Trees per unit of area stay as many, whatever their number.
    let side = 2.4 * f64::from(trees.max(1)).sqrt();
    let ground = grid(200, 200, |u, v| {
        let (x, z) = (1.1 * side * (f64::from(u) - 0.5), 1.1 * side * (0.5 - f64::from(v)));
        DVec3::new(x, height(x, z), z).as_vec3()
    });
    scene.shapes.push(mesh_shape(Mesh { uvs: Vec::new(), ..ground }, 0));
    scene.groups.push(Group { name: "tree".into(), shapes: vec![mesh_shape(tree(), 1)] });
    let random = |number: u32, dimension: u32| f64::from(mix(number.wrapping_mul(8).wrapping_add(dimension))) / 4_294_967_296.0;
    let columns = f64::from(trees.max(1)).sqrt().ceil() as u32;
    let step = side / f64::from(columns);
    let place = |number: u32| {
        let at = |cell: u32, dimension: u32| (f64::from(cell) + 0.8 * random(number, dimension) + 0.1) * step - 0.5 * side;
        let (x, z) = (at(number % columns, 0), at(number / columns, 1));
        let (turn, size) = (std::f64::consts::TAU * random(number, 2), 0.7 + 0.6 * random(number, 3));
        let scale = DVec3::new(size, size * (0.8 + 0.5 * random(number, 4)), size);
        DAffine3::from_scale_rotation_translation(scale, DQuat::from_rotation_y(turn), DVec3::new(x, height(x, z) - 0.1, z))
    };
    let places: Vec<DAffine3> = (0..trees).map(place).collect();
    scene.camera.position.y += height(scene.camera.position.x, scene.camera.position.z);
    scene.instances.push(Instances {
        label: "trees".into(),
        group: 0,
        places: Arc::new(places),
        transform: Transform::default(),
        material: None,
        motion: None,
        pivot: None,
        receiver: 0,
    });
    Ok(scene)
}

const FOREST: &str = r#"
[render]
max_depth = 5
[camera]
position = [0, 9, 26]
look_at = [0, 2, -10]
vfov = 45
[[material]]
name = "ground"
type = "diffuse"
reflectance = [0.22, 0.17, 0.09]
[[material]]
name = "needles"
type = "diffuse"
reflectance = [0.09, 0.19, 0.06]
[[material]]
name = "bark"
type = "diffuse"
reflectance = [0.2, 0.13, 0.08]
[[light]]
type = "sky"
zenith = [0.35, 0.6, 1.4]
horizon = [1.3, 1.25, 1.1]
ground = [0.1, 0.1, 0.08]
[[light]]
type = "directional"
direction = [-0.5, -0.7, -0.4]
irradiance = [6, 5.2, 4]
"#;

/// A spruce: a trunk of eight sides, and needles on whorls of drooping branches.
fn tree() -> Mesh {
    const SIDES: u32 = 8;
    const TRUNK_TRIANGLES: usize = 2 * SIDES as usize;
    let mut mesh = Mesh::default();
    for (height, radius) in [(0.0, 0.09), (4.0, 0.01)] {
        for side in 0..SIDES {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
            mesh.positions.push(DVec3::new(radius * cosine, height, radius * sine).as_vec3());
        }
    }
    for side in 0..SIDES {
        let next = (side + 1) % SIDES;
        mesh.faces.extend([[side, side + SIDES, next], [next, side + SIDES, next + SIDES]]);
    }
    let random = |number: usize, dimension: u32| f64::from(mix((number as u32) * 4 + dimension)) / 4_294_967_296.0;
    for needle in 0..TREE_TRIANGLES - TRUNK_TRIANGLES {
        // Along one of fourteen branches of one of sixteen whorls.
        let (whorl, branch, along) = ((needle % 16) as f64 / 16.0, (needle / 16 % 14) as f64, random(needle, 0).sqrt());
        let reach = 1.1 * (1.0 - whorl) + 0.05;
        let angle = std::f64::consts::TAU * (branch + 0.37 * whorl * 16.0) / 14.0;
        let (outward, across) = (DVec3::new(angle.cos(), 0.0, angle.sin()), DVec3::new(-angle.sin(), 0.0, angle.cos()));
        let root = DVec3::Y * (0.5 + 3.4 * whorl) + (outward - 0.45 * DVec3::Y * along) * (reach * along);
        let side = if needle % 2 == 0 { 1.0 } else { -1.0 };
        let tip =
            root + (0.5 * outward + side * across) * (0.05 + 0.11 * random(needle, 1)) - DVec3::Y * (0.09 * random(needle, 2));
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([root, tip, root + 0.035 * outward + 0.02 * DVec3::Y].map(|corner| corner.as_vec3()));
        mesh.faces.push([first, first + 1, first + 2]);
    }
    mesh.face_materials = (0..mesh.faces.len()).map(|face| if face < TRUNK_TRIANGLES { 2 } else { 1 }).collect();
    mesh
}

/// A room with two boxes and a lamp; a feature replaces one of its parts.
#[derive(Debug, Clone)]
pub struct Room {
    pub render: &'static str,
    pub film: &'static str,
    pub camera: &'static str,
    /// Keys of the material of the two boxes.
    pub material: &'static str,
    /// The larger thing in the room.
    pub object: &'static str,
    /// Whatever else: textures, materials, lights.
    pub more: &'static str,
}

impl Default for Room {
    fn default() -> Self {
        Self {
            render: "",
            film: "",
            camera: "",
            material: "type = \"diffuse\"\nreflectance = 0.6",
            object: "type = \"box\"\nmin = [-0.9, 0, -0.8]\nmax = [-0.1, 1.3, 0]\nmaterial = \"subject\"",
            more: "",
        }
    }
}

impl Room {
    /// The scene.
    ///
    /// # Errors
    /// A part that is no valid TOML.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        let Self { render, film, camera, material, object, more } = self;
        let text = format!(
            r#"
[film]
size = [256, 256]
{film}
[render]
max_depth = 6
{render}
[camera]
position = [0, 1, 4.4]
look_at = [0, 1, 0]
vfov = 36
{camera}
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.7
[[material]]
name = "red"
type = "diffuse"
reflectance = [0.6, 0.1, 0.1]
[[material]]
name = "lamp"
type = "emissive"
radiance = 12
[[material]]
name = "subject"
{material}
[[shape]]
type = "rectangle"
material = "white"
corner = [-1.3, 0, 1.3]
edge_u = [2.6, 0, 0]
edge_v = [0, 0, -2.6]
[[shape]]
type = "rectangle"
material = "white"
corner = [-1.3, 2.2, -1.3]
edge_u = [2.6, 0, 0]
edge_v = [0, 0, 2.6]
[[shape]]
type = "rectangle"
material = "white"
corner = [-1.3, 0, -1.3]
edge_u = [2.6, 0, 0]
edge_v = [0, 2.2, 0]
[[shape]]
type = "rectangle"
material = "red"
corner = [-1.3, 0, 1.3]
edge_u = [0, 0, -2.6]
edge_v = [0, 2.2, 0]
[[shape]]
type = "rectangle"
material = "white"
corner = [1.3, 0, -1.3]
edge_u = [0, 0, 2.6]
edge_v = [0, 2.2, 0]
[[shape]]
type = "rectangle"
material = "lamp"
corner = [-0.4, 2.199, -0.4]
edge_u = [0.8, 0, 0]
edge_v = [0, 0, 0.8]
[[shape]]
type = "box"
min = [0.2, 0, -0.2]
max = [0.9, 0.7, 0.5]
material = "subject"
[[shape]]
{object}
{more}
"#
        );
        load_toml_str(&text, "room", Path::new(""))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(scene: &Scene) -> usize {
        scene.shapes.iter().map(|shape| if let Geometry::Mesh(mesh) = &shape.geometry { mesh.faces.len() } else { 0 }).sum()
    }

    #[test]
    fn a_forest_stores_its_tree_once() {
        let scene = forest(50).unwrap();
        assert_eq!((scene.groups[0].triangles(), scene.instance_count()), (TREE_TRIANGLES, 50));
        assert!(scene.validate().is_ok());
        let mut mesh = tree();
        assert_eq!(mesh.drop_degenerate_faces(), 0);
    }

    #[test]
    fn scenes_have_the_size_that_is_asked_for() {
        for wanted in [1_000, 10_000, 100_000] {
            let found = triangles(&hills(wanted).unwrap()) as f64;
            assert!((found / f64::from(wanted) - 1.0).abs() < 0.05, "{found} for {wanted}");
        }
        for emitting in [1, 7, 10_000] {
            let scene = panel(emitting).unwrap();
            let Geometry::Mesh(mesh) = &scene.shapes[1].geometry else { panic!("the panel is a mesh") };
            let bright = mesh.face_materials.iter().filter(|material| **material == 2).count();
            assert_eq!(bright, emitting as usize);
        }
        for count in [1, 2, 16] {
            let blends = leaves(count).unwrap().materials.iter().filter(|material| material.is_blend()).count();
            assert_eq!(blends, count as usize - 1);
        }
        assert!(Room::default().scene().unwrap().has_light());
    }
}
