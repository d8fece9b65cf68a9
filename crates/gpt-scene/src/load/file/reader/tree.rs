//! Serde's reader of the tree: of a value, of the keys of a table, the values of a list, and the kind of an enum.

use std::ops::Range;

use serde::de::value::StrDeserializer;
use serde::de::{
    Deserialize, DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error, Expected, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::located::LOCATED;
use super::mistake::Mistake;

/// Begins the name for serde of an enum whose kind is said by a key of its table: `#[serde(rename = "key:type")]`.
const TAG: &str = "key:";

/// A value of the tree.
pub type Node<'t> = Spanned<DeValue<'t>>;

/// Reads the whole tree.
pub fn read<'t, T: Deserialize<'t>>(root: &'t Node<'t>) -> Result<T, Mistake> {
    T::deserialize(Reader { node: root, view: View::default() })
}

/// All mistakes in the tree, in the order of the text. A key that is missing is one of them where its table has no others: a misspelt
/// key is missing as well.
pub fn mistakes<T: DeserializeOwned>(root: &Node<'_>) -> Vec<Mistake> {
    let mut search = Search { root, path: Vec::new(), around: Vec::new(), found: Vec::new() };
    search.collect::<T>(root);
    search.found.sort_by_key(|mistake| mistake.span.as_ref().map(|span| span.start));
    search.found
}

/// A search for all mistakes. Serde reports the first one that it meets, so each value that is refused is read again part by part.
struct Search<'t> {
    root: &'t Node<'t>,
    path: Vec<Step<'t>>,
    /// The bytes of the values that the path leads through.
    around: Vec<Range<usize>>,
    found: Vec<Mistake>,
}

impl<'t> Search<'t> {
    /// Finds the mistakes of the value at the end of the path.
    fn collect<T: DeserializeOwned>(&mut self, node: &'t Node<'t>) {
        let view = View { path: &self.path, without: None };
        let Err(mistake) = T::deserialize(Reader { node: self.root, view }) else { return };
        // A table of which one key is read lacks the others.
        if mistake.span.as_ref().is_some_and(|span| self.around.contains(span)) {
            return;
        }
        let earlier = self.found.len();
        self.around.push(node.span());
        match node.get_ref() {
            DeValue::Table(table) => {
                for (key, value) in table {
                    self.step::<T>(Step::Key(key.get_ref()), value);
                }
            }
            // Only tables stand in lists of any length whose entries are read alike.
            DeValue::Array(list) if list.iter().all(|entry| matches!(entry.get_ref(), DeValue::Table(_))) => {
                for (index, entry) in list.iter().enumerate() {
                    self.step::<T>(Step::Entry(index), entry);
                }
            }
            _ => {}
        }
        self.around.pop();
        if !self.found[earlier..].contains(&mistake) {
            self.found.push(mistake);
        }
    }

    fn step<T: DeserializeOwned>(&mut self, step: Step<'t>, node: &'t Node<'t>) {
        self.path.push(step);
        self.collect::<T>(node);
        self.path.pop();
    }
}

/// One step from a value into it.
#[derive(Clone, Copy)]
enum Step<'t> {
    Key(&'t str),
    Entry(usize),
}

/// How much of a value there is to be read.
#[derive(Clone, Copy, Default)]
struct View<'t> {
    /// The only part of the value that is read; the whole value where the path is empty.
    path: &'t [Step<'t>],
    /// A key of the table that was read already.
    without: Option<&'static str>,
}

impl View<'_> {
    /// The view of the part to which the path's first step leads.
    fn inner(self) -> Self {
        Self { path: self.path.get(1..).unwrap_or_default(), without: None }
    }
}

/// Reads one value.
#[derive(Clone, Copy)]
struct Reader<'t> {
    node: &'t Node<'t>,
    view: View<'t>,
}

