//! Textures as entries of the description. What no entry can say is a picture that is made of the texture.

use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

use super::converter::Converter;
use super::text::Spot;
use super::texture_node::{ImageLeaf, MOST_PARTS, NodeKind, Placement, TextureNode};
use crate::load::error::{SceneError, show};
use crate::load::file::colour::Rgb;
use crate::load::file::reference::{FileOr, TextureName};
use crate::load::file::syntax::{CheckerEntry, ColorSpaceEntry, ImageEntry, TextureEntry, TextureFilterEntry, WrapEntry};
use crate::load::file::value::Exactly;
use crate::load::file::writer::picture;
use crate::load::image_file::{EmbeddedFile, Pictures};
use crate::load::import::Input;
use crate::scene::{ColorSpace, ImageData, Texels};
use crate::spectrum::Spectrum;

/// Most texels along a side of a picture that is made of several, and those of one that is made of none.
const LARGEST_SIDE: f64 = 2048.0;
const PLAIN_SIDE: f64 = 256.0;

/// The use of a texture's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Use {
    /// Shares of light, from 0 to 1.
    Albedo,
    /// Light, or any amount.
    Colours,
    /// Numbers from 0 to 1.
    Share,
    /// Roots of numbers from 0 to 1: widths of microfacets.
    Root,
    /// Heights, of which slopes are taken.
    Heights,
}

impl Use {
    fn is_number(self) -> bool {
        matches!(self, Self::Share | Self::Root | Self::Heights)
    }

    /// The value as it is used.
    fn of(self, value: Spectrum) -> Spectrum {
        match self {
            Self::Colours => value.max(Spectrum::BLACK),
            Self::Albedo | Self::Share => value.clamp(Spectrum::BLACK, Spectrum::WHITE),
            Self::Root => value.clamp(Spectrum::BLACK, Spectrum::WHITE).sqrt(),
            Self::Heights => value,
        }
    }
}

