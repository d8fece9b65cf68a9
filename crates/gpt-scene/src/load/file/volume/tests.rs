use std::fs;

use glam::I64Vec3;

use super::*;
use crate::load::access::Access;
use crate::load::file::Document;
use crate::load::file::value::Fraction;
use crate::load::file::writer::{Names, SideFiles};
use crate::scene::Scene;

#[derive(Deserialize)]
struct Holder {
    density: Located<VolumeEntry>,
}

/// The volume of an entry in a file of this folder, and the scene in which files are remembered.
fn resolved<R: Rule>(folder: &Path, entry: &str) -> Result<(Volume, Scene), SceneError> {
    let text = format!("density = {entry}\n");
    let document = Document::new("scene.toml", &text);
    let Holder { density } = document.read()?;
    let mut resolver = Resolver::new(document, folder, Access::default());
    let volume = resolver.volume::<R>(&density.value, &density.place)?;
    assert_eq!(resolver.volume::<R>(&density.value, &density.place)?, volume, "a grid is the same a second time");
    Ok((volume, resolver.scene))
}

fn volume(entry: &str) -> Volume {
    resolved::<NonNegative>(Path::new(""), entry).unwrap_or_else(|error| panic!("{error}")).0
}

fn error_of(folder: &Path, entry: &str) -> SceneError {
    resolved::<NonNegative>(folder, entry).expect_err("it is refused")
}

/// A folder with `smoke.vol`: the values 0 and 1 along x in the box from (0, 0, 0) to (2, 1, 1).
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let grid = VoxelGrid::new([2, 1, 1], 1, vec![0.0, 1.0]).expect("a grid");
    let content = volume::write_mitsuba(&grid, DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0));
    fs::write(folder.path().join("smoke.vol"), content).expect("the file is written");
    folder
}

#[test]
fn values_are_written_in_the_scene_file() {
    let grey = volume(
        "{ resolution = [2, 1, 2], values = [0, 1, 2, 3.5], bounds = [[-1, 0, 0], [1, 1, 1]], filter = 'nearest', scale = 2 }",
    );
    assert_eq!(grey.value_at(DVec3::new(0.5, 0.5, 0.2)), Spectrum::grey(2.0));
    assert_eq!(grey.value_at(DVec3::new(0.5, 0.5, 0.7)), Spectrum::grey(7.0));
    assert_eq!(grey.value_at(DVec3::new(1.5, 0.5, 0.7)), Spectrum::BLACK);
    let coloured = volume("{ resolution = [1, 1, 1], values = [0.1, 0.2, 0.3], outside = 'border' }");
    assert_eq!((coloured.grid.channels(), coloured.filter), (3, VolumeFilter::Trilinear));
    assert_eq!(coloured.value_at(DVec3::splat(9.0)), Spectrum::from_f32([0.1, 0.2, 0.3]));
    let with_background = volume("{ resolution = [1, 1, 1], values = [1], background = 0.5 }");
    assert_eq!(with_background.value_at(DVec3::splat(9.0)), Spectrum::grey(0.5));
}

#[test]
fn a_file_stands_where_its_box_and_the_transform_put_it() {
    let folder = folder();
    let at = |keys: &str, point: [f64; 3]| {
        let entry = format!("{{ file = 'smoke.vol', filter = 'nearest'{keys} }}");
        let (volume, scene) = resolved::<NonNegative>(folder.path(), &entry).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.sources.paths().collect::<Vec<_>>(), [folder.path().join("smoke.vol")]);
        volume.value_at(point.into()).r()
    };
    assert_eq!([at("", [1.5, 0.5, 0.5]), at("", [0.5, 0.5, 0.5]), at("", [2.5, 0.5, 0.5])], [1.0, 0.0, 0.0]);
    assert_eq!(at(", transform = [{ scale = 2 }, { translate = [10, 0, 0] }]", [13.0, 1.5, 0.5]), 1.0);
    assert_eq!(at(", bounds = [[0, 0, 0], [1, 1, 1]]", [0.75, 0.5, 0.5]), 1.0);
    assert_eq!(at(", bounds = [[0, 0, 0], [1, 1, 1]]", [1.5, 0.5, 0.5]), 0.0);
}

