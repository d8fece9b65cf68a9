//! Tells the crate where the built-in scenes are that it embeds, as `GPT_SCENES`.

use std::env;
use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let crate_folder = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    // The link `scenes` leads to the folder of the repository. `cargo package` follows it, so that a published crate has the files themselves.
    // Git for Windows writes links as text unless told otherwise; the folder is two levels up in any checkout.
    let linked = crate_folder.join("scenes");
    let scenes = if linked.is_dir() { linked } else { crate_folder.join("../../scenes") };
    println!("cargo::rustc-env=GPT_SCENES={}", scenes.display());
}
