//! Materials as numbers, and the form that gives their order: what two of them have to share for one to turn into the other.

use super::numbers::{Numbers, each};
use super::{Emission, Material};

impl Material {
    /// Its numbers. Those of two materials of one form stand for the same.
    pub fn numbers(&self) -> Vec<f64> {
        let mut found = Vec::new();
        self.clone().each_number(&mut |number| found.push(*number));
        found
    }

    /// The material with other numbers, in the same order; those that are missing stay.
    pub fn with_numbers(&self, numbers: &[f64]) -> Self {
        let mut changed = self.clone();
        let mut next = numbers.iter();
        changed.each_number(&mut |number| *number = next.next().copied().unwrap_or(*number));
        changed
    }

    /// Both are the same but for their names and numbers.
    pub fn has_form_of(&self, other: &Self) -> bool {
        let form = |material: &Self| {
            let mut form = Self { name: String::new(), ..material.clone() };
            form.each_number(&mut |number| *number = 0.0);
            format!("{form:?}")
        };
        form(self) == form(other)
    }

    /// Both scatter and emit alike, at every place of a surface.
    pub fn looks_like(&self, other: &Self) -> bool {
        self.numbers() == other.numbers() && self.has_form_of(other)
    }

    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        each!(visit: self.kind, self.emission);
    }
}

impl Numbers for Emission {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.radiance.each_number(visit);
    }
}