impl<'t> Reader<'t> {
    /// Reads the value as `seed` does, which may find mistakes of its own in it.
    fn read<S: DeserializeSeed<'t>>(self, seed: S) -> Result<S::Value, Mistake> {
        seed.deserialize(self).map_err(|mistake| mistake.within(self.node.span()))
    }

    fn entries(self, table: &'t DeTable<'t>) -> Entries<'t> {
        let entries = match self.view.path.first() {
            Some(Step::Key(key)) => Source::One(table.get_key_value(*key)),
            _ => Source::All(table.iter()),
        };
        Entries { entries, without: self.view.without, value: None, view: self.view.inner() }
    }

    fn items(self, list: &'t [Node<'t>]) -> Items<'t> {
        let items = match self.view.path.first() {
            Some(Step::Entry(entry)) => &list[*entry..=*entry],
            _ => list,
        };
        Items { items: items.iter(), view: self.view.inner() }
    }

    fn number(self) -> Result<Number, Mistake> {
        match self.node.get_ref() {
            DeValue::Integer(digits) => {
                let (text, radix) = (digits.as_str(), digits.radix());
                let signed = i64::from_str_radix(text, radix).map(Number::Signed);
                signed
                    .or_else(|_| u64::from_str_radix(text, radix).map(Number::Unsigned))
                    .map_err(|_| Mistake::custom("the number is too large"))
            }
            DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
                Ok(value) if value.is_finite() || digits.as_str().contains("inf") || value.is_nan() => Ok(Number::Float(value)),
                _ => Err(Mistake::custom("the number is too large")),
            },
            _ => Ok(Number::None),
        }
    }

    /// The complaint about a value of another kind than `expected`.
    fn unexpected(self, expected: &dyn Expected) -> Mistake {
        let found = match self.node.get_ref() {
            DeValue::String(text) => Unexpected::Str(text),
            DeValue::Boolean(value) => Unexpected::Bool(*value),
            DeValue::Datetime(_) => Unexpected::Other("date"),
            DeValue::Array(_) => Unexpected::Seq,
            DeValue::Table(_) => Unexpected::Map,
            DeValue::Integer(_) | DeValue::Float(_) => match self.number() {
                Ok(Number::Signed(value)) => Unexpected::Signed(value),
                Ok(Number::Unsigned(value)) => Unexpected::Unsigned(value),
                Ok(Number::Float(value)) => Unexpected::Float(value),
                Ok(Number::None) | Err(_) => Unexpected::Other("number"),
            },
        };
        Mistake::invalid_type(found, expected).within(self.node.span())
    }

    /// The kind of an enum that is written here, and where its content is.
    fn choice(self, name: &'static str, kinds: &[&str]) -> Result<Choice<'t>, Mistake> {
        let span = self.node.span();
        if name == LOCATED {
            return Ok(Choice { kind: Kind::Span(span.clone()), span, content: Some(self) });
        }
        let found = self.node.get_ref();
        let Some(tag) = name.strip_prefix(TAG) else {
            return match found {
                DeValue::String(text) => Ok(Choice { kind: Kind::Name(text), span, content: None }),
                other => Err(Mistake::new(span, format!("expected a name in quotes, found {}", other.type_str()))),
            };
        };
        let DeValue::Table(table) = found else {
            return Err(Mistake::new(span, format!("expected a table with the key `{tag}`, found {}", found.type_str())));
        };
        let content = Some(Self { node: self.node, view: View { without: Some(tag), ..self.view } });
        match table.get(tag) {
            None => Err(Mistake::without_kind(tag, kinds).within(span)),
            Some(kind) => match kind.get_ref() {
                DeValue::String(text) => Ok(Choice { kind: Kind::Name(text), span: kind.span(), content }),
                other => Err(Mistake::new(kind.span(), format!("expected a name in quotes, found {}", other.type_str()))),
            },
        }
    }
}

/// A number as serde tells them apart; none where something else is written.
enum Number {
    Signed(i64),
    Unsigned(u64),
    Float(f64),
    None,
}

macro_rules! read_numbers {
    ($($method:ident)*) => {$(
        fn $method<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
            self.deserialize_f64(visitor)
        }
    )*};
}

macro_rules! read_anything {
    ($($method:ident)*) => {$(
        fn $method<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
            self.deserialize_any(visitor)
        }
    )*};
}

