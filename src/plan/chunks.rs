//! Arrays too large for one binding, cut into chunks.
//!
//! A device may have memory for an array and yet bind no more than a part of it at once. Such an array becomes several buffers of whole
//! records, and its loads ask in which of them a record lies. Arrays that fit one binding are read as ever.

use std::fmt::{self, Write as _};

use super::bindings::Binding;
use super::error::PlanError;
use super::limits::DeviceLimits;
use super::memory::{self, megabytes};
use crate::packed::PackedScene;
use crate::packed::bvh4::NODE_RECORD_WORDS;
use crate::packed::instance::INSTANCE_RECORD_WORDS;
use crate::packed::primitive::{ATTRIBUTE_RECORD_WORDS, PRIMITIVE_RECORD_WORDS};

/// Chunks of an array at most: binding numbers stay below 1,000, which WebGPU allows.
const MAX_CHUNKS: u32 = 100;
/// Storage buffers that a stage may bind besides the scene's: of paths, queues, film, statistics.
const OTHER_BUFFERS: u32 = 4;

/// Names by which shaders know an array of records (`shaders/geometry/records.wgsl`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RecordArray {
    /// For people.
    pub label: &'static str,
    pub name: &'static str,
    /// A record: its fields are `w0`, `w1`, …
    pub words_type: &'static str,
    pub word: &'static str,
    /// Words of a record, of 16 bytes each.
    pub words: u32,
    /// The function that loads a record.
    pub load: &'static str,
    /// The function that loads one word of a record.
    pub load_word: &'static str,
    /// Binding of the first chunk.
    pub binding: u32,
    pub switch: &'static str,
    /// Generated where the array is cut.
    pub file: &'static str,
}

pub const PRIMITIVES: RecordArray = RecordArray {
    label: memory::PRIMITIVES,
    name: "primitives",
    words_type: "PrimitiveWords",
    word: "vec4<f32>",
    words: PRIMITIVE_RECORD_WORDS,
    load: "primitive_words",
    load_word: "primitive_word",
    binding: Binding::Primitives as u32,
    switch: "PRIMITIVE_CHUNKS",
    file: "geometry/primitive_chunks.wgsl",
};

pub const NODES: RecordArray = RecordArray {
    label: memory::NODES,
    name: "nodes",
    words_type: "NodeWords",
    word: "vec4<u32>",
    words: NODE_RECORD_WORDS,
    load: "node_words",
    load_word: "node_word",
    binding: Binding::Nodes as u32,
    switch: "NODE_CHUNKS",
    file: "geometry/node_chunks.wgsl",
};

pub const ATTRIBUTES: RecordArray = RecordArray {
    label: memory::ATTRIBUTES,
    name: "attributes",
    words_type: "AttributeWords",
    word: "vec4<f32>",
    words: ATTRIBUTE_RECORD_WORDS,
    load: "attribute_words",
    load_word: "attribute_word",
    binding: Binding::Attributes as u32,
    switch: "ATTRIBUTE_CHUNKS",
    file: "geometry/attribute_chunks.wgsl",
};

pub const INSTANCES: RecordArray = RecordArray {
    label: memory::INSTANCES,
    name: "instances",
    words_type: "InstanceWords",
    word: "vec4<f32>",
    words: INSTANCE_RECORD_WORDS,
    load: "instance_words",
    load_word: "instance_word",
    binding: Binding::Instances as u32,
    switch: "INSTANCE_CHUNKS",
    file: "geometry/instance_chunks.wgsl",
};

/// Texels of images and maps, whose records are single numbers of 32 bits.
pub const TEXELS: RecordArray = RecordArray {
    label: memory::TEXELS,
    name: "texels",
    words_type: "",
    word: "u32",
    words: 1,
    load: "",
    load_word: "texel_word",
    binding: Binding::Texels as u32,
    switch: "TEXEL_CHUNKS",
    file: "geometry/texel_chunks.wgsl",
};