impl Converter<'_> {
    /// A texture as a parameter of an entry.
    pub fn input(&mut self, node: &Rc<TextureNode>, used: Use, spot: &Spot) -> Result<Input, SceneError> {
        if let Some(constant) = node.as_constant() {
            return Ok(Input::Constant(used.of(constant)));
        }
        let key = format!("{:p} {used:?}", Rc::as_ptr(node));
        if let Some(known) = self.made_textures.get(&key) {
            return Ok(known.clone());
        }
        let input = match &node.kind {
            NodeKind::Checker(parts, placement) => match parts.each_ref().map(|part| part.as_constant()) {
                [Some(a), Some(b)] => self.checker([a, b].map(|colour| used.of(colour)), *placement, &node.name, spot)?,
                _ => self.baked(node, used, spot)?,
            },
            NodeKind::Image(leaf) => self.image(leaf, used, &node.name, spot)?,
            NodeKind::Product([one, other]) => match (one.as_constant(), other.as_constant()) {
                (None, Some(factor)) => self.scaled(node, one, factor, used, spot)?,
                (Some(factor), None) => self.scaled(node, other, factor, used, spot)?,
                (Some(one), Some(other)) => Input::Constant(used.of(one * other)),
                (None, None) => self.product(node, [one, other], used, spot)?,
            },
            NodeKind::Constant(_) | NodeKind::Bilinear(..) | NodeKind::Mix(_) => self.baked(node, used, spot)?,
        };
        self.made_textures.insert(key, input.clone());
        Ok(input)
    }

    /// A texture times a constant.
    fn scaled(
        &mut self,
        whole: &Rc<TextureNode>,
        node: &Rc<TextureNode>,
        factor: Spectrum,
        used: Use,
        spot: &Spot,
    ) -> Result<Input, SceneError> {
        let is_within = factor.min_component() >= 0.0 && (used == Use::Colours || factor.max_component() <= 1.0);
        if !is_within || !matches!(used, Use::Albedo | Use::Colours | Use::Share) {
            return self.baked(whole, used, spot);
        }
        Ok(match self.input(node, used, spot)? {
            Input::Constant(colour) => Input::Constant(used.of(colour * factor)),
            Input::Texture(name, own) => Input::Texture(name, own * factor),
        })
    }

    /// Two textures, one times the other.
    fn product(
        &mut self,
        whole: &Rc<TextureNode>,
        parts: [&Rc<TextureNode>; 2],
        used: Use,
        spot: &Spot,
    ) -> Result<Input, SceneError> {
        if !matches!(used, Use::Albedo | Use::Colours | Use::Share) {
            return self.baked(whole, used, spot);
        }
        let [one, other] = parts;
        // A texture of numbers may be one of coloured pictures.
        let other_use = if used == Use::Colours { Use::Colours } else { Use::Share };
        let (Input::Texture(name, factor), Input::Texture(times, other_factor)) =
            (self.input(one, used, spot)?, self.input(other, other_use, spot)?)
        else {
            return self.baked(whole, used, spot);
        };
        let entry = |name: &str| self.scene.file.texture.iter().rev().find(|entry| entry.name() == name).cloned();
        let (Some(mut first), Some(second)) = (entry(&name), entry(&times)) else { return self.baked(whole, used, spot) };
        if first.common().times.is_some() || second.common().times.is_some() {
            return self.baked(whole, used, spot);
        }
        *first.common_mut().times = Some(spot.place().at(TextureName(times)));
        match self.add_texture(spot, &whole.name, first) {
            Input::Texture(name, _) => Ok(Input::Texture(name, factor * other_factor)),
            constant @ Input::Constant(_) => Ok(constant),
        }
    }

    fn checker(&mut self, [a, b]: [Spectrum; 2], placement: Placement, name: &str, spot: &Spot) -> Result<Input, SceneError> {
        let mut entry = TextureEntry::Checker(CheckerEntry {
            name: spot.place().at(String::new()),
            a: spot.possible(Rgb::of(a))?,
            b: spot.possible(Rgb::of(b))?,
            scale: None,
            rotation: None,
            offset: None,
            second_uvs: None,
            bends_by_first_uvs: None,
            times: None,
        });
        place(&mut entry, placement, spot)?;
        Ok(self.add_texture(spot, name, entry))
    }

    /// A picture as it is, or a picture of what is made of its texels.
    fn image(&mut self, leaf: &ImageLeaf, used: Use, name: &str, spot: &Spot) -> Result<Input, SceneError> {
        let is_float =
            leaf.path.extension().is_some_and(|ending| ["exr", "hdr", "pfm"].iter().any(|e| ending.eq_ignore_ascii_case(e)));
        let is_scaled = leaf.scale < 0.0 || used != Use::Colours && leaf.scale > 1.0;
        // Only what depends on the texels has them looked at.
        let is_looked_at = is_scaled || leaf.inverts || used.is_number() || used == Use::Albedo && is_float;
        let picture = if is_looked_at { self.read(leaf) } else { None };
        let made = picture.filter(|image| {
            let is_beyond =
                || used == Use::Albedo && image.texels.colors().any(|texel| f64::from(texel.max_element()) * leaf.scale > 1.0);
            let is_grey = || image.texels.colors().all(|colour| colour.x == colour.y && colour.y == colour.z);
            let is_plain = |used: Use| used == Use::Share && is_grey() && !has_alpha(image);
            leaf.inverts || is_scaled || is_beyond() || used.is_number() && !is_plain(used)
        });
        let place_of = spot.place();
        let (file, space, factor) = match made {
            Some(image) => {
                let of_alpha = used.is_number() && has_alpha(&image);
                let texel = |index: usize| used.of(value_of(leaf, &image, index, used.is_number(), of_alpha));
                let texels = (0..image.texels.len()).map(|index| texel(index).to_f32()).collect();
                let made =
                    ImageData { width: image.width, height: image.height, texels: Texels::Float(texels), has_alpha: false };
                let space = (used == Use::Heights).then_some(ColorSpaceEntry::Linear);
                (self.embedded(&stem_of(&leaf.path), &made), space, 1.0)
            }
            None => (FileOr::OnDisk(leaf.path.clone()), leaf.is_linear.then_some(ColorSpaceEntry::Linear), leaf.scale),
        };
        let mut entry = ImageEntry::of_file(place_of.at(String::new()), place_of.at(file));
        entry.color_space = space;
        entry.wrap = (leaf.wrap != WrapEntry::Repeat).then_some(leaf.wrap);
        entry.filter = leaf.filter;
        let mut entry = TextureEntry::Image(entry);
        place(&mut entry, leaf.placement, spot)?;
        let wanted = if name.is_empty() { stem_of(&leaf.path) } else { name.to_owned() };
        match self.add_texture(spot, &wanted, entry) {
            Input::Texture(name, _) => Ok(Input::Texture(name, Spectrum::grey(factor))),
            constant @ Input::Constant(_) => Ok(constant),
        }
    }

    /// A picture over the unit square of texture coordinates, which is repeated.
    fn baked(&mut self, node: &Rc<TextureNode>, used: Use, spot: &Spot) -> Result<Input, SceneError> {
        if node.size > MOST_PARTS {
            let instead = "a value of 0.5 is taken everywhere";
            self.approximate(spot, format!("texture of more than {MOST_PARTS} parts"), instead);
            return Ok(Input::Constant(used.of(Spectrum::grey(0.5))));
        }
        let mut loaded = Vec::new();
        let mut side = [PLAIN_SIDE; 2];
        self.load_pictures(node, used.is_number(), &mut loaded, &mut side);
        let [width, height] = side.map(|side| side.min(LARGEST_SIDE).round() as u32);
        let mut texels = Vec::with_capacity(width as usize * height as usize);
        for row in 0..height {
            for column in 0..width {
                let at = [(f64::from(column) + 0.5) / f64::from(width), 1.0 - (f64::from(row) + 0.5) / f64::from(height)];
                texels.push(used.of(value_at(node, at, &mut loaded.iter())).to_f32());
            }
        }
        let instead = format!("a picture of {width} x {height} texels over the unit square of texture coordinates is taken");
        self.approximate(spot, format!("texture `{}`, which is made of others", node.name), instead);
        let made = ImageData { width, height, texels: Texels::Float(texels), has_alpha: false };
        let place = spot.place();
        let file = self.embedded(&node.name, &made);
        let mut entry = ImageEntry::of_file(place.at(String::new()), place.at(file));
        entry.color_space = (used == Use::Heights).then_some(ColorSpaceEntry::Linear);
        Ok(self.add_texture(spot, &node.name, TextureEntry::Image(entry)))
    }

    /// Reads the pictures within a texture, in the order in which they are looked up, and finds how many texels they ask for.
    fn load_pictures(&self, node: &TextureNode, is_number: bool, loaded: &mut Vec<Loaded>, side: &mut [f64; 2]) {
        match &node.kind {
            NodeKind::Constant(_) | NodeKind::Bilinear(..) => {}
            NodeKind::Image(leaf) => {
                let image = self.read(leaf);
                if let Some(image) = &image {
                    let sides = [image.width, image.height].map(f64::from);
                    for axis in 0..2 {
                        side[axis] = side[axis].max(sides[axis] * leaf.placement.scale[axis].abs());
                    }
                }
                let of_alpha = is_number && image.as_ref().is_some_and(has_alpha);
                loaded.push(Loaded { image, is_number, of_alpha });
            }
            NodeKind::Checker(parts, placement) => {
                for (side, scale) in side.iter_mut().zip(placement.scale) {
                    *side = side.max(32.0 * scale.abs());
                }
                parts.iter().for_each(|part| self.load_pictures(part, is_number, loaded, side));
            }
            NodeKind::Product([tex, scale]) => {
                self.load_pictures(tex, is_number, loaded, side);
                self.load_pictures(scale, true, loaded, side);
            }
            NodeKind::Mix([first, second, amount]) => {
                self.load_pictures(first, is_number, loaded, side);
                self.load_pictures(second, is_number, loaded, side);
                self.load_pictures(amount, true, loaded, side);
            }
        }
    }

    /// The picture of a file, as linear colours; None of one that cannot be read, which is reported when the texture is.
    fn read(&self, leaf: &ImageLeaf) -> Option<ImageData> {
        let space = leaf.is_linear.then_some(ColorSpace::Linear);
        Pictures::new(self.files.clone()).read_file(&leaf.path, space).ok().map(|picture| picture.image)
    }

    /// The mean of what a texture shows.
    pub fn mean_of(&self, node: &TextureNode) -> Spectrum {
        if node.size > MOST_PARTS {
            return Spectrum::grey(0.5);
        }
        match &node.kind {
            NodeKind::Constant(colour) => *colour,
            NodeKind::Image(leaf) => self.mean_of_picture(leaf),
            NodeKind::Checker([a, b], _) => 0.5 * (self.mean_of(a) + self.mean_of(b)),
            NodeKind::Bilinear(corners, _) => corners.iter().copied().sum::<Spectrum>() / 4.0,
            NodeKind::Product([a, b]) => self.mean_of(a) * self.mean_of(b),
            NodeKind::Mix([a, b, amount]) => self.mean_of(a).lerp(self.mean_of(b), self.mean_of(amount).mean()),
        }
    }

    fn mean_of_picture(&self, leaf: &ImageLeaf) -> Spectrum {
        let Some(image) = self.read(leaf) else { return Spectrum::grey(0.5) };
        let count = image.texels.len();
        let values = (0..count).map(|index| value_of(leaf, &image, index, false, false));
        values.sum::<Spectrum>() / count.max(1) as f64
    }

    /// The mean of the picture of a light.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn picture(&self, path: &Path, spot: &Spot) -> Result<ImageData, SceneError> {
        let read = Pictures::new(self.files.clone()).read_file(path, None);
        read.map(|picture| picture.image).map_err(|reason| spot.error(format!("{}: {reason}", show(path))))
    }

    /// A picture in memory.
    pub fn embedded(&self, name: &str, image: &ImageData) -> FileOr<EmbeddedFile> {
        let name = if name.is_empty() { "picture" } else { name };
        // A name may hold what no file's name can.
        let plain: String =
            name.chars().map(|one| if one.is_alphanumeric() || "-_. ".contains(one) { one } else { '-' }).collect();
        FileOr::InMemory(Arc::new(EmbeddedFile { name: format!("{plain}.exr"), bytes: picture(image).into() }))
    }

    /// Adds a texture, which it gives a name.
    pub fn add_texture(&mut self, spot: &Spot, wanted: &str, mut entry: TextureEntry) -> Input {
        let name = self.scene.free_texture_name(if wanted.is_empty() { "texture" } else { wanted });
        *entry.common_mut().name = spot.place().at(name.clone());
        self.scene.file.texture.push(entry);
        Input::Texture(name, Spectrum::WHITE)
    }

    /// A picture of a file as it is, looked up by texture coordinates: of directions, or of light.
    pub fn plain_picture(&mut self, path: &Path, spot: &Spot, change: impl FnOnce(&mut ImageEntry)) -> Input {
        let place = spot.place();
        let mut entry = ImageEntry::of_file(place.at(String::new()), place.at(FileOr::OnDisk(path.to_owned())));
        change(&mut entry);
        self.add_texture(spot, &stem_of(path), TextureEntry::Image(entry))
    }
}

