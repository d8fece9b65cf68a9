//! `gpt verify`.

use super::*;

#[test]
fn verify_compares_the_devices_and_says_how_much_matches() {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return;
    }
    let place = Workplace::new();
    let answer = place.expect(0, "verify scene.toml --spp 2");
    let line = text(&place.run("verify scene.toml --spp 2").stdout);
    assert!(line.contains("agrees") && line.contains("of 768 paths match"), "{line} {answer}");
    let verdicts: Value = serde_json::from_slice(&place.run("verify scene.toml --spp 2 --json").stdout).expect("it is JSON");
    assert_eq!(verdicts[0]["agrees"], true);
    assert_eq!(verdicts[0]["paths"], 768);
    assert_eq!(place.files(), ["scene.toml"], "evidence is left only where something differs");
    place.expect(3, "verify missing.toml");
    place.expect(4, "verify scene.toml --device no-such-device");
    place.expect(2, "verify --spp 0");
}

/// The last line is the verdict, in words; a folder that cannot be made changes nothing about it.
#[test]
fn verify_ends_with_its_verdict() {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return;
    }
    let place = Workplace::new();
    let green = text(&place.run("verify cornell --size 24x24 --spp 2").stdout);
    assert!(green.ends_with("\nGREEN: it agrees\n"), "{green}");
    std::fs::write(place.path("taken"), "a file, and no folder").expect("it is written");
    let red = place.run("verify cornell --size 24x24 --spp 2 --plant brdf --evidence taken/below");
    let (said, warned) = (text(&red.stdout), text(&red.stderr));
    assert_eq!(red.status.code(), Some(7), "{said} {warned}");
    assert!(said.ends_with("\nRED: 1 of 1 differ: cornell\n"), "{said}");
    assert!(said.contains("differ by more than rounding explains, and none may"), "{said}");
    assert!(warned.contains("cannot be kept in taken/below"), "{warned}");
}

/// Either place for the film's sums can be asked for, and the plan says which one it takes.
#[test]
#[ignore = "slow"]
fn the_film_is_where_it_is_asked_to_be() {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return;
    }
    let place = Workplace::new();
    for (film, words) in [("textures", "rgba32float storage textures"), ("buffers", "storage buffers")] {
        let plan = text(&place.run(&format!("check cornell --plan --film {film}")).stdout);
        let line = plan.lines().find(|line| line.starts_with("film  ") && line.contains("rows together")).unwrap_or_default();
        assert!(line.contains(words) && line.contains("(asked for)"), "{plan}");
        let green = text(&place.run(&format!("verify cornell --size 24x24 --spp 2 --film {film}")).stdout);
        assert!(green.ends_with("\nGREEN: it agrees\n"), "{green}");
    }
    for arguments in ["verify --device cpu --film buffers", "bench speed scene.toml --device cpu --film textures"] {
        let stderr = place.expect(2, arguments);
        assert!(stderr.contains("leave out --film"), "gpt {arguments}: {stderr}");
    }
}

/// Without a graphics device, the CPU is held against closed forms, and nothing else.
#[test]
fn verify_on_the_cpu_holds_the_reference_against_closed_forms() {
    let place = Workplace::new();
    let output = place.run("verify --device cpu");
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.ends_with(&format!("\nGREEN: all {} agree\n", gpt::verify::closed_forms::count())), "{said}");
    let stderr = place.expect(2, "verify cornell --device cpu");
    assert!(stderr.contains("with --device cpu there are no two devices to compare"), "{stderr}");
}