/// How an array is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Chunks {
    pub array: RecordArray,
    /// Bytes of the whole array.
    pub bytes: u64,
    /// Bytes of every chunk but the last, which has the rest: a whole number of records.
    pub chunk_bytes: u64,
    pub count: u32,
}

impl Chunks {
    /// Cuts an array so that no chunk is larger than `limit` bytes, which hold at least one record.
    pub fn new(array: RecordArray, bytes: u64, limit: u64) -> Self {
        let record_bytes = array.record_bytes();
        let chunk_bytes = (limit / record_bytes).max(1) * record_bytes;
        let count = bytes.div_ceil(chunk_bytes).max(1).min(u64::from(u32::MAX)) as u32;
        Self { array, bytes, chunk_bytes, count }
    }

    /// One binding holds everything.
    pub fn is_whole(&self) -> bool {
        self.count == 1
    }

    /// Binding numbers, each with the bytes of the array that stand there.
    pub fn bindings(&self) -> impl Iterator<Item = (u32, std::ops::Range<usize>)> + use<> {
        let Self { array, bytes, chunk_bytes, count } = *self;
        (0..count).map(move |chunk| {
            let first = u64::from(chunk) * chunk_bytes;
            (array.chunk_binding(chunk), first as usize..bytes.min(first + chunk_bytes) as usize)
        })
    }

    /// WGSL with the chunks' bindings and the functions that load a record, or one of its words, from whichever has it.
    pub fn wgsl(&self) -> String {
        let RecordArray { name, words_type, word, words, load, load_word, .. } = self.array;
        if self.array.is_of_numbers() {
            return self.wgsl_of_numbers();
        }
        let records = (self.chunk_bytes / self.array.record_bytes()) as u32;
        let mut text = String::new();
        let (mut body, mut word_body) = (String::new(), String::new());
        for chunk in 0..self.count {
            let number = self.array.chunk_binding(chunk);
            let _ = writeln!(text, "@group(0) @binding({number}) var<storage, read> {name}_{chunk}: array<{word}>;");
            let first_record = chunk * records;
            let condition =
                if chunk + 1 == self.count { String::new() } else { format!("if index < {}u ", first_record + records) };
            let fields: Vec<String> = (0..words).map(|word| format!("{name}_{chunk}[first + {word}u]")).collect();
            let before = if chunk == 0 { "" } else { " else " };
            let first =
                format!("{before}{condition}{{\n        let first = (index - {first_record}u) * {words}u;\n        found = ");
            let _ = write!(body, "{first}{words_type}({});\n    }}", fields.join(", "));
            let _ = write!(word_body, "{first}{name}_{chunk}[first + word];\n    }}");
        }
        format!(
            "#import geometry/words.wgsl\n\n{text}\nfn {load}(index: u32) -> {words_type} {{\n    var found: {words_type};\n    {body}\n    return found;\n}}\n\n\
             fn {load_word}(index: u32, word: u32) -> {word} {{\n    var found: {word};\n    {word_body}\n    return found;\n}}\n"
        )
    }
}

impl Chunks {
    /// Variant of `wgsl` for records that are single numbers.
    fn wgsl_of_numbers(&self) -> String {
        let RecordArray { name, word, load_word, .. } = self.array;
        let records = self.chunk_bytes / self.array.record_bytes();
        let (mut text, mut body) = (String::new(), String::new());
        for chunk in 0..self.count {
            let number = self.array.chunk_binding(chunk);
            let _ = writeln!(text, "@group(0) @binding({number}) var<storage, read> {name}_{chunk}: array<{word}>;");
            let first = u64::from(chunk) * records;
            if chunk + 1 < self.count {
                let _ = writeln!(
                    body,
                    "    if index < {}u {{\n        return {name}_{chunk}[index - {first}u];\n    }}",
                    first + records
                );
            } else {
                let _ = writeln!(body, "    return {name}_{chunk}[index - {first}u];");
            }
        }
        format!("{text}\nfn {load_word}(index: u32) -> {word} {{\n{body}}}\n")
    }
}

