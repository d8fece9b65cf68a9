//! Shapes, transforms, objects and media.

use glam::DVec3;

use super::{Folder, SCENE, report, valid, whole};
use crate::scene::{Geometry, MaterialKind, Mesh, Scene, Shape};

fn last(scene: &Scene) -> &Shape {
    scene.shapes.last().expect("a shape")
}

fn mesh(shape: &Shape) -> &Mesh {
    match &shape.geometry {
        Geometry::Mesh(mesh) => mesh,
        other => panic!("{}", other.kind_name()),
    }
}

#[test]
fn transforms_apply_to_what_follows() {
    let at = |text: &str| last(&valid(text)).transform.to_affine();
    let ball = "Shape \"sphere\"";
    // The last one written is the first one applied.
    let moved = at(&format!("Translate 1 2 3\nScale 2 2 2\n{ball}"));
    assert_eq!(moved.transform_point3(DVec3::X), DVec3::new(3.0, 2.0, 3.0));
    let turned = at(&format!("Rotate 90 0 0 1\nTranslate 1 0 0\n{ball}"));
    assert!(turned.translation.distance(DVec3::Y) < 1e-12);
    let matrix = at(&format!(
        "Translate 9 9 9\nTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1 ]\nConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1 ]\n{ball}"
    ));
    assert_eq!(matrix.translation, DVec3::new(5.0, 5.0, 6.0));
    let named = at(&format!("Translate 1 0 0\nCoordinateSystem \"a\"\nIdentity\nScale 3 3 3\nCoordSysTransform \"a\"\n{ball}"));
    assert_eq!(named.translation, DVec3::X);
    let camera = at(&format!("CoordSysTransform \"camera\"\n{ball}"));
    assert!(camera.translation.distance(DVec3::new(0.0, 0.0, 4.0)) < 1e-12);
    let restored =
        at(&format!("AttributeBegin\nTranslate 1 0 0\nAttributeEnd\nTransformBegin\nScale 2 2 2\nTransformEnd\n{ball}"));
    assert_eq!(restored, glam::DAffine3::IDENTITY);
}

#[test]
fn attributes_are_those_of_what_follows() {
    let scene = valid(
        "Attribute \"shape\" \"float radius\" 3\nShape \"sphere\"\nAttributeBegin\nAttribute \"shape\" \"float radius\" 2\nShape \"sphere\"\n\
         Shape \"sphere\" \"float radius\" 1\nAttributeEnd\nShape \"sphere\"",
    );
    let radius = |shape: &Shape| if let Geometry::Sphere(sphere) = &shape.geometry { sphere.radius } else { 0.0 };
    assert_eq!(scene.shapes.iter().map(radius).collect::<Vec<_>>(), [3.0, 2.0, 1.0, 3.0]);
}

#[test]
fn round_shapes_stay_round_where_they_can() {
    let kind = |text: &str| {
        let scene = valid(text);
        (last(&scene).geometry.kind_name(), report(&scene))
    };
    let light = "AreaLightSource \"diffuse\"\n";
    for (text, expected, words) in [
        ("Shape \"sphere\"", "sphere", ""),
        ("Shape \"disk\" \"float height\" 2", "disk", ""),
        ("Shape \"cylinder\"", "cylinder", ""),
        ("Scale 2 2 2\nShape \"sphere\"", "sphere", ""),
        ("Scale 2 2 1\nShape \"sphere\"", "mesh", "scaled unevenly"),
        ("Shape \"sphere\" \"float zmin\" 0", "mesh", "in part"),
        ("Shape \"cylinder\" \"float phimax\" 180", "mesh", "in part"),
        ("Shape \"disk\" \"float innerradius\" 0.5", "mesh", "in part"),
        // Nobody sees that a front is turned, but where light leaves it.
        ("ReverseOrientation\nShape \"sphere\"", "sphere", ""),
        (&format!("{light}ReverseOrientation\nShape \"sphere\""), "mesh", "turned inside out"),
        (&format!("{light}Scale -1 1 1\nShape \"sphere\""), "mesh", "turned inside out"),
        (&format!("{light}ReverseOrientation\nScale -1 1 1\nShape \"sphere\""), "sphere", ""),
        (&format!("{light}ReverseOrientation\nShape \"disk\""), "disk", ""),
    ] {
        let (found, said) = kind(text);
        assert!(found == expected && said.contains(words) && (said.is_empty() == words.is_empty()), "{text}: {found} {said}");
    }
    // Spheres of triangles face outward, those turned inside out inward.
    for (text, sign) in
        [("Shape \"sphere\" \"float zmax\" 0.9", 1.0), ("Material \"dielectric\"\nReverseOrientation\nShape \"sphere\"", -1.0)]
    {
        let scene = valid(text);
        let mesh = mesh(last(&scene));
        for face in &mesh.faces {
            let middle: DVec3 = face.iter().map(|corner| mesh.positions[*corner as usize].as_dvec3()).sum();
            let normal = mesh.face_normal(*face).expect("it has area");
            assert!(sign * normal.dot(middle) > 0.0, "{text}");
        }
    }
    let scene = valid("ReverseOrientation\nAreaLightSource \"diffuse\"\nShape \"disk\" \"float radius\" 2");
    let Geometry::Disk(disk) = &last(&scene).geometry else { panic!("a disk") };
    assert_eq!((disk.normal, disk.radius), (DVec3::NEG_Z, 2.0));
}

