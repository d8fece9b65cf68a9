//! Colours of scene files, in every form in which they may be written, and the textures that stand for colours and numbers.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::reference::{NamesTextures, TextureName};
use super::value::{Checked, Exactly, Located, NonNegative, Rule, Temperature};
use crate::black_body::black_body;
use crate::math::srgb_to_linear_f64;
use crate::scene::Channel;
use crate::spectrum::Spectrum;

/// `[r, g, b]`, one number for grey, `"#rrggbb"` or `{ kelvin = 3200 }`.
#[derive(Debug, Clone)]
pub struct Rgb<R>(pub Spectrum, PhantomData<R>);

/// A colour as [`Rgb`], or `{ texture = "name" }`.
#[derive(Debug, Clone)]
pub enum Colour<R> {
    Constant(Rgb<R>),
    Texture(TextureReference<Rgb<NonNegative>>),
}

/// One number or `{ texture = "name" }`.
#[derive(Debug, Clone)]
pub enum Scalar<R> {
    Constant(Checked<R>),
    Texture(TextureReference<Checked<NonNegative>>),
}

/// `{ texture = "name", … }`, its factor a colour or a number.
#[derive(Debug, Clone)]
pub struct TextureReference<F> {
    pub texture: Located<TextureName>,
    pub channel: Option<Channel>,
    pub factor: Option<F>,
}

/// A texture in place of a colour.
#[derive(Debug, Clone, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table with the key `texture`")]
#[schemars(rename = "TextureOfColours")]
struct ColourTexture {
    /// A `[[texture]]`'s name.
    texture: Located<TextureName>,
    /// The channel that is taken for a grey; the colour when left out.
    channel: Option<ChannelName>,
    /// Multiplies the texture, 1 when left out.
    factor: Option<Rgb<NonNegative>>,
}

/// A table where a colour can stand: a texture or a temperature.
#[derive(Debug, Clone, serde::Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table with the key `texture` or `kelvin`")]
struct ColourTable {
    texture: Option<Located<TextureName>>,
    channel: Option<ChannelName>,
    kelvin: Option<Checked<Temperature>>,
    factor: Option<Rgb<NonNegative>>,
}

/// A table where a colour without texture can stand.
#[derive(Debug, Clone, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table with the key `kelvin`")]
#[schemars(rename = "ColourOfTemperature")]
struct TemperatureTable {
    /// The colour of a black body of this temperature, its largest channel 1.
    kelvin: Checked<Temperature>,
    /// Multiplies the colour, 1 when left out.
    factor: Option<Rgb<NonNegative>>,
}

/// A colour temperature where a colour is a share of light.
#[derive(JsonSchema)]
#[schemars(rename = "ShareOfTemperature", deny_unknown_fields)]
#[allow(dead_code, reason = "it is read as a `TemperatureTable`, and described as this")]
struct ShareTable {
    /// The colour of a black body of this temperature, its largest channel 1.
    kelvin: Checked<Temperature>,
}

impl TemperatureTable {
    fn colour<R: Rule, E: Error>(self) -> Result<Spectrum, E> {
        if self.factor.is_some() && is_share::<R>() {
            return Err(E::custom("a temperature has a `factor` where the colour is one of light, not a share of it"));
        }
        let colour = black_body(self.kelvin.0) * self.factor.map_or(Spectrum::WHITE, |factor| factor.0);
        colour.to_rgb().into_iter().try_for_each(|channel| Checked::<R>::new(channel).map(|_| ()))?;
        Ok(colour)
    }
}

/// Every colour of a screen is among the values. Of an index of refraction, which has three channels as well, 0 is not.
fn is_colour<R: Rule>() -> bool {
    R::accepts(0.0) && R::accepts(1.0)
}

fn is_share<R: Rule>() -> bool {
    !R::accepts(2.0)
}

/// The linear colour that `#rrggbb` is in sRGB.
fn hexadecimal(text: &str) -> Option<Spectrum> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6)?;
    let is_digit = |byte: u8| byte.is_ascii_hexdigit();
    let code = u32::from_str_radix(digits, 16).ok().filter(|_| digits.bytes().all(is_digit))?;
    let [_, red, green, blue] = code.to_be_bytes().map(|byte| srgb_to_linear_f64(f64::from(byte) / 255.0));
    Some(Spectrum::new(red, green, blue))
}