/// Each method asks for one kind of value alone, so that no more is compiled for each type than it can be made of.
impl<'t> Deserializer<'t> for Reader<'t> {
    type Error = Mistake;

    fn deserialize_any<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
        match self.node.get_ref() {
            DeValue::String(_) => self.deserialize_str(visitor),
            DeValue::Integer(_) | DeValue::Float(_) => self.deserialize_f64(visitor),
            DeValue::Boolean(_) => self.deserialize_bool(visitor),
            DeValue::Datetime(_) => Err(self.unexpected(&visitor)),
            DeValue::Array(_) => self.deserialize_seq(visitor),
            DeValue::Table(_) => self.deserialize_map(visitor),
        }
    }

    fn deserialize_bool<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
        match self.node.get_ref() {
            DeValue::Boolean(value) => visitor.visit_bool(*value).map_err(|mistake: Mistake| mistake.within(self.node.span())),
            _ => Err(self.unexpected(&visitor)),
        }
    }

    fn deserialize_f64<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
        let value = match self.number() {
            Ok(Number::Signed(value)) => visitor.visit_i64(value),
            Ok(Number::Unsigned(value)) => visitor.visit_u64(value),
            Ok(Number::Float(value)) => visitor.visit_f64(value),
            Ok(Number::None) => return Err(self.unexpected(&visitor)),
            Err(mistake) => Err(mistake),
        };
        value.map_err(|mistake| mistake.within(self.node.span()))
    }

    fn deserialize_str<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
        match self.node.get_ref() {
            DeValue::String(text) => visitor.visit_str(text).map_err(|mistake: Mistake| mistake.within(self.node.span())),
            _ => Err(self.unexpected(&visitor)),
        }
    }

    fn deserialize_string<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'t>>(self, _: &'static str, visitor: V) -> Result<V::Value, Mistake> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
        match self.node.get_ref() {
            DeValue::Array(list) => visitor.visit_seq(self.items(list)).map_err(|mistake| mistake.within(self.node.span())),
            _ => Err(self.unexpected(&visitor)),
        }
    }

    fn deserialize_tuple<V: Visitor<'t>>(self, _: usize, visitor: V) -> Result<V::Value, Mistake> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'t>>(self, _: &'static str, _: usize, visitor: V) -> Result<V::Value, Mistake> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_map<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
        match self.node.get_ref() {
            DeValue::Table(table) => visitor.visit_map(self.entries(table)).map_err(|mistake| mistake.within(self.node.span())),
            _ => Err(self.unexpected(&visitor)),
        }
    }

    fn deserialize_struct<V: Visitor<'t>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Mistake> {
        self.deserialize_map(visitor)
    }

    fn deserialize_enum<V: Visitor<'t>>(
        self,
        name: &'static str,
        kinds: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Mistake> {
        visitor.visit_enum(self.choice(name, kinds)?).map_err(|mistake| mistake.within(self.node.span()))
    }

    fn deserialize_ignored_any<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
        visitor.visit_unit()
    }

    fn deserialize_unit_struct<V: Visitor<'t>>(self, _: &'static str, visitor: V) -> Result<V::Value, Mistake> {
        self.deserialize_any(visitor)
    }

    read_numbers! { deserialize_i8 deserialize_i16 deserialize_i32 deserialize_i64 deserialize_u8 deserialize_u16 deserialize_u32 deserialize_u64 deserialize_f32 }
    read_anything! { deserialize_char deserialize_bytes deserialize_byte_buf deserialize_unit deserialize_identifier }
}

/// The keys of a table.
struct Entries<'t> {
    entries: Source<'t>,
    /// The key that is passed over.
    without: Option<&'static str>,
    /// The value of the key that was read last, and how much of it there is.
    value: Option<&'t Node<'t>>,
    view: View<'t>,
}

enum Source<'t> {
    All(toml::map::Iter<'t, Spanned<DeString<'t>>, Node<'t>>),
    One(Option<(&'t Spanned<DeString<'t>>, &'t Node<'t>)>),
}

