//! `gpt denoise` and `gpt render --denoise`, with the real library where it is installed, and without it.

use gpt::denoise::library::{Library, OidnError, VARIABLE};
use gpt::output::Channels;

use super::common::effort::announce;
use super::*;

/// True if the library is installed; else a line says what is left out.
fn is_installed() -> bool {
    match Library::open() {
        Ok(_) => true,
        Err(OidnError::Missing(_)) => {
            announce(&format!("left out: denoising by Open Image Denoise, which is not installed ({VARIABLE} names it)"));
            false
        }
        Err(error) => panic!("{error}"),
    }
}

/// Relative to the picture: of the absolute one, the edges of the lamp are nearly all, and those a denoiser softens.
fn error(a: &Image, b: &Image) -> f64 {
    gpt::compare::compare(a, b).expect("one size").relmse.all
}

#[test]
fn a_denoised_picture_is_nearer_the_truth_and_says_its_bias() {
    if !is_installed() {
        return;
    }
    let place = Workplace::new();
    let cornell = "render cornell --device cpu --size 64x64 -q";
    place.expect(0, &format!("{cornell} --spp 8 --aov albedo,normal,variance,samples -o raw.exr"));
    place.expect(0, &format!("{cornell} --spp 256 --seed 7 -o truth.exr"));
    let raw = fs::read(place.path("raw.exr")).expect("a picture");
    let said = place.expect(0, "denoise raw.exr -o clean.exr -o clean.png");
    assert!(said.contains("Open Image Denoise 2") && said.contains("albedo and normals") && said.contains("tiles"), "{said}");
    assert_eq!(raw, fs::read(place.path("raw.exr")).expect("a picture"), "the raw picture stays");
    let [raw, clean, truth] = ["raw.exr", "clean.exr", "truth.exr"].map(|name| place.image(name));
    let (before, after) = (error(&raw, &truth), error(&clean, &truth));
    assert!(after < 0.4 * before, "{before} before, {after} after");
    let header = Channels::read(&place.path("clean.exr")).expect("a picture");
    assert!(header.attribute("gpt:denoiser").is_some_and(|name| name.starts_with("Open Image Denoise")));
    assert!(header.attribute("gpt:denoiserBias").is_some_and(|bias| bias.starts_with("energy ")));
    let report: Value = serde_json::from_slice(&place.run("denoise raw.exr -o again.exr --json").stdout).expect("JSON");
    assert_eq!((&report["bias"]["tiles"], &report["bias"]["noise_is_measured"]), (&Value::from(16), &Value::Bool(true)));
    // Without layers it is done too, by the picture alone, and less well.
    place.expect(0, &format!("{cornell} --spp 8 -o bare.exr"));
    assert!(place.expect(0, "denoise bare.exr -o bare-clean.exr").contains("layers: none"));
    let bare = error(&place.image("bare-clean.exr"), &truth);
    assert!(bare < before && bare != after, "{bare} without layers");
    assert!(place.expect(0, "compare clean.exr clean.exr").contains("clean.exr was denoised"));
}

#[test]
fn a_render_is_denoised_beside_itself() {
    if !is_installed() {
        return;
    }
    let place = Workplace::new();
    let said = place.expect(0, "render scene.toml --device cpu --denoise -o a.exr -o a.png");
    assert!(said.contains("a.denoised.exr, a.denoised.png: by Open Image Denoise"), "{said}");
    assert_eq!(place.files(), ["a.denoised.exr", "a.denoised.png", "a.exr", "a.png", "scene.toml"]);
    assert_ne!(place.image("a.exr").pixels, place.image("a.denoised.exr").pixels);
    place.expect(0, "render scene.toml --device cpu -q -o plain.exr");
    assert_eq!(place.image("a.exr").pixels, place.image("plain.exr").pixels, "the raw picture is what it is without");
    // The layers that were rendered are in the raw file.
    assert!(Channels::read(&place.path("a.exr")).expect("a picture").channel("Albedo.R").is_some());
}