/// A texture in place of a number.
#[derive(Debug, Clone, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table with the key `texture`")]
#[schemars(rename = "TextureOfNumbers")]
struct ScalarTexture {
    /// A `[[texture]]`'s name.
    texture: Located<TextureName>,
    /// The channel that counts; the red one when left out.
    channel: Option<ChannelName>,
    /// Multiplies the texture, 1 when left out.
    factor: Option<Checked<NonNegative>>,
}

/// A channel of a texture. Textures without alpha have 1 everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ChannelName {
    /// Red.
    R,
    /// Green.
    G,
    /// Blue.
    B,
    /// Alpha, which is never coded in sRGB.
    A,
}

impl From<ChannelName> for Channel {
    fn from(written: ChannelName) -> Self {
        match written {
            ChannelName::R => Self::R,
            ChannelName::G => Self::G,
            ChannelName::B => Self::B,
            ChannelName::A => Self::A,
        }
    }
}

impl From<ColourTexture> for TextureReference<Rgb<NonNegative>> {
    fn from(ColourTexture { texture, channel, factor }: ColourTexture) -> Self {
        Self { texture, channel: channel.map(Into::into), factor }
    }
}

impl From<ScalarTexture> for TextureReference<Checked<NonNegative>> {
    fn from(ScalarTexture { texture, channel, factor }: ScalarTexture) -> Self {
        Self { texture, channel: channel.map(Into::into), factor }
    }
}

/// The forms of a value in place of a colour, which a visitor meets.
enum Form<R, T> {
    Number(Checked<R>),
    Triple([Checked<R>; 3]),
    Texture(T),
}

struct FormVisitor<R, T> {
    words: &'static str,
    triple: bool,
    texture: bool,
    /// `"#rrggbb"` is possible.
    code: bool,
    of: PhantomData<(R, T)>,
}

impl<'de, R: Rule, T: Deserialize<'de>> Visitor<'de> for FormVisitor<R, T> {
    type Value = Form<R, T>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} ({})", self.words, R::WORDS)
    }
    fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
        Checked::new(value).map(Form::Number)
    }
    fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
        self.visit_f64(value as f64)
    }
    fn visit_u64<E: Error>(self, value: u64) -> Result<Self::Value, E> {
        self.visit_f64(value as f64)
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
        if !self.triple {
            return Err(Error::invalid_type(serde::de::Unexpected::Seq, &self));
        }
        let mut values = Vec::with_capacity(3);
        while let Some(value) = seq.next_element::<Checked<R>>()? {
            values.push(value);
        }
        let length = values.len();
        let triple = values.try_into().map_err(|_| Error::invalid_length(length, &"3 numbers, [r, g, b]"))?;
        Ok(Form::Triple(triple))
    }
    fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
        if !self.code {
            return Err(E::invalid_type(serde::de::Unexpected::Str(text), &self));
        }
        let Some(colour) = hexadecimal(text) else {
            return Err(E::custom(format_args!("expected a colour such as \"#ff8800\", found \"{text}\"")));
        };
        let [red, green, blue] = colour.to_rgb().map(Checked::new);
        Ok(Form::Triple([red?, green?, blue?]))
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
        if !self.texture {
            return Err(Error::invalid_type(serde::de::Unexpected::Map, &self));
        }
        T::deserialize(MapAccessDeserializer::new(map)).map(Form::Texture)
    }
}

fn rgb<R>(values: [Checked<R>; 3]) -> Spectrum {
    Spectrum::from_rgb(values.map(|value| value.0))
}

impl<R: Rule> Rgb<R> {
    /// The colour.
    ///
    /// # Errors
    /// A sentence about a channel that `R` does not accept.
    pub fn of(colour: Spectrum) -> Result<Self, String> {
        colour.to_rgb().into_iter().try_for_each(|channel| Checked::<R>::of(channel).map(|_| ()))?;
        Ok(Self(colour, PhantomData))
    }