/// The box of a sparse grid is that of active voxels, without the border that the reader adds.
#[test]
fn bounds_hold_the_active_voxels_of_a_sparse_grid() {
    let grid =
        Arc::new(VoxelGrid::new([3, 3, 3], 1, (0..27).map(|index| f32::from(u8::from(index == 13))).collect()).expect("a grid"));
    let placed = PlacedGrid { grid, to_index: DAffine3::IDENTITY, background: Some(Spectrum::BLACK), border: 1 };
    let text = "density = { file = 'x.vdb', bounds = [[2, 2, 2], [4, 4, 4]], filter = 'nearest' }\n";
    let document = Document::new("scene.toml", text);
    let Holder { density } = document.read().expect("an entry");
    let mut resolver = Resolver::new(document, Path::new(""), Access::default());
    resolver.grids.insert(("x.vdb".into(), None), placed);
    let volume = resolver.volume::<NonNegative>(&density.value, &density.place).expect("a volume");
    let at = |x: f64| volume.value_at(DVec3::new(x, 3.0, 3.0)).r();
    assert_eq!([at(1.9), at(2.1), at(3.9), at(4.1)], [0.0, 1.0, 1.0, 0.0]);
}

#[test]
fn mistakes_are_reported_at_their_keys() {
    let folder = folder();
    let reported = |entry: &str| {
        let error = error_of(folder.path(), entry);
        (error.key().unwrap_or_default().to_owned(), error.message().to_owned(), error.help_text().unwrap_or_default().to_owned())
    };
    let cases = [
        ("{ scale = 2 }", "density", "needs the key `file`, or `resolution` and `values`"),
        ("{ file = 'absent.vdb' }", "density.file", "absent.vdb"),
        ("{ file = 'smoke.vol', grid = 'density' }", "density.file", "`grid` has to be left out"),
        ("{ file = 'smoke.vol', values = [1] }", "density.values", "not both"),
        ("{ file = 'smoke.vol', resolution = [1, 1, 1] }", "density.resolution", "belongs to `values`"),
        ("{ values = [1] }", "density.values", "need the key `resolution`"),
        ("{ resolution = [1, 1, 2], values = [1] }", "density.values", "it has 1 values, and not 1 × 1 × 2 = 2"),
        ("{ resolution = [1, 0, 2], values = [1] }", "density.resolution[1]", "at least 1"),
        ("{ resolution = [1, 1, 1], values = [-1] }", "density.values[0]", "expected a number from 0 to 1e18"),
        ("{ resolution = [1, 1, 1], values = [nan] }", "density.values[0]", "expected a number from 0 to 1e18"),
        ("{ resolution = [1, 1, 1], values = [1], grid = 'a' }", "density.grid", "`file`, which is missing"),
        ("{ resolution = [1, 1, 1], values = [1], bounds = [[0, 0, 0], [1, 0, 1]] }", "density.bounds", "above the lower one"),
        ("{ resolution = [1, 1, 1], values = [1], transform = { scale = 0 } }", "density.transform.scale", "flattens"),
        ("{ resolution = [1, 1, 1], values = [1], filter = 'cubic' }", "density.filter", "cubic"),
        ("{ resolution = [4294967295, 4294967295, 4294967295], values = [1] }", "density.values", "the most"),
    ];
    for (entry, key, message) in cases {
        let (found_key, found, _) = reported(entry);
        assert!(found_key == key && found.contains(message), "{entry}: {found_key}: {found}");
    }
    assert!(reported("{ scale = 2 }").2.contains("smoke.vdb"));
    fs::write(folder.path().join("no.vdb"), "no volume").expect("the file is written");
    assert!(reported("{ file = 'no.vdb' }").1.contains("OpenVDB (.vdb), NanoVDB (.nvdb) and Mitsuba"));
}

