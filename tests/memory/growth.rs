//! Scenes of twice the size take twice the work, whatever is odd about them: faces that coincide, models of very many parts, deep blends. Work
//! is the bytes that were asked for, and the time.

use std::borrow::Cow;
use std::fmt::Write;
use std::hint::black_box;
use std::path::Path;
use std::sync::LazyLock;
use std::time::Duration;

use crate::clock;
use crate::common::effort::in_full;
use crate::common::files::folder_with;
use crate::counting::{bytes_ever, take_turn};
use gpt::cpu::ReferenceRenderer;
use gpt::load;
use gpt::packed::PackedScene;
use gpt::reference::Integrator;
use gpt::scene::Scene;

const HEAD: &str = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvfov = 40\n[[light]]\ntype = \"environment\"\nradiance = 1\n\
    [[material]]\nname = \"m\"\ntype = \"diffuse\"\nreflectance = 0.5\n";

fn read(text: &str) -> Scene {
    load::load_toml_str(text, "grown.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}"))
}

/// True if trial runs trace their paths, most of which go through thousands of spheres and blends.
static WITH_TRIAL_RUNS: LazyLock<bool> = LazyLock::new(|| in_full("trial runs of scenes of twice the size"));

/// Prepares the scene for both devices.
fn prepare(scene: &Scene) {
    let mut scene = Cow::Borrowed(scene);
    if !*WITH_TRIAL_RUNS {
        // Too small for a trial run.
        scene.to_mut().film.size = [8, 8];
    }
    black_box(PackedScene::new(&scene).expect("it can be packed"));
    black_box(ReferenceRenderer::new(&scene).expect("it can be rendered"));
}

/// Makes the allocator keep what it once had: how long it takes to get pages anew depends on the machine, and on whether the sum of what is in
/// use passes some threshold.
fn keep_pages() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    for (option, value) in [(libc::M_ARENA_MAX, 1), (libc::M_MMAP_THRESHOLD, 1 << 25), (libc::M_TRIM_THRESHOLD, i32::MAX)] {
        // SAFETY: the call takes numbers only.
        let status = unsafe { libc::mallopt(option, value) };
        assert_eq!(status, 1, "the allocator knows the option {option}");
    }
}

/// The kinds of work that grow by more than that of twice the size. Quadratic work grows by four.
fn excess(size: usize, work: impl Fn(usize) + Sync) -> Option<String> {
    keep_pages();
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    one_thread.install(|| work(2 * size));
    let measure = |size: usize| {
        let mut shortest = Duration::MAX;
        let mut bytes = 0;
        for _ in 0..3 {
            let before = bytes_ever();
            // On one thread, whose time is known and does not grow where the machine is busy.
            let time = one_thread.install(|| {
                let start = clock::of_thread();
                work(size);
                clock::of_thread() - start
            });
            shortest = shortest.min(time);
            bytes = bytes_ever() - before;
        }
        (shortest, bytes)
    };
    let (once, twice) = (measure(size), measure(2 * size));
    let report = format!("{size}: {once:.1?}, {}: {twice:.1?}", 2 * size);
    // Machines are busy, and caches overflow; the shortest of three times is blurred by less than a half.
    let in_time = twice.0 < 3 * once.0 + Duration::from_millis(20);
    let in_memory = twice.1 < once.1 * 5 / 2 + 100_000;
    (!in_time || !in_memory).then_some(report)
}

pub fn assert_linear(what: &str, size: usize, work: impl Fn(usize) + Sync) {
    // A busy machine lengthens one measurement now and then, and quadratic work all of them.
    let reports: Vec<String> = (0..4).map_while(|_| excess(size, &work)).collect();
    assert!(reports.len() < 4, "{what}: {reports:?}");
}

