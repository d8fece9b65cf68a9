//! Materials and textures.

use super::{Folder, SCENE, read, report, valid};
use crate::scene::{ColorInput, ConductorFresnel, Dispersion, MaterialKind, Scene, Slab, TextureKind, TextureWrap};
use crate::spectrum::Spectrum;

fn kind(scene: &Scene) -> &MaterialKind {
    &scene.materials[scene.shapes.last().expect("a shape").material].kind
}

fn of(material: &str) -> Scene {
    valid(&format!("Material {material}\nShape \"sphere\""))
}

#[test]
fn diffuse_surfaces_reflect_what_they_say() {
    let reflectance = |scene: &Scene| match kind(scene) {
        MaterialKind::Diffuse { reflectance: ColorInput::Constant(colour) } => *colour,
        other => panic!("{other:?}"),
    };
    assert_eq!(reflectance(&of("\"diffuse\" \"rgb reflectance\" [ .1 .2 .3 ]")), Spectrum::new(0.1, 0.2, 0.3));
    assert_eq!(reflectance(&of("\"diffuse\"")), Spectrum::grey(0.5));
    // A constant spectrum is grey under daylight; half of it is half as bright.
    let grey = reflectance(&of("\"diffuse\" \"spectrum reflectance\" [ 300 .4 900 .4 ]"));
    assert!(grey.distance(Spectrum::grey(0.4)) < 1e-9, "{grey}");
    let red = reflectance(&of("\"diffuse\" \"spectrum reflectance\" [ 300 0 580 0 620 1 900 1 ]"));
    assert!(red.r() > 0.8 && red.g() < 0.1 && red.b() < 0.02, "{red}");
    let folder = Folder::new(&[
        ("a.pbrt", SCENE.replace("MORE", "Material \"diffuse\" \"spectrum reflectance\" \"a.spd\"\nShape \"sphere\"").as_bytes()),
        ("a.spd", b"# wavelength, value\n300 .4\n900 .4 # the end\n"),
    ]);
    assert!(reflectance(&folder.valid("a.pbrt")).distance(Spectrum::grey(0.4)) < 1e-9);
    let leaf =
        of("\"diffusetransmission\" \"rgb reflectance\" [ .2 .2 .2 ] \"rgb transmittance\" [ .4 .4 .4 ] \"float scale\" .5");
    let MaterialKind::DiffuseTransmission { reflectance, transmittance } = kind(&leaf) else { panic!("{:?}", kind(&leaf)) };
    assert_eq!((*reflectance, *transmittance), (ColorInput::grey(0.1), ColorInput::grey(0.2)));
}

/// The width of microfacets is the root of the roughness, unless that is not to be remapped.
#[test]
fn roughness_becomes_width_as_there() {
    let widths = |parameters: &str| {
        let scene = of(&format!("\"conductor\" {parameters}"));
        let MaterialKind::Conductor { facets, .. } = kind(&scene) else { panic!("{:?}", kind(&scene)) };
        (facets.alpha, facets.alpha_v)
    };
    assert_eq!(widths("\"float roughness\" .25"), (ColorInput::grey(0.5), None));
    assert_eq!(widths("\"float roughness\" .25 \"bool remaproughness\" false"), (ColorInput::grey(0.25), None));
    assert_eq!(widths("\"float uroughness\" .25 \"float vroughness\" .04"), (ColorInput::grey(0.5), Some(ColorInput::grey(0.2))));
    assert_eq!(widths("\"float roughness\" .04 \"float uroughness\" .25"), (ColorInput::grey(0.5), Some(ColorInput::grey(0.2))));
    assert_eq!(widths(""), (ColorInput::grey(0.0), None));
    // Slightly rough is smooth there.
    assert_eq!(widths("\"float roughness\" 9e-7"), (ColorInput::grey(0.0), None));
}