/// The benchmark measures denoised pictures beside raw ones.
#[test]
fn denoising_is_a_setting_of_the_benchmark() {
    if !is_installed() {
        return;
    }
    let place = Workplace::new();
    let counts = "--size 32x32 --spp 8 --levels 2 --replications 2 --reference-spp 64 --references kept";
    let output = place.run(&format!("bench convergence scene.toml --device cpu --denoise no,yes {counts} -o out"));
    let [said, progress] = [&output.stdout, &output.stderr].map(|bytes| text(bytes));
    assert!(output.status.success() && said.contains("  raw ") && said.contains("  denoised "), "{said}{progress}");
    let report: Value = serde_json::from_slice(&fs::read(place.path("out/convergence.json")).expect("a file")).expect("JSON");
    let settings = report.pointer("/scenes/0/settings").expect("its settings");
    let errors = |setting: usize| settings[setting]["levels"][1]["mse"]["estimate"].as_f64();
    assert_eq!((&settings[0]["setting"], &settings[1]["setting"]), (&"raw".into(), &"denoised".into()));
    assert!(errors(0).is_some() && errors(1).is_some() && errors(0) != errors(1), "{settings}");
    let page = fs::read_to_string(place.path("out/report.html")).expect("a page");
    assert!(page.contains("denoiser where it is denoised"));
}

/// Parts are denoised once they are joined, by what the whole picture's own denoising is helped by.
#[test]
fn parts_are_denoised_once_they_are_joined() {
    let place = Workplace::new();
    let render = "render scene.toml --device cpu --denoise";
    for (name, first) in [("a", 0), ("b", 4)] {
        let said = place.expect(0, &format!("{render} --spp 4 --first-sample {first} -o {name}.exr"));
        assert!(said.contains("gpt merge --denoise"), "{said}");
    }
    assert_eq!(place.files(), ["a.exr", "b.exr", "scene.toml"]);
    let output = place.command("merge a.exr b.exr --denoise -o x.exr").env(VARIABLE, "/nowhere").output().expect("it starts");
    assert_eq!((output.status.code(), place.path("x.exr").exists()), (Some(1), false), "{}", text(&output.stderr));
    if !is_installed() {
        return;
    }
    let said = place.expect(0, "merge a.exr b.exr --denoise -o x.exr");
    assert!(said.contains("x.denoised.exr: by Open Image Denoise") && said.contains("albedo and normals"), "{said}");
    place.expect(0, &format!("{render} --spp 8 -q -o whole.exr"));
    let near = |a: &str, b: &str| {
        let (a, b) = (place.image(a), place.image(b));
        a.pixels.iter().flatten().zip(b.pixels.iter().flatten()).all(|(a, b)| (a - b).abs() <= 1e-3 * (1.0 + b.abs()))
    };
    assert!(near("x.denoised.exr", "whole.denoised.exr"));
    // The control: fewer samples are denoised to something else.
    place.expect(0, "merge a.exr --denoise -o y.exr");
    assert!(!near("y.denoised.exr", "whole.denoised.exr"));
}

/// Its absence is found before anything is rendered.
#[test]
fn a_missing_library_is_named_with_how_to_get_it() {
    let place = Workplace::new();
    place.expect(0, "render scene.toml --device cpu -q -o a.exr");
    for arguments in [
        "denoise a.exr -o b.exr",
        "render scene.toml --device cpu --spp 1000000 --denoise -o c.exr",
        "bench convergence scene.toml --device cpu --spp 1000000 --denoise yes -o report",
    ] {
        let output = place.command(arguments).env(VARIABLE, "/nowhere/at/all").output().expect("the program starts");
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{stderr}");
        assert!(stderr.contains("pip install pyoidn") && stderr.contains("/nowhere/at/all"), "{stderr}");
    }
    fs::write(place.path("libOpenImageDenoise.so.2"), "no library").expect("a file");
    let output = place.command("denoise a.exr -o b.exr").env(VARIABLE, place.0.path()).output().expect("the program starts");
    assert!(text(&output.stderr).contains("is not Open Image Denoise"), "{}", text(&output.stderr));
    assert!(place.expect(2, "denoise a.exr -o a.exr").contains("would be overwritten"));
    place.expect(3, "denoise missing.exr -o b.exr");
    assert!(place.expect(2, "render scene.toml --device cpu --denoise -o a.png").contains(".exr"));
    assert!(!place.path("b.exr").exists() && !place.path("c.exr").exists());
}
