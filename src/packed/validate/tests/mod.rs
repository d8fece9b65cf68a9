//! Every word of every packed record, corrupted: what a kernel would follow out of bounds is refused, and what it only computes with is
//! not.

mod kernel;
mod scenes;

use rayon::prelude::*;

use super::words::{Array, Word};
use crate::effort::in_full;
use crate::packed::environment::PackedMap;
use crate::packed::hierarchy::Traversal;
use crate::packed::{NONE, PackedScene};
use crate::sampling::hash::mix;

/// A word that is no index, no kind and no count of the scenes here, and not [`NONE`] either.
const BEYOND: u32 = u32::MAX - 1;

fn words_mut(scene: &mut PackedScene, array: Array) -> &mut [u32] {
    match array {
        Array::Primitives => bytemuck::cast_slice_mut(&mut scene.primitives),
        Array::Attributes => bytemuck::cast_slice_mut(&mut scene.attributes),
        Array::Nodes => bytemuck::cast_slice_mut(&mut scene.hierarchy.nodes),
        Array::Instances => bytemuck::cast_slice_mut(&mut scene.instances),
        Array::Materials => bytemuck::cast_slice_mut(&mut scene.materials.materials),
        Array::Parameters => bytemuck::cast_slice_mut(&mut scene.materials.further),
        Array::BlendParts => bytemuck::cast_slice_mut(&mut scene.materials.parts),
        Array::Layers => bytemuck::cast_slice_mut(&mut scene.materials.layers),
        Array::Weights => bytemuck::cast_slice_mut(&mut scene.materials.weights),
        Array::Lights => bytemuck::cast_slice_mut(&mut scene.lights),
        Array::LightNodes => bytemuck::cast_slice_mut(&mut scene.light_nodes),
        Array::LightProfiles => bytemuck::cast_slice_mut(&mut scene.light_profiles),
        Array::Textures => bytemuck::cast_slice_mut(&mut scene.textures.textures),
    }
}

/// A function that replaces a word.
type Corruption = Box<dyn Fn(u32) -> u32 + Sync>;

/// A place in a packed scene that can be overwritten.
#[derive(Debug, Clone, Copy)]
enum PackedWord {
    Word(Array, usize),
    Motion(usize),
    Texel(usize),
    Map(usize),
    LightCells(usize),
    StackSize,
    PrimitiveCount,
}

fn map_fields(map: &mut PackedMap) -> [&mut u32; 8] {
    let PackedMap { first_texel, width, height, first_node, first_density, grid_width, grid_height, levels, rows: _ } = map;
    [first_texel, width, height, first_node, first_density, grid_width, grid_height, levels]
}

/// Changes one word; the map's fields where there is a map.
fn change(scene: &mut PackedScene, place: PackedWord, new: impl Fn(u32) -> u32) {
    let as_bits = |float: &mut f32| *float = f32::from_bits(new(float.to_bits()));
    match place {
        PackedWord::Word(array, word) => {
            let word = &mut words_mut(scene, array)[word];
            *word = new(*word);
        }
        PackedWord::Motion(word) => as_bits(&mut bytemuck::cast_slice_mut::<_, f32>(&mut scene.motions)[word]),
        PackedWord::Texel(word) => {
            let word = word - scene.textures.first_word();
            scene.textures.words[word] = new(scene.textures.words[word]);
        }
        PackedWord::Map(field) => {
            if let Some(map) = &mut scene.environment.map {
                let [field] =
                    map_fields(map).into_iter().skip(field).take(1).collect::<Vec<_>>().try_into().expect("eight fields");
                *field = new(*field);
            }
        }
        PackedWord::LightCells(word) => scene.light_cells[word] = new(scene.light_cells[word]),
        PackedWord::StackSize => scene.hierarchy.stack_size = new(scene.hierarchy.stack_size),
        PackedWord::PrimitiveCount => scene.hierarchy.primitive_count = new(scene.hierarchy.primitive_count),
    }
}

