//! Surfaces seen from behind, outlines, hidden nodes, and nodes that leave no volume.

use gpt::Render;

use super::*;

/// A square from −1 to 1 that faces +Z, a cube from −1 to 1 that faces outward, and both in other sizes and turned inside out; of one material.
fn solids(material: Value) -> File {
    let mut file = File::new();
    let square =
        file.add("VEC3", &[-1.0, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.0]);
    let turned =
        file.add("VEC3", &[-1.0, -1.0, 0.0, 1.0, 1.0, 0.0, 1.0, -1.0, 0.0, -1.0, -1.0, 0.0, -1.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    let mut faces: Vec<[f32; 3]> = Vec::new();
    for axis in 0..3 {
        for sign in [-1.0_f32, 1.0] {
            let corner = |a: f32, b: f32| {
                let mut at = [0.0; 3];
                (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (sign, sign * a, b);
                at
            };
            let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            faces.extend([a, b, c, a, c, d]);
        }
    }
    let cube = file.add("VEC3", &faces.concat());
    let inverted: Vec<f32> =
        faces.chunks(3).flat_map(|face| [face[0], face[2], face[1]].concat()).map(|number| 1.3 * number).collect();
    let hull = file.add("VEC3", &inverted);
    let mesh = |position: usize, material: usize| json!({ "primitives": [{ "attributes": { "POSITION": position }, "material": material }] });
    file.root["meshes"] = json!([mesh(square, 0), mesh(turned, 0), mesh(cube, 1), mesh(hull, 0)]);
    let grey = json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.5, 0.5, 1.0], "metallicFactor": 0.0 },
        "extensions": { "KHR_materials_specular": { "specularFactor": 0.0 } } });
    file.root["materials"] = json!([material, grey]);
    file
}

/// A diffuse material that reflects so much.
fn diffuse(reflectance: f64, double_sided: bool) -> Value {
    json!({ "pbrMetallicRoughness": { "baseColorFactor": [reflectance, reflectance, reflectance, 1.0], "metallicFactor": 0.0 },
        "extensions": { "KHR_materials_specular": { "specularFactor": 0.0 } }, "doubleSided": double_sided })
}

/// The mean of each pixel of a row through the middle of the picture of an import under a sky of 1, from z = 6.
fn row_of(file: &File, nodes: Value, extra: &str) -> Vec<f64> {
    let mut file = File { root: file.root.clone(), data: file.data.clone() };
    file.root["nodes"] = nodes;
    let all: Vec<usize> = (0..file.root["nodes"].as_array().expect("nodes").len()).collect();
    file.root["scenes"] = json!([{ "nodes": all }]);
    let text = format!(
        "film.size = [9, 9]\nrender.spp = 64\ncamera = {{ position = [0, 0, 6], look_at = [0, 0, 0], vfov = 34 }}\n\
         import = [{{ file = \"a.glb\" }}]\n{extra}\n"
    );
    let light = if extra.contains("[[light]]") { "" } else { "[[light]]\ntype = \"environment\"\nradiance = 1\n" };
    let text = text + light;
    let scene = Folder::new(&[("a.glb", &file.binary()), ("scene.toml", text.as_bytes())]).valid("scene.toml");
    let options = gpt::RenderOptions { device: gpt::DeviceChoice::Cpu, ..gpt::RenderOptions::default() };
    let image = scene.render(&options).unwrap_or_else(|error| panic!("{error}"));
    let pixels = image.pixels();
    (0..9).map(|x| f64::from(pixels[4 * 9 + x].iter().sum::<f32>()) / 3.0).collect()
}

/// The back of what is not double-sided is not there: the sky of 1 is seen through it.
#[test]
fn backs_of_one_sided_materials_are_not_there() {
    for (double_sided, from_behind) in [(false, 1.0), (true, 0.0)] {
        let file = solids(diffuse(0.0, double_sided));
        for (mesh, expected) in [(0, 0.0), (1, from_behind)] {
            let row = row_of(&file, json!([{ "mesh": mesh }]), "");
            assert!((row[4] - expected).abs() < 1e-6, "double-sided {double_sided}, mesh {mesh}: {row:?}");
        }
        // A mirroring node turns the corners' order and not the front.
        let row = row_of(&file, json!([{ "mesh": 0, "scale": [-1.0, 1.0, 1.0] }]), "");
        assert!(row[4].abs() < 1e-6, "mirrored: {row:?}");
        let row = row_of(&file, json!([{ "mesh": 0, "scale": [1.0, 1.0, -1.0] }]), "");
        assert!((row[4] - from_behind).abs() < 1e-6, "mirrored along the axis: {row:?}");
    }
}

