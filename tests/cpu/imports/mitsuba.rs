//! Mitsuba's XML.

use gpt::load::LoadOptions;
use gpt::scene::{EnvironmentRadiance, Geometry, Light, MaterialKind, Projection, TextureKind};

use super::{Folder, picture, refusal, report};

const SCENE: &str = r#"<scene version="3.0.0">
  <integrator type="path"><integer name="max_depth" value="4"/><integer name="rr_depth" value="3"/></integrator>
  <sensor type="perspective">
    <string name="fov_axis" value="y"/><float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="0,0,4" target="0,0,0" up="0,1,0"/></transform>
    <sampler type="independent"><integer name="sample_count" value="2"/></sampler>
    <film type="hdrfilm"><integer name="width" value="40"/><integer name="height" value="30"/><rfilter type="tent"/></film>
  </sensor>
  <bsdf type="twosided" id="red"><bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.2, 0.1"/></bsdf></bsdf>
  <shape type="sphere"><point name="center" x="0.1" y="0.25" z="-0.5"/><float name="radius" value="0.75"/><ref id="red"/></shape>
  <shape type="rectangle"><transform name="to_world"><translate z="-2"/></transform><ref id="red"/></shape>
  <emitter type="point"><point name="position" x="1" y="2" z="3"/><rgb name="intensity" value="10 20 30"/></emitter>
  MORE
</scene>"#;

const SAME: &str = r#"
[film]
size = [40, 30]
filter = { type = "tent", radius = 1 }
[render]
max_depth = 4
roulette_depth = 3
spp = 2
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
vfov = 40
[[material]]
name = "red"
type = "diffuse"
reflectance = [0.7, 0.2, 0.1]
[[shape]]
type = "sphere"
center = [0.1, 0.25, -0.5]
radius = 0.75
material = "red"
[[shape]]
type = "rectangle"
corner = [-1, -1, -2]
edge_u = [2, 0, 0]
edge_v = [0, 2, 0]
material = "red"
[[light]]
type = "point"
position = [1, 2, 3]
intensity = [10, 20, 30]
"#;

fn with(more: &str) -> String {
    SCENE.replace("MORE", more)
}

fn read(more: &str) -> gpt::scene::Scene {
    Folder::new(&[("a.xml", with(more).as_bytes())]).valid("a.xml")
}

#[test]
fn a_scene_and_its_likeness_make_the_same_picture() {
    let other = SAME.replace("0.75", "0.7500001");
    let folder = Folder::new(&[("a.xml", with("").as_bytes()), ("b.toml", SAME.as_bytes()), ("c.toml", other.as_bytes())]);
    let (scene, same) = (folder.valid("a.xml"), folder.valid("b.toml"));
    assert_eq!((&scene.film, &scene.render), (&same.film, &same.render));
    assert_eq!(report(&scene), "");
    assert_eq!(picture(&scene), picture(&same));
    // The control: a sphere a little larger.
    assert_ne!(picture(&folder.valid("c.toml")), picture(&same));
}

#[test]
fn what_is_written_makes_the_same_picture() {
    let more = r#"<shape type="cylinder"><float name="radius" value="0.3"/><ref id="red"/></shape>
      <shape type="cylinder"><boolean name="flip_normals" value="true"/><float name="radius" value="1.1"/><ref id="red"/></shape>
      <shape type="obj"><string name="filename" value="a.obj"/><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
        <string name="filename" value="a.png"/></texture></bsdf></shape>"#;
    let object = "v -1 -1 0\nv 1 -1 0.3\nv 0 1 0\nv 1 1 1\nvt 0 0\nvt 1 0.1\nvt 0.3 1\nf 1/1 2/2 3/3\nf 2/2 4/1 3/3\n";
    let folder = Folder::new(&[("a.xml", with(more).as_bytes()), ("a.obj", object.as_bytes())]);
    image::RgbImage::from_fn(3, 2, |x, y| image::Rgb([x as u8 * 80, y as u8 * 200, 90]))
        .save(folder.path("a.png"))
        .expect("a picture");
    let scene = folder.valid("a.xml");
    assert_eq!(picture(&scene), picture(&folder.written("a.xml")));
}

