//! The files of an installation beside the program.

use super::*;

#[test]
fn completions_and_man_pages_know_every_command() {
    let place = Workplace::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = text(&place.run(&format!("completions {shell}")).stdout);
        assert!(["render", "target-error", "compare", "sobol"].iter().all(|word| script.contains(word)), "{shell}: {script}");
    }
    place.expect(2, "completions basic");
    assert!(text(&place.run("man").stdout).starts_with(".ie"), "roff");
    place.expect(0, "man -o pages");
    for page in ["gpt.1", "gpt-render.1", "gpt-test.1", "gpt-bench-speed.1"] {
        let page = fs::read_to_string(place.path("pages").join(page)).expect("a page");
        assert!(page.contains(".TH"), "{page}");
    }
}

/// bash itself reads them.
#[cfg(unix)]
#[test]
fn bash_completes_commands_and_values() {
    let place = Workplace::new();
    fs::write(place.path("gpt.bash"), place.run("completions bash").stdout).expect("a file");
    let complete = |words: &str, last: usize| {
        let script = format!(
            "source gpt.bash; COMP_WORDS=({words}); COMP_CWORD={last}; _gpt gpt \"${{COMP_WORDS[{last}]}}\" \"${{COMP_WORDS[{}]}}\"; echo \"${{COMPREPLY[@]}}\"",
            last - 1
        );
        let output = Command::new("bash").args(["-c", &script]).current_dir(place.0.path()).output().expect("bash starts");
        text(&output.stdout)
    };
    assert_eq!(complete("gpt comp", 1).trim(), "compare completions");
    assert!(complete("gpt render --sampler ha", 3).contains("halton"));
}