    /// Reads three numbers or one that stands for all three; `words` say what is expected.
    pub fn deserialize_as<'de, D: Deserializer<'de>>(deserializer: D, words: &'static str) -> Result<[f64; 3], D::Error> {
        let visitor = FormVisitor::<R, IgnoredAny> { words, triple: true, texture: false, code: false, of: PhantomData };
        match deserializer.deserialize_any(visitor)? {
            Form::Triple(values) => Ok(values.map(|value| value.0)),
            Form::Number(number) => Ok([number.0; 3]),
            Form::Texture(_) => Err(Error::custom("a texture is not possible here")),
        }
    }
}

impl<'de, R: Rule> Deserialize<'de> for Rgb<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if !is_colour::<R>() {
            let channels = Self::deserialize_as(deserializer, "[r, g, b] or one number")?;
            return Ok(Self(Spectrum::from_rgb(channels), PhantomData));
        }
        let words = "a colour: [r, g, b], one number, \"#rrggbb\" or { kelvin = 3200 }";
        let visitor = FormVisitor::<R, TemperatureTable> { words, triple: true, texture: true, code: true, of: PhantomData };
        let colour = match deserializer.deserialize_any(visitor)? {
            Form::Triple(values) => rgb(values),
            Form::Number(number) => Spectrum::grey(number.0),
            Form::Texture(temperature) => temperature.colour::<R, D::Error>()?,
        };
        Ok(Self(colour, PhantomData))
    }
}

impl<'de, R: Rule> Deserialize<'de> for Colour<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let words = "a colour: [r, g, b], one number, \"#rrggbb\", { kelvin = 3200 } or { texture = \"name\" }";
        let visitor = FormVisitor::<R, ColourTable> { words, triple: true, texture: true, code: true, of: PhantomData };
        Ok(match deserializer.deserialize_any(visitor)? {
            Form::Number(value) => Self::Constant(Rgb(Spectrum::grey(value.0), PhantomData)),
            Form::Triple(values) => Self::Constant(Rgb(rgb(values), PhantomData)),
            Form::Texture(ColourTable { texture: Some(texture), channel, kelvin: None, factor }) => {
                Self::Texture(ColourTexture { texture, channel, factor }.into())
            }
            Form::Texture(ColourTable { texture: None, channel: None, kelvin: Some(kelvin), factor }) => {
                Self::Constant(Rgb(TemperatureTable { kelvin, factor }.colour::<R, D::Error>()?, PhantomData))
            }
            Form::Texture(_) => return Err(Error::custom("expected a table with one of the keys `texture` and `kelvin`")),
        })
    }
}

impl<'de, R: Rule> Deserialize<'de> for Scalar<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let words = "one number or { texture = \"name\" }";
        let visitor = FormVisitor::<R, ScalarTexture> { words, triple: false, texture: true, code: false, of: PhantomData };
        match deserializer.deserialize_any(visitor)? {
            Form::Number(value) => Ok(Self::Constant(value)),
            Form::Texture(texture) => Ok(Self::Texture(texture.into())),
            Form::Triple(_) => Err(Error::custom("a colour is not possible here, expected one number")),
        }
    }
}

/// One number or a table that names a texture.
#[derive(Debug, Clone)]
pub enum NumberOr<R, T> {
    Number(Checked<R>),
    Table(T),
}

impl<'de, R: Rule, T: Deserialize<'de>> Deserialize<'de> for NumberOr<R, T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let words = "one number or { texture = \"name\" }";
        let visitor = FormVisitor::<R, T> { words, triple: false, texture: true, code: false, of: PhantomData };
        match deserializer.deserialize_any(visitor)? {
            Form::Number(value) => Ok(Self::Number(value)),
            Form::Texture(table) => Ok(Self::Table(table)),
            Form::Triple(_) => Err(Error::custom("a colour is not possible here, expected one number")),
        }
    }
}

impl<R: Rule, T: JsonSchema> JsonSchema for NumberOr<R, T> {
    fn schema_name() -> Cow<'static, str> {
        format!("{}Or{}", R::NAME, T::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        any_of(vec![generator.subschema_for::<Checked<R>>(), generator.subschema_for::<T>()])
    }
}