/// Texture coordinates of a cylinder go round as there: as on the triangles that stand for one that is scaled unevenly.
#[test]
fn cylinders_keep_their_texture_coordinates() {
    let tube = |steps: &str, is_reversed: bool| {
        let more = format!(
            r#"<shape type="cylinder"><point name="p0" value="0.3 -0.9 0.4"/><point name="p1" value="-0.2 1 0.9"/><float name="radius" value="0.8"/>
              <transform name="to_world">{steps}<rotate x="1" y="2" angle="15"/></transform>
              <bsdf type="twosided"><bsdf type="diffuse"><texture type="bitmap" name="reflectance"><string name="filename" value="a.png"/></texture>
              </bsdf></bsdf></shape>"#
        );
        let folder = Folder::new(&[("a.xml", with(&more).as_bytes())]);
        let gradient = |x: u32, y: u32| {
            let x = if is_reversed { 7 - x } else { x };
            image::Rgb([x as u8 * 30, y as u8 * 60, 255 - x as u8 * 30])
        };
        image::RgbImage::from_fn(8, 4, gradient).save(folder.path("a.png")).expect("a picture");
        let scene = folder.valid("a.xml");
        let is_mesh = matches!(scene.shapes.last().expect("it is there").geometry, Geometry::Mesh(_));
        (is_mesh, picture(&scene))
    };
    let difference = |a: &[[u32; 3]], b: &[[u32; 3]]| {
        let numbers = |picture: &[[u32; 3]]| picture.iter().flatten().map(|bits| f32::from_bits(*bits)).collect::<Vec<_>>();
        let [a, b] = [a, b].map(numbers);
        let sum: f32 = a.iter().sum();
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f32>() / sum
    };
    for steps in ["", r#"<scale x="-1.2" y="1.2" z="1.2"/>"#] {
        let (exact, mesh) = (tube(steps, false), tube(&format!(r#"<scale z="1.00001"/>{steps}"#), false));
        assert_eq!((exact.0, mesh.0), (false, true));
        let off = difference(&exact.1, &mesh.1);
        assert!(off < 0.01, "{steps}: {off}");
        // The control: coordinates that go round the other way.
        let other = difference(&exact.1, &tube(steps, true).1);
        assert!(other > 0.1, "{steps}: {other}");
    }
}

#[test]
fn every_kind_of_bsdf_becomes_a_material() {
    let rows = [
        (r#"<bsdf type="conductor"><string name="material" value="Au"/></bsdf>"#, "conductor"),
        (r#"<bsdf type="conductor"/>"#, "mirror"),
        (r#"<bsdf type="roughconductor"><rgb name="eta" value="0.2 0.9 1.1"/><rgb name="k" value="3.9"/></bsdf>"#, "conductor"),
        (r#"<bsdf type="dielectric"><string name="int_ior" value="diamond"/></bsdf>"#, "glass"),
        (r#"<bsdf type="roughdielectric"><float name="alpha" value="0.2"/></bsdf>"#, "rough_glass"),
        (r#"<bsdf type="null"/>"#, "pass"),
        (r#"<bsdf type="phong"/>"#, "phong"),
        (r#"<bsdf type="mask"><float name="opacity" value="0"/><bsdf type="diffuse"/></bsdf>"#, "pass"),
        (
            r#"<bsdf type="blendbsdf"><float name="weight" value="0.3"/><bsdf type="diffuse"/><bsdf type="conductor"/></bsdf>"#,
            "blend",
        ),
        (
            r#"<bsdf type="mixturebsdf"><string name="weights" value="0.3, 0.3, 0.1"/><bsdf type="diffuse"/><bsdf type="conductor"/><bsdf type="phong"/></bsdf>"#,
            "blend",
        ),
        (r#"<bsdf type="bumpmap"><texture type="checkerboard"/><bsdf type="dielectric"/></bsdf>"#, "glass"),
        (r#"<bsdf type="measured"/>"#, "diffuse"),
    ];
    for (bsdf, expected) in rows {
        let scene = read(&format!(r#"<shape type="sphere">{bsdf}</shape>"#));
        let material = &scene.materials[scene.shapes[2].material];
        assert_eq!(material.kind.type_name(), expected, "{bsdf}");
    }
    for bsdf in ["plastic", "roughplastic", "thindielectric", "principled", "roughdiffuse", "coating", "difftrans", "ward"] {
        let within = if bsdf == "coating" { r#"<bsdf type="diffuse"/>"# } else { "" };
        let scene = read(&format!(r#"<shape type="sphere"><bsdf type="{bsdf}">{within}</bsdf></shape>"#));
        assert_ne!(picture(&scene).len(), 0, "{bsdf}");
    }
}

#[test]
fn blends_take_mitsubas_share_of_the_second() {
    let blend = r#"<shape type="sphere"><bsdf type="blendbsdf"><float name="weight" value="0.3"/><bsdf type="diffuse"/><bsdf type="null"/></bsdf></shape>"#;
    let scene = read(blend);
    let MaterialKind::Blend { materials, weight } = &scene.materials[scene.shapes[2].material].kind else { panic!("no blend") };
    assert!(matches!(weight, gpt::scene::BlendWeight::Constant { value } if *value == 0.3));
    assert_eq!(scene.materials[materials[0]].kind.type_name(), "pass");
}

#[test]
fn shapes_and_lights_stand_where_they_are_put() {
    let scene = read(
        r#"<shapegroup/>"#
            .replace(
                "<shapegroup/>",
                r#"<shape type="shapegroup" id="group"><shape type="disk"/><shape type="cube"/></shape>
        <shape type="instance"><ref id="group"/><transform name="toWorld"><scale value="2"/><translate x="5"/></transform></shape>
        <shape type="instance"><ref id="group"/></shape>
        <shape type="rectangle"><emitter type="area"><rgb name="radiance" value="1 2 3"/></emitter></shape>
        <emitter type="spot"><transform name="to_world"><lookat origin="0 3 0" target="0 0 0" up="0 0 1"/></transform></emitter>
        <emitter type="directional"><vector name="direction" x="0" y="-1" z="0"/></emitter>
        <emitter type="constant"><rgb name="radiance" value="0.5"/></emitter>"#,
            )
            .as_str(),
    );
    assert_eq!(scene.shapes.len(), 2 + 4 + 1);
    assert_eq!(scene.shapes[2].transform.to_affine().transform_point3(glam::DVec3::X), glam::DVec3::new(7.0, 0.0, 0.0));
    assert!(matches!(scene.shapes[3].geometry, Geometry::Box(_)));
    let lamp = &scene.materials[scene.shapes[6].material];
    assert!(lamp.emission.is_some_and(|emission| !emission.two_sided));
    let Light::Spot(spot) = &scene.lights[1] else { panic!("no spot") };
    assert!((spot.direction - glam::DVec3::NEG_Y).length() < 1e-12 && spot.angle_degrees == 20.0 && spot.falloff_degrees == 15.0);
    assert!(matches!(&scene.lights[3], Light::Environment(e) if matches!(e.radiance, EnvironmentRadiance::Constant(_))));
}

/// A group of meshes is stored once where that saves enough, and stands where copies would stand.
#[test]
fn groups_of_meshes_become_instances() {
    let scene_of = |count: usize, more: &str| {
        let instances: String = (0..count)
            .map(|index| {
                format!(
                    r#"<shape type="instance"><ref id="group"/><transform name="to_world"><scale x="2"/><translate y="{index}"/></transform></shape>"#
                )
            })
            .collect();
        let own = r#"<transform name="to_world"><translate x="3"/></transform>"#;
        // Turned inside out, it is a mesh.
        let flipped = r#"<boolean name="flip_normals" value="true"/>"#;
        read(&format!(
            r#"<shape type="shapegroup" id="group"><shape type="cylinder">{flipped}{own}</shape>{more}</shape>{instances}"#
        ))
    };
    let (many, few) = (scene_of(6, ""), scene_of(2, ""));
    assert_eq!((many.groups.len(), many.instance_count(), few.groups.len()), (1, 6, 0));
    assert_eq!(many.groups[0].name, "group");
    let placed = |scene: &gpt::scene::Scene, number: usize| {
        let map = scene.instances[0].maps().nth(number).expect("it is there") * scene.groups[0].shapes[0].transform.to_affine();
        map.transform_point3(glam::DVec3::X)
    };
    let before = few.shapes.len() - 2;
    for number in 0..2 {
        let copy = few.shapes[before + number].transform.to_affine().transform_point3(glam::DVec3::X);
        assert!((placed(&many, number) - copy).length() < 1e-12, "{copy}");
    }
    // What is no mesh, or gives light, is copied.
    for more in [
        r#"<shape type="sphere"/>"#,
        r#"<shape type="cube"><boolean name="flip_normals" value="true"/><emitter type="area"/></shape>"#,
    ] {
        assert_eq!(scene_of(6, more).groups.len(), 0, "{more}");
    }
}

/// The direction from which a map's texel comes, before and after the scene is turned so that the map stands upright.
#[test]
fn environment_maps_that_lie_turn_the_scene() {
    let folder = |turn: &str| {
        let map = format!(
            r#"<emitter type="envmap"><string name="filename" value="a.png"/><transform name="to_world">{turn}</transform></emitter>"#
        );
        let folder = Folder::new(&[("a.xml", with(&map).as_bytes())]);
        image::RgbImage::new(8, 4).save(folder.path("a.png")).expect("a picture");
        folder.valid("a.xml")
    };
    let upright = folder(r#"<rotate y="1" angle="30"/>"#);
    let Light::Environment(map) = &upright.lights[1] else { panic!("no map") };
    assert!((map.rotation_degrees - 30.0).abs() < 1e-9, "{}", map.rotation_degrees);
    assert_eq!(upright.camera.up, glam::DVec3::Y);
    // Z up: what was up along Y there is up along Z in the file, and the camera's Y becomes -Z of the turned world.
    let lying = folder(r#"<rotate x="1" angle="90"/>"#);
    assert!((lying.camera.up - glam::DVec3::NEG_Z).length() < 1e-12, "{}", lying.camera.up);
}

#[test]
fn old_names_parameters_and_includes_are_understood() {
    let scene = r##"<scene version="0.5.0">
      <default name="width" value="64"/>
      <include filename="camera.xml"/>
      <path value="parts"/>
      <bsdf type="diffuse" id="a"><srgb name="reflectance" value="#808080"/></bsdf>
      <alias id="a" as="b"/>
      <shape type="sphere"><ref id="b"/><transform name="toWorld"><scale value="$size"/></transform></shape>
      <emitter type="constant"/>
    </scene>"##;
    let camera = r#"<scene version="0.5.0"><sensor type="thinlens"><float name="fov" value="90"/><float name="apertureRadius" value="0.1"/>
      <float name="focusDistance" value="3"/><transform name="toWorld"><lookAt origin="0,0,5" target="0,0,0" up="0,1,0"/></transform>
      <film type="hdrfilm"><integer name="width" value="$width"/><integer name="height" value="32"/></film></sensor></scene>"#;
    let folder = Folder::new(&[("a.xml", scene.as_bytes()), ("camera.xml", camera.as_bytes())]);
    let message = refusal(folder.load("a.xml"));
    assert!(message.contains("a.xml:7") && message.contains("$size"), "{message}");
    let given = |pairs: &[(&str, &str)]| LoadOptions {
        definitions: pairs.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect(),
        ..LoadOptions::default()
    };
    let scene = folder.load_as("a.xml", &given(&[("size", "2"), ("width", "48")])).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.film.size, [48, 32]);
    let Projection::Perspective { vertical_fov_degrees } = scene.camera.projection else { panic!("no perspective") };
    assert!((vertical_fov_degrees.to_radians() / 2.0).tan() - 32.0 / 48.0 < 1e-12);
    assert!(scene.camera.aperture.is_some_and(|aperture| aperture.radius == 0.1) && scene.camera.focus_distance == 3.0);
    let message = refusal(folder.load_as("a.xml", &given(&[("size", "2"), ("witdh", "48")])));
    assert!(message.contains("witdh"), "{message}");
}

#[test]
fn nothing_is_left_out_silently() {
    let scene = read(
        r#"<shape type="sphere"><float name="foo" value="1"/><bsdf type="diffuse"/><medium type="homogeneous" name="interior"/></shape>
        <shape type="hair"/><emitter type="collimated"/><medium type="homogeneous"/>"#,
    );
    let report = report(&scene);
    for said in [
        "shape `sphere`: `foo` x1",
        "medium `homogeneous` in shape",
        "shape `hair`",
        "emitter `collimated`",
        "medium `homogeneous` in scene",
    ] {
        assert!(report.contains(said), "{said}:\n{report}");
    }
    let place = &scene.import_report.dropped[0].place;
    assert!(place.contains("a.xml:"), "{place}");
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    let rows = [
        ("<shape type=\"sphere\"><ref id=\"green\"/></shape>", "no plugin with the id `green`"),
        ("<shape type=\"obj\"><string name=\"filename\" value=\"absent.obj\"/></shape>", "no file absent.obj"),
        ("<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>", "the radius of a sphere is above 0"),
        ("<shape type=\"sphere\"><float name=\"radius\" value=\"one\"/></shape>", "expected a number, found `one`"),
        ("<shape type=\"sphere\"><transform name=\"to_world\"><scale x=\"0\"/></transform></shape>", "scale by 0"),
        ("<shape type=\"sphere\"><string name=\"radius\" value=\"1\"/></shape>", "`radius` is not a number"),
        ("<nonsense/>", "<nonsense> is no element"),
        ("<bsdf type=\"diffuse\" id=\"red\"/>", "a second plugin has the id `red`"),
        ("<shape type=\"sphere\"><bsdf type=\"twosided\"/></shape>", "needs a bsdf within"),
        (
            "<shape type=\"sphere\"><bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"cheese\"/></bsdf></shape>",
            "nothing is known of the material `cheese`",
        ),
        ("<shape type=\"sphere\"><point name=\"center\" value=\"1 2 3 4\"/></shape>", "expected three numbers"),
        (
            "<shape type=\"sphere\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"1 2\"/></bsdf></shape>",
            "expected one number or three",
        ),
        ("&unknown;", "is not valid XML"),
        ("<shape", "is not valid XML"),
        ("text", "text outside"),
    ];
    for (more, said) in rows {
        let folder = Folder::new(&[("a.xml", with(more).as_bytes())]);
        let message = refusal(folder.load("a.xml"));
        assert!(message.contains(said) && message.contains("a.xml:"), "{more}: {message}");
    }
    let itself = "<scene><include filename=\"a.xml\"/></scene>";
    for (text, said) in [
        (itself, "include each other"),
        ("", "XML"),
        ("<a/>", "begins with <a>"),
        ("<scene version=\"3.0.0\"/>", "nothing to render"),
    ] {
        let folder = Folder::new(&[("a.xml", text.as_bytes())]);
        assert!(refusal(folder.load("a.xml")).contains(said), "{text}");
    }
    let billion = "<!DOCTYPE lolz [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]><scene>&b;</scene>";
    assert!(refusal(Folder::new(&[("a.xml", billion.as_bytes())]).load("a.xml")).contains("XML"));
}

/// Two triangles with colours of their vertices and numbers of their faces.
const PAINTED: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n\
    property uchar green\nproperty uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nproperty float weight_0\nend_header\n\
    -1 -1 0 255 0 0\n1 -1 0 0 255 0\n1 1 0 0 0 255\n-1 1 0 255 255 0\n3 0 1 2 0.25\n3 0 2 3 0.75\n";

/// Attributes of a mesh are what they are at its vertices and on its faces.
#[test]
fn mesh_attributes_are_textures() {
    let scene = |attribute: &str, weight: bool| {
        let texture = |name: &str| {
            format!(r#"<texture name="{name}" type="mesh_attribute"><string name="name" value="{attribute}"/></texture>"#)
        };
        let bsdf = if weight {
            format!(r#"<bsdf type="blendbsdf">{}<bsdf type="diffuse"/><bsdf type="null"/></bsdf>"#, texture("weight"))
        } else {
            format!(r#"<bsdf type="diffuse">{}</bsdf>"#, texture("reflectance"))
        };
        with(&format!(r#"<shape type="ply"><string name="filename" value="b.ply"/>{bsdf}</shape>"#))
    };
    let read = |attribute: &str, weight: bool| {
        let xml = scene(attribute, weight);
        let folder = Folder::new(&[("a.xml", xml.as_bytes()), ("b.ply", PAINTED.as_bytes())]);
        let scene = folder.valid("a.xml");
        assert_eq!(picture(&folder.written("a.xml")), picture(&scene), "{attribute}");
        scene
    };
    let texels = |scene: &gpt::scene::Scene, name: &str| {
        let texture = scene.textures.iter().find(|texture| texture.name == name).expect("it is there");
        let gpt::scene::TextureKind::Image(image) = &texture.kind else { panic!("no image") };
        image.image.texels.colors().map(|texel| texel.to_array()).collect::<Vec<_>>()
    };
    let painted = read("vertex_color", false);
    assert_eq!(report(&painted), "");
    // The first triangle's block is 2 × 2 texels in rows of 4.
    let colours = texels(&painted, "vertex_color");
    assert_eq!([colours[0], colours[1], colours[4]], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    assert_eq!([colours[2], colours[3], colours[6]], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0]]);
    let weighed = read("face_weight", true);
    let weights = texels(&weighed, "face_weight");
    assert_eq!([weights[0], weights[5], weights[2], weights[7]], [[0.25; 3], [0.25; 3], [0.75; 3], [0.75; 3]]);
    // What is not there is told.
    assert!(report(&read("vertex_nothing", false)).contains("attribute `vertex_nothing`"));
}

/// A crop off the film's middle, and a film moved aside, look where they do in the whole picture.
#[test]
fn crops_and_principal_points_shift_the_picture() {
    let read = |film: &str, sensor: &str| {
        let film = format!(r#"<integer name="width" value="40"/><integer name="height" value="30"/>{film}"#);
        let text = SCENE.replace(r#"<integer name="width" value="40"/><integer name="height" value="30"/>"#, &film);
        let text = text.replace(r#"<float name="fov" value="40"/>"#, &format!(r#"<float name="fov" value="40"/>{sensor}"#));
        let folder = Folder::new(&[("a.xml", text.replace("MORE", "").as_bytes())]);
        let scene = folder.valid("a.xml");
        assert_eq!(report(&scene), "");
        assert_eq!(folder.written("a.xml").camera, scene.camera);
        scene.camera
    };
    let crop = r#"<integer name="crop_width" value="10"/><integer name="crop_height" value="10"/><integer name="crop_offset_x" value="25"/>
        <integer name="crop_offset_y" value="0"/>"#;
    // The crop's middle is 10 pixels to the right of the film's and 10 above it.
    assert_eq!(read(crop, "").shift, [1.0, 1.0]);
    assert_eq!(read("", r#"<float name="principal_point_offset_x" value="0.25"/>"#).shift, [0.25, -0.0]);
    assert_eq!(read("", "").shift, [0.0, 0.0]);
}

/// A picture of heights.
const HAMMERED: &[u8] = include_bytes!("../../../scenes/textures/hammered.png");

/// Bump maps, and textures that lights throw, are read without a word; the picture is that of the scene file written from it.
#[test]
fn bumps_and_thrown_pictures_are_exact() {
    let xml = with(
        r#"<shape type="rectangle"><bsdf type="bumpmap"><texture type="bitmap"><string name="filename" value="h.png"/></texture><float name="scale" value="0.1"/>
          <bsdf type="diffuse"/></bsdf></shape>
        <emitter type="spot"><texture name="texture" type="checkerboard"/><transform name="to_world">
          <lookat origin="0 0 3" target="0 0 0" up="0 1 0"/></transform></emitter>
        <emitter type="projector"><texture name="irradiance" type="checkerboard"/><float name="fov" value="30"/>
          <float name="scale" value="2"/><transform name="to_world"><lookat origin="0 0 3" target="0 0 0" up="0 1 0"/></transform></emitter>"#,
    );
    let folder = Folder::new(&[("a.xml", xml.as_bytes()), ("h.png", HAMMERED)]);
    let scene = folder.valid("a.xml");
    assert_eq!(report(&scene), "");
    let Light::Spot(spot) = &scene.lights[1] else { panic!("no spot") };
    assert!(spot.picture.is_some() && spot.curve == gpt::scene::FalloffCurve::Linear);
    let Light::Projector(projector) = &scene.lights[2] else { panic!("no projector") };
    assert!(
        (projector.vertical_fov_degrees - 30.0).abs() < 1e-9
            && (projector.irradiance.x - 2.0 * std::f64::consts::PI).abs() < 1e-12
    );
    let bumpy = scene.materials.iter().filter_map(|material| material.normal_map).next().expect("a map");
    assert_eq!(scene.textures[bumpy].relief, gpt::scene::Relief::Heights(0.1));
    assert_eq!(picture(&folder.written("a.xml")), picture(&scene));
}

/// Where both coordinates are below a half, a checkerboard of colours shows its first one and a checkerboard of numbers its second.
#[test]
fn checkerboards_of_numbers_are_the_other_way_round() {
    let board = |name: &str| {
        format!(
            r#"<texture name="{name}" type="checkerboard"><float name="color0" value="0.1"/><float name="color1" value="0.7"/></texture>"#
        )
    };
    for (bsdf, first) in [
        (format!(r#"<bsdf type="diffuse">{}</bsdf>"#, board("reflectance")), 0.1),
        (format!(r#"<bsdf type="roughconductor">{}</bsdf>"#, board("alpha")), 0.7),
    ] {
        let scene = read(&format!(r#"<shape type="rectangle">{bsdf}</shape>"#));
        let TextureKind::Checker { a, .. } = scene.textures[0].kind else { panic!("no checker") };
        assert_eq!(a.x, first, "{bsdf}");
    }
}

/// As there, unless the scene says otherwise; the picture is that of the scene file written from it.
#[test]
fn bent_normals_are_shadowed() {
    let map = |more: &str| {
        with(&format!(
            r#"<shape type="rectangle"><bsdf type="normalmap"><texture name="normalmap" type="bitmap"><boolean name="raw" value="true"/>
            <string name="filename" value="h.png"/></texture>{more}<bsdf type="diffuse"/></bsdf></shape>"#
        ))
    };
    let pictures = [("", true), (r#"<boolean name="use_shadowing_function" value="false"/>"#, false)].map(|(more, expected)| {
        let folder = Folder::new(&[("a.xml", map(more).as_bytes()), ("h.png", HAMMERED)]);
        let scene = folder.valid("a.xml");
        let bent = scene.materials.iter().find_map(|material| material.normal_map).expect("a map");
        assert_eq!((scene.textures[bent].shadows_bent_normals, report(&scene).as_str()), (expected, ""));
        assert_eq!(scene.textures[bent].mirrors_bent_normals, expected);
        let drawn = picture(&scene);
        assert_eq!(picture(&folder.written("a.xml")), drawn);
        drawn
    });
    assert_ne!(pictures[0], pictures[1]);
}

#[test]
fn bumps_without_slopes_are_reported() {
    let scene = read(
        r#"<shape type="rectangle"><bsdf type="bumpmap"><texture type="checkerboard"/><bsdf type="diffuse"/></bsdf></shape>"#,
    );
    assert_eq!(report(&scene), "texture `checkerboard` as a bump map x1: it has steps and no slopes, and bends no normals\n");
}

/// A square seen from the front, which v crosses upward or downward; the map of normals is the same everywhere, so in Mitsuba, where green points
/// across the normal and the tangent, both look alike. In a scene file of ours, where green points to where v grows, they do not.
#[test]
fn green_points_across_the_tangent_whichever_way_v_runs() {
    let square = |v: [u8; 4]| {
        let rows = [["-1 -1", "0"], ["1 -1", "1"], ["1 1", "1"], ["-1 1", "0"]].into_iter().zip(v);
        let rows: String = rows.map(|([place, u], v)| format!("{place} 0 {u} {v}\n")).collect();
        format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float u\n\
             property float v\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n{rows}3 0 1 2\n3 0 2 3\n"
        )
    };
    let (upward, downward) = (square([0, 0, 1, 1]), square([1, 1, 0, 0]));
    // One face of each.
    let both = upward
        .replace("element vertex 4", "element vertex 7")
        .replace("3 0 1 2\n3 0 2 3\n", "-1 -1 0 0 1\n1 1 0 1 0\n-1 1 0 0 0\n3 0 1 2\n3 4 5 6\n");
    let mut png = std::io::Cursor::new(Vec::new());
    let texel = image::Rgb([150, 220, 190]);
    image::RgbImage::from_pixel(2, 2, texel).write_to(&mut png, image::ImageFormat::Png).expect("memory can be written to");
    let scene = |file: &str| {
        with(&format!(
            r#"<shape type="ply"><string name="filename" value="{file}"/><bsdf type="normalmap"><texture name="normalmap" type="bitmap">
            <boolean name="raw" value="true"/><string name="filename" value="h.png"/></texture><bsdf type="diffuse"><rgb name="reflectance"
            value="0.5"/></bsdf></bsdf></shape>"#
        ))
    };
    let ours = |file: &str| {
        format!(
            "[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = 40\n[[texture]]\nname = \"h\"\ntype = \"image\"\nfile = \"h.png\"\n\
             color_space = \"linear\"\n[[material]]\nname = \"m\"\ntype = \"diffuse\"\nreflectance = 0.5\nnormal_map = \"h\"\n\
             [[shape]]\ntype = \"mesh\"\nfile = \"{file}\"\nmaterial = \"m\"\n[[light]]\ntype = \"point\"\nposition = [0, 3, 3]\nintensity = 10\n"
        )
    };
    let folder = Folder::new(&[
        ("up.ply", upward.as_bytes()),
        ("down.ply", downward.as_bytes()),
        ("both.ply", both.as_bytes()),
        ("h.png", &png.into_inner()),
        ("up.xml", scene("up.ply").as_bytes()),
        ("down.xml", scene("down.ply").as_bytes()),
        ("both.xml", scene("both.ply").as_bytes()),
        ("up.toml", ours("up.ply").as_bytes()),
        ("down.toml", ours("down.ply").as_bytes()),
    ]);
    let [up, down, both] = ["up.xml", "down.xml", "both.xml"].map(|name| folder.valid(name));
    assert_eq!([&up, &down, &both].map(|scene| scene.shapes.len()), [1, 1, 2].map(|count| count + up.shapes.len() - 1));
    assert_eq!(picture(&down), picture(&up));
    assert_eq!(picture(&both), picture(&up));
    assert_eq!(picture(&folder.written("down.xml")), picture(&up));
    assert_ne!(picture(&folder.valid("up.toml")), picture(&folder.valid("down.toml")), "the control");
}

/// What has no sensor is framed, whatever its shapes are.
#[test]
fn scenes_without_sensor_and_meshes_are_framed() {
    for (shape, size) in [("sphere", 1.0), ("disk", 1.0), ("rectangle", 1.0), ("cube", 1.0), ("cylinder", 1.0), ("sphere", 100.0)]
    {
        let placed = |offset: f64| {
            let map = format!("<transform name=\"to_world\"><scale value=\"{size}\"/><translate x=\"{offset}\"/></transform>");
            let text = format!("<scene version=\"3.0.0\"><shape type=\"{shape}\">{map}</shape></scene>");
            Folder::new(&[("a.xml", text.as_bytes())]).valid("a.xml").camera
        };
        let [camera, beside] = [0.0, 3.0].map(placed);
        let distance = (camera.position - camera.look_at).length();
        assert!(distance > size && distance < 10.0 * size, "{shape}: {distance}");
        assert!((beside.look_at - camera.look_at).distance((3.0, 0.0, 0.0).into()) < 1e-9 * size, "{shape}");
    }
}