#[test]
fn a_misspelt_name_of_a_grid_is_suggested() {
    let folder = folder();
    let place = Place::default();
    let document = Document::new("scene.toml", "");
    let resolver = Resolver::new(document, folder.path(), Access::default());
    let names = || vec!["density".to_owned(), "temperature".to_owned()];
    let error = VolumeError::NoSuchGrid { wanted: "densty".to_owned(), names: names() };
    let file = place.at(FileOr::Written("a.vdb".to_owned()));
    let reported = resolver.grid_error(Path::new("a.vdb"), &file, Some(&place.at("densty".to_owned())), &error);
    assert_eq!(reported.message(), "a.vdb: it has no grid named `densty`");
    assert_eq!(reported.help_text(), Some("did you mean `density`? valid choices: density, temperature"));
    let reported = resolver.grid_error(Path::new("a.vdb"), &file, None, &VolumeError::WhichGrid { names: names() });
    assert_eq!(reported.message(), "a.vdb: it has 2 grids, and the key `grid` does not say which");
    assert_eq!(reported.help_text(), Some("valid choices: density, temperature"));
}

#[test]
fn values_are_such_as_the_key_can_have() {
    let entry = "{ resolution = [2, 1, 1], values = [0.5, 1], scale = 2 }";
    let error = resolved::<Fraction>(Path::new(""), entry).expect_err("2 is no albedo");
    assert_eq!(error.message(), "expected a number from 0 to 1, found 2 in the grid times its `scale`");
    assert!(resolved::<Fraction>(Path::new(""), &entry.replace("scale = 2", "scale = 1")).is_ok());
}

#[test]
fn volumes_are_written_and_read_again() {
    let folder = folder();
    let entries = [
        "{ file = 'smoke.vol' }",
        "{ file = 'smoke.vol', filter = 'nearest', scale = 3, background = 0.25, transform = [{ rotate = [1, 2, 3], degrees = 40 }, { translate = [1, 0, 0] }] }",
        "{ resolution = [1, 2, 1], values = [0.1, 0.2, 0.3, 1, 2, 3], outside = 'border', bounds = [[-3, 0, 1], [5, 7, 8]] }",
    ];
    for entry in entries {
        let (volume, scene) = resolved::<NonNegative>(folder.path(), entry).unwrap_or_else(|error| panic!("{error}"));
        let names = || Names::unique(std::iter::empty(), "");
        let files = SideFiles::beside(&folder.path().join("again.toml"));
        let mut writer = Writer {
            scene: &scene,
            textures: names(),
            materials: names(),
            media: names(),
            groups: names(),
            nodes: names(),
            files,
            names_unreadable: true,
        };
        let written = write_volume(&volume, &mut writer);
        for (path, content) in writer.files.into_files() {
            fs::create_dir_all(path.parent().expect("a folder")).expect("the folder is made");
            fs::write(path, content).expect("the file is written");
        }
        assert_eq!(written.contains("transform"), !entry.ends_with("'smoke.vol' }"), "{written}");
        let (again, _) = resolved::<NonNegative>(folder.path(), &written).unwrap_or_else(|error| panic!("{written}: {error}"));
        assert!(again.to_index.abs_diff_eq(volume.to_index, 1e-12), "{written}");
        assert_eq!(Volume { to_index: volume.to_index, ..again }, volume, "{written}");
    }
}

#[test]
fn grids_in_memory_fill_the_unit_box() {
    let grid = Arc::new(VoxelGrid::new([1, 1, 2], 1, vec![1.0, 2.0]).expect("a grid"));
    let entry = VolumeEntry { file: Some(Place::default().at(FileOr::InMemory(grid.clone()))), ..VolumeEntry::default() };
    let mut resolver = Resolver::new(Document::new("scene.toml", ""), Path::new(""), Access::default());
    let volume = resolver.volume::<NonNegative>(&entry, &Place::default()).expect("a volume");
    assert!(Arc::ptr_eq(&volume.grid, &grid));
    assert_eq!(volume.value_at(DVec3::new(0.5, 0.5, 0.75)), Spectrum::grey(2.0));
    assert_eq!(volume.grid.voxel(I64Vec3::ZERO), Spectrum::WHITE);
}