/// There u turns from +x over +y, and v goes from the lower pole to the upper one: both here, and on the triangles that stand for a part.
#[test]
fn textures_lie_on_spheres_as_there() {
    let tiles = "Texture \"t\" \"spectrum\" \"checkerboard\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n";
    let ball = valid(&format!("{tiles}Shape \"sphere\" \"float radius\" 2"));
    let map = last(&ball).transform.to_affine();
    // Texture coordinates turn from −z over +x here, and +y is up.
    for (here, there) in [(DVec3::NEG_Z, DVec3::X), (DVec3::X, DVec3::Y), (DVec3::Y, DVec3::Z)] {
        assert!(map.transform_vector3(here).distance(there) < 1e-12, "{here}");
    }
    let part = valid(&format!("{tiles}Shape \"sphere\" \"float radius\" 2 \"float zmax\" 1.999999"));
    let shape = last(&part);
    let (mesh, map) = (mesh(shape), shape.transform.to_affine());
    for (at, uv) in mesh.positions.iter().zip(&mesh.uvs) {
        let at = map.transform_point3(at.as_dvec3()) / 2.0;
        let turn = (at.y.atan2(at.x) / std::f64::consts::TAU).rem_euclid(1.0);
        let v = 1.0 - at.z.clamp(-1.0, 1.0).acos() / std::f64::consts::PI;
        let is_seam = uv.x < 1e-6 || uv.x > 1.0 - 1e-6 || uv.y < 1e-3 || uv.y > 1.0 - 1e-3;
        assert!(is_seam || (turn - f64::from(uv.x)).abs() < 1e-5, "{at} {uv}");
        assert!((v - f64::from(uv.y)).abs() < 2e-3, "{at} {uv}");
    }
}

const TRIANGLE: &str = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]";

fn front(scene: &Scene) -> DVec3 {
    let mesh = mesh(last(scene));
    mesh.face_normal(mesh.faces[0]).expect("it has area")
}

#[test]
fn fronts_of_triangles_are_where_their_normals_point() {
    let light = "AreaLightSource \"diffuse\"\n";
    let down = " \"normal N\" [ 0 0 -1 0 0 -1 0 0 -1 ]";
    for (text, z) in [
        (TRIANGLE.to_owned(), 1.0),
        (format!("ReverseOrientation\n{TRIANGLE}"), -1.0),
        (format!("{TRIANGLE}{down}"), -1.0),
        (format!("ReverseOrientation\n{TRIANGLE}{down}"), 1.0),
        (format!("{light}Scale -1 1 1\n{TRIANGLE}"), 1.0),
    ] {
        let scene = valid(&text);
        assert_eq!(front(&scene), DVec3::Z * z, "{text}");
        let mesh = mesh(last(&scene));
        assert!(mesh.normals.iter().all(|normal| f64::from(normal.z) == z), "{text}");
    }
}