impl<R: Rule> Colour<R> {
    /// The colour itself.
    ///
    /// # Errors
    /// A sentence about a channel that `R` does not accept.
    pub fn constant(colour: Spectrum) -> Result<Self, String> {
        Rgb::of(colour).map(Self::Constant)
    }

    /// A texture times a factor.
    ///
    /// # Errors
    /// A sentence about a factor below 0.
    pub fn of_texture(texture: Located<TextureName>, factor: Spectrum) -> Result<Self, String> {
        let factor = if factor == Spectrum::WHITE { None } else { Some(Rgb::of(factor)?) };
        Ok(Self::Texture(TextureReference { texture, channel: None, factor }))
    }
}

impl<R> Colour<R> {
    /// The largest channel, where textures are at most white.
    pub fn largest(&self) -> f64 {
        match self {
            Self::Constant(colour) => colour.0.max_component(),
            Self::Texture(texture) => texture.factor.as_ref().map_or(1.0, |factor| factor.0.max_component()),
        }
    }
}

impl<R: Rule> Scalar<R> {
    /// The number itself.
    ///
    /// # Errors
    /// A sentence about a number that `R` does not accept.
    pub fn constant(number: f64) -> Result<Self, String> {
        Checked::of(number).map(Self::Constant)
    }

    /// A channel of a texture, the red one where none is said, times a factor.
    ///
    /// # Errors
    /// A sentence about a factor below 0.
    pub fn of_texture(texture: Located<TextureName>, channel: Option<Channel>, factor: f64) -> Result<Self, String> {
        let factor = if factor == 1.0 { None } else { Some(Checked::of(factor)?) };
        Ok(Self::Texture(TextureReference { texture, channel, factor }))
    }
}

/// Black.
impl<R> Default for Colour<R> {
    fn default() -> Self {
        Self::Constant(Rgb(Spectrum::BLACK, PhantomData))
    }
}

/// 0
impl Default for Scalar<NonNegative> {
    fn default() -> Self {
        Self::Constant(Checked::ZERO)
    }
}

impl<R> NamesTextures for Rgb<R> {}

impl<R> NamesTextures for Colour<R> {
    fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
        if let Self::Texture(reference) = self {
            reference.texture.each_texture(visit);
        }
    }
}

impl<R> NamesTextures for Scalar<R> {
    fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
        if let Self::Texture(reference) = self {
            reference.texture.each_texture(visit);
        }
    }
}

impl<R, T: NamesTextures> NamesTextures for NumberOr<R, T> {
    fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
        if let Self::Table(table) = self {
            table.each_texture(visit);
        }
    }
}

/// The schema of a value that may take any of these forms.
pub fn any_of(forms: Vec<Schema>) -> Schema {
    json_schema!({ "anyOf": forms })
}

impl<R: Rule> JsonSchema for Rgb<R> {
    fn schema_name() -> Cow<'static, str> {
        format!("ConstantColour{}", R::NAME).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut forms = vec![generator.subschema_for::<Exactly<Checked<R>, 3>>(), generator.subschema_for::<Checked<R>>()];
        if is_colour::<R>() {
            forms.push(json_schema!({ "description": "sRGB.", "type": "string", "pattern": "^#[0-9a-fA-F]{6}$" }));
            forms.push(match is_share::<R>() {
                true => generator.subschema_for::<ShareTable>(),
                false => generator.subschema_for::<TemperatureTable>(),
            });
        }
        any_of(forms)
    }
}

impl<R: Rule> JsonSchema for Colour<R> {
    fn schema_name() -> Cow<'static, str> {
        format!("Colour{}", R::NAME).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        any_of(vec![generator.subschema_for::<Rgb<R>>(), generator.subschema_for::<ColourTexture>()])
    }
}

impl<R: Rule> JsonSchema for Scalar<R> {
    fn schema_name() -> Cow<'static, str> {
        format!("Scalar{}", R::NAME).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        any_of(vec![generator.subschema_for::<Checked<R>>(), generator.subschema_for::<ScalarTexture>()])
    }
}