/// Red with each fault, green without; the pictures are left behind, and the command for the worst path shows where the two part.
#[test]
#[ignore = "slow"]
fn verify_notices_planted_faults_and_says_how_to_follow_the_worst_path() {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return;
    }
    let place = Workplace::new();
    let small = "verify cornell --size 24x24 --spp 2";
    place.expect(0, small);
    for fault in ["brdf", "mis", "light"] {
        let stderr = place.expect(7, &format!("{small} --plant {fault} --evidence {fault}"));
        for ending in ["gpu.exr", "cpu.exr", "difference.exr", "heat.png"] {
            assert!(place.path(fault).join(format!("cornell-{ending}")).is_file(), "{fault}: {ending}");
        }
        let (_, command) = stderr.split_once(": gpt verify").expect("the command is named");
        let (command, _) = command.split_once(" follows it").expect("to its end");
        let planted = place.run(&format!("verify {command}"));
        let shown = text(&planted.stdout);
        assert_eq!(planted.status.code(), Some(7), "{shown}");
        assert!(shown.contains("\n* ") && shown.contains("the radiance DIFFERS; the paths part at vertex"), "{shown}");
        let sound = command.replace(&format!(" --plant {fault}"), "");
        assert_ne!(sound, command, "the fault is part of it");
        let shown = text(&place.run(&format!("verify {sound}")).stdout);
        assert!(shown.ends_with("the radiance agrees; the paths do not part\n"), "{fault}: {shown}");
    }
    let stderr = place.expect(2, "verify scene.toml --plant mis");
    assert!(stderr.contains("the scene has nothing for the fault `mis` to act on"), "{stderr}");
    place.expect(2, "verify cornell --plant nothing");
}

#[test]
fn verify_follows_one_path_on_both_devices() {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return;
    }
    let place = Workplace::new();
    place.expect(0, "render spheres --size 24x16 --spp 1 --first-sample 3 --device gpu -q -o one.exr");
    let image = place.image("one.exr");
    // Mirror, glass, floor and background.
    for (x, y) in [(8, 8), (15, 9), (12, 14), (12, 0)] {
        let output = place.run(&format!("verify spheres --size 24x16 --pixel {x},{y} --sample 3 --json"));
        let path: Value = serde_json::from_slice(&output.stdout).expect("it is JSON");
        assert_eq!(path["agrees"], true, "{path}");
        let rendered = image.pixels[y * 24 + x];
        for (channel, value) in rendered.iter().enumerate() {
            let traced = path["gpu_radiance"][channel].as_f64().expect("a number");
            assert!((traced - f64::from(*value)).abs() <= 1e-6 * traced.abs(), "{x},{y}: {traced}, rendered {value}");
        }
        let rows = path["rows"].as_array().expect("rows");
        let both = rows.iter().filter(|row| row["cpu"] != Value::Null && row["gpu"] != Value::Null).count();
        assert!(both >= 2, "{path}");
        assert!(rows.iter().all(|row| row["parts"] == false), "{path}");
    }
    let stderr = place.expect(2, "verify scene.toml --pixel 24,0");
    assert!(stderr.contains("there is no pixel 24,0 in a picture of 24x16"), "{stderr}");
    place.expect(2, "verify scene.toml --pixel 24");
    place.expect(2, "verify scene.toml --sample 1");
}

#[test]
#[ignore = "long: gpt verify of every built-in scene"]
fn long_verify_without_a_scene_tries_closed_forms_and_every_built_in_scene() {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return;
    }
    let place = Workplace::new();
    let output = place.run("verify --size 32x32 --spp 1 --json");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let findings: Vec<Value> = serde_json::from_slice(&output.stdout).expect("it is JSON");
    let closed = findings.iter().filter(|finding| finding["closed_form"].is_string()).count();
    let scenes = findings.iter().filter(|finding| finding["scene"].is_string()).count();
    // One with keyframes is verified as it is without a frame, and at its first.
    let keyed = gpt::load::builtin_names()
        .filter(|name| !gpt::load::load(Some(name)).expect("it is built in").animation.is_empty())
        .count();
    assert!(keyed > 0);
    assert_eq!((closed, scenes), (gpt::verify::closed_forms::count(), gpt::load::builtin_names().count() + keyed));
}