impl<'t> Entries<'t> {
    fn next(&mut self) -> Option<&'t Spanned<DeString<'t>>> {
        let without = self.without;
        let is_read = |key: &Spanned<DeString<'_>>| without.is_none_or(|without| key.get_ref() != without);
        let (key, value) = match &mut self.entries {
            Source::All(entries) => entries.find(|(key, _)| is_read(key)),
            Source::One(entry) => entry.take().filter(|(key, _)| is_read(key)),
        }?;
        self.value = Some(value);
        Some(key)
    }
}

impl<'t> MapAccess<'t> for Entries<'t> {
    type Error = Mistake;

    fn next_key_seed<K: DeserializeSeed<'t>>(&mut self, seed: K) -> Result<Option<K::Value>, Mistake> {
        let Some(key) = self.next() else { return Ok(None) };
        let name: StrDeserializer<'_, Mistake> = key.get_ref().as_ref().into_deserializer();
        seed.deserialize(name).map(Some).map_err(|mistake| mistake.within(key.span()))
    }

    fn next_value_seed<S: DeserializeSeed<'t>>(&mut self, seed: S) -> Result<S::Value, Mistake> {
        let node = self.value.take().ok_or_else(|| Mistake::custom("a value was read before its key"))?;
        Reader { node, view: self.view }.read(seed)
    }
}

/// The values of a list.
struct Items<'t> {
    items: std::slice::Iter<'t, Node<'t>>,
    view: View<'t>,
}

impl<'t> SeqAccess<'t> for Items<'t> {
    type Error = Mistake;

    fn next_element_seed<S: DeserializeSeed<'t>>(&mut self, seed: S) -> Result<Option<S::Value>, Mistake> {
        let view = self.view;
        self.items.next().map(|node| Reader { node, view }.read(seed)).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.items.len())
    }
}

/// The kind of an enum and its content.
struct Choice<'t> {
    kind: Kind<'t>,
    /// Place of the kind.
    span: Range<usize>,
    content: Option<Reader<'t>>,
}

enum Kind<'t> {
    Name(&'t str),
    /// The place of a value with its place.
    Span(Range<usize>),
}

impl<'t> EnumAccess<'t> for Choice<'t> {
    type Error = Mistake;
    type Variant = Content<'t>;

    fn variant_seed<S: DeserializeSeed<'t>>(self, seed: S) -> Result<(S::Value, Content<'t>), Mistake> {
        let kind = seed.deserialize(self.kind).map_err(|mistake| mistake.within(self.span))?;
        Ok((kind, Content(self.content)))
    }
}

impl<'t> Deserializer<'t> for Kind<'t> {
    type Error = Mistake;

    fn deserialize_any<V: Visitor<'t>>(self, visitor: V) -> Result<V::Value, Mistake> {
        match self {
            Self::Name(name) => visitor.visit_str(name),
            Self::Span(span) => visitor.visit_u128(((span.start as u128) << 64) | span.end as u128),
        }
    }

    serde::forward_to_deserialize_any! {
        <V: Visitor<'t>>
        bool i8 i16 i32 i64 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct newtype_struct seq tuple
        tuple_struct map struct enum identifier ignored_any
    }
}

/// Values beside the kind; none where the entry is a mere name.
struct Content<'t>(Option<Reader<'t>>);

impl<'t> VariantAccess<'t> for Content<'t> {
    type Error = Mistake;

    fn unit_variant(self) -> Result<(), Mistake> {
        Ok(())
    }

    fn newtype_variant_seed<S: DeserializeSeed<'t>>(self, seed: S) -> Result<S::Value, Mistake> {
        self.0.ok_or_else(|| Mistake::custom("expected a table"))?.read(seed)
    }

    fn tuple_variant<V: Visitor<'t>>(self, _: usize, visitor: V) -> Result<V::Value, Mistake> {
        Err(Mistake::invalid_type(Unexpected::TupleVariant, &visitor))
    }

    fn struct_variant<V: Visitor<'t>>(self, _: &'static [&'static str], visitor: V) -> Result<V::Value, Mistake> {
        Err(Mistake::invalid_type(Unexpected::StructVariant, &visitor))
    }
}
