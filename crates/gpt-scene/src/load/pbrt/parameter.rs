//! Parameters: a type and a name in quotes, and values.

use std::cell::Cell;
use std::rc::Rc;

use glam::DVec3;

use super::color_space::RgbSpace;
use super::lexer::{Lexeme, Lexer, Token};
use super::text::Spot;
use crate::load::error::SceneError;

/// The type of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Flag,
    Integer,
    Float,
    Point2,
    Point3,
    Normal,
    Text,
    Texture,
    Rgb,
    Spectrum,
    BlackBody,
}

/// The names of types; `point`, `vector` and `color` are those of versions before 4, which mean the same.
const KINDS: [(&str, Kind); 15] = [
    ("bool", Kind::Flag),
    ("integer", Kind::Integer),
    ("float", Kind::Float),
    ("point2", Kind::Point2),
    ("vector2", Kind::Point2),
    ("point3", Kind::Point3),
    ("point", Kind::Point3),
    ("vector3", Kind::Point3),
    ("vector", Kind::Point3),
    ("normal", Kind::Normal),
    ("string", Kind::Text),
    ("texture", Kind::Texture),
    ("rgb", Kind::Rgb),
    ("spectrum", Kind::Spectrum),
    ("blackbody", Kind::BlackBody),
];
/// A type of versions before 4.
const COLOR: &str = "color";

/// The values of a parameter.
#[derive(Debug)]
pub enum Values {
    Numbers(Vec<f64>),
    Texts(Vec<String>),
    Flags(Vec<bool>),
}

#[derive(Debug)]
pub struct Parameter {
    pub kind: Kind,
    pub name: String,
    pub values: Values,
    pub spot: Spot,
    /// The colour space of its `rgb`.
    pub space: RgbSpace,
    /// Something asked for it, so that it has an effect.
    pub used: Cell<bool>,
}

impl Parameter {
    pub fn numbers(&self) -> &[f64] {
        if let Values::Numbers(numbers) = &self.values { numbers } else { &[] }
    }

    pub fn texts(&self) -> &[String] {
        if let Values::Texts(texts) = &self.values { texts } else { &[] }
    }

    fn count(&self) -> usize {
        match &self.values {
            Values::Numbers(numbers) => numbers.len(),
            Values::Texts(texts) => texts.len(),
            Values::Flags(flags) => flags.len(),
        }
    }
}

/// Reads the parameters that follow a directive, as far as there are some.
///
/// # Errors
/// A parameter without type, name or values, or with values of another type.
pub fn read_parameters(lexer: &mut Lexer, space: RgbSpace) -> Result<Vec<Rc<Parameter>>, SceneError> {
    let mut parameters = Vec::new();
    while let Some(lexeme) = lexer.peek()?.filter(|lexeme| lexeme.token == Token::Quoted) {
        lexer.next()?;
        parameters.push(Rc::new(read_parameter(lexer, lexeme, space)?));
    }
    Ok(parameters)
}

fn read_parameter(lexer: &mut Lexer, declaration: Lexeme, space: RgbSpace) -> Result<Parameter, SceneError> {
    let spot = lexer.spot(declaration);
    let text = lexer.text(declaration)?;
    let mut words = text.split_ascii_whitespace();
    let (Some(kind), Some(name), None) = (words.next(), words.next(), words.next()) else {
        return Err(spot.error(format!("a parameter is its type and its name, as \"float radius\", and not \"{text}\"")));
    };
    let known = KINDS.iter().find(|(known, _)| *known == kind).map(|(_, kind)| *kind);
    let kind = known.or((kind == COLOR).then_some(Kind::Rgb)).ok_or_else(|| {
        let names: Vec<&str> = KINDS.iter().map(|(name, _)| *name).collect();
        spot.error(format!("`{kind}` is no type of parameters")).with_help(format!("there are {}", names.join(", ")))
    })?;
    let values = read_values(lexer, kind, name)?;
    let parameter = Parameter { kind, name: name.to_owned(), values, spot, space, used: Cell::new(false) };
    if parameter.count() == 0 {
        return Err(parameter.spot.error(format!("`{name}` has no values")));
    }
    Ok(parameter)
}