/// Every word, and whether it is one that has to be refused where it is [`BEYOND`].
fn places(scene: &PackedScene) -> Vec<(PackedWord, bool)> {
    let mut places = Vec::new();
    for array in Array::ALL {
        for (index, record) in array.of(scene).chunks_exact(array.record_words()).enumerate() {
            for word in 0..record.len() {
                let listed = array.words().iter().find(|(listed, _)| *listed == word);
                let judged = match listed {
                    None => false,
                    Some((_, Word::Index(_) | Word::Optional(_) | Word::Checked)) => true,
                    Some((_, Word::CheckedIn(holds))) => holds(record),
                };
                places.push((PackedWord::Word(array, index * record.len() + word), judged));
            }
        }
    }
    // In a motion, the number of steps and their kinds: the fourth words of the first row and of every second
    // one behind it.
    let mut row = 0;
    while row < scene.motions.len() {
        let rows = 1 + 2 * scene.motions[row][3].to_bits() as usize;
        for within in 0..rows {
            let judged = within == 0 || within % 2 == 1;
            places.extend((0..4).map(|word| (PackedWord::Motion(4 * (row + within) + word), judged && word == 3)));
        }
        row += rows;
    }
    let nodes = scene.environment.map.map_or(0..0, |map| map.first_node as usize..map.first_density as usize);
    // Before the map stand colours and what integers stand for: any will do.
    let first = scene.environment.map.map_or(scene.textures.texel_words(), |map| map.first_texel as usize);
    places.extend((first..scene.textures.texel_words()).map(|texel| (PackedWord::Texel(texel), nodes.contains(&texel))));
    if scene.environment.map.is_some() {
        places.extend((0..8).map(|field| (PackedWord::Map(field), true)));
    }
    // The begin of the grid of cells of lights and the size of its boxes may have any value.
    places.extend((0..scene.light_cells.len()).map(|word| (PackedWord::LightCells(word), word >= 4)));
    let walks_nodes = scene.hierarchy.traversal == Traversal::Bvh;
    places.extend([(PackedWord::StackSize, walks_nodes), (PackedWord::PrimitiveCount, true)]);
    places
}

/// The values that replace a word: ends of arrays and of fields, and the word with one bit inverted.
fn corruptions(scene: &PackedScene) -> Vec<Corruption> {
    let mut values = vec![0, 1, 2, 3, 7, 11, 255, 256, 1 << 10, 1 << 24, 1 << 28, 1 << 30, (1 << 31) - 1, 1 << 31, BEYOND, NONE];
    for length in Array::ALL.map(|array| array.len(scene) as u32).into_iter().chain([scene.textures.texel_words() as u32]) {
        values.extend([length.wrapping_sub(1), length, length + 1]);
    }
    values.sort_unstable();
    values.dedup();
    let mut corruptions: Vec<Corruption> = Vec::new();
    corruptions.extend(values.into_iter().map(|value| Box::new(move |_| value) as Corruption));
    corruptions.extend((0..32_u32).map(|bit| Box::new(move |word: u32| word ^ 1 << bit) as Corruption));
    corruptions.push(Box::new(|word| word.wrapping_add(1)));
    corruptions.push(Box::new(|word| word.wrapping_sub(1)));
    corruptions
}

/// Scenes that pass the checks can be followed by a kernel.
fn assert_safe(scene: &PackedScene, what: &dyn Fn() -> String) {
    if scene.validate().is_ok()
        && let Err(found) = kernel::follow(scene)
    {
        panic!("{}: it passes, and a kernel reads {found}", what());
    }
}

#[test]
fn what_was_packed_passes_and_uses_every_array() {
    let scenes = scenes::all();
    for (name, scene) in &scenes {
        assert!(scene.validate().is_ok(), "{name}");
        assert_eq!(kernel::follow(scene), Ok(()), "{name}");
    }
    for array in Array::ALL {
        assert!(scenes.iter().any(|(_, scene)| array.len(scene) > 1), "no scene has two {array:?}");
    }
    let any = |holds: fn(&PackedScene) -> bool| scenes.iter().any(|(_, scene)| holds(scene));
    assert!(any(|scene| !scene.motions.is_empty()) && any(|scene| !scene.hierarchy.boxes.is_empty()));
    assert!(any(|scene| !scene.light_cells.is_empty()));
    assert!(any(|scene| scene.environment.map.is_some_and(|map| map.levels > 1)));
}

#[test]
fn no_corrupted_word_leads_a_kernel_out_of_bounds() {
    // Another part of the corruptions at each word, so that words of a kind meet all of them, and each word some. Words that are free lead
    // nowhere; a few values each show it.
    let share = if in_full("15 in 16 corruptions of each word that something is found by") { 1 } else { 16 };
    let mut led_astray = 0;
    for (name, scene) in scenes::all() {
        let corruptions = corruptions(&scene);
        led_astray += places(&scene)
            .into_par_iter()
            .enumerate()
            .map(|(index, (place, judged))| {
                let one_in = if judged { share } else { 8 * share.min(8) };
                assert!(one_in <= corruptions.len(), "each word meets one");
                let tried = corruptions.iter().enumerate().filter(|(number, _)| (number + index) % one_in == 0);
                let is_led_astray = |(number, corruption): (usize, &Corruption)| {
                    let mut changed = scene.clone();
                    change(&mut changed, place, corruption);
                    assert_safe(&changed, &|| format!("{name}, {place:?}, corruption {number}"));
                    judged && kernel::follow(&changed).is_err()
                };
                tried.map(is_led_astray).filter(|astray| *astray).count()
            })
            .sum::<usize>();
    }
    // The control: followed without the checks, thousands of them would have read out of bounds or never ended.
    assert!(led_astray > 5_000 / share, "{led_astray} corruptions lead a kernel astray");
}