#[test]
fn triangles_have_texture_coordinates_where_they_need_some() {
    let tiles = "Texture \"t\" \"spectrum\" \"checkerboard\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n";
    let uvs = |text: &str| mesh(last(&valid(text))).uvs.iter().map(|uv| uv.to_array()).collect::<Vec<_>>();
    assert!(uvs(TRIANGLE).is_empty());
    assert_eq!(uvs(&format!("{tiles}{TRIANGLE}")), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
    assert_eq!(uvs(&format!("{tiles}{TRIANGLE} \"point2 uv\" [ 0 0 .5 0 0 .5 ]")), [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]]);
    let scene = valid(&format!("{TRIANGLE} \"normal N\" [ 0 0 1 ]"));
    assert!(report(&scene).contains("`N` of another number") && mesh(last(&scene)).normals.is_empty());
}

#[test]
fn meshes_of_files_are_read_once() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
               property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
    let shape = "Shape \"plymesh\" \"string filename\" \"a.ply\"\n";
    let more = format!("{shape}Translate 2 0 0\n{shape}ReverseOrientation\n{shape}");
    let folder = Folder::new(&[("a.pbrt", SCENE.replace("MORE", &more).as_bytes()), ("a.ply", ply.as_bytes())]);
    let scene = folder.valid("a.pbrt");
    let [first, second, third] = &scene.shapes[..] else { panic!("three shapes") };
    let address = |shape: &Shape| std::ptr::from_ref(mesh(shape));
    assert!(address(first) == address(second) && address(first) != address(third));
    assert_eq!((mesh(first).faces.len(), report(&scene).as_str()), (2, ""));
}

#[test]
fn patches_and_subdivided_meshes_are_triangles() {
    let patch = |places: &str| {
        let scene = valid(&format!("Shape \"bilinearmesh\" \"point3 P\" [ {places} ]"));
        (mesh(last(&scene)).faces.len(), report(&scene))
    };
    assert_eq!(patch("0 0 0 1 0 0 0 1 0 1 1 0"), (2, String::new()));
    let (faces, said) = patch("0 0 0 1 0 0 0 1 0 1 1 1");
    assert!(faces == 512 && said.contains("512 triangles each"), "{faces} {said}");
    let scene = valid("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]");
    assert_eq!(front(&scene), DVec3::Z);
    let corners = "\"point3 P\" [ 1 0 0 0 1 0 -1 0 0 0 -1 0 0 0 1 0 0 -1 ]";
    let faces = "\"integer indices\" [ 0 1 4 1 2 4 2 3 4 3 0 4 1 0 5 2 1 5 3 2 5 0 3 5 ]";
    let scene = valid(&format!("Shape \"loopsubdiv\" {corners} {faces} \"integer levels\" 2"));
    assert_eq!((mesh(last(&scene)).faces.len(), report(&scene).as_str()), (128, ""));
    let ball = mesh(last(&scene));
    assert!(ball.faces.iter().all(|face| {
        let middle: DVec3 = face.iter().map(|corner| ball.positions[*corner as usize].as_dvec3()).sum();
        ball.face_normal(*face).is_some_and(|normal| normal.dot(middle) > 0.0)
    }));
}