fn read_values(lexer: &mut Lexer, kind: Kind, name: &str) -> Result<Values, SceneError> {
    let ends = |lexer: &Lexer| lexer.here().error(format!("the file ends where values of `{name}` should be"));
    let first = lexer.next()?.ok_or_else(|| ends(lexer))?;
    let is_list = first.token == Token::Open;
    let mut values = match kind {
        Kind::Flag => Values::Flags(Vec::new()),
        Kind::Text | Kind::Texture => Values::Texts(Vec::new()),
        _ => Values::Numbers(Vec::new()),
    };
    let mut next = if is_list { lexer.next()?.ok_or_else(|| ends(lexer))? } else { first };
    loop {
        if is_list && next.token == Token::Close {
            return Ok(values);
        }
        let wrong = |expected: &str| {
            let found = lexer.word(next);
            lexer.spot(next).error(format!("`{name}` expects {expected}, and this is {found}"))
        };
        match (&mut values, next.token) {
            (Values::Numbers(numbers), Token::Word) => {
                let number = number(lexer.word(next)).ok_or_else(|| wrong("numbers"))?;
                if kind == Kind::Integer && number.fract() != 0.0 {
                    return Err(wrong("whole numbers"));
                }
                numbers.push(number);
            }
            // A spectrum may have a name.
            (Values::Numbers(numbers), Token::Quoted) if kind == Kind::Spectrum && numbers.is_empty() => {
                values = Values::Texts(vec![lexer.text(next)?]);
            }
            (Values::Texts(texts), Token::Quoted) => texts.push(lexer.text(next)?),
            // Versions before 4 wrote them in quotes.
            (Values::Flags(flags), Token::Word | Token::Quoted) => match lexer.word(next).trim_matches('"') {
                "true" => flags.push(true),
                "false" => flags.push(false),
                _ => return Err(wrong("true or false")),
            },
            (Values::Numbers(_), _) => return Err(wrong("numbers")),
            (Values::Texts(_), _) => return Err(wrong("texts in quotes")),
            (Values::Flags(_), _) => return Err(wrong("true or false")),
        }
        if !is_list {
            return Ok(values);
        }
        next = lexer.next()?.ok_or_else(|| ends(lexer))?;
    }
}

/// A finite number as pbrt writes it, decimal or hexadecimal.
pub fn number(word: &str) -> Option<f64> {
    let is_numeral = word.starts_with(|first: char| first.is_ascii_digit() || matches!(first, '+' | '-' | '.'));
    let value = crate::load::spelling::numbers::number::<f64>(word).filter(|_| is_numeral)?;
    Some(value.value)
}

/// The content of a directive: its type, as `sphere`, and its parameters.
#[derive(Debug)]
pub struct Entity {
    /// The directive, as `Shape`.
    pub directive: &'static str,
    pub name: String,
    pub spot: Spot,
    /// Its own parameters, then those of the attributes around it, each in the order of the file.
    own: Vec<Rc<Parameter>>,
    around: Vec<Rc<Parameter>>,
    /// The colour space around it.
    pub space: RgbSpace,
}

impl Entity {
    pub fn new(
        directive: &'static str,
        name: String,
        spot: Spot,
        own: Vec<Rc<Parameter>>,
        around: Vec<Rc<Parameter>>,
        space: RgbSpace,
    ) -> Self {
        Self { directive, name, spot, own, around, space }
    }

    /// A copy of the directive with another type.
    pub fn of_type(self, name: String) -> Self {
        Self { name, ..self }
    }

    /// How reports call it: `Shape \`sphere\``.
    pub fn title(&self) -> String {
        format!("{} `{}`", self.directive, self.name)
    }

    pub fn error(&self, message: impl Into<String>) -> SceneError {
        self.spot.error(message)
    }

