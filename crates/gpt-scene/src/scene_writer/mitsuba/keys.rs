//! Tables of a scene file, and which of their keys were looked at.

use std::cell::RefCell;
use std::collections::BTreeSet;

use crate::spectrum::Spectrum;
use glam::{DAffine3, DVec3};
use toml::{Table, Value};

/// Values that are looked up by keys.
pub trait Lookup {
    fn look_up(&self, key: &str) -> Option<&Value>;
}

impl Lookup for Table {
    fn look_up(&self, key: &str) -> Option<&Value> {
        self.get(key)
    }
}

/// A table that notes the keys that are asked for. What is left at the end has no effect, and is reported.
pub struct Keys<'t> {
    table: &'t Table,
    asked: RefCell<BTreeSet<String>>,
}

impl Lookup for Keys<'_> {
    fn look_up(&self, key: &str) -> Option<&Value> {
        self.get(key)
    }
}

impl<'t> Keys<'t> {
    pub fn of(table: &'t Table) -> Self {
        Self { table, asked: RefCell::default() }
    }

    pub fn get(&self, key: &str) -> Option<&'t Value> {
        self.asked.borrow_mut().insert(key.to_owned());
        self.table.get(key)
    }

    pub fn contains_key(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    /// The keys that nothing asked for.
    pub fn rest(&self) -> Vec<&'t str> {
        let asked = self.asked.borrow();
        self.table.keys().map(String::as_str).filter(|key| !asked.contains(*key)).collect()
    }
}

/// The tables of a list.
pub fn entries<'t>(scene: &'t Table, key: &str) -> Vec<&'t Table> {
    let list = scene.get(key).and_then(Value::as_array);
    list.map(|list| list.iter().filter_map(Value::as_table).collect()).unwrap_or_default()
}

pub fn table<'t>(table: &'t impl Lookup, key: &str) -> Option<&'t Table> {
    table.look_up(key)?.as_table()
}

pub fn text<'t>(table: &'t impl Lookup, key: &str) -> Option<&'t str> {
    table.look_up(key)?.as_str()
}

pub fn flag(table: &impl Lookup, key: &str) -> Option<bool> {
    table.look_up(key)?.as_bool()
}

pub fn integer(table: &impl Lookup, key: &str) -> Option<i64> {
    table.look_up(key)?.as_integer()
}

pub fn as_number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|number| number as f64))
}

pub fn number(table: &impl Lookup, key: &str) -> Option<f64> {
    as_number(table.look_up(key)?)
}

pub fn numbers(table: &impl Lookup, key: &str) -> Option<Vec<f64>> {
    table.look_up(key)?.as_array()?.iter().map(as_number).collect()
}

pub fn vector(table: &impl Lookup, key: &str) -> Option<DVec3> {
    let numbers: [f64; 3] = numbers(table, key)?.try_into().ok()?;
    Some(DVec3::from_array(numbers))
}

/// Three numbers or one for grey; black where nothing is written.
pub fn colour(table: &impl Lookup, key: &str) -> Spectrum {
    let rgb = numbers(table, key).and_then(|numbers| numbers.try_into().ok()).map(Spectrum::from_rgb);
    rgb.or(number(table, key).map(Spectrum::grey)).unwrap_or_default()
}

/// The map of a transform: steps, or one of them.
pub fn transform(written: &Value) -> DAffine3 {
    match written {
        Value::Array(steps) => steps.iter().fold(DAffine3::IDENTITY, |so_far, written| step(written) * so_far),
        single => step(single),
    }
}

fn step(written: &Value) -> DAffine3 {
    let Some(step) = written.as_table() else { return DAffine3::IDENTITY };
    if let Some(scale) = vector(step, "scale").or(number(step, "scale").map(DVec3::splat)) {
        return DAffine3::from_scale(scale);
    }
    if let (Some(axis), Some(degrees)) = (vector(step, "rotate"), number(step, "degrees")) {
        return DAffine3::from_axis_angle(axis.normalize_or(DVec3::Y), degrees.to_radians());
    }
    if let Some(offset) = vector(step, "translate") {
        return DAffine3::from_translation(offset);
    }
    let rows: Option<[f64; 16]> = numbers(step, "matrix").and_then(|rows| rows.try_into().ok());
    rows.map_or(DAffine3::IDENTITY, |rows| DAffine3::from_mat4(glam::DMat4::from_cols_array(&rows).transpose()))
}