#[test]
fn objects_are_stored_once_where_that_pays() {
    let grid: String = (0..32).map(|i| format!("{} 0 0 {} 1 0 ", i, i)).collect();
    let faces: String =
        (0..31).map(|i| format!("{} {} {} {} {} {} ", 2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 2, 2 * i + 3, 2 * i + 1)).collect();
    let strip = format!("Shape \"trianglemesh\" \"point3 P\" [ {grid} ] \"integer indices\" [ {faces} ]\n");
    let object = |shapes: &str| format!("ObjectBegin \"o\"\nTranslate 0 1 0\n{shapes}ObjectEnd\n");
    let places: String =
        (0..30).map(|i| format!("AttributeBegin\nTranslate 0 0 {i}\nObjectInstance \"o\"\nAttributeEnd\n")).collect();
    let scene = valid(&format!("{}{places}", object(&strip)));
    let [instances] = &scene.instances[..] else { panic!("{}", scene.instances.len()) };
    let maps: Vec<_> = instances.maps().collect();
    assert!(scene.shapes.is_empty() && maps.len() == 30 && maps[7].translation == DVec3::new(0.0, 0.0, 7.0));
    assert_eq!(scene.groups[0].shapes[0].transform.to_affine().translation, DVec3::Y);
    // A ball is copied, unless there are very many.
    let few = valid(&format!("{}{places}", object("Shape \"sphere\"\n")));
    assert!(few.instances.is_empty() && few.shapes.len() == 30);
    assert_eq!(few.shapes[7].transform.to_affine().translation, DVec3::new(0.0, 1.0, 7.0));
    let many = valid(&format!("{}{}", object("Shape \"sphere\"\n"), places.repeat(4)));
    assert!(many.shapes.is_empty() && report(&many).contains("object with many instances"), "{}", report(&many));
    let lamp = valid(&format!("{}ObjectInstance \"o\"", object("AreaLightSource \"diffuse\"\nShape \"sphere\"\n")));
    assert!(
        report(&lamp).contains("within an object x1: it gives no light")
            && lamp.materials.iter().all(|one| one.emission.is_none())
    );
}

const FOG: &str = "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ .1 .2 .3 ] \"rgb sigma_s\" [ 1 2 3 ] \"float scale\" 2\n";

fn interior(scene: &Scene, shape: &Shape) -> Option<String> {
    scene.materials[shape.material].interior.map(|medium| scene.media[medium].name.clone())
}

#[test]
fn media_fill_the_bodies_that_name_them() {
    let scene = valid(&format!("{FOG}MediumInterface \"fog\" \"\"\nMaterial \"interface\"\nShape \"sphere\""));
    assert_eq!((interior(&scene, last(&scene)).as_deref(), report(&scene).as_str()), (Some("fog"), ""));
    let fog = &scene.media[0];
    assert_eq!((fog.absorption.to_rgb(), fog.scattering.to_rgb()), ([0.2, 0.4, 0.6], [2.0, 4.0, 6.0]));
    // A body that light does not go through is not filled with nothing.
    let wall = valid(&format!("{FOG}MediumInterface \"\" \"fog\"\nShape \"sphere\""));
    assert_eq!(interior(&wall, last(&wall)), None);
    assert!(report(&wall).contains("exterior medium of a shape"), "{}", report(&wall));
    // The camera is in fog, of which glass is filled too unless it says that nothing is in it.
    let around = |more: &str| {
        let scene = SCENE.replace("Camera", &format!("{FOG}MediumInterface \"\" \"fog\"\nCamera"));
        whole(&scene.replace("MORE", more))
    };
    let glass = around("MediumInterface \"\" \"\"\nMaterial \"dielectric\"\nShape \"sphere\"");
    assert_eq!((glass.camera_medium, interior(&glass, last(&glass)).as_deref()), (Some(0), Some("fog")));
    let hollow = around("Material \"dielectric\"\nShape \"sphere\"");
    assert_eq!(interior(&hollow, last(&hollow)).as_deref(), Some("(empty)"));
    assert_eq!(report(&hollow), "");
    // An integrator that knows no media leaves them out.
    let text = SCENE
        .replace("volpath", "path")
        .replace("MORE", &format!("{FOG}MediumInterface \"fog\" \"\"\nMaterial \"interface\"\nShape \"sphere\""));
    let blind = whole(&text);
    assert!(blind.media.is_empty() && report(&blind).contains("medium beside Integrator `path`"), "{}", report(&blind));
}