#[test]
fn metals_are_told_by_name_by_numbers_and_by_reflectance() {
    let constants = |parameters: &str| {
        let scene = of(&format!("\"conductor\" {parameters}"));
        assert_eq!(report(&scene), "");
        match kind(&scene) {
            MaterialKind::Conductor { fresnel: ConductorFresnel::Complex { eta, k }, .. } => [*eta, *k],
            other => panic!("{other:?}"),
        }
    };
    let gold = constants("\"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"");
    assert!((gold[0].r() - 0.143119).abs() < 1e-9 && constants("")[0].r() > 0.2, "copper where nothing is said");
    assert_eq!(
        constants("\"rgb eta\" [ .2 .9 1.1 ] \"rgb k\" [ 4 3 2 ]"),
        [[0.2, 0.9, 1.1], [4.0, 3.0, 2.0]].map(Spectrum::from_rgb)
    );
    // Each of two metals has its part.
    let mixed = constants("\"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Ag-k\"");
    assert!(mixed[0] == gold[0] && (mixed[1].r() - 4.82835).abs() < 1e-9);
    let [eta, k] = constants("\"rgb reflectance\" [ .9 .5 0 ]");
    let reflected =
        ((eta - Spectrum::WHITE) * (eta - Spectrum::WHITE) + k * k) / ((eta + Spectrum::WHITE) * (eta + Spectrum::WHITE) + k * k);
    assert!(reflected.distance(Spectrum::new(0.9, 0.5, 0.0)) < 1e-9, "{reflected}");
    let error =
        read("Material \"conductor\" \"rgb reflectance\" [ .5 .5 .5 ] \"spectrum eta\" \"metal-Au-eta\"\nShape \"sphere\"");
    assert!(error.map(|_| ()).expect_err("both").message().contains("either `reflectance`"));
}

#[test]
fn glasses_bend_each_colour_as_they_should() {
    let plain = of("\"dielectric\" \"float eta\" 1.4");
    assert!(matches!(kind(&plain), MaterialKind::Glass { ior, thin: false, dispersion: None, .. } if *ior == 1.4));
    assert!(matches!(kind(&of("\"dielectric\"")), MaterialKind::Glass { ior: 1.5, .. }));
    assert!(matches!(kind(&of("\"thindielectric\"")), MaterialKind::Glass { thin: true, .. }));
    let flint = of("\"dielectric\" \"spectrum eta\" \"glass-F11\"");
    let MaterialKind::Glass { ior, dispersion: Some(Dispersion::Sellmeier { .. }), .. } = kind(&flint) else {
        panic!("{:?}", kind(&flint))
    };
    assert!((ior - 1.7847).abs() < 1e-3 && report(&flint).is_empty(), "{ior}");
    let curve = of("\"dielectric\" \"spectrum eta\" [ 400 1.53 500 1.52 600 1.515 700 1.51 ]");
    assert!(
        matches!(kind(&curve), MaterialKind::Glass { dispersion: Some(Dispersion::Abbe(_)), .. })
            && report(&curve).contains("Cauchy")
    );
    let rough = of("\"dielectric\" \"float roughness\" .09");
    assert!(matches!(kind(&rough), MaterialKind::RoughGlass { facets, .. } if facets.alpha == ColorInput::grey(0.3)));
}

/// A coat over its base, with what is between them; both sides look alike.
#[test]
fn coats_lie_over_their_bases() {
    let stack = |material: &str| {
        let scene = of(material);
        let MaterialKind::Layered(layers) = kind(&scene).clone() else { panic!("{:?}", kind(&scene)) };
        (scene, layers)
    };
    let (scene, layers) = stack("\"coateddiffuse\" \"float roughness\" .09 \"float eta\" 1.3 \"rgb reflectance\" [ .1 .2 .3 ]");
    let [coat, base] = layers.interfaces[..] else { panic!("{:?}", layers.interfaces) };
    assert!(
        matches!(&scene.materials[coat].kind, MaterialKind::RoughGlass { ior, facets, .. } if *ior == 1.3 && facets.alpha == ColorInput::grey(0.3))
    );
    assert!(matches!(&scene.materials[base].kind, MaterialKind::Diffuse { .. }));
    let slab = &layers.slabs[0];
    let medium = &scene.media[slab.medium.expect("it absorbs")];
    assert_eq!(
        (slab.thickness, medium.absorption, medium.scattering),
        (ColorInput::grey(0.01), Spectrum::WHITE, Spectrum::BLACK)
    );
    assert!(layers.mirrored && report(&scene).contains("within 10 crossings"), "{}", report(&scene));
    let (scene, layers) = stack("\"coateddiffuse\" \"float thickness\" 0 \"integer maxdepth\" 100");
    assert!(layers.slabs[0] == Slab::NOTHING && report(&scene).is_empty());
    // The metal's index is that over the coat's.
    let (scene, layers) = stack(
        "\"coatedconductor\" \"float interface.eta\" 2 \"rgb conductor.eta\" [ 1 2 3 ] \"rgb conductor.k\" [ 4 5 6 ] \"rgb albedo\" [ .5 .5 .5 ]",
    );
    let MaterialKind::Conductor { fresnel: ConductorFresnel::Complex { eta, k }, .. } =
        &scene.materials[layers.interfaces[1]].kind
    else {
        panic!("{:?}", scene.materials[layers.interfaces[1]].kind)
    };
    assert_eq!([eta.to_rgb(), k.to_rgb()], [[0.5, 1.0, 1.5], [2.0, 2.5, 3.0]]);
    assert_eq!(scene.media[layers.slabs[0].medium.expect("it scatters")].scattering, Spectrum::grey(0.5));
}

#[test]
fn mixtures_have_the_second_by_the_amount() {
    let names = "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"b\" \"string type\" \"dielectric\"\n";
    let scene = valid(&format!(
        "{names}MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" .25\nNamedMaterial \"m\"\nShape \"sphere\""
    ));
    let MaterialKind::Blend { materials, weight } = kind(&scene) else { panic!("{:?}", kind(&scene)) };
    assert_eq!(materials.map(|part| scene.materials[part].name.as_str()), ["b", "a"]);
    assert_eq!(format!("{weight:?}"), "Constant { value: 0.25 }");
    let within = "MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [ \"m\" \"m\" ]\nNamedMaterial \"m\"\nShape \"sphere\"";
    let error = read(within).map(|_| ()).expect_err("within itself");
    assert!(error.message().contains("within itself"), "{error}");
}

#[test]
fn bodies_that_light_gets_into_are_media_within_glass() {
    let scene = of("\"subsurface\" \"string name\" \"Skin1\" \"float scale\" 2 \"float eta\" 1.4");
    let material = &scene.materials[scene.shapes[0].material];
    let medium = &scene.media[material.interior.expect("it is filled")];
    assert!(
        matches!(material.kind, MaterialKind::Glass { ior: 1.4, .. }) && medium.scattering == Spectrum::new(1.48, 1.76, 2.02)
    );
    assert!(report(&scene).contains("a medium within glass"), "{}", report(&scene));
    let bright = of("\"subsurface\" \"rgb reflectance\" [ .9 .5 .1 ] \"rgb mfp\" [ 2 2 2 ]");
    let medium = &bright.media[0];
    let albedo = medium.scattering / (medium.scattering + medium.absorption);
    assert!((medium.extinction().r() - 0.5).abs() < 1e-9 && albedo.r() > 0.97 && albedo.b() < 0.6, "{albedo}");
}

fn textured(texture: &str, parameter: &str) -> Scene {
    let folder = Folder::new(&[(
        "a.pbrt",
        SCENE.replace("MORE", &format!("{texture}\nMaterial {parameter}\nShape \"sphere\"")).as_bytes(),
    )]);
    let texel = |x: u32, y: u32| image::Rgb([x as u8 * 100, y as u8 * 100, 50]);
    image::RgbImage::from_fn(3, 2, texel).save(folder.path("a.png")).expect("a picture");
    let grey = |x: u32, _: u32| image::Luma([x as u8 * 100]);
    image::GrayImage::from_fn(3, 2, grey).save(folder.path("g.png")).expect("a picture");
    folder.valid("a.pbrt")
}

const RED: &str = "\"diffuse\" \"texture reflectance\" \"t\"";

#[test]
fn pictures_are_looked_up_as_there() {
    let picture = "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\"";
    let scene =
        textured(&format!("{picture} \"float uscale\" 2 \"float vdelta\" .5 \"string wrap\" \"clamp\" \"float scale\" .5"), RED);
    let texture = &scene.textures[0];
    let TextureKind::Image(image) = &texture.kind else { panic!("{texture:?}") };
    assert_eq!((image.scale, texture.transform.offset, image.wrap), ([2.0, 1.0], [0.0, 0.5], [TextureWrap::Clamp; 2]));
    assert!(
        matches!(kind(&scene), MaterialKind::Diffuse { reflectance: ColorInput::ScaledTexture(_, factor) } if *factor == Spectrum::grey(0.5))
    );
    assert_eq!(report(&scene), "");
    let first = |scene: &Scene, index: usize| match &scene.textures[0].kind {
        TextureKind::Image(image) => image.image.texels.color(index),
        other => panic!("{other:?}"),
    };
    let linear = textured(&format!("{picture} \"string encoding\" \"linear\""), RED);
    assert!((first(&linear, 1).x - 100.0 / 255.0).abs() < 1e-6 && (first(&scene, 1).x - 0.1274).abs() < 1e-3);
    let inverted = textured(&format!("{picture} \"bool invert\" true"), RED);
    assert!((first(&inverted, 1).x - (1.0 - 0.1274)).abs() < 1e-3, "{}", first(&inverted, 1));
    // More than 1 is 1 where a share of light is meant.
    let bright = textured(&format!("{picture} \"float scale\" 3"), RED);
    assert!(first(&bright, 2).x == 1.0 && (first(&bright, 1).x - 0.382).abs() < 2e-3);
}

#[test]
fn numbers_of_pictures_are_their_means() {
    let picture = |name: &str| {
        format!("Texture \"r\" \"float\" \"imagemap\" \"string filename\" \"{name}\" \"string encoding\" \"linear\"")
    };
    let width = |name: &str, remap: bool| {
        let scene =
            textured(&picture(name), &format!("\"conductor\" \"texture roughness\" \"r\" \"bool remaproughness\" {remap}"));
        assert_eq!(report(&scene), "");
        match &scene.textures[0].kind {
            TextureKind::Image(image) => image.image.texels.color(1).x,
            other => panic!("{other:?}"),
        }
    };
    let mean = (100.0 + 0.0 + 50.0) / (3.0 * 255.0);
    assert!((width("a.png", false) - mean).abs() < 1e-6);
    assert!((width("a.png", true) - mean.sqrt()).abs() < 1e-6);
    assert!((width("g.png", false) - 100.0 / 255.0).abs() < 1e-6);
}

#[test]
fn textures_are_made_of_others() {
    let tiles =
        "Texture \"c\" \"spectrum\" \"checkerboard\" \"float uscale\" 4 \"rgb tex1\" [ .2 .4 .6 ] \"rgb tex2\" [ 1 1 1 ]\n";
    let picture = "Texture \"p\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\"\n";
    let halved = textured(&format!("{tiles}Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"c\" \"float scale\" .5"), RED);
    assert!(matches!(&halved.textures[0].kind, TextureKind::Checker { a, .. } if *a == Spectrum::new(0.2, 0.4, 0.6)));
    assert!(
        matches!(kind(&halved), MaterialKind::Diffuse { reflectance: ColorInput::ScaledTexture(_, factor) } if *factor == Spectrum::grey(0.5))
    );
    let grey = "Texture \"g\" \"float\" \"imagemap\" \"string filename\" \"g.png\"\n";
    let product = textured(
        &format!("{picture}{grey}Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"p\" \"texture scale\" \"g\""),
        RED,
    );
    assert!(
        product.textures.iter().any(|texture| texture.times.is_some()) && report(&product).is_empty(),
        "{}",
        report(&product)
    );
    let mixed = textured(
        &format!("{tiles}Texture \"t\" \"spectrum\" \"mix\" \"texture tex1\" \"c\" \"rgb tex2\" [ 0 0 0 ] \"float amount\" .25"),
        RED,
    );
    assert!(report(&mixed).contains("made of others"), "{}", report(&mixed));
    let TextureKind::Image(image) = &mixed.textures[0].kind else { panic!("a picture") };
    // The lower left square is the first colour.
    let lower_left = image.image.texels.color((image.image.height as usize - 1) * image.image.width as usize);
    assert!((lower_left - glam::Vec3::new(0.15, 0.3, 0.45)).abs().max_element() < 1e-5, "{lower_left}");
    let constant = textured("Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [ .1 .1 .1 ]", RED);
    assert!(
        constant.textures.is_empty()
            && matches!(kind(&constant), MaterialKind::Diffuse { reflectance } if *reflectance == ColorInput::grey(0.1))
    );
    let circle = "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"t\"";
    let error = read(&format!("{circle}\nMaterial {RED}\nShape \"sphere\"")).map(|_| ()).expect_err("within itself");
    assert!(error.message().contains("within itself"), "{error}");
    // Each of forty textures is the one before twice.
    let doubled: String = (1..40)
        .map(|i| format!("Texture \"{i}\" \"spectrum\" \"mix\" \"texture tex1\" \"{}\" \"texture tex2\" \"{}\"\n", i - 1, i - 1))
        .collect();
    let first = tiles.replace("\"c\"", "\"0\"");
    let many = textured(&format!("{first}{doubled}"), "\"diffuse\" \"texture reflectance\" \"39\"");
    assert!(report(&many).contains("more than 256 parts"), "{}", report(&many));
}

#[test]
fn normals_are_bent_by_pictures_and_by_heights() {
    let scene = textured("", "\"diffuse\" \"string normalmap\" \"a.png\"");
    assert!(scene.materials[scene.shapes[0].material].normal_map.is_some());
    let bumps = textured(
        "Texture \"h\" \"float\" \"imagemap\" \"string filename\" \"g.png\"",
        "\"diffuse\" \"texture displacement\" \"h\"",
    );
    assert!(bumps.materials[bumps.shapes[0].material].normal_map.is_some());
    let TextureKind::Image(image) = &bumps.textures[0].kind else { panic!("a picture") };
    assert!((image.image.texels.color(1).x - 0.1274).abs() < 1e-3, "sRGB is decoded");
}
