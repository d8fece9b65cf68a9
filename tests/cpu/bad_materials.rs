//! Materials and blends that are wrong: each is one error that names the place, the key and what would be right. And some that look
//! wrong and are not.

use std::path::Path;

use crate::common::files::folder_with;
use gpt::load;
use gpt::load::SceneError;
use gpt::packed::{PackError, PackedScene};
use gpt::scene::Scene;

const HEADER: &str = r#"
[film]
size = [4, 4]
[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
vfov = 40
[[light]]
type = "environment"
radiance = 1
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 1
material = "m"
[[texture]]
name = "checks"
type = "checker"
a = 0
b = 3
[[material]]
name = "white"
type = "diffuse"
reflectance = 1
[[material]]
name = "mirror"
type = "mirror"
"#;

fn load_in(folder: &Path, materials: &str) -> Result<Scene, SceneError> {
    load::load_toml_str(&format!("{HEADER}{materials}"), "test.toml", folder)
}

fn load(materials: &str) -> Result<Scene, SceneError> {
    load_in(Path::new(""), materials)
}

fn complaint(materials: &str) -> String {
    match load(materials) {
        Ok(_) => panic!("no complaint about\n{materials}"),
        Err(error) => match error.help_text() {
            Some(help) => format!("{error} [{help}]"),
            None => error.to_string(),
        },
    }
}

fn material(body: &str) -> String {
    format!("[[material]]\nname = \"m\"\n{body}\n")
}

fn blend(weight: &str) -> String {
    material(&format!("type = \"blend\"\nmaterials = [\"white\", \"mirror\"]\nweight = {weight}"))
}

/// Stacks that cannot be.
#[test]
fn layers_that_do_not_go_together_are_refused() {
    let others = "[[medium]]\nname = \"glow\"\nemission = 1\n[[material]]\nname = \"coat\"\ntype = \"glass\"\n\
                  [[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 1\n\
                  [[material]]\nname = \"within\"\ntype = \"layered\"\ninterfaces = [\"m\"]\n\
                  [[material]]\nname = \"stack\"\ntype = \"layered\"\ninterfaces = [\"coat\", \"white\"]\n\
                  [[material]]\nname = \"half a stack\"\ntype = \"blend\"\nmaterials = [\"stack\", \"white\"]\nweight = { type = \"constant\", value = 0.5 }\n\
                  [[material]]\nname = \"by angle\"\ntype = \"blend\"\nmaterials = [\"coat\", \"mirror\"]\nweight = { type = \"facing\", power = 1 }\n\
                  [[material]]\nname = \"body\"\ntype = \"principled\"\ntransmission = 1\nattenuation_color = 0.5\nattenuation_distance = 1\n";
    let layered = |keys: &str| format!("{}{others}", material(&format!("type = \"layered\"\n{keys}")));
    let rows = [
        ("interfaces = []", "`interfaces` names no material"),
        ("interfaces = [\"coat\", \"wite\"]", "there is no material named `wite`"),
        ("interfaces = [\"coat\", \"white\"]\nslabs = []", "between 2 interfaces are 1 slabs, and 0 are written"),
        ("interfaces = [\"coat\", \"white\"]\nslabs = [{ thickness = -1 }]", "thickness: expected"),
        ("interfaces = [\"coat\", \"white\"]\nslabs = [{ medium = \"glow\" }]", "the medium of a slab needs a `thickness`"),
        ("interfaces = [\"coat\", \"white\"]\nslabs = [{ thickness = 1, medium = \"fog\" }]", "there is no medium named `fog`"),
        (
            "interfaces = [\"coat\", \"white\"]\nslabs = [{ thickness = 1, medium = \"glow\" }]",
            "must be the same everywhere, and give off no light",
        ),
        ("interfaces = [\"coat\", \"white\"]\nmodel = \"fourier\"", "model: `fourier` is not a valid choice"),
        ("interfaces = [\"coat\", \"lamp\"]", "the interface `lamp` gives off light"),
        ("interfaces = [\"coat\", \"within\"]", "has more than 64 interfaces"),
        ("interfaces = [\"coat\", \"half a stack\"]", "the interface `half a stack` blends the stack `stack`"),
        ("interfaces = [\"by angle\", \"white\"]", "is blended by the direction that it is seen from"),
        ("interfaces = [\"coat\", \"body\"]", "has a medium of its own"),
    ];
    for (keys, message) in rows {
        let found = complaint(&layered(keys));
        assert!(found.contains(message), "{keys}: {found}");
    }
    assert!(load(&layered("interfaces = [\"coat\", \"stack\"]")).is_ok(), "a stack may be an interface");
}

/// Keys that exclude each other, or need each other.
#[test]
fn keys_of_rough_surfaces_that_do_not_go_together_are_refused() {
    let metal = |keys: &str| material(&format!("type = \"conductor\"\nreflectance = 0.9\n{keys}"));
    let glass = |keys: &str| material(&format!("type = \"rough_glass\"\n{keys}"));
    let plastic = |keys: &str| material(&format!("type = \"plastic\"\nreflectance = 0.5\n{keys}"));
    let principled = |keys: &str| material(&format!("type = \"principled\"\n{keys}"));
    let rows = [
        (metal("alpha_u = 0.1"), "`alpha_u` needs `alpha_v`"),
        (metal("roughness_v = 0.1"), "`roughness_v` needs `roughness_u`"),
        (metal("alpha = 0.1\nalpha_u = 0.1\nalpha_v = 0.2"), "one width, or two"),
        (metal("alpha_u = 0.1\nalpha_v = 0.2\nroughness_u = 0.1\nroughness_v = 0.2"), "either `alpha_u` and `alpha_v` or"),
        (metal("distribution = \"beckmann\""), "`distribution` is for rough surfaces"),
        (metal("masking = \"separable\""), "`masking` is for rough surfaces"),
        (metal("alpha = 0.1\ndistribution = \"phong\""), "distribution: `phong` is not a valid choice"),
        (metal("alpha = 0.1\nmasking = \"none\""), "masking: `none` is not a valid choice"),
        (metal("specular_reflectance = 1.5"), "expected a number from 0 to 1, found 1.5"),
        (metal("alpha_u = 0.1\nalpha_v = 2"), "alpha_v: expected a number from 0 to 1, found 2"),
        (glass("exponent = 20\nmasking = \"separable\""), "`masking` is for microfacets"),
        (glass("exponent = 20\nthin = true"), "thin walls are for microfacets"),
        (glass("exponent = 20\nalpha_u = 0.1\nalpha_v = 0.2"), "either `exponent` or one of"),
        (glass("exponent = 20\ndistribution = \"beckmann\""), "`exponent` belongs to distribution = \"phong\""),
        (plastic("alpha = 0.1\nroughness = 0.1"), "either `alpha` or `roughness`"),
        (plastic("masking = \"separable\""), "`masking` is for rough surfaces"),
        (plastic("ior = 0"), "ior: expected an index of refraction from 0.1 to 10, found 0"),
        (principled("anisotropy_rotation = 30"), "`anisotropy_rotation` needs the key `anisotropy`"),
        (principled("abbe_number = 30"), "`abbe_number` needs the key `transmission` or `subsurface`"),
        (principled("transmission = 1\nthin = true\ncauchy = [1.5, 0.01, 0]"), "a `thin` wall does not bend light"),
        (principled("transmission = 1\nior = 1.5\ncauchy = [1.5, 0.01, 0]"), "either `ior`"),
        (principled("thin = true"), "`thin` needs the key `transmission`"),
        (principled("clearcoat_roughness = 0.1"), "`clearcoat_roughness` needs the key `clearcoat`"),
        (principled("anisotropy_direction = \"checks\""), "`anisotropy_direction` needs the key `anisotropy`"),
        (
            principled("anisotropy = 0.5\nanisotropy_direction = \"bumps\""),
            "material[2].anisotropy_direction: there is no texture named `bumps`",
        ),
        (principled("coat_normal_map = \"bumps\""), "`coat_normal_map` needs the key `clearcoat`"),
        (principled("clearcoat = 1\ncoat_normal_scale = 2"), "`coat_normal_scale` needs the key `coat_normal_map`"),
        (
            principled("clearcoat = 1\ncoat_normal_map = \"bumps\""),
            "material[2].coat_normal_map: there is no texture named `bumps`",
        ),
        (
            principled("clearcoat = 1\ncoat_normal_map = \"checks\"\ncoat_normal_scale = inf"),
            "material[2].coat_normal_scale: expected a number of magnitude at most 1e18, found inf",
        ),
        (principled("sheen_roughness = 0.1"), "`sheen_roughness` needs the key `sheen_color`"),
        (principled("transmission = 1\nattenuation_color = 0.5"), "`attenuation_color` needs the key `attenuation_distance`"),
        (principled("transmission = 1\nattenuation_distance = 2"), "`attenuation_distance` needs the key `attenuation_color`"),
        (principled("attenuation_color = 0.5\nattenuation_distance = 2"), "`attenuation_color` needs the key `transmission`"),
        (
            principled("transmission = 1\nthin = true\nattenuation_color = 0.5\nattenuation_distance = 2"),
            "a `thin` wall encloses nothing that could take light",
        ),
        (principled("transmission = 1\nattenuation_color = 0.5\nattenuation_distance = 0"), "expected a number above 0, found 0"),
        (principled("sheen_color = 1.5"), "sheen_color: expected a number from 0 to 1, found 1.5"),
        (principled("metallic = 1.1"), "metallic: expected a number from 0 to 1, found 1.1"),
        (principled("specular_color = -1"), "specular_color: expected a number from 0 to 1e18, found -1"),
        (material("type = \"pass\"\ntwo_sided = false"), "`pass` is the same on both sides"),
    ];
    for (text, expected) in rows {
        let found = complaint(&text);
        assert!(found.contains(expected), "expected: {expected}\nfound: {found}\nfor:\n{text}");
    }
    for keys in
        ["alpha = 0.1", "alpha_u = 0.1\nalpha_v = 0.1", "roughness_u = 0.1\nroughness_v = 0.5\ndistribution = \"beckmann\""]
    {
        assert!(load(&metal(keys)).is_ok(), "{keys}");
    }
}

#[test]
fn numbers_out_of_range_name_the_key_and_the_range() {
    let rows = [
        (blend("{ type = \"constant\", value = 1.5 }"), "material[2].weight.value: expected a number from 0 to 1, found 1.5"),
        (blend("{ type = \"constant\", value = -0.1 }"), "material[2].weight.value: expected a number from 0 to 1, found -0.1"),
        (blend("{ type = \"constant\", value = nan }"), "expected a number from 0 to 1, found NaN"),
        (blend("{ type = \"facing\", power = -1 }"), "weight.power: expected a number from 0 to 1e18, found -1"),
        (blend("{ type = \"facing\", power = inf }"), "weight.power: expected a number from 0 to 1e18, found inf"),
        (blend("{ type = \"fresnel\", ior = 0 }"), "weight.ior: expected an index of refraction from 0.1 to 10, found 0"),
        (blend("{ type = \"fresnel\", ior = -1.5 }"), "expected an index of refraction from 0.1 to 10, found -1.5"),
        (blend("{ type = \"texture\", texture = \"absent\" }"), "there is no texture named `absent`"),
        (blend("{ type = \"angle\" }"), "weight.type: `angle` is not a valid choice [valid choices: constant, facing"),
        (blend("{ type = \"threshold\", tau = 0.5 }"), "material[2].weight: the key `of` is missing"),
        (blend("0.5"), "weight"),
        (material("type = \"glass\"\nior = 0"), "material[2].ior: expected an index of refraction from 0.1 to 10, found 0"),
        (material("type = \"rough_glass\"\nroughness = 1.2"), "material[2].roughness: "),
        (material("type = \"conductor\"\nreflectance = 0.5\nroughness = -0.1"), "expected a number from 0 to 1, found -0.1"),
        (
            material("type = \"conductor\"\npreset = \"tin\""),
            "material[2].preset: `tin` is not a valid choice [valid choices: gold, copper",
        ),
        (
            material("type = \"conductor\"\npreset = \"gold\"\neta = 1\nk = 1"),
            "a conductor needs both `eta` and `k`, or `preset`",
        ),
        (material("type = \"conductor\"\neta = 1"), "a conductor needs both `eta` and `k`"),
        (material("type = \"mirror\"\nreflectance = 1.01"), "expected a number from 0 to 1, found 1.01"),
        (material("type = \"phong\"\ndiffuse = 0.6\nspecular = 0.5\nexponent = 9"), "diffuse + specular is at most 1"),
        (material("type = \"phong\"\ndiffuse = 0.6\nspecular = 0.1\nexponent = -1"), "exponent"),
        (
            material("type = \"diffuse\"\nreflectance = { texture = \"checks\" }"),
            "expected a number from 0 to 1, found 3 in the texture `checks`",
        ),
        (
            material("type = \"diffuse\"\nreflectance = { texture = \"checks\", factor = [0.3, 0.5, 0.1] }"),
            "material[2].reflectance.texture: expected a number from 0 to 1, found 1.5 in the texture `checks` times its factor",
        ),
        (
            material("type = \"diffuse\"\nreflectance = { texture = \"checks\", factor = -1 }"),
            "material[2].reflectance.factor: expected a number from 0 to 1e18, found -1",
        ),
        (
            material("type = \"glossy\"\nreflectance = 1\nexponent = { texture = \"checks\", channel = \"x\" }"),
            "exponent.channel: `x` is not a valid choice [did you mean `a`? valid choices: r, g, b, a]",
        ),
        (
            material("type = \"glossy\"\nreflectance = 1\nexponent = { texture = \"checks\", factor = [1, 1, 1] }"),
            "material[2].exponent.factor: ",
        ),
        (
            material("type = \"conductor\"\npreset = \"gold\"\nroughness = { texture = \"checks\", channel = \"g\" }"),
            "material[2].roughness.texture: expected a number from 0 to 1, found 3 in the texture `checks`",
        ),
        (
            blend("{ type = \"texture\", texture = \"checks\", factor = 0.5 }"),
            "material[2].weight.factor: `factor` needs the key `channel`",
        ),
        (
            blend("{ type = \"texture\", texture = \"checks\", channel = \"b\", factor = 1.5 }"),
            "material[2].weight.factor: expected a number from 0 to 1, found 1.5",
        ),
        (material("type = \"mirror\"\nopacity = 1.5"), "material[2].opacity: expected a number from 0 to 1, found 1.5"),
        (
            material("type = \"mirror\"\nopacity = \"half\""),
            "material[2].opacity: invalid type: string \"half\", expected one number or { texture = \"name\" }",
        ),
        (
            material("type = \"mirror\"\nopacity = { texture = \"checks\" }"),
            "material[2].opacity.texture: expected a number from 0 to 1, found 3 in the texture `checks`",
        ),
        (
            material("type = \"mirror\"\nopacity = { texture = \"checks\", factor = 0.3, cutoff = 2 }"),
            "material[2].opacity.cutoff: expected a number from 0 to 1, found 2",
        ),
        (
            material("type = \"mirror\"\nopacity = { texture = \"checks\", cutof = 0.5 }"),
            "material[2].opacity.cutof: unknown key `cutof`",
        ),
        (material("type = \"blend\"\nmaterials = [\"white\"]\nweight = { type = \"facing\" }"), "materials"),
        (
            material("type = \"blend\"\nmaterials = [\"white\", \"miror\"]\nweight = { type = \"facing\" }"),
            "there is no material named `miror` [did you mean `mirror`?",
        ),
    ];
    for (text, expected) in rows {
        let complaint = complaint(&text);
        assert!(complaint.starts_with("test.toml:") && complaint.contains(expected), "{text}\n{complaint}");
    }
}

#[test]
fn blends_in_a_circle_and_without_end_are_refused() {
    let of = |name: &str, first: &str, second: &str| {
        format!(
            "[[material]]\nname = \"{name}\"\ntype = \"blend\"\nmaterials = [\"{first}\", \"{second}\"]\n\
             weight = {{ type = \"facing\" }}\n"
        )
    };
    assert!(complaint(&of("m", "white", "m")).contains("the blend `m` contains itself"));
    let circle = of("m", "white", "a") + &of("a", "b", "mirror") + &of("b", "white", "m");
    assert!(complaint(&circle).contains("contains itself"));
    let stack = "[[material]]\nname = \"s\"\ntype = \"layered\"\ninterfaces = [\"m\"]\n";
    assert!(complaint(&(of("m", "white", "m") + stack)).contains("the blend `m` contains itself"));
    // Every level names the one before it twice: 2^17 leaves, then 2^64.
    for levels in [17, 64] {
        let mut doubling = of("l0", "white", "mirror");
        for level in 1..levels {
            doubling += &of(&format!("l{level}"), &format!("l{}", level - 1), &format!("l{}", level - 1));
        }
        let text = doubling + &of("m", &format!("l{}", levels - 1), "white");
        assert!(complaint(&text).contains("is of more than 65536 materials"));
    }
}

/// A chain of blends has a leaf and a weight more at every level, the weights of a leaf being those of its whole branch.
#[test]
fn a_chain_of_blends_as_long_as_it_may_be_is_packed_or_refused_by_name() {
    let chain = |levels: usize| {
        let mut text = String::new();
        for level in 0..levels {
            let name = if level + 1 == levels { "m".to_owned() } else { format!("l{level}") };
            let below = if level == 0 { "mirror".to_owned() } else { format!("l{}", level - 1) };
            text += &format!(
                "[[material]]\nname = \"{name}\"\ntype = \"blend\"\nmaterials = [\"white\", \"{below}\"]\n\
                 weight = {{ type = \"facing\" }}\n"
            );
        }
        load(&text).unwrap_or_else(|error| panic!("{error}"))
    };
    assert!(PackedScene::new(&chain(40)).is_ok());
    match PackedScene::new(&chain(3000)) {
        Err(PackError::TooManyWeights { limit, .. }) => assert_eq!(limit, 1 << 20),
        other => panic!("{:?}", other.map(|_| ())),
    }
}

#[test]
fn masks_with_alpha_and_normal_maps_inside_blends_say_what_to_do() {
    let mut rgba = Vec::new();
    let pixels = image::RgbaImage::from_pixel(2, 2, image::Rgba([200, 100, 50, 128]));
    pixels.write_to(&mut std::io::Cursor::new(&mut rgba), image::ImageFormat::Png).expect("encoding to memory works");
    let folder = folder_with(&[("mask.png", &rgba)]);
    let texture = "[[texture]]\nname = \"mask\"\ntype = \"image\"\nfile = \"mask.png\"\ncolor_space = \"linear\"\n";
    let text = format!("{texture}{}", blend("{ type = \"texture\", texture = \"mask\" }"));
    let error = load_in(folder.path(), &text).expect_err("alpha");
    assert!(error.to_string().contains("whose alpha channel would have no effect"), "{error}");
    let bumpy = "[[material]]\nname = \"bumpy\"\ntype = \"diffuse\"\nreflectance = 0.5\nnormal_map = \"mask\"\n";
    let inside = material("type = \"blend\"\nmaterials = [\"bumpy\", \"white\"]\nweight = { type = \"facing\" }");
    let error = load_in(folder.path(), &format!("{texture}{bumpy}{inside}")).expect_err("a normal map inside");
    assert!(error.to_string().contains("`bumpy` has a normal map and is part of a blend"), "{error}");
}

/// Values with a meaning are accepted: x⁰ is 1 everywhere; a threshold's tau may be any number; a threshold
/// of a threshold is one.
#[test]
fn limits_with_a_meaning_are_accepted() {
    for weight in [
        "{ type = \"facing\", power = 0 }",
        "{ type = \"constant\", value = 0 }",
        "{ type = \"constant\", value = 1 }",
        "{ type = \"threshold\", tau = 2, of = { type = \"facing\" } }",
        "{ type = \"threshold\", tau = -1, of = { type = \"facing\" } }",
        "{ type = \"threshold\", tau = 0.5, of = { type = \"threshold\", tau = 0.2, of = { type = \"facing\" } } }",
    ] {
        let scene = load(&blend(weight)).unwrap_or_else(|error| panic!("{error}"));
        assert!(PackedScene::new(&scene).is_ok(), "{weight}");
    }
}
