//! Many materials or shapes at once, each in a cell of a grid of its own: one kernel where each alone would take one. What differs is told
//! by the cells in which its paths begin.

use std::collections::{BTreeMap, BTreeSet};

use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::plan::PlanOptions;
use gpt::scene::Scene;
use gpt::verify::{self, Verdict};

use super::DEVICE;
use super::materials::BUMPS;

/// Pixels along a side of a cell.
const SIDE: usize = 16;
/// The background of all cells, and the light on them. Cells are squares of length 1, seen by parallel rays.
const ROOM: &str = r#"
[render]
spp = 4
max_depth = 5
[[light]]
type = "point"
position = [-2, 1, 4]
intensity = [12, 10, 8]
[[shape]]
type = "plane"
point = [0, 0, -0.7]
normal = [0, 0, 1]
material = "floor"
"#;

/// A name, and what it does to a scene.
pub type Change<'a> = (&'a str, &'a dyn Fn(&mut Scene));

/// A scene with a name for each of its cells, row by row from the top.
pub struct TestGrid {
    pub scene: Scene,
    names: Vec<String>,
    columns: usize,
}

impl TestGrid {
    /// `cell` gives the tables of the cell with this number and this middle; `tables` are those that all share. A material that several cells
    /// define in the same words is defined once.
    pub fn new(columns: usize, tables: &str, names: Vec<String>, cell: impl Fn(usize, [f64; 2]) -> String) -> Self {
        let rows = names.len().div_ceil(columns);
        let mut text = format!(
            "[film]\nsize = [{}, {}]\n[camera]\nposition = [0, 0, 10]\nlook_at = [0, 0, 0]\nprojection = \"orthographic\"\nheight = {rows}\n\
             shutter = [0, 1]\n{ROOM}",
            SIDE * columns,
            SIDE * rows
        );
        // Above the grid, and not in sight: its front is towards the grid.
        let top = 0.5 * rows as f64;
        text += &format!(
            "[[shape]]\ntype = \"rectangle\"\ncorner = [-1, {}, 1]\nedge_u = [2, 0, 0]\nedge_v = [0, -0.8, 1.2]\nmaterial = \"lamp\"\n{tables}",
            top + 1.0
        );
        let mut defined = BTreeSet::new();
        for index in 0..names.len() {
            let x = (index % columns) as f64 - 0.5 * (columns - 1) as f64;
            let y = top - 0.5 - (index / columns) as f64;
            for table in format!("\n{}", cell(index, [x, y])).split("\n[[").filter(|table| !table.trim().is_empty()) {
                if !table.starts_with("material") || defined.insert(table.trim().to_owned()) {
                    text += &format!("[[{table}\n");
                }
            }
        }
        let scene = load::load_toml_str(&text, "grid.toml", BUMPS.path()).unwrap_or_else(|error| panic!("{error}\n{text}"));
        Self { scene, names, columns }
    }

    /// The cell that a pixel shows.
    fn name_at(&self, [column, row]: [u32; 2]) -> &str {
        let index = row as usize / SIDE * self.columns + column as usize / SIDE;
        self.names.get(index).map_or("an empty cell", String::as_str)
    }

    /// How many of the paths that nothing explains begin in each cell.
    fn cells_of(&self, verdict: &Verdict) -> BTreeMap<&str, u32> {
        let mut cells = BTreeMap::new();
        for path in &verdict.unexplained_paths {
            *cells.entry(self.name_at(path.pixel)).or_default() += 1;
        }
        cells
    }

    /// The device's paths are the reference's, by these settings.
    pub fn assert_agrees(&self, what: &str, options: &PlanOptions, set: impl Fn(&mut Scene)) {
        let Some(device) = DEVICE.as_ref() else { return };
        let mut scene = self.scene.clone();
        set(&mut scene);
        let verdict = super::compare_on(device, &scene, options);
        println!("{what}: {:.4} % of {} paths match", 100.0 * verdict.matching_share(), verdict.paths);
        assert!(verdict.agrees, "{what}: paths begin at {:?}: {verdict:#?}", self.cells_of(&verdict));
    }

    /// The control: a reference that renders another grid is noticed. The device has the same kernel each time, and two samples are enough.
    pub fn assert_notices(&self, changes: &[Change<'_>]) {
        let Some(device) = DEVICE.as_ref() else { return };
        let mut scene = self.scene.clone();
        scene.render.spp = 2;
        let mut gpu = GpuRenderer::on(device, &scene, &PlanOptions::default()).expect("the scene fits");
        for (what, change) in changes {
            let mut other = scene.clone();
            change(&mut other);
            let mut cpu = ReferenceRenderer::new(&other).expect("the scene is supported");
            let verdict = verify::compare(&other, &mut gpu, &mut cpu, None).expect("both render");
            println!("{what}: {:.4} % match", 100.0 * verdict.matching_share());
            assert!(!verdict.agrees, "{what}, and nobody notices: {verdict:#?}");
        }
    }
}