/// A picture of a texture, whether it is one of numbers, and whether those are its alpha.
struct Loaded {
    image: Option<ImageData>,
    is_number: bool,
    of_alpha: bool,
}

/// Some texel lets something through.
fn has_alpha(image: &ImageData) -> bool {
    image.has_alpha && (0..image.texels.len()).any(|index| image.texels.get(index)[3] != 1.0)
}

/// A texel's value: of a texture of numbers the mean of its channels, or its alpha where the picture has some.
fn value_of(leaf: &ImageLeaf, image: &ImageData, index: usize, is_number: bool, of_alpha: bool) -> Spectrum {
    let [red, green, blue, alpha] = image.texels.get(index).map(f64::from);
    let value = match (is_number, of_alpha) {
        (true, true) => Spectrum::grey(alpha),
        (true, false) => Spectrum::grey(Spectrum::new(red, green, blue).mean()),
        (false, _) => Spectrum::new(red, green, blue),
    };
    let scaled = value * leaf.scale;
    if leaf.inverts { (Spectrum::WHITE - scaled).max(Spectrum::BLACK) } else { scaled }
}

/// The value of a texture at texture coordinates. `loaded` are its pictures in their order.
fn value_at<'l>(node: &TextureNode, at: [f64; 2], loaded: &mut impl Iterator<Item = &'l Loaded>) -> Spectrum {
    let placed = |placement: &Placement| [0, 1].map(|axis| at[axis] * placement.scale[axis] + placement.offset[axis]);
    match &node.kind {
        NodeKind::Constant(colour) => *colour,
        NodeKind::Image(leaf) => match loaded.next() {
            Some(Loaded { image: Some(image), is_number, of_alpha }) => {
                looked_up(leaf, image, (*is_number, *of_alpha), placed(&leaf.placement))
            }
            _ => Spectrum::grey(0.5),
        },
        NodeKind::Checker(parts, placement) => {
            let [first, second] = parts.each_ref().map(|part| value_at(part, at, loaded));
            let [u, v] = placed(placement).map(|place| place.floor() as i64);
            if (u + v).rem_euclid(2) == 0 { first } else { second }
        }
        NodeKind::Bilinear([v00, v01, v10, v11], placement) => {
            let [u, v] = placed(placement);
            v00.lerp(*v10, u).lerp(v01.lerp(*v11, u), v)
        }
        NodeKind::Product([one, other]) => {
            let first = value_at(one, at, loaded);
            first * value_at(other, at, loaded)
        }
        NodeKind::Mix([first, second, amount]) => {
            let [first, second] = [first, second].map(|part| value_at(part, at, loaded));
            first.lerp(second, value_at(amount, at, loaded).r())
        }
    }
}

