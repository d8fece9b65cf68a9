//! Materials and textures of Mitsuba's XML.

use super::*;

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
    // A missing attribute is reported.
    assert!(report(&read("vertex_nothing", false)).contains("attribute `vertex_nothing`"));
}

/// A picture of heights.
const HAMMERED: &[u8] = include_bytes!("../../../../scenes/textures/hammered.png");

/// Bump maps, and textures that lights throw, are read without a word; the picture is that of the scene file written from it.
#[test]
fn bumps_and_projected_pictures_are_exact() {
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
            && (projector.irradiance.r() - 2.0 * std::f64::consts::PI).abs() < 1e-12
    );
    let bumpy = scene.materials.iter().filter_map(|material| material.normal_map).next().expect("a map");
    assert_eq!(scene.textures[bumpy].relief, gpt::scene::Relief::Heights(0.1));
    assert_eq!(picture(&folder.written("a.xml")), picture(&scene));
}

/// Below a half in both coordinates, a checkerboard of colours shows its first one and a checkerboard of
/// numbers its second.
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
        assert_eq!(a.r(), first, "{bsdf}");
    }
}

/// The shadow is Mitsuba's, unless the scene says otherwise; the picture is that of the scene file written
/// from it.
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
        assert_eq!((scene.textures[bent].shadows_perturbed_normals, report(&scene).as_str()), (expected, ""));
        assert_eq!(scene.textures[bent].mirrors_perturbed_normals, expected);
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
