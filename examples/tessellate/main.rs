//! Makes the models of the built-in material scenes, `scenes/models/*.obj`, from their formulas:
//!
//! ```sh
//! cargo run --release --example tessellate [FOLDER]     # default: scenes/models
//! ```

mod knot;
mod surface;
mod teapot;

use std::path::PathBuf;
use std::process::ExitCode;

use surface::Surface;

fn main() -> ExitCode {
    let folder = PathBuf::from(std::env::args_os().nth(1).unwrap_or_else(|| "scenes/models".into()));
    for (name, text) in models() {
        let path = folder.join(name).with_extension("obj");
        if let Err(error) = std::fs::write(&path, text) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        }
        println!("{}", path.display());
    }
    ExitCode::SUCCESS
}

/// Their names and files.
pub fn models() -> [(&'static str, String); 2] {
    [("teapot", obj(teapot::ABOUT, &teapot::teapot())), ("knot", obj(knot::ABOUT, &knot::knot()))]
}

fn obj(about: &str, surface: &Surface) -> String {
    format!("# {about}\n# Made by `cargo run --release --example tessellate`.\n{}", surface.to_obj())
}