/// A picture between its texels; v runs upward over it.
fn looked_up(leaf: &ImageLeaf, image: &ImageData, (is_number, of_alpha): (bool, bool), [u, v]: [f64; 2]) -> Spectrum {
    let (width, height) = (i64::from(image.width), i64::from(image.height));
    let wrapped =
        |place: i64, side: i64| if leaf.wrap == WrapEntry::Repeat { place.rem_euclid(side) } else { place.clamp(0, side - 1) };
    let texel = |x: i64, y: i64| {
        let index = wrapped(y, height) * width + wrapped(x, width);
        value_of(leaf, image, index as usize, is_number, of_alpha)
    };
    let (x, y) = (u * width as f64, (1.0 - v) * height as f64);
    if matches!(leaf.filter, Some(TextureFilterEntry::Nearest)) {
        return texel(x.floor() as i64, y.floor() as i64);
    }
    let (x, y) = (x - 0.5, y - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let row = |y: i64| texel(left as i64, y).lerp(texel(left as i64 + 1, y), x - left);
    row(top as i64).lerp(row(top as i64 + 1), y - top)
}

/// States how a texture lies.
fn place(entry: &mut TextureEntry, placement: Placement, spot: &Spot) -> Result<(), SceneError> {
    if let (Some(scale), true) = (entry.scale_mut(), placement.scale != [1.0; 2]) {
        *scale = Some(spot.possible(Exactly::of(placement.scale))?);
    }
    if placement.offset != [0.0; 2] {
        *entry.common_mut().offset = Some(spot.possible(Exactly::of(placement.offset))?);
    }
    Ok(())
}

fn stem_of(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}
