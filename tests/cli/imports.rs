//! Scenes of other programs on the command line.

use serde_json::Value;

use super::{Workplace, text};

const SCENE: &str = r#"<scene version="3.0.0"><default name="size" value="1"/>
<sensor type="perspective"><float name="fov" value="40"/><transform name="to_world"><lookat origin="0 0 4" target="0 0 0" up="0 1 0"/></transform>
<film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/></film>
<sampler type="independent"><integer name="sample_count" value="4"/></sampler></sensor>
<shape type="sphere"><float name="radius" value="$size"/><float name="foo" value="1"/><bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>
<shape type="hair"/><shape type="hair"/>
<emitter type="constant"/></scene>"#;

fn place() -> Workplace {
    let place = Workplace::new();
    place.write("a.xml", SCENE);
    place
}

const PBRT: &str = r#"LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 16 "integer yresolution" 12
Sampler "halton" "integer pixelsamples" 4
WorldBegin
Shape "sphere" "float foo" 1
Shape "curve"
LightSource "infinite""#;

#[test]
fn scenes_of_pbrt_are_rendered_written_and_checked() {
    let place = Workplace::new();
    place.write("a.pbrt", PBRT);
    let said = place.expect(0, "render a.pbrt --device cpu --quiet -o a.exr --save-scene b.toml");
    assert!(said.contains("2 things are dropped") && said.lines().count() == 1, "{said}");
    place.expect(0, "import a.pbrt -o c.toml");
    for scene in ["b.toml", "c.toml"] {
        place.expect(0, &format!("render {scene} --device cpu --quiet -o b.exr"));
        place.expect(0, "compare a.exr b.exr");
    }
    let said = text(&place.run("check a.pbrt").stdout);
    assert!(said.contains("Shape `curve`: it is left out [a.pbrt:7]") && said.contains("Shape `sphere`: `foo`"), "{said}");
    place.write("b.pbrt", PBRT.replace("\"float foo\" 1", "\"float radius\" x"));
    let said = place.expect(3, "check b.pbrt");
    assert!(said.contains("b.pbrt:6:31") && said.contains("expects numbers"), "{said}");
    for (more, word) in [("--camera left", "`left`"), ("-D size=1", "$size")] {
        let said = place.expect(3, &format!("check a.pbrt {more}"));
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn what_is_written_renders_the_same_picture() {
    let place = place();
    let said = place.expect(0, "render a.xml -D size=0.5 --device cpu --quiet -o a.exr");
    assert!(said.contains("3 things are dropped") && said.lines().count() == 1, "{said}");
    place.expect(0, "import a.xml -D size=0.5 -o written.toml");
    place.expect(0, "render written.toml --device cpu --quiet -o b.exr");
    place.expect(0, "compare a.exr b.exr");
    // The control: another size.
    place.expect(0, "render a.xml --device cpu --quiet -o c.exr");
    place.expect(7, "compare a.exr c.exr");
}

/// However a scene is written, what comes from no file lies in one folder, which the scene file names from where it lies.
#[test]
fn files_are_written_beside_the_scene_file() {
    let place = place();
    let disk = r#"<shape type="disk"><transform name="to_world"><scale x="0.5"/></transform></shape>"#;
    place.write("disk.xml", SCENE.replace("</scene>", &format!("{disk}</scene>")));
    place.expect(0, "import disk.xml -o a.toml");
    place.expect(0, "render disk.xml --spp 4 --device cpu --quiet -o a.exr --save-scene b.toml");
    let [imported, saved] = ["a", "b"].map(|name| {
        let text = std::fs::read_to_string(place.path(&format!("{name}.toml"))).expect("it was written");
        assert!(text.starts_with("version = 1\n") && text.contains(&format!("file = \"{name}.files/mesh-1.ply\"")), "{text}");
        (
            text.replace(&format!("{name}.files"), ""),
            std::fs::read(place.path(&format!("{name}.files/mesh-1.ply"))).expect("the mesh"),
        )
    });
    assert_eq!(imported, saved);
}

/// A model becomes the scene file of what `gpt render` shows of it.
#[test]
fn models_are_imported_as_they_are_framed() {
    let place = Workplace::new();
    place.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0.3\nf 1 2 3\n");
    // A model is framed for the shape of its picture.
    place.expect(0, "import m.obj -o written.toml");
    place.expect(0, "render written.toml --size 12x12 --spp 2 --device cpu --quiet -o b.exr");
    place.expect(0, "render m.obj --size 12x12 --spp 2 --device cpu --quiet -o a.exr");
    place.expect(0, "compare a.exr b.exr");
    place.expect(0, "render m.obj --size 12x12 --spp 2 --seed 9 --device cpu --quiet -o c.exr");
    place.expect(7, "compare a.exr c.exr");
}

#[test]
fn check_lists_what_is_not_exact_and_strict_refuses_it() {
    let place = place();
    let output = place.run("check a.xml");
    let said = text(&output.stdout);
    assert!(said.contains("dropped\n") && said.contains("shape `hair` (2 times): it is left out [a.xml:6]"), "{said}");
    let output = place.run("check a.xml --json --strict");
    assert_eq!(output.status.code(), Some(3));
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let hair = report["dropped"]
        .as_array()
        .and_then(|items| items.iter().find(|item| item["what"] == "shape `hair`"))
        .expect("it is listed");
    assert_eq!((&hair["count"], &hair["where"], &hair["instead"]), (&2.into(), &"a.xml:6".into(), &"it is left out".into()));
    assert!(report["approximated"].is_array());
    for command in ["render a.xml --strict --device cpu --quiet -o a.exr", "import a.xml --strict -o b.toml"] {
        let said = place.expect(3, command);
        assert!(said.contains("3 things are dropped"), "{said}");
    }
    assert!(!place.path("b.toml").exists() && !place.path("a.exr").exists());
    // A scene of ours has nothing to list.
    let report: Value = serde_json::from_slice(&place.run("check scene.toml --json --strict").stdout).expect("JSON");
    assert_eq!((report["dropped"].as_array().map(Vec::len), report["valid"].as_bool()), (Some(0), Some(true)));
}

#[test]
fn wrong_files_and_arguments_are_refused() {
    let place = place();
    for (command, said) in [
        ("check absent.xml", "absent.xml"),
        ("check a.xml -D foo=1", "$foo"),
        ("check a.xml --camera none", "`none`"),
        ("import scene.toml -o b.toml", "cannot be imported"),
    ] {
        let stderr = place.expect(3, command);
        assert!(stderr.contains(said), "{command}: {stderr}");
    }
    for command in ["check a.xml -D size", "import a.xml", "import a.xml -o b.txt"] {
        place.expect(2, command);
    }
    #[cfg(unix)]
    place.expect(3, "check /dev/zero.xml");
}

/// An exported scene that is imported again is the same scene, but for rounding of the places of its
/// surfaces.
#[test]
#[ignore = "slow"]
fn what_is_exported_comes_back() {
    let place = place();
    place.expect(0, "export cornell -o c.xml");
    place.expect(0, "render cornell --size 24x24 --spp 16 --device cpu --quiet -o a.exr");
    place.expect(0, "render c.xml --size 24x24 --spp 16 --device cpu --quiet -o b.exr");
    place.expect(0, "compare a.exr b.exr --metric relmse --tolerance 0.02");
    // The control: with the light out.
    let dark = std::fs::read_to_string(place.path("c.xml")).expect("it was written").replacen(
        "name=\"radiance\" value=\"",
        "name=\"radiance\" value=\"0.",
        1,
    );
    place.write("dark.xml", dark);
    place.expect(0, "render dark.xml --size 24x24 --spp 16 --device cpu --quiet -o c.exr");
    place.expect(7, "compare a.exr c.exr --metric relmse --tolerance 0.02");
    for name in ["veach-mis", "gallery", "knot-plastic", "spheres"] {
        place.expect(0, &format!("export {name} -o {name}.xml"));
        place.expect(0, &format!("check {name}.xml"));
    }
    place.expect(3, "export gallery --strict -o d.xml");
    place.expect(2, "export cornell -o d.toml");
    assert!(!place.path("d.xml").exists());
    // An imported scene comes back as well.
    place.expect(0, "export a.xml -o e.xml");
    place.expect(0, "check e.xml");
}

/// Colours however they are written, opacity, and what cannot be said.
#[test]
fn what_is_exported_is_said_or_reported() {
    let place = place();
    let text = std::fs::read_to_string(place.path("scene.toml")).expect("the scene");
    let material = "[[material]]\nname = \"veil\"\ntype = \"diffuse\"\nreflectance = \"#ff8000\"\nopacity = 0.25\n\
                    [[material]]\nname = \"glow\"\ntype = \"emissive\"\nradiance = { kelvin = 3200, factor = 2 }\n\
                    [[material]]\nname = \"lacquer\"\ntype = \"principled\"\nbase_color = 0.5\nsheen_color = 0.5\n";
    let shapes = ["veil", "glow", "lacquer"]
        .map(|name| format!("[[shape]]\ntype = \"sphere\"\ncenter = [9, 0, 0]\nradius = 0.1\nmaterial = \"{name}\"\n"));
    let textures = "[[texture]]\nname = \"checks\"\ntype = \"checker\"\na = 0.2\nb = 0.5\ntimes = \"others\"\nsecond_uvs = true\n\
                    [[texture]]\nname = \"others\"\ntype = \"checker\"\na = 0.2\nb = 0.5\n\
                    [[material]]\nname = \"checked\"\ntype = \"diffuse\"\nreflectance = { texture = \"checks\" }\n\
                    [[shape]]\ntype = \"sphere\"\ncenter = [9, 0, 0]\nradius = 0.1\nmaterial = \"checked\"\n";
    place.write("all.toml", format!("{text}\n{material}{textures}{}", shapes.concat()));
    let said = place.expect(0, "export all.toml -o all.xml");
    assert!(said.contains("material `lacquer`: key `sheen_color`: it has no effect"), "{said}");
    for key in ["times", "second_uvs"] {
        assert!(said.contains(&format!("texture `checks`: key `{key}`: it has no effect")), "{said}");
    }
    assert_eq!(said.matches("texture `checks`").count(), 2, "{said}");
    let xml = std::fs::read_to_string(place.path("all.xml")).expect("it was written");
    assert!(xml.contains("<bsdf type=\"mask\" id=\"veil\">") && xml.contains("name=\"opacity\" value=\"0.25\""), "{xml}");
    // 1, 0.2159 and 0: the hex digits are sRGB. And a lamp is not black.
    assert!(xml.contains("name=\"reflectance\" value=\"1, 0.215"), "{xml}");
    assert!(!xml.contains("name=\"radiance\" value=\"0, 0, 0\""), "{xml}");
    place.expect(3, "export all.toml --strict -o strict.xml");
    let parts = ["id=\"veil (where it is)\"", "id=\"veil\""].map(|id| xml.find(id).unwrap_or(usize::MAX));
    assert!(parts[0] < parts[1] && parts[1] < usize::MAX, "what is named stands above: {parts:?}");
}