/// Trial runs and learning trace paths whose number is fixed, so that what they take must be bounded by what a path takes. On one thread.
fn assert_bounded(what: &str, size: usize, scene: impl Fn(usize) -> Scene + Sync) {
    const MOST: Duration = Duration::from_secs(30);
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let measure = |size: usize| {
        let scene = scene(size);
        let time_of = |work: &(dyn Fn() + Sync)| {
            one_thread.install(|| {
                let start = clock::of_thread();
                work();
                clock::of_thread() - start
            })
        };
        let without_trial_runs = time_of(&|| drop(black_box(Integrator::new(&scene).expect("it can be rendered"))));
        // With trial runs, learning, and what `gpt check` guesses the time by.
        let all = time_of(&|| {
            black_box(ReferenceRenderer::new(&scene).expect("it can be rendered"));
            let integrator = Integrator::new(&scene).expect("it can be rendered");
            black_box(integrator.time_of_path(256, 1.0));
        });
        (all.saturating_sub(without_trial_runs), all)
    };
    let (once, twice) = (measure(size), measure(2 * size));
    let report = format!("{what}, {size}: {once:.1?}, {}: {twice:.1?}", 2 * size);
    assert!(twice.0 < 3 * once.0 + Duration::from_secs(2) && twice.0 < MOST, "{report}");
}

/// A mesh of so many faces, at these corners and of this material.
fn pile(material: &str, count: usize) -> String {
    let faces = "[0, 1, 2], ".repeat(count);
    format!(
        "[[material]]\nname = \"p\"\n{material}\n[[shape]]\ntype = \"mesh\"\nmaterial = \"p\"\npositions = [[-2,-2,0],[2,-2,0],[0,2,0]]\nfaces = [{faces}]\n"
    )
}

const LAMP: &str = "[[light]]\ntype = \"point\"\nposition = [1, 2, 4]\nintensity = 5\n";

#[test]
#[ignore = "long: trial runs of surfaces in one place"]
fn long_trial_runs_of_surfaces_in_one_place() {
    let _turn = take_turn();
    for (what, material, size) in [
        ("opaque", "type = \"diffuse\"\nreflectance = 0.5", 5000),
        ("veiled", "type = \"diffuse\"\nreflectance = 0.5\nopacity = 0.5", 1000),
        ("clear", "type = \"diffuse\"\nreflectance = 0.5\nopacity = 0.001", 1000),
        ("glass", "type = \"glass\"\nior = 1.5", 5000),
        ("lamps", "type = \"emissive\"\nradiance = 2", 5000),
    ] {
        assert_bounded(what, size, |count| read(&format!("{HEAD}{LAMP}{}", pile(material, count))));
    }
}

#[test]
#[ignore = "long: trial runs of lamps and guides among much"]
fn long_trial_runs_of_lamps_and_guides_among_much() {
    let _turn = take_turn();
    let veil = "type = \"diffuse\"\nreflectance = 0.5\nopacity = 0.5";
    let lamps: String =
        (0..40).map(|lamp| format!("[[light]]\ntype = \"point\"\nposition = [{}, 2, 4]\nintensity = 5\n", lamp - 20)).collect();
    for settings in ["light_choice = \"cells\"", "light_choice = \"auto\"", "guiding = \"on\"", "guiding = \"auto\""] {
        assert_bounded(settings, 1000, |count| read(&format!("[render]\n{settings}\n{HEAD}{lamps}{}", pile(veil, count))));
    }
}

#[test]
#[ignore = "long: trial runs of needles across each other"]
fn long_trial_runs_of_needles_across_each_other() {
    let _turn = take_turn();
    assert_bounded("needles", 10_000, |count| {
        let mut positions = String::new();
        let mut faces = String::new();
        for index in 0..count {
            let (sine, cosine) = (index as f64 * 2.399_963).sin_cos();
            let depth = index as f64 / count as f64;
            let _ = write!(
                positions,
                "[{},{},{depth}],[{},{},{depth}],[{},{},{}],",
                -3.0 * cosine,
                -3.0 * sine,
                3.0 * cosine,
                3.0 * sine,
                3.0 * cosine,
                3.0 * sine + 1e-3,
                depth + 1e-3
            );
            let _ = write!(faces, "[{},{},{}],", 3 * index, 3 * index + 1, 3 * index + 2);
        }
        read(&format!("{HEAD}{LAMP}[[shape]]\ntype = \"mesh\"\nmaterial = \"m\"\npositions = [{positions}]\nfaces = [{faces}]\n"))
    });
}