    /// A value of an entry, or the error about one that is not possible.
    pub fn possible<T>(&self, made: Result<T, String>) -> Result<T, SceneError> {
        made.map_err(|message| self.error(format!("{}: {message}", self.title())))
    }

    /// The parameter of this name and of one of these types that counts: the last one, its own before those around.
    pub fn find(&self, name: &str, kinds: &[Kind]) -> Option<&Rc<Parameter>> {
        let fits = |parameter: &&Rc<Parameter>| parameter.name == name && kinds.contains(&parameter.kind);
        let found = self.own.iter().rev().chain(self.around.iter().rev()).find(fits)?;
        // Parameters that it hides have no effect either, and are no mistakes.
        self.own.iter().filter(|other| other.name == name && other.kind == found.kind).for_each(|other| other.used.set(true));
        found.used.set(true);
        Some(found)
    }

    /// The only value, as numbers; so many of them.
    fn numbers_of(&self, name: &str, kinds: &[Kind], each: usize) -> Result<Option<&[f64]>, SceneError> {
        let Some(parameter) = self.find(name, kinds) else { return Ok(None) };
        let numbers = parameter.numbers();
        if numbers.len() != each {
            let count = numbers.len();
            return Err(parameter.spot.error(format!("`{name}` has {count} numbers where it should have {each}")));
        }
        Ok(Some(numbers))
    }

    pub fn float(&self, name: &str) -> Result<Option<f64>, SceneError> {
        Ok(self.numbers_of(name, &[Kind::Float, Kind::Integer], 1)?.map(|numbers| numbers[0]))
    }

    pub fn float_or(&self, name: &str, default: f64) -> Result<f64, SceneError> {
        Ok(self.float(name)?.unwrap_or(default))
    }

    pub fn integer(&self, name: &str) -> Result<Option<i64>, SceneError> {
        Ok(self.numbers_of(name, &[Kind::Integer], 1)?.map(|numbers| numbers[0] as i64))
    }

    pub fn integer_or(&self, name: &str, default: i64) -> Result<i64, SceneError> {
        Ok(self.integer(name)?.unwrap_or(default))
    }

    pub fn point_or(&self, name: &str, default: DVec3) -> Result<DVec3, SceneError> {
        Ok(self.numbers_of(name, &[Kind::Point3], 3)?.map_or(default, DVec3::from_slice))
    }

    pub fn flag_or(&self, name: &str, default: bool) -> Result<bool, SceneError> {
        let Some(parameter) = self.find(name, &[Kind::Flag]) else { return Ok(default) };
        match &parameter.values {
            Values::Flags(flags) if flags.len() == 1 => Ok(flags[0]),
            _ => Err(parameter.spot.error(format!("`{name}` is true or false, once"))),
        }
    }

    pub fn text(&self, name: &str) -> Result<Option<&str>, SceneError> {
        self.text_of(name, Kind::Text)
    }

    /// The name of a texture.
    pub fn texture(&self, name: &str) -> Result<Option<&str>, SceneError> {
        self.text_of(name, Kind::Texture)
    }

    fn text_of(&self, name: &str, kind: Kind) -> Result<Option<&str>, SceneError> {
        let Some(parameter) = self.find(name, &[kind]) else { return Ok(None) };
        match parameter.texts() {
            [text] => Ok(Some(text)),
            many => Err(parameter.spot.error(format!("`{name}` has {} texts where it should have one", many.len()))),
        }
    }

    /// All values of a list, whose count is a multiple of `each`; none where it is not written.
    pub fn list(&self, name: &str, kind: Kind, each: usize) -> Result<&[f64], SceneError> {
        let Some(parameter) = self.find(name, &[kind]) else { return Ok(&[]) };
        let numbers = parameter.numbers();
        if !numbers.len().is_multiple_of(each) {
            return Err(parameter.spot.error(format!("`{name}` has {} numbers, which is no multiple of {each}", numbers.len())));
        }
        Ok(numbers)
    }

