//! Jobs on the schedulers that are there: Slurm by daemons of its own, Open Job Description by its command line.

use super::common::effort::announce;
use super::parts::most_units;
use super::*;

fn farm() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("farm")
}

/// True if all of these programs are installed; a line says what is missing.
fn are_installed(programs: &[&str], what: &str) -> bool {
    let is_missing =
        |program: &&&str| Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_err();
    match programs.iter().find(is_missing) {
        None => true,
        Some(program) => {
            announce(&format!("left out: {what}, because {program} is not installed"));
            false
        }
    }
}

/// The picture of the chunks is the one of a single render, to the last place.
fn check(place: &Workplace, picture: &str, flags: &str) {
    place.expect(0, &format!("render scene.toml -q {flags} -o whole.exr"));
    let [whole, merged] = ["whole.exr", picture].map(|name| place.image(name));
    assert!(most_units(&whole, &merged) <= 1, "{}", most_units(&whole, &merged));
    assert!(place.files().iter().all(|name| !name.contains("part")), "{:?}", place.files());
    // The control: one sample less is another picture.
    place.expect(0, "render scene.toml -q --device cpu --size 64x48 --spp 5 -o whole.exr");
    assert!(most_units(&place.image("whole.exr"), &merged) > 100);
}

#[test]
fn a_plan_is_what_its_commands_do() {
    let place = Workplace::new();
    let output = place.run("plan scene.toml --chunks 3 --spp 10 --size 20x12 --seed 4 -o p.exr");
    let plan: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let chunks = plan["chunks"].as_array().expect("a list");
    assert_eq!(chunks.len(), 3);
    let run = |command: &Value| {
        let words: Vec<&str> = command.as_array().expect("words").iter().map(|word| word.as_str().expect("a word")).collect();
        assert_eq!(words[0], "gpt");
        place.expect(0, &words[1..].join(" "))
    };
    for chunk in chunks {
        assert!(["device_bytes", "host_bytes", "cpu_seconds"].iter().all(|key| chunk[key].as_f64() > Some(0.0)), "{chunk}");
        run(&chunk["command"]);
    }
    run(&plan["merge"]["command"]);
    place.expect(0, "render scene.toml -q --spp 10 --size 20x12 --seed 4 -o whole.exr");
    assert!(most_units(&place.image("whole.exr"), &place.image("p.exr")) <= 1);
    assert_eq!(plan["exit_codes"]["retry"], serde_json::json!([5, 130]));
    place.expect(2, "plan scene.toml --chunks 11 --spp 10");
    place.expect(3, "plan none.toml --chunks 1");
}

/// A chunk is rendered by a process that knows its command alone, in which all that was said of the scene must stand.
#[test]
fn chunks_render_the_scene_that_was_planned() {
    let place = Workplace::new();
    let sensor = |name: &str, x: i32| {
        format!(
            "<sensor type=\"perspective\" id=\"{name}\"><float name=\"fov\" value=\"40\"/><film type=\"hdrfilm\"><integer name=\"width\" \
             value=\"12\"/><integer name=\"height\" value=\"8\"/></film><transform name=\"to_world\"><lookat origin=\"{x}, 0, 5\" \
             target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform></sensor>"
        )
    };
    let room = format!(
        "<scene version=\"3.0.0\">{}{}<default name=\"grey\" value=\"0.9\"/><shape type=\"sphere\"><bsdf type=\"diffuse\">\
         <rgb name=\"reflectance\" value=\"$grey\"/></bsdf></shape><emitter type=\"constant\"/></scene>",
        sensor("front", 0),
        sensor("left eye's", -2)
    );
    fs::write(place.path("my room.xml"), room).expect("the scene");
    let said = ["-D", "grey=0.1 0.2 0.3", "--camera", "left eye's", "--assets-root", ".", "--seed", "3"];
    let run = |before: &[&str]| {
        let output = place.command("").args(before).output().expect("the program starts");
        assert_eq!(output.status.code(), Some(0), "{before:?}: {}", text(&output.stderr));
        output
    };
    let plan = run(&[&["plan", "my room.xml", "--chunks", "2", "--spp", "8", "-o", "p q.exr"], said.as_slice()].concat());
    let plan: Value = serde_json::from_slice(&plan.stdout).expect("JSON");
    let chunks = plan["chunks"].as_array().expect("a list").iter();
    for command in chunks.chain([&plan["merge"]]) {
        let words: Vec<&str> = command["command"].as_array().expect("words").iter().filter_map(Value::as_str).collect();
        run(&words[1..]);
        // A shell reads the same words.
        #[cfg(unix)]
        {
            let printed = format!("gpt() {{ printf '%s\\n' gpt \"$@\"; }}; {}", command["shell"].as_str().expect("text"));
            let output = Command::new("sh").args(["-c", &printed]).output().expect("a shell");
            assert_eq!(text(&output.stdout).lines().collect::<Vec<_>>(), words);
        }
    }
    let whole = ["render", "my room.xml", "-q", "--spp", "8", "-o", "whole.exr"];
    run(&[whole.as_slice(), said.as_slice()].concat());
    assert!(most_units(&place.image("whole.exr"), &place.image("p q.exr")) <= 1);
    // The control: without what was said it is another picture.
    run(&whole);
    assert!(most_units(&place.image("whole.exr"), &place.image("p q.exr")) > 100);
    // Standard input is not there for another process.
    place.expect(2, "plan - --chunks 1");
}