#[test]
fn trial_runs_of_instances_in_one_place() {
    let _turn = take_turn();
    assert_bounded("instances", 5000, |count| {
        let group = "[[group]]\nname = \"g\"\n[[group.shape]]\ntype = \"mesh\"\nmaterial = \"m\"\npositions = [[-2,-2,0],[2,-2,0],[0,2,0]]\nfaces = [[0,1,2]]\n";
        let places = "[[instance]]\ngroup = \"g\"\n".repeat(count);
        read(&format!("{HEAD}{LAMP}{group}{places}"))
    });
}

#[test]
fn trial_runs_of_deep_blends() {
    let _turn = take_turn();
    assert_bounded("blends", 2000, |count| {
        let mut text = format!("{HEAD}{LAMP}[[material]]\nname = \"g\"\ntype = \"glossy\"\nexponent = 20\nreflectance = 0.5\n");
        let mut inner = "g".to_owned();
        for index in 0..count {
            let _ = writeln!(text, "[[material]]\nname = \"b{index}\"\ntype = \"blend\"\nmaterials = [\"{inner}\", \"g\"]");
            let _ = writeln!(text, "weight = {{ type = \"constant\", value = 0.999 }}");
            inner = format!("b{index}");
        }
        let corners = "positions = [[-2,-2,0],[2,-2,0],[0,2,0]]\nfaces = [[0,1,2]]";
        read(&format!("{text}[[shape]]\ntype = \"mesh\"\nmaterial = \"{inner}\"\n{corners}\n"))
    });
}

/// The control: what is quadratic, in time or in memory, is noticed.
#[test]
fn quadratic_work_is_noticed() {
    let _turn = take_turn();
    let slow = |size: usize| {
        let sum = (0..size * size).fold(0_usize, |sum, number| black_box(sum.wrapping_mul(31) ^ number));
        black_box(sum);
    };
    // A busy machine blurs one measurement now and then.
    assert!((0..4).any(|_| excess(6000, slow).is_some()));
    let greedy = |size: usize| (0..size).for_each(|_| drop(black_box(vec![0_u8; size * 10])));
    assert!(excess(1000, greedy).is_some());
}

#[test]
fn faces_that_coincide() {
    let _turn = take_turn();
    let scene = |count: usize| {
        let faces = "[0, 1, 2], ".repeat(count);
        read(&format!(
            "{HEAD}[[shape]]\ntype = \"mesh\"\nmaterial = \"m\"\npositions = [[0,0,0],[1,0,0],[0,1,0]]\nfaces = [{faces}]\n"
        ))
    };
    let packed = PackedScene::new(&scene(5000)).expect("it can be packed");
    assert!(packed.hierarchy.stack_size <= 64, "{}", packed.hierarchy.stack_size);
    assert_linear("copies of a triangle", 5000, |count| prepare(&scene(count)));
}

#[test]
fn spheres_about_one_centre() {
    let _turn = take_turn();
    assert_linear("concentric spheres", 4000, |count| {
        let spheres = (1..=count).fold(String::new(), |mut text, radius| {
            let _ = writeln!(text, "[[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = {radius}\nmaterial = \"m\"");
            text
        });
        prepare(&read(&format!("{HEAD}{spheres}")));
    });
}

