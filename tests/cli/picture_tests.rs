//! `gpt test` and the page that it shares with `gpt compare`, as their users meet them.

use super::*;

/// A folder `scenes` with `lit.toml` and `dim.toml`.
fn workplace() -> Workplace {
    let place = Workplace::new();
    fs::create_dir(place.path("scenes")).expect("a folder");
    let lit = scene().replace("spp = 8", "max_depth = 3");
    fs::write(place.path("scenes/lit.toml"), &lit).expect("a scene");
    fs::write(place.path("scenes/dim.toml"), lit.replace("[40, 30, 20]", "[4, 3, 2]")).expect("a scene");
    place
}

fn rewrite(place: &Workplace, name: &str, from: &str, to: &str) {
    let text = fs::read_to_string(place.path(name)).expect("a scene");
    assert!(text.contains(from), "{text}");
    fs::write(place.path(name), text.replace(from, to)).expect("a scene");
}

fn report(place: &Workplace, arguments: &str) -> (Option<i32>, Value) {
    let output = place.run(&format!("{arguments} --json -q"));
    let report = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("JSON: {}", text(&output.stderr)));
    (output.status.code(), report)
}

const TEST: &str = "test scenes --device cpu --change 10%";

#[test]
fn golden_pictures_are_made_and_changes_are_found_and_accepted() {
    let place = workplace();
    let stderr = place.expect(3, TEST);
    assert_eq!(stderr.matches("Error").count(), 0, "what is wrong is in the answer: {stderr}");
    let missing = text(&place.run(TEST).stdout);
    assert!(missing.contains("there is no golden picture") && missing.contains("--bless"), "{missing}");

    place.expect(0, &format!("{TEST} --bless"));
    assert!(place.path("scenes/golden/lit.exr").is_file() && place.path("scenes/golden/dim.exr").is_file());
    let (code, green) = report(&place, TEST);
    assert_eq!((code, &green["agrees"]), (Some(0), &Value::Bool(true)), "{green}");
    assert!(
        [0, 1].iter().all(|scene| green["scenes"][scene]["flip"].as_f64()
            < green["scenes"][scene]["flip_of_noise"].as_f64().map(|noise| 1.5 * noise))
            && green["scenes"][0]["scene_changed"] == false,
        "{green}"
    );
    assert!(!place.path("gpt-test.html").exists(), "nothing differs");

    rewrite(&place, "scenes/lit.toml", "reflectance = 0.5", "reflectance = 0.55");
    let output = place.run(&format!("{TEST} --junit out.xml --html out.html"));
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(7), "{said}");
    assert!(said.contains("lit: DIFFERS") && said.contains("dim: agrees") && said.contains("(+"), "{said}");
    assert!(said.ends_with("RED: 1 of 2 differ: lit\n"), "{said}");
    let page = fs::read_to_string(place.path("out.html")).expect("a page");
    assert!(page.contains("differs") && page.contains("data-mode=\"z\"") && !page.contains("http"), "a page of its own");
    let junit = fs::read_to_string(place.path("out.xml")).expect("a file");
    let tree = roxmltree::Document::parse(&junit).expect("XML");
    let suite = tree.root_element().first_element_child().expect("a suite");
    assert_eq!(
        (suite.attribute("tests"), suite.attribute("failures"), suite.attribute("errors")),
        (Some("2"), Some("1"), Some("0"))
    );
    assert_eq!(tree.descendants().filter(|node| node.has_tag_name("failure")).count(), 1);

    // The commands that are said repeat it.
    let (_, red) = report(&place, &format!("{TEST} lit"));
    let command = red["scenes"][0]["commands"][1].as_str().expect("a command");
    let [render, compare] = command.split(" && ").collect::<Vec<_>>()[..] else { panic!("{command}") };
    place.expect(0, &render.replacen("gpt render", "render -q", 1));
    place.expect(7, compare.strip_prefix("gpt ").expect("a command of ours"));
    assert!(place.path("now.html").is_file());

    let before = fs::read(place.path("scenes/golden/dim.exr")).expect("a picture");
    place.expect(0, &format!("{TEST} --update"));
    assert_eq!(before, fs::read(place.path("scenes/golden/dim.exr")).expect("a picture"), "what agrees stays byte for byte");
    place.expect(0, TEST);
}