#[test]
fn listed_words_are_refused_and_others_are_not() {
    let mut counts = [0; 2];
    let everywhere = in_full("numbers that are none or huge in seven of eight words");
    for (name, scene) in scenes::all() {
        for (index, (place, judged)) in places(&scene).into_iter().enumerate() {
            counts[usize::from(judged)] += 1;
            let values = [BEYOND, f32::NAN.to_bits(), f32::MAX.to_bits()];
            for value in values.into_iter().take(if everywhere || index % 8 == 0 { 3 } else { 1 }) {
                let mut changed = scene.clone();
                change(&mut changed, place, |_| value);
                let refused = changed.validate().is_err();
                assert!(refused || !judged || value != BEYOND, "{name}: {place:?} passes as {value:#x}");
                assert!(judged || !refused, "{name}: {place:?} is free, and refused as {value:#x}");
            }
        }
    }
    assert!(counts.into_iter().all(|count| count > 500), "{counts:?} words are free and judged");
}

/// Several words at once: a run that is moved and made longer, a kind that is changed along with its texture.
#[test]
fn no_corrupted_words_together_lead_a_kernel_out_of_bounds() {
    for (name, scene) in scenes::all() {
        let judged: Vec<PackedWord> = places(&scene).into_iter().filter(|(_, judged)| *judged).map(|(place, _)| place).collect();
        let corruptions = corruptions(&scene);
        let mut random = 1;
        let mut draw = |count: usize| {
            random = mix(random + 1);
            random as usize % count
        };
        let mut passed = 0;
        for number in 0..2_000 {
            let mut changed = scene.clone();
            for _ in 0..2 + draw(2) {
                let place = judged[draw(judged.len())];
                change(&mut changed, place, &corruptions[draw(corruptions.len())]);
            }
            assert_safe(&changed, &|| format!("{name}, case {number}"));
            passed += u32::from(changed.validate().is_ok());
        }
        assert!(passed < 200, "{name}: {passed} of 2000 corrupted scenes pass");
    }
}

fn cut_last<T>(array: &mut Vec<T>) {
    array.pop();
}

#[test]
fn arrays_cut_short_are_refused_where_something_names_their_end() {
    let cuts: [fn(&mut PackedScene); 16] = [
        |scene| scene.primitives.truncate(1),
        |scene| cut_last(&mut scene.attributes),
        |scene| cut_last(&mut scene.hierarchy.nodes),
        |scene| cut_last(&mut scene.hierarchy.boxes),
        |scene| cut_last(&mut scene.hierarchy.roots),
        |scene| cut_last(&mut scene.instances),
        |scene| cut_last(&mut scene.materials.materials),
        |scene| cut_last(&mut scene.materials.further),
        |scene| cut_last(&mut scene.materials.parts),
        |scene| cut_last(&mut scene.materials.weights),
        |scene| cut_last(&mut scene.lights),
        |scene| cut_last(&mut scene.light_nodes),
        |scene| cut_last(&mut scene.light_profiles),
        |scene| cut_last(&mut scene.textures.textures),
        |scene| cut_last(&mut scene.textures.words),
        |scene| cut_last(&mut scene.motions),
    ];
    let scenes = scenes::all();
    for (number, cut) in cuts.into_iter().enumerate() {
        let mut refused = 0;
        for (name, scene) in &scenes {
            let mut scene = scene.clone();
            cut(&mut scene);
            assert_safe(&scene, &|| format!("{name}, cut {number}"));
            refused += u32::from(scene.validate().is_err());
        }
        assert!(refused > 0, "cut {number}");
    }
}

/// Nine times the primitives take about nine times the time, three times as much allowed for whatever else the machine does.
#[test]
fn checks_take_time_in_proportion_to_the_scene() {
    let least = |side: u32| {
        let scene = scenes::grid(side);
        let time = || {
            let start = std::time::Instant::now();
            assert!(scene.validate().is_ok());
            start.elapsed().as_secs_f64()
        };
        (0..12).map(|_| time()).fold(f64::INFINITY, f64::min)
    };
    // A busy machine lengthens one measurement now and then, and quadratic work all of them.
    let too_long = || Some([60, 180].map(least)).filter(|[small, large]| *large >= 3.0 * 9.0 * small + 0.02);
    let seconds: Vec<_> = (0..4).map_while(|_| too_long()).collect();
    assert!(seconds.len() < 4, "for 7,200 and 64,800 triangles: {seconds:?}");
}