/// A camera that moves, and the frames of it from one render.
fn animation() -> Workplace {
    let place = Workplace::new();
    let keys = "vfov = 40\nkeyframes = [{ frame = 0, vfov = 40 }, { frame = 10, vfov = 20 }]";
    fs::write(place.path("scene.toml"), scene().replace("vfov = 40", keys)).expect("the scene file");
    place.expect(0, "render scene.toml -q --device cpu --frames 3-9 -o whole.#.exr");
    place
}

/// All frames are those of one render.
fn check_frames(place: &Workplace) {
    for frame in 3..10 {
        let read = |name: &str| fs::read(place.path(&format!("{name}.{frame}.exr"))).expect("the picture");
        assert!(read("whole") == read("chunk"), "frame {frame}");
    }
    // The control: they are different pictures.
    assert!(fs::read(place.path("whole.3.exr")).expect("a picture") != fs::read(place.path("chunk.4.exr")).expect("a picture"));
}

#[test]
fn frames_are_planned_in_chunks() {
    let place = animation();
    let output = place.run("plan scene.toml --frames 3-9 --chunks 3 -o chunk.#.exr");
    let plan: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let chunks = plan["chunks"].as_array().expect("a list");
    let frames: Vec<&str> = chunks.iter().filter_map(|chunk| chunk["frames"].as_str()).collect();
    assert_eq!(frames, ["3,4", "5,6", "7-9"]);
    assert!(plan["merge"].is_null());
    for chunk in chunks {
        let words: Vec<&str> = chunk["command"].as_array().expect("words").iter().filter_map(Value::as_str).collect();
        place.expect(0, &format!("{} --device cpu", words[1..].join(" ")));
    }
    check_frames(&place);
    place.expect(2, "plan scene.toml --frames 3-9 --chunks 8");
    place.expect(2, "plan scene.toml --frames 3-9 --chunks 2 -o chunk.exr");
}

/// The script that schedulers run, by itself.
#[cfg(unix)]
#[test]
fn a_chunk_of_frames_is_rendered_by_its_script() {
    let place = animation();
    for index in 0..3 {
        let mut command = Command::new("sh");
        command.arg(farm().join("frames.sh")).args([&index.to_string(), "3", "3", "9", "scene.toml", "chunk.#.exr"]);
        command.args(["--device", "cpu", "-q"]).env("GPT", env!("CARGO_BIN_EXE_gpt")).current_dir(place.path(""));
        assert!(command.status().expect("a shell").success());
    }
    check_frames(&place);
}

#[cfg(unix)]
#[test]
fn open_job_description_renders_frames() {
    if !are_installed(&["openjd"], "frames of Open Job Description") {
        return;
    }
    let place = animation();
    let mut command = Command::new("openjd");
    command.arg("run").arg(farm().join("openjd/frames.yaml")).args(["--step", "Render"]);
    for parameter in [
        format!("Farm={}", farm().display()),
        format!("Gpt={}", env!("CARGO_BIN_EXE_gpt")),
        format!("Scene={}", place.path("scene.toml").display()),
        format!("Picture={}", place.path("chunk.#.exr").display()),
        "First=3".to_owned(),
        "Last=9".to_owned(),
        "LastChunk=1".to_owned(),
    ] {
        command.args(["-p", &parameter]);
    }
    let output = command.output().expect("openjd");
    let said = format!("{}{}", text(&output.stdout), text(&output.stderr));
    assert!(output.status.success() && said.contains("openjd_progress: 100.0"), "{said}");
    // Whatever device there is renders them.
    assert!((3..10).all(|frame| place.path(&format!("chunk.{frame}.exr")).is_file()));
}