#[test]
fn a_boundary_whose_front_is_turned_holds_what_is_before_it() {
    let turned = "Material \"interface\"\nReverseOrientation\n";
    let ball = valid(&format!("{FOG}MediumInterface \"\" \"fog\"\n{turned}Shape \"sphere\""));
    assert!(matches!(last(&ball).geometry, Geometry::Sphere(_)));
    assert_eq!((interior(&ball, last(&ball)).as_deref(), report(&ball).as_str()), (Some("fog"), ""));
    let wound = |faces: &str, outward: &str| {
        let corners = "\"point3 P\" [ 0 0 0 1 0 0 0 1 0 0 0 1 ]";
        let shape = format!("Shape \"trianglemesh\" {corners} \"integer indices\" [ {faces} ]");
        let scene = valid(&format!("{FOG}MediumInterface {outward}\nMaterial \"interface\"\n{shape}"));
        assert_eq!((interior(&scene, last(&scene)).as_deref(), report(&scene).as_str()), (Some("fog"), ""));
        let mesh = mesh(last(&scene));
        mesh.faces
            .iter()
            .map(|face| face.map(|index| mesh.positions[index as usize]))
            .map(|[a, b, c]| a.dot(b.cross(c)))
            .sum::<f32>()
    };
    assert_eq!(wound("0 2 1 0 1 3 0 3 2 1 2 3", "\"fog\" \"\""), 1.0);
    assert_eq!(wound("0 1 2 0 3 1 0 2 3 1 3 2", "\"\" \"fog\""), 1.0);
}

#[test]
fn media_are_what_they_say() {
    let of = |medium: &str| {
        let scene = valid(&format!(
            "MakeNamedMedium \"m\" {medium}\nMediumInterface \"m\" \"\"\nMaterial \"interface\"\nShape \"sphere\""
        ));
        (scene.media[0].clone(), report(&scene))
    };
    let (milk, said) = of("\"string type\" \"homogeneous\" \"string preset\" \"Wholemilk\" \"float g\" .5 \"float scale\" 10");
    assert!(milk.scattering.r() == 25.5 && milk.phase.mean_cosine() == 0.5 && said.is_empty(), "{milk:?} {said}");
    let (glow, _) = of("\"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 2 3 ] \"rgb Le\" [ 2 2 2 ] \"float Lescale\" 3");
    assert_eq!(glow.emission.to_rgb(), [6.0, 12.0, 18.0]);
    let (grid, said) = of(
        "\"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" 1 \"float density\" [ 0 4 ] \"point3 p0\" [ -1 -1 -1 ] \"rgb sigma_s\" [ 2 2 2 ] \"rgb Le\" [ 1 1 1 ] \"float Lescale\" [ 0 5 ]",
    );
    let grids = grid.grids.as_ref().expect("it has a grid");
    assert_eq!((grids.density().grid.values(), grid.scattering.r()), (&[0.0, 4.0][..], 2.0));
    assert_eq!(grids.emission().expect("it glows").grid.values(), [0.0, 5.0]);
    assert!(said.contains("border of the grid"), "{said}");
    let (colours, _) = of("\"string type\" \"rgbgrid\" \"rgb sigma_a\" [ 1 1 1 ] \"rgb sigma_s\" [ 3 1 0 ] \"float scale\" 2");
    let grids = colours.grids.as_ref().expect("it has a grid");
    assert_eq!(grids.density().grid.values(), [4.0, 2.0, 1.0]);
    assert_eq!((grids.albedo().expect("shares").grid.values(), colours.extinction().r()), (&[0.75, 0.5, 0.0][..], 2.0));
    let (hot, _) = of("\"string type\" \"uniformgrid\" \"float density\" 1 \"float temperature\" 3000");
    let light = hot.grids.as_ref().expect("it has a grid").emission().expect("it glows").grid.values().to_vec();
    assert!(light[0] > light[2] && light[2] > 1.0, "{light:?}");
    let (cloud, said) = of("\"string type\" \"cloud\"");
    assert!(cloud.extinction().is_black() && said.contains("MakeNamedMedium `cloud`"), "{said}");
}

#[test]
fn openings_are_shares_of_their_surfaces() {
    let kind = |more: &str| {
        let scene = valid(more);
        (scene.materials[last(&scene).material].clone(), report(&scene))
    };
    let (half, said) = kind("Shape \"sphere\" \"float alpha\" .25");
    assert!(matches!(half.kind, MaterialKind::Blend { .. }) && said.is_empty());
    let (whole, _) = kind("Shape \"sphere\" \"float alpha\" 1");
    assert!(matches!(whole.kind, MaterialKind::Diffuse { .. }), "the control");
    let (_, said) = kind("AreaLightSource \"diffuse\"\nShape \"sphere\" \"float alpha\" 0");
    assert!(said.contains("light of a shape that is not there"), "{said}");
}
