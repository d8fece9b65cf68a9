//! Renders one after the other, each on a device that is opened for it, as programs in Python make them: what one takes, it gives back.

use gpt::load::load_toml_str;
use gpt::{DeviceChoice, RenderOptions, Renderer, Silent};

use crate::counting::{Peak, take_turn};

const RENDERS: u64 = 60;

const SCENE: &str = "[film]\nsize = [32, 32]\n[render]\nspp = 1\nmax_depth = 2\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = 40\n\
    [[material]]\nname = \"m\"\ntype = \"diffuse\"\nreflectance = 0.5\n[[shape]]\ntype = \"sphere\"\nmaterial = \"m\"\nradius = 1\ncenter = [0, 0, 0]\n\
    [[light]]\ntype = \"point\"\nposition = [3, 4, 5]\nintensity = 40\n";

/// Kibibytes of memory that the process has.
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let row = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    row.split_whitespace().next()?.parse().ok()
}

#[test]
fn renders_give_back_what_they_take() {
    let _turn = take_turn();
    if std::env::var("GPT_TEST_GPU").as_deref() == Ok("skip") {
        return;
    }
    let scene = load_toml_str(SCENE, "scene", std::path::Path::new("")).expect("a scene");
    let options = RenderOptions { device: DeviceChoice::Gpu, ..RenderOptions::default() };
    let render = || {
        Renderer::new(&scene, &options).and_then(|mut renderer| renderer.image(&Silent)).expect("it renders");
    };
    // Everything that is made once is made now.
    (0..20).for_each(|_| render());
    let (peak, before) = (Peak::from_now(), resident());
    (0..RENDERS).for_each(|_| render());
    assert!(peak.bytes_now() < RENDERS as usize * 1024, "{} bytes are kept", peak.bytes_now());
    if let (Some(before), Some(after)) = (before, resident()) {
        let growth = after.saturating_sub(before);
        assert!(growth < RENDERS * 50, "{growth} KiB in {RENDERS} renders");
    }
}
