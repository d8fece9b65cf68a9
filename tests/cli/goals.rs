//! Renders that end by time or error.

use super::*;

#[test]
fn a_time_limit_saves_a_whole_picture_and_says_how_many_samples_it_has() {
    let place = Workplace::new();
    let said = place.expect(0, "render scene.toml --device cpu --spp 100000000 --time-limit 0.4 -o a.exr --stats s.json");
    let stats = place.stats("s.json");
    let samples = stats["spp_done"].as_u64().expect("a number");
    assert!((1..100_000_000).contains(&samples), "{samples}");
    assert!(said.contains(&format!("{samples} spp of 100000000 when time was up")), "{said}");
    assert_eq!((&stats["stopped_by"], &stats["interrupted"]), (&"time_limit".into(), &false.into()));
    assert_eq!(stats["samples"], samples * 24 * 16);
    assert_eq!(header_number(&place.path("a.exr"), "gpt:samples"), samples as i32);
    assert_eq!(header_number(&place.path("a.exr"), "gpt:complete"), 0);
    // The picture equals that of as many samples.
    place.expect(0, &format!("render scene.toml --device cpu --spp {samples} -o b.exr"));
    place.expect(0, "compare a.exr b.exr --tolerance 1e-5");
}

#[test]
fn enough_time_changes_nothing() {
    let place = Workplace::new();
    place.expect(0, "render scene.toml --device cpu --spp 12 --time-limit 1e9 -o a.exr --stats s.json");
    assert_eq!(place.stats("s.json")["stopped_by"], "samples");
    assert_eq!(header_number(&place.path("a.exr"), "gpt:samples"), 12);
    assert_eq!(header_number(&place.path("a.exr"), "gpt:complete"), 1);
}

#[test]
fn an_error_to_reach_is_reached_or_its_lack_is_told() {
    let place = Workplace::new();
    let said = place.expect(0, "render scene.toml --device cpu --spp 4096 --target-error 0.01 -o a.exr --stats s.json");
    let stats = place.stats("s.json");
    assert!(said.contains("when the error was reached"), "{said}");
    assert_eq!((&stats["stopped_by"], &stats["target_error"]), (&"target_error".into(), &0.01.into()));
    let bound = stats["error_bound"].as_f64().expect("a number");
    assert!(bound <= 0.01 && stats["expected_error"].as_f64() < Some(bound), "{stats}");
    place.expect(0, "render scene.toml --device cpu --spp 4096 --seed 1234 -o truth.exr");
    place.expect(0, "compare a.exr truth.exr --metric relmse --tolerance 0.01");

    let said = place.expect(0, "render scene.toml --device cpu --spp 16 --target-error 1e-9 -o a.exr --stats s.json -q");
    assert!(said.contains("was not reached"), "{said}");
    assert_eq!(place.stats("s.json")["stopped_by"], "samples");
}

#[test]
fn samples_may_follow_the_noise_together_with_the_rest() {
    let place = Workplace::new();
    place.expect(0, "render scene.toml --device cpu --spp 100 --adaptive -o a.exr --stats s.json");
    assert_eq!(place.stats("s.json")["adaptive"], true);
    for (key, value) in [("gpt:adaptive", 1), ("gpt:samples", 100), ("gpt:complete", 1)] {
        assert_eq!(header_number(&place.path("a.exr"), key), value, "{key}");
    }
    let all =
        "render scene.toml --device cpu --spp 100000000 --adaptive --target-error 1e-12 --time-limit 0.4 -o a.exr --stats s.json";
    place.expect(0, all);
    assert_eq!(place.stats("s.json")["stopped_by"], "time_limit");
}

#[test]
fn wishes_that_cannot_be_are_refused() {
    let place = Workplace::new();
    for wish in [
        "--time-limit 0",
        "--time-limit -3",
        "--time-limit soon",
        "--target-error 0",
        "--target-error inf",
        "--target-error 0.1 --spp 15",
        "--target-error 0.1 --first-sample 8",
        "--adaptive --first-sample 8",
    ] {
        place.expect(2, &format!("render scene.toml --device cpu {wish}"));
    }
    let said = place.expect(2, "plan scene.toml --chunks 2 --aov low");
    assert!(said.contains("do not add up"), "{said}");
    assert_eq!(place.files(), ["scene.toml"]);
}

