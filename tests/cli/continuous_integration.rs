//! The commands that `action.yml` and `docs/ci.md` give to other systems, run as they stand there.

use super::installing::pack;
use super::*;

fn project() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn project_file(name: &str) -> String {
    fs::read_to_string(project().join(name)).expect("a file of the project")
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// The lines below a line, as far as they are farther in.
fn block<'a>(lines: &[&'a str], at: usize) -> Vec<&'a str> {
    let outer = indent(lines[at]);
    lines[at + 1..].iter().copied().take_while(|line| line.trim().is_empty() || indent(line) > outer).collect()
}

/// The shell scripts of an action's steps, each with its environment.
fn steps(action: &str, inputs: &[(&str, &str)]) -> Vec<(String, Vec<(String, String)>)> {
    let lines: Vec<&str> = action.lines().collect();
    let starts = (0..lines.len()).filter(|&at| lines[at].trim_start().starts_with("- name:"));
    let filled = |text: &str| {
        inputs.iter().fold(text.to_owned(), |text, (name, value)| text.replace(&format!("${{{{ inputs.{name} }}}}"), value))
    };
    let step = |at: usize| {
        let lines: Vec<&str> = [lines[at]].into_iter().chain(block(&lines, at)).collect();
        let run = lines.iter().position(|line| line.trim() == "run: |")?;
        let script: Vec<&str> = block(&lines, run).into_iter().map(str::trim_start).collect();
        let environment = lines.iter().position(|line| line.trim() == "env:").map_or_else(Vec::new, |env| block(&lines, env));
        let pair = |line: &&str| line.trim().split_once(": ").map(|(name, value)| (name.to_owned(), filled(value)));
        Some((script.join("\n"), environment.iter().filter_map(pair).collect()))
    };
    starts.filter_map(step).collect()
}

/// The commands of a list in the page's YAML.
fn commands(page: &str, key: &str) -> Vec<String> {
    let lines: Vec<&str> = page.lines().collect();
    let at = lines.iter().position(|line| line.trim() == format!("{key}:")).expect("the list is there");
    block(&lines, at).into_iter().filter_map(|line| line.trim().strip_prefix("- ").map(str::to_owned)).collect()
}

/// Runs a script as GitHub does, in the place. On the path are the folders that steps before it have put there, or else that of the program.
fn run(place: &Workplace, script: &str, environment: &[(String, String)]) -> Output {
    let programs = Path::new(env!("CARGO_BIN_EXE_gpt")).parent().expect("a folder").display().to_string();
    let added = fs::read_to_string(place.path("added-to-path")).unwrap_or(programs);
    let path = format!("{}:{}", added.trim().replace('\n', ":"), std::env::var("PATH").unwrap_or_default());
    Command::new("bash")
        .args(["--noprofile", "--norc", "-eo", "pipefail", "-c", script])
        .current_dir(place.0.path())
        .env("PATH", path)
        .env("GITHUB_ACTION_PATH", project())
        .env("GITHUB_PATH", place.path("added-to-path"))
        .env("RUNNER_TEMP", place.0.path())
        .envs(environment.iter().cloned())
        .output()
        .expect("bash starts")
}

/// A folder `tests/scenes` with a golden picture, made with the changes that the page looks for.
fn blessed() -> Workplace {
    let place = Workplace::new();
    fs::create_dir_all(place.path("tests/scenes")).expect("a folder");
    fs::write(place.path("tests/scenes/lit.toml"), scene()).expect("a scene");
    place.expect(0, "test tests/scenes --bless --change 2% -q --device gpu");
    place
}

fn spoil(place: &Workplace) {
    fs::write(place.path("tests/scenes/lit.toml"), scene().replace("reflectance = 0.5", "reflectance = 0.55")).expect("a scene");
}

