//! `--traversal`, with any device and without.

use super::{Workplace, text};

#[test]
#[ignore = "slow"]
fn the_way_is_said_and_what_cannot_be_is_refused() {
    let place = Workplace::new();
    for (arguments, words) in [
        ("check scene.toml --plan", "primitives, at most 64)"),
        ("check scene.toml --plan --traversal bvh", "few other shapes as constants (asked for)"),
        ("check motion-blur --plan", "(something moves, and is no constant)"),
    ] {
        let output = place.run(arguments);
        assert_eq!(output.status.code(), Some(0), "gpt {arguments}");
        assert!(text(&output.stdout).contains(words), "gpt {arguments}: `{words}` is not in\n{}", text(&output.stdout));
    }
    // A moving shape has no place in an acceleration structure, and not every device has one.
    for command in ["check", "render", "verify"] {
        let stderr = place.expect(4, &format!("{command} motion-blur --traversal ray-query"));
        assert!(stderr.contains("--traversal ray-query") || stderr.contains("adapter"), "gpt {command}: {stderr}");
    }
    for (arguments, words) in [
        ("render scene.toml --device cpu --traversal ray-query", "leave out --traversal"),
        ("bench speed scene.toml --device cpu --traversal bvh", "leave out --traversal"),
        ("render scene.toml --traversal rays", "ray-query"),
    ] {
        let stderr = place.expect(2, arguments);
        assert!(stderr.contains(words), "gpt {arguments}: `{words}` is not in\n{stderr}");
    }
    assert_eq!(place.files(), ["scene.toml"]);
}
