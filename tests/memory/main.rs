//! How much memory is taken, counted by an allocator of this program's own. It counts for the whole process, so its tests take turns.

#[path = "../common/mod.rs"]
mod common;
#[path = "../statistics/random.rs"]
mod random;

mod clock;
mod counting;
mod growing_imports;
mod growth;
mod hostile;
mod hostile_files;
mod hostile_imports;
mod import_budgets;
mod large_pictures;
mod many_files;
mod repeated_renders;
mod seeds;
mod triangle_gltf;