    /// The place of a parameter, or of all where it is not written.
    pub fn spot_of(&self, name: &str) -> &Spot {
        self.own.iter().chain(&self.around).rev().find(|parameter| parameter.name == name).map_or(&self.spot, |one| &one.spot)
    }

    /// True where a parameter of this name is written, of whatever type.
    pub fn has(&self, name: &str) -> bool {
        self.own.iter().chain(&self.around).any(|parameter| parameter.name == name)
    }

    /// Marks parameters that change nothing that is rendered here.
    pub fn without_effect(&self, names: &[&str]) {
        self.own.iter().filter(|parameter| names.contains(&parameter.name.as_str())).for_each(|one| one.used.set(true));
    }

    /// Marks all of them: the whole directive is reported.
    pub fn all_without_effect(&self) {
        self.own.iter().for_each(|parameter| parameter.used.set(true));
    }

    /// Its own parameters for which nothing asked.
    pub fn unused(&self) -> impl Iterator<Item = &Rc<Parameter>> {
        self.own.iter().filter(|parameter| !parameter.used.get())
    }
}

#[cfg(test)]
mod tests {
    use super::super::text::SourceText;
    use super::*;

    fn entity(text: &str) -> Result<Entity, SceneError> {
        let source = Rc::new(SourceText { name: "a.pbrt".to_owned(), text: text.to_owned() });
        let mut lexer = Lexer::new(source);
        let spot = lexer.here();
        let own = read_parameters(&mut lexer, RgbSpace::Srgb)?;
        Ok(Entity::new("Shape", "sphere".to_owned(), spot, own, Vec::new(), RgbSpace::Srgb))
    }

    #[test]
    fn values_stand_alone_or_in_brackets() {
        let shape =
            entity("\"float radius\" 2 \"bool a\" true \"bool b\" [ \"false\" ] \"string  file\" [\"x y\"] \"point P\" [1 2 3]")
                .unwrap();
        assert_eq!((shape.float("radius").unwrap(), shape.flag_or("a", false).unwrap()), (Some(2.0), true));
        assert_eq!((shape.flag_or("b", true).unwrap(), shape.text("file").unwrap()), (false, Some("x y")));
        assert_eq!(shape.point_or("P", DVec3::ZERO).unwrap(), DVec3::new(1.0, 2.0, 3.0));
        assert_eq!((shape.float("zmin").unwrap(), shape.unused().count()), (None, 0));
    }

    #[test]
    fn the_last_of_a_name_counts_and_the_type_has_to_fit() {
        let shape = entity("\"float radius\" 1 \"float radius\" 3 \"string zmin\" \"a\"").unwrap();
        assert_eq!((shape.float("radius").unwrap(), shape.float("zmin").unwrap()), (Some(3.0), None));
        assert_eq!(shape.unused().map(|one| one.name.as_str()).collect::<Vec<_>>(), ["zmin"]);
    }

    #[test]
    fn mistakes_are_shown_where_they_are() {
        for (text, words, column) in [
            ("\"radius\" 1", "its type and its name", 1),
            ("\"flaot radius\" 1", "no type", 1),
            ("\"float radius\" [ 1 x ]", "expects numbers", 20),
            ("\"integer n\" 1.5", "whole numbers", 13),
            ("\"float radius\" [ 1", "the file ends", 19),
            ("\"float radius\" [ ]", "no values", 1),
            ("\"string s\" 1", "texts in quotes", 12),
            ("\"bool b\" 1", "true or false", 10),
            ("\"float r\" nan", "expects numbers", 11),
        ] {
            let error = entity(text).expect_err(text);
            assert!(error.message().contains(words), "{text}: {error}");
            assert_eq!((error.line(), error.column()), (Some(1), Some(column)), "{text}");
        }
        let error = entity("\"float radius\" [1 2]").unwrap().float("radius").unwrap_err();
        assert!(error.message().contains("2 numbers where it should have 1"), "{error}");
    }
}