/// Light that arrives at a front is stopped by it, and what arrives at a back is not: shadow rays meet surfaces as other rays do.
#[test]
fn shadow_rays_meet_fronts_alone() {
    let lamp = "[[light]]\ntype = \"point\"\nposition = [0, 0, 9]\nintensity = 40\n\
        [[material]]\nname = \"wall\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
        [[shape]]\ntype = \"rectangle\"\ncorner = [-9, -9, -2]\nedge_u = [18, 0, 0]\nedge_v = [0, 18, 0]\nmaterial = \"wall\"\n";
    // Both stand in the lamp's way and out of the camera's.
    let at = |mesh: usize| json!([{ "mesh": mesh, "translation": [0.0, 0.0, 8.0] }]);
    let file = solids(diffuse(0.5, false));
    // From the wall, the first shows its back and the second its front.
    let [lit, shadowed] = [0, 1].map(|mesh| row_of(&file, at(mesh), lamp)[4]);
    let expected = 0.5 / std::f64::consts::PI * 40.0 / 121.0;
    assert!((lit / expected - 1.0).abs() < 0.02 && shadowed < 1e-6, "{lit} {shadowed} {expected}");
}

/// An inverted hull shows its far side around the model, and neither hides nor darkens it.
#[test]
fn outlines_do_not_hide_their_models() {
    let model_and_hull = || json!([{ "mesh": 2 }, { "mesh": 3 }]);
    let alone = row_of(&solids(diffuse(0.0, false)), json!([{ "mesh": 2 }]), "");
    let outlined = row_of(&solids(diffuse(0.0, false)), model_and_hull(), "");
    // A convex body of 0.5 under a sky of 1.
    assert!((alone[4] - 0.5).abs() < 0.02, "{alone:?}");
    assert!((outlined[4] - alone[4]).abs() < 0.02, "{outlined:?}");
    let is_outline = |x: usize| alone[x] > 0.99 && outlined[x] < 0.5;
    assert!((0..9).any(is_outline), "{alone:?} {outlined:?}");
    // The control: both sides of the hull are there.
    let hidden = row_of(&solids(diffuse(0.0, true)), model_and_hull(), "");
    assert!(hidden[4] < 1e-6, "{hidden:?}");
    let mut file = solids(diffuse(0.0, false));
    file.root["nodes"] = json!([{ "mesh": 3 }]);
    file.root["scenes"] = json!([{ "nodes": [0] }]);
    assert!(report(&file.read()).contains("outline"), "{}", report(&file.read()));
    // Around the camera it is a room.
    file.root["nodes"] = json!([{ "mesh": 3 }, { "camera": 0 }]);
    file.root["scenes"] = json!([{ "nodes": [0, 1] }]);
    assert!(!report(&file.read()).contains("outline"), "{}", report(&file.read()));
}

/// A closed body that is filled has both sides, whatever its material says (KHR_materials_volume).
#[test]
fn filled_bodies_have_both_sides() {
    let glass = json!({ "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 0.0 }, "extensions": {
        "KHR_materials_transmission": { "transmissionFactor": 1.0 }, "KHR_materials_volume": { "thicknessFactor": 1.0 } } });
    let mut file = solids(glass.clone());
    file.root["nodes"] = json!([{ "mesh": 0 }]);
    file.root["scenes"] = json!([{ "nodes": [0] }]);
    let scene = file.read();
    assert!(matches!(scene.materials[scene.shapes[0].material].kind, MaterialKind::Principled(_)));
    // Without a volume it is a wall, which has a back.
    file.root["materials"][0]["extensions"]["KHR_materials_volume"] = json!({});
    let scene = file.read();
    assert!(matches!(scene.materials[scene.shapes[0].material].kind, MaterialKind::Blend { .. }));
}

#[test]
fn hidden_nodes_show_nothing_and_keep_their_cameras() {
    let mut file = File::new();
    let hidden = json!({ "KHR_node_visibility": { "visible": false } });
    assert_eq!((file.read().shapes.len(), file.read().lights.len()), (1, 1));
    file.root["nodes"] = json!([
        { "children": [1], "extensions": hidden },
        { "mesh": 0, "camera": 0, "extensions": { "KHR_lights_punctual": { "light": 0 }, "KHR_node_visibility": { "visible": true } } },
        { "mesh": 0, "extensions": { "KHR_lights_punctual": { "light": 0 } }, "translation": [0.0, 0.0, 1.0] },
    ]);
    file.root["scenes"] = json!([{ "nodes": [0, 2] }]);
    let scene = file.read();
    assert_eq!((scene.shapes.len(), scene.lights.len(), report(&scene)), (1, 1, String::new()));
    assert!(matches!(scene.camera.projection, Projection::Perspective { .. }));
}

/// A square whose node leaves no depth of it is the square; one without an area is left out.
#[test]
fn what_a_node_flattens_stays_where_it_has_area() {
    let file = solids(diffuse(0.0, true));
    let row =
        |scale: Value| row_of(&file, json!([{ "mesh": 0, "scale": scale }, { "mesh": 2, "translation": [0.0, 99.0, 0.0] }]), "");
    assert_eq!(row(json!([1.0, 1.0, 0.0])), row(json!([1.0, 1.0, 1.0])));
    assert!((row(json!([1.0, 0.0, 1.0]))[4] - 1.0).abs() < 1e-6);
    // A cube becomes its front and back.
    let flat = row_of(&file, json!([{ "mesh": 2, "scale": [1.0, 1.0, 0.0] }]), "");
    assert!(flat[4] > 0.4 && flat[4] < 0.6 || flat[4] < 1e-6, "{flat:?}");
}