/// A release as GitHub serves it, in the place: an archive of scripts/archive with a program that passes on to the one under test, and its sum. The
/// address of the repository that has it.
#[cfg(target_os = "linux")]
fn release(place: &Workplace) -> String {
    let folder = place.path(&format!("releases/download/v{}", env!("CARGO_PKG_VERSION")));
    pack(place, &format!("{}-unknown-linux-gnu", std::env::consts::ARCH), &folder);
    format!("file://{}", place.0.path().display())
}

#[cfg(target_os = "linux")]
#[test]
fn the_actions_steps_run_as_they_stand() {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return;
    }
    let place = blessed();
    let repository = release(&place);
    let inputs = [
        ("directory", "tests/scenes"),
        ("arguments", "--change 2%"),
        ("report", "out"),
        ("version", ""),
        ("sha256", ""),
        ("repository", &repository),
    ];
    let steps = steps(&project_file("action.yml"), &inputs);
    assert_eq!(steps.len(), 3, "{steps:?}");
    for (script, environment) in &steps {
        let output = run(&place, script, environment);
        assert!(output.status.success(), "{script}\n{}{}", text(&output.stdout), text(&output.stderr));
    }
    assert!(place.path("out/report.html").is_file() && place.path("out/junit.xml").is_file());
    let added = fs::read_to_string(place.path("added-to-path")).expect("a folder was put on the path");
    assert!(Path::new(added.trim()).join("gpt").is_file(), "the program that was downloaded is the one that ran: {added}");
    // The control: what differs makes the step fail.
    spoil(&place);
    assert_eq!(run(&place, &steps[2].0, &steps[2].1).status.code(), Some(7));
}

/// No program is unpacked whose sum is not the one that is expected, whoever states it.
#[cfg(target_os = "linux")]
#[test]
fn a_download_with_another_sum_is_refused() {
    let place = Workplace::new();
    let repository = release(&place);
    let version = env!("CARGO_PKG_VERSION");
    let download = |into: &str, sum: &str| {
        let script = project().join("scripts/download-release");
        run(&place, &format!("'{}' {repository} {version} {into} {sum}", script.display()), &[])
    };
    let output = download("good", "");
    assert!(output.status.success() && place.path(text(&output.stdout).trim()).join("gpt").is_file(), "{output:?}");
    let other = "0".repeat(64);
    let beside = fs::read_dir(place.path(&format!("releases/download/v{version}")))
        .expect("a release")
        .map(|entry| entry.expect("a file").path());
    for sum in beside.filter(|path| path.extension().is_some_and(|ending| ending == "sha256")) {
        fs::write(sum, format!("{other}  archive\n")).expect("a sum");
    }
    for (into, sum) in [("stated", ""), ("pinned", other.as_str())] {
        let output = download(into, sum);
        let message = text(&output.stderr);
        assert!(!output.status.success() && message.contains("is not unpacked"), "{message}");
        assert!(fs::read_dir(place.path(into)).expect("a folder").all(|entry| !entry.expect("an entry").path().is_dir()));
    }
    let output = download("absent", "");
    assert!(!output.status.success());
    let none = run(&place, &format!("'{}' {repository} 99.0.0 none", project().join("scripts/download-release").display()), &[]);
    assert!(
        !none.status.success() && text(&none.stderr).contains("cannot be fetched: is there a release 99.0.0?"),
        "{}",
        text(&none.stderr)
    );
}

#[test]
fn the_pages_commands_run_as_they_stand() {
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return;
    }
    let place = blessed();
    let page = project_file("docs/ci.md");
    let all = commands(&page, "script");
    assert_eq!(all.len(), 1, "{all:?}");
    for command in &all {
        let output = run(&place, command, &[]);
        assert!(output.status.success(), "{command}\n{}{}", text(&output.stdout), text(&output.stderr));
    }
    assert!(place.path("report.html").is_file() && place.path("junit.xml").is_file());
    spoil(&place);
    assert_eq!(run(&place, &all[0], &[]).status.code(), Some(7));
    assert!(
        page.contains("directory:") && project_file("action.yml").contains("\n  directory:"),
        "the inputs are those of the action"
    );
}