#[test]
fn inline_meshes_with_faces_that_are_left_out() {
    let _turn = take_turn();
    assert_linear("inline meshes", 1000, |count| {
        let meshes = (0..count).fold(String::new(), |mut text, index| {
            let _ = writeln!(
                text,
                "[[shape]]\ntype = \"mesh\"\nmaterial = \"m\"\npositions = [[{index},0,0],[1,0,1],[0,1,0]]\nfaces = [[0,1,2],[0,0,1]]"
            );
            text
        });
        let scene = read(&format!("{HEAD}{meshes}"));
        assert!(scene.warnings[count - 1].ends_with(&format!("shape[{}]: 1 triangles without area were left out", count - 1)));
    });
}

#[test]
fn models_of_many_groups_and_materials() {
    let _turn = take_turn();
    assert_linear("groups", 4000, |count| {
        let mut model = "mtllib model.mtl\nvt 0 0\n".to_owned();
        let mut materials = String::new();
        for index in 0..count {
            let _ = writeln!(materials, "newmtl m{index}\nKd 0.5 0.5 0.5");
            // Half of the materials are not in the library.
            let _ = writeln!(
                model,
                "o o{index}\nusemtl m{}\nv {index} 0 0\nv {index} 1 0\nv {index} 0 1\nf -3/1 -2/1 -1/1",
                2 * index
            );
        }
        let folder = folder_with(&[("model.obj", model.as_bytes()), ("model.mtl", materials.as_bytes())]);
        prepare(&load::load(folder.path().join("model.obj").to_str()).unwrap_or_else(|error| panic!("{error}")));
    });
}

