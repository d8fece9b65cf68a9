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
    assert_eq!(place.files(), ["scene.toml"]);
}
