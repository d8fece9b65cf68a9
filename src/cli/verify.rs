//! `gpt verify`.

use std::fmt::Write;
use std::path::Path;

use gpt::plan::PlanOptions;
use gpt::scene::{self, Scene};
use gpt::verify::{self, DEFAULT_SIDE, DEFAULT_SPP, Verdict, evidence};

use super::arguments::VerifyArguments;
use super::exit::{Exit, Failure};
use super::terminal;

/// Verifies one scene, or all that are built in, and prints the verdicts.
pub fn run(arguments: &VerifyArguments) -> Result<Exit, Failure> {
    let names: Vec<String> = match &arguments.scene {
        Some(name) => vec![name.clone()],
        None => scene::builtin_names().map(str::to_owned).collect(),
    };
    let mut verdicts = Vec::new();
    for name in &names {
        let scene = load(name, arguments)?;
        let verdict = verify::verify(&scene, &arguments.device, &PlanOptions::default())?;
        if !arguments.json {
            terminal::answer(&line(&verdict))?;
        }
        if !verdict.agrees {
            leave_evidence(&arguments.evidence, &scene, &verdict, name)?;
        }
        verdicts.push(verdict);
    }
    if arguments.json {
        terminal::answer_json(&verdicts)?;
    }
    let all_agree = verdicts.iter().all(|verdict| verdict.agrees);
    Ok(if all_agree { Exit::Done } else { Exit::Difference })
}

fn load(name: &str, arguments: &VerifyArguments) -> Result<Scene, Failure> {
    let mut scene = scene::load(Some(name))?;
    match arguments.size {
        Some(size) => scene.film.size = size,
        None => verify::shrink(&mut scene, DEFAULT_SIDE),
    }
    scene.render.spp = arguments.spp.unwrap_or(DEFAULT_SPP);
    scene.render.seed = arguments.seed.unwrap_or(scene.render.seed);
    Ok(scene)
}

fn line(verdict: &Verdict) -> String {
    let mut text = String::new();
    let _ = write!(
        text,
        "{:<16} {}  {:.4} % of {} paths match  rms {:.1e}  largest {:.1e}  not finite {}",
        verdict.scene,
        if verdict.agrees { "agrees " } else { "DIFFERS" },
        100.0 * verdict.matching_share(),
        verdict.paths,
        verdict.rms_difference,
        verdict.largest_difference,
        verdict.non_finite_samples
    );
    for rejection in verdict.rejections.iter().take(5) {
        let _ = write!(text, "\n    {rejection}");
    }
    if verdict.rejections.len() > 5 {
        let _ = write!(text, "\n    and {} more regions", verdict.rejections.len() - 5);
    }
    text.push('\n');
    text
}

fn leave_evidence(folder: &Path, scene: &Scene, verdict: &Verdict, name: &str) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::Other(format!("cannot make the folder {}: {error}", folder.display())))?;
    for path in evidence::write(folder, scene, verdict)? {
        terminal::warn(&format!("wrote {}", path.display()));
    }
    let [x, y, sample] = verdict.worst_path;
    terminal::warn(&format!(
        "the worst path is sample {sample} of the pixel at column {x}, row {y}: \
         gpt render {name} --size {}x{} --seed {} --first-sample {sample} --spp 1 shows it",
        verdict.width, verdict.height, scene.render.seed
    ));
    Ok(())
}