/// The answer of a command that finds a difference.
fn differs(place: &Workplace, arguments: &str) -> String {
    let output = place.run(arguments);
    assert_eq!(output.status.code(), Some(7), "{}", text(&output.stderr));
    text(&output.stdout)
}

#[test]
fn intervals_become_as_narrow_as_was_asked_for() {
    let place = Workplace::new();
    let render = "render scene.toml --device cpu --spp 4096 --target-interval 4% --confidence 95%";
    let said = place.expect(0, &format!("{render} --aov low,high -o a.exr --stats s.json"));
    assert!(said.contains("when the intervals were narrow enough") && said.contains("mean of the picture: "), "{said}");
    let stats = place.stats("s.json");
    assert_eq!((&stats["stopped_by"], &stats["target_interval"]), (&"target_interval".into(), &0.04.into()));
    assert_eq!((&stats["sampler"], &stats["interval"]["confidence"]), (&"independent".into(), &0.95.into()));
    assert!(stats["interval"]["widest"].as_f64().expect("a number") <= 0.04, "{stats}");
    // Its picture is that of as many independent samples.
    let samples = stats["spp_done"].as_u64().expect("a number");
    place.expect(0, &format!("render scene.toml --device cpu --spp {samples} --sampler independent -o b.exr"));
    place.expect(0, "compare a.exr b.exr --tolerance 1e-5");

    // Another picture of the scene may be equal to it; one that is darker for sure is not. The truth states no intervals and is taken as it is.
    place.expect(0, "render scene.toml --device cpu --spp 1024 --seed 5 -o truth.exr");
    let said = differs(&place, "compare a.exr truth.exr");
    assert!(said.contains("the means may be equal (95 % confidence)") && said.contains("no pixel differs for sure"), "{said}");
    place.expect(0, &format!("{render} --max-depth 1 -o dark.exr -q"));
    let said = differs(&place, "compare a.exr dark.exr");
    assert!(said.contains("the means differ by at least") && said.contains("(90 % confidence)"), "{said}");
    assert!(!said.contains("for sure"), "the darker one states no interval of pixels: {said}");
    let report: serde_json::Value = serde_json::from_str(&differs(&place, "compare a.exr truth.exr --json")).expect("JSON");
    assert_eq!((&report["intervals"]["pixels"], &report["intervals"]["relative"]), (&0.into(), &0.0.into()));

    let said =
        place.expect(0, "render scene.toml --device cpu --spp 32 --target-interval 0.0001% --interval-of pixels -o c.exr -q");
    assert!(said.contains("the intervals did not become as narrow as 0.0001 %: pixels"), "{said}");
}

#[test]
fn intervals_that_cannot_be_are_refused() {
    let place = Workplace::new();
    for (flags, why) in [
        ("--confidence 99%", "--target-interval"),
        ("--interval-of tiles", "--target-interval"),
        ("--target-interval 1% --confidence 20%", "from 50% to below 100%"),
        ("--target-interval 1% --adaptive", "--adaptive"),
        ("--target-interval 1% --target-error 0.1", "--target-error"),
        ("--target-interval 1% --crop 0,0,4,4", "--crop"),
        ("--aov low --crop 0,0,4,4", "whole picture"),
        ("--target-interval 1% --spp 4", "at least 16 samples"),
        ("--target-interval 1% --spp 64 --max-depth 0 --interval-by bound", "max_depth"),
        ("--target-interval 0%", "above 0"),
    ] {
        let said = place.expect(2, &format!("render scene.toml --device cpu -o a.exr {flags}"));
        assert!(said.contains(why), "{flags}: {said}");
    }
    let said = place.expect(2, "plan scene.toml --chunks 2 --aov low");
    assert!(said.contains("do not add up"), "{said}");
    assert_eq!(place.files(), ["scene.toml"]);
}
