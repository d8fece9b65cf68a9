//! Mitsuba's XML.

mod looks;
mod version_3;

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
              <transform name="to_world">{steps}<rotate x="0.6" y="0.8" angle="15"/></transform>
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
    // Shapes that are no meshes, or give light, are copied.
    for more in [
        r#"<shape type="sphere"/>"#,
        r#"<shape type="cube"><boolean name="flip_normals" value="true"/><emitter type="area"/></shape>"#,
    ] {
        assert_eq!(scene_of(6, more).groups.len(), 0, "{more}");
    }
}

/// A map that stands upright is turned by its angle, another one by its transform; the scene stays as the file has it.
#[test]
fn environment_maps_are_turned_about_any_axis() {
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
    assert_eq!(map.turn, None);
    // Z up: the map's Y is the world's Z.
    let lying = folder(r#"<rotate y="1" angle="30"/><rotate x="1" angle="90"/><scale value="3"/>"#);
    assert_eq!(lying.camera.up, glam::DVec3::Y);
    let Light::Environment(map) = &lying.lights[1] else { panic!("no map") };
    let turn = map.turn.expect("it lies");
    let stated = glam::DMat3::from_rotation_x(90.0_f64.to_radians()) * glam::DMat3::from_rotation_y(30.0_f64.to_radians());
    assert!(turn.abs_diff_eq(stated, 1e-12) && map.rotation_degrees == 0.0, "{map:?}");
    assert!((turn * glam::DVec3::Y - glam::DVec3::Z).length() < 1e-12, "{turn}");
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
        <shape type="hair"/><emitter type="collimated"/><shape type="sphere"><bsdf type="null"/><medium type="homogeneous"/></shape>"#,
    );
    let report = report(&scene);
    for said in [
        "shape `sphere`: `foo` x1",
        "medium beside integrator `path`",
        "shape `hair`",
        "emitter `collimated`",
        "medium `homogeneous` in shape",
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
    let billion = "<!DOCTYPE lolz [<!ENTITY a \"&b;&b;\"><!ENTITY b \"&a;&a;&a;&a;\">]><scene>&b;</scene>";
    assert!(refusal(Folder::new(&[("a.xml", billion.as_bytes())]).load("a.xml")).contains("XML"));
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

/// A scene without a sensor is framed, whatever its shapes are.
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