/// With a chunk that is killed and one that is asked to stop on the way.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "slow"]
fn slurm_renders_a_picture_in_chunks() {
    if !are_installed(&["sbatch", "slurmctld", "slurmd"], "a job array on Slurm") {
        return;
    }
    let place = Workplace::new();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/farm/slurm.sh");
    // Far from the ports of other runs.
    let port = 20_000 + std::process::id() % 10_000 * 3;
    let flags = "--device cpu --size 64x48";
    let output = Command::new("sh")
        .arg(script)
        .args([folder.path().to_str().expect("a name"), &port.to_string(), "4", "8000"])
        .args(["scene.toml", "picture.exr", "--checkpoint", "0.2"])
        .args(flags.split(' '))
        .env("GPT", env!("CARGO_BIN_EXE_gpt"))
        .current_dir(place.path(""))
        .output()
        .expect("a shell");
    let said = format!("{}{}", text(&output.stdout), text(&output.stderr));
    if output.status.code() == Some(77) && std::env::var("GPT_TEST").as_deref() != Ok("all") {
        announce(&format!("left out: a job array on Slurm, because its daemons do not run here:\n{said}"));
        return;
    }
    assert!(output.status.success(), "{said}");
    assert!(said.contains("sent SIGKILL") && said.contains("sent SIGTERM"), "{said}");
    check(&place, "picture.exr", &format!("{flags} --spp 8000"));
}

#[cfg(unix)]
#[test]
fn open_job_description_renders_a_picture_in_chunks() {
    if !are_installed(&["openjd"], "a job of Open Job Description") {
        return;
    }
    let place = Workplace::new();
    let scene = place.path("scene.toml").display().to_string();
    let picture = place.path("picture.exr").display().to_string();
    let parameters = [
        format!("Farm={}", farm().display()),
        format!("Gpt={}", env!("CARGO_BIN_EXE_gpt")),
        format!("Scene={scene}"),
        format!("Picture={picture}"),
        "Spp=8".to_owned(),
        "LastChunk=2".to_owned(),
    ];
    let mut command = Command::new("openjd");
    command.arg("run").arg(farm().join("openjd/render.yaml")).args(["--step", "Merge", "--run-dependencies"]);
    for parameter in &parameters {
        command.args(["-p", parameter]);
    }
    let output = command.output().expect("openjd");
    let said = format!("{}{}", text(&output.stdout), text(&output.stderr));
    assert!(output.status.success() && said.contains("openjd_progress: 100.0"), "{said}");
    check(&place, "picture.exr", "--spp 8");
}

/// Lines on standard output for other programs.
#[test]
fn progress_is_told_to_other_programs() {
    let place = Workplace::new();
    let render = "render scene.toml --device cpu -q -o a.exr --progress";
    let lines =
        |format: &str| text(&place.run(&format!("{render} {format}")).stdout).lines().map(str::to_owned).collect::<Vec<_>>();
    let events: Vec<Value> = lines("json").iter().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!((&events[0]["event"], &events[0]["film_bytes"]), (&"start".into(), &(24 * 16 * 32).into()));
    assert!(events.iter().any(|event| event["event"] == "progress" && event["percent"] == 100.0), "{events:?}");
    let last = events.last().expect("events");
    assert_eq!((&last["event"], &last["complete"], &last["outputs"][0]), (&"end".into(), &true.into(), &"a.exr".into()));
    let openjd = lines("openjd");
    assert!(openjd.iter().all(|line| line.starts_with("openjd_progress: ") || line.starts_with("openjd_status: ")), "{openjd:?}");
    assert!(lines("plain").iter().any(|line| line.starts_with("100.0 %, 3072 of 3072 samples")));
    place.expect(2, &format!("{render} json -o -"));
    // The control: nothing is said without.
    assert_eq!(text(&place.run("render scene.toml --device cpu -q -o a.exr").stdout), "");
}