#[test]
fn one_model_in_many_materials() {
    let _turn = take_turn();
    let folder = folder_with(&[("model.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".repeat(500).as_bytes())]);
    assert_linear("materials", 200, |count| {
        let entries = (0..count).fold(HEAD.to_owned(), |mut text, index| {
            let _ = writeln!(text, "[[material]]\nname = \"n{index}\"\ntype = \"diffuse\"\nreflectance = 0.5");
            let _ = writeln!(text, "[[shape]]\ntype = \"mesh\"\nfile = \"model.obj\"\nmaterial = \"n{index}\"");
            text
        });
        let scene = load::load_toml_str(&entries, "grown.toml", folder.path()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((scene.shapes[0].material, scene.shapes[count - 1].material), (1, count));
    });
}

#[test]
fn chains_of_blends() {
    let _turn = take_turn();
    assert_linear("blends", 4000, |count| {
        let mut text = HEAD.to_owned();
        let mut inner = "m".to_owned();
        for index in 0..count {
            let _ = writeln!(text, "[[material]]\nname = \"b{index}\"\ntype = \"blend\"\nmaterials = [\"{inner}\", \"m\"]");
            let _ = writeln!(text, "weight = {{ type = \"constant\", value = 0.5 }}");
            inner = format!("b{index}");
        }
        for index in 0..count / 10 {
            let _ = writeln!(text, "[[shape]]\ntype = \"sphere\"\ncenter = [{index}, 0, 0]\nradius = 1\nmaterial = \"{inner}\"");
        }
        prepare(&read(&text));
    });
}

#[test]
fn polygons_of_many_corners() {
    let _turn = take_turn();
    assert_linear("corners", 15_000, |count| {
        let mut model = String::new();
        for corner in 0..count {
            let (sine, cosine) = (corner as f64 / count as f64 * std::f64::consts::TAU).sin_cos();
            let radius = if corner % 2 == 0 { 1.0 } else { 0.9 };
            let _ = writeln!(model, "v {} {} 0", radius * cosine, radius * sine);
        }
        let corners: String = (1..=count).map(|corner| format!(" {corner}")).collect();
        let folder = folder_with(&[("model.obj", format!("{model}f{corners}\n").as_bytes())]);
        let scene = load::load(folder.path().join("model.obj").to_str()).unwrap_or_else(|error| panic!("{error}"));
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    });
}

/// Every kind of statement that is mended, so many times.
#[test]
fn models_full_of_odd_statements() {
    let _turn = take_turn();
    assert_linear("odd statements", 2000, |count| {
        let continued = "\\\n".repeat(count);
        let blanks = "x ".repeat(count);
        let mut model = format!("g {blanks}\nmtllib {blanks}a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 {continued} 2 3\n");
        let mut library = format!("newmtl {blanks}\nmap_Kd {}\nKd 1 {continued} 0 0\n", "-s 1 ".repeat(count));
        for index in 0..count {
            let _ = writeln!(
                model,
                "v nan {index} 0\nvn nan 0 1\nvt x\nusemtl n{index} # a\nf 1 2\nf 0 1 2\nf 1 2 {}\nf 1/-1/-1 2/-1/-1 3/9999999/-1\nf 1 / 2 3 {}, 2\n\
                 # a comment \\\nnonsense {index}\nf 1//{index} 2 3",
                index + 4,
                index % 3 + 1
            );
            let _ = writeln!(library, "newmtl n{index} # a\nKd nan\nNs -1\nillum {index}\nodd{index} 1\nKd spectral a\nmap_Bump");
        }
        let folder = folder_with(&[("model.obj", model.as_bytes()), ("a.mtl", library.as_bytes())]);
        let scene = load::load(folder.path().join("model.obj").to_str()).unwrap_or_else(|error| panic!("{error}"));
        assert!((10..60).contains(&scene.warnings.len()), "{:?}", scene.warnings);
    });
    assert_linear("odd numbers", 10_000, |count| {
        let header = format!(
            "ply\nformat ascii 1.0\nelement vertex {count}\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n\
            property float ny\nproperty float nz\nelement face {count}\nproperty list uchar int vertex_indices\nend_header\n"
        );
        let mut data = String::new();
        for index in 0..count {
            let _ = writeln!(data, "{} {} {} nan 0 1", index % 7, index / 7, if index % 5 == 4 { "nan" } else { "0" });
        }
        for index in 0..count {
            let _ = writeln!(data, "3 {} {} {} 9", index % 9, index, index / 2);
        }
        let folder = folder_with(&[("model.ply", (header + &data).as_bytes())]);
        let scene = load::load(folder.path().join("model.ply").to_str()).unwrap_or_else(|error| panic!("{error}"));
        assert!((1..10).contains(&scene.warnings.len()), "{:?}", scene.warnings);
    });
}

#[test]
fn mistakes_at_the_end_of_long_lines() {
    let _turn = take_turn();
    assert_linear("a long line", 100_000, |count| {
        let positions = "[0, 0, 0], ".repeat(count);
        let text =
            format!("{HEAD}[[shape]]\ntype = \"mesh\"\nmaterial = \"m\"\npositions = [{positions}]\nfaces = [[0, 1, {count}]]\n");
        let error = load::load_toml_str(&text, "grown.toml", Path::new("")).expect_err("there is no such position");
        assert_eq!(error.line(), Some(16));
        assert!(error.to_string().len() < 500 && error.excerpt().is_some_and(|excerpt| excerpt.text.len() < 1000));
    });
}

/// Files in which everything is wrong, as the reader sees it and as the scene does. Twenty mistakes of them are told.
#[test]
fn mistakes_in_every_entry() {
    let _turn = take_turn();
    for (mistake, words) in [("radiuss = 1\nmaterial = \"m\"", "radiuss"), ("radius = 1\nmaterial = \"none\"", "none")] {
        assert_linear(words, 2000, |count| {
            let entry = format!("[[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\n{mistake}\n");
            let text = format!("{HEAD}{}", entry.repeat(count));
            let error = load::load_toml_str(&text, "grown.toml", Path::new("")).expect_err("everything is wrong");
            assert!(error.line().is_some_and(|line| line < 20) && error.to_string().contains(words), "{error}");
            assert_eq!(error.others().len(), 19);
        });
    }
}