#[test]
fn what_cannot_be_tested_is_said() {
    let place = workplace();
    for (code, arguments, words) in [
        (3, "test nowhere", "nowhere"),
        (3, "test .git", ".git"),
        (2, "test scenes cornel", "its scenes are dim, lit"),
        (2, "test scenes --change 0", "between 0 and 1"),
        (2, "test scenes --bless --update", "--update"),
    ] {
        let stderr = place.expect(code, arguments);
        assert!(stderr.contains(words), "gpt {arguments}: {stderr}");
    }
    place.expect(0, &format!("{TEST} lit --bless -q"));
    rewrite(&place, "scenes/lit.toml", "size = [24, 16]", "size = [24, 15]");
    let (code, report) = report(&place, &format!("{TEST} lit"));
    assert_eq!(code, Some(7));
    assert!(report["scenes"][0]["message"].as_str().is_some_and(|words| words.contains("24x15")), "{report}");
    // A picture that does not say how it varies is no golden picture.
    place.expect(0, "render scenes/lit.toml --spp 4 --device cpu -q -o scenes/golden/lit.exr");
    let refused = place.run(&format!("{TEST} lit"));
    assert_eq!(refused.status.code(), Some(3));
    assert!(text(&refused.stdout).contains("Variance.R"), "{}", text(&refused.stdout));
    fs::write(place.path("scenes/lit.toml"), "[film\n").expect("a file");
    assert_eq!(place.run(&format!("{TEST} lit")).status.code(), Some(3));
    let stderr = text(&place.run("test scenes lit --device cpu --require-device").stdout);
    assert!(stderr.contains("lit: FAILED"), "{stderr}");
}

#[test]
fn pictures_of_other_programs_are_candidates() {
    let place = workplace();
    place.expect(0, &format!("{TEST} lit --bless -q"));
    fs::create_dir(place.path("theirs")).expect("a folder");
    let candidates = format!("{TEST} lit --candidate-dir theirs");
    assert_eq!(place.run(&candidates).status.code(), Some(3), "there is no picture yet");
    // Another program has other samples and no variances.
    place.expect(0, "render scenes/lit.toml --spp 64 --seed 9 --device cpu --sampler halton -q -o theirs/lit.exr");
    let (code, green) = report(&place, &candidates);
    assert_eq!(code, Some(0), "{green}");
    assert!(green["scenes"][0]["message"].as_str().is_some_and(|words| words.contains("does not say how its samples vary")));
    rewrite(&place, "scenes/lit.toml", "reflectance = 0.5", "reflectance = 0.6");
    place.expect(0, "render scenes/lit.toml --spp 64 --seed 9 --device cpu -q -o theirs/lit.exr");
    assert_eq!(report(&place, &candidates).0, Some(7));
    // With variances and numbers of samples, these count.
    place.expect(0, "render scenes/lit.toml --spp 64 --seed 9 --device cpu --aov variance,samples -q -o theirs/lit.exr");
    let (code, red) = report(&place, &candidates);
    assert_eq!((code, &red["scenes"][0]["spp"]), (Some(7), &Value::from(64)), "{red}");
    place.expect(0, "render scenes/lit.toml --spp 4 --device cpu -q -o theirs/lit.png");
    let twice = place.run(&candidates);
    assert!(text(&twice.stdout).contains("several pictures are of one scene"), "{}", text(&twice.stdout));
}

/// A ball reaches a little into tiles beside it, and 16 samples of a pixel find nothing of it there.
#[test]
fn light_that_few_samples_find_is_no_difference() {
    let place = workplace();
    rewrite(&place, "scenes/lit.toml", "position = [0, 0, 4]", "position = [0, 0, 5.5]");
    let bless = format!("{TEST} lit --bless -q --max-spp 512");
    place.expect(0, &bless);
    fs::create_dir(place.path("theirs")).expect("a folder");
    for layers in ["", " --aov variance,samples"] {
        for seed in 0..3 {
            let render = format!("render scenes/lit.toml --spp 16 --seed {seed} --device cpu -q{layers} -o theirs/lit.exr");
            place.expect(0, &render);
            let (code, said) = report(&place, &format!("{TEST} lit --candidate-dir theirs"));
            assert_eq!(code, Some(0), "seed {seed}{layers}: {said}");
        }
    }
    // The control: as dark as those tiles are, a ball a quarter brighter is found.
    rewrite(&place, "scenes/lit.toml", "reflectance = 0.5", "reflectance = 0.625");
    place.expect(0, "render scenes/lit.toml --spp 16 --device cpu -q --aov variance,samples -o theirs/lit.exr");
    assert_eq!(report(&place, &format!("{TEST} lit --candidate-dir theirs")).0, Some(7));
}

/// ꟻLIP alone can fail a test, and its limit is in the verdict.
#[test]
fn the_eye_may_have_a_limit() {
    let place = workplace();
    place.expect(0, &format!("{TEST} lit --bless -q"));
    let (code, report) = report(&place, &format!("{TEST} lit --flip 0.000001"));
    assert_eq!(code, Some(7), "{report}");
    assert!(report["scenes"][0]["message"].as_str().is_some_and(|words| words.contains("above the limit")), "{report}");
    place.expect(0, &format!("{TEST} lit --flip 0.5"));
}