impl fmt::Display for Chunks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} in {} of at most {}", self.array.label, self.count, megabytes(self.chunk_bytes))
    }
}

impl RecordArray {
    pub fn record_bytes(&self) -> u64 {
        let word = if self.is_of_numbers() { 4 } else { 16 };
        word * u64::from(self.words)
    }

    /// Its words are single numbers and not four of them.
    fn is_of_numbers(&self) -> bool {
        self.word == "u32"
    }

    /// The first chunk stands where the whole array would; the others in a range that no other array has: the bindings of arrays differ in their
    /// last digit.
    fn chunk_binding(&self, chunk: u32) -> u32 {
        if chunk == 0 { self.binding } else { MAX_CHUNKS * (self.binding % 10) + chunk }
    }
}

/// The arrays that stand in storage buffers and may be cut, in chunks of at most `limit` bytes: those of primitives and of the hierarchy's nodes
/// where they do, of attributes and instances where there are any, and of texels.
pub fn cut(packed: &PackedScene, stored_primitives: bool, stored_nodes: bool, limit: u64) -> Vec<Chunks> {
    let mut arrays = Vec::new();
    if stored_primitives {
        arrays.push(Chunks::new(PRIMITIVES, size_of_val(&packed.primitives[..]) as u64, limit));
    }
    if stored_nodes {
        arrays.push(Chunks::new(NODES, size_of_val(&packed.hierarchy.nodes[..]) as u64, limit));
    }
    if packed.has_attributes() {
        arrays.push(Chunks::new(ATTRIBUTES, size_of_val(&packed.attributes[..]) as u64, limit));
    }
    if !packed.instances.is_empty() {
        arrays.push(Chunks::new(INSTANCES, size_of_val(&packed.instances[..]) as u64, limit));
    }
    if packed.textures.texel_words() > 0 {
        arrays.push(Chunks::new(TEXELS, packed.textures.texel_bytes(), limit));
    }
    arrays
}

/// Refuses what cannot be bound even in chunks of at most `limit` bytes. `others` counts the scene's further storage buffers, with those of a guide
/// and of cells of lights, where they were `learned`.
///
/// # Errors
/// [`PlanError::DoesNotFit`] naming the largest array that is cut, where a stage would need more buffers than the device allows.
pub fn check(
    arrays: &[Chunks],
    others: u32,
    [guided, in_cells]: [bool; 2],
    limit: u64,
    limits: &DeviceLimits,
) -> Result<(), PlanError> {
    let needed = arrays.iter().fold(others + OTHER_BUFFERS, |sum, array| sum.saturating_add(array.count));
    let has_instances = arrays.iter().any(|array| array.array == INSTANCES);
    if (has_instances || guided || in_cells) && needed > limits.max_storage_buffers && arrays.iter().all(Chunks::is_whole) {
        let what = match [guided, in_cells] {
            [true, _] => "a guide (`guiding`)",
            [false, true] => "lights in cells (`light_choice`)",
            [false, false] => "its instances",
        };
        return Err(PlanError::DoesNotFit(format!(
            "with {what} a stage would need up to {needed} storage buffers, and can have {}",
            limits.max_storage_buffers
        )));
    }
    let cut = arrays.iter().filter(|array| !array.is_whole());
    match cut.max_by_key(|array| array.bytes) {
        Some(array) if needed > limits.max_storage_buffers || array.count > MAX_CHUNKS => Err(PlanError::DoesNotFit(format!(
            "its {} need {}, and the device can bind {} at once; in chunks of that size a stage would need up to {needed} buffers, and can have {}",
            array.array.label,
            megabytes(array.bytes),
            megabytes(limit),
            limits.max_storage_buffers.min(MAX_CHUNKS),
        ))),
        _ => Ok(()),
    }
}
