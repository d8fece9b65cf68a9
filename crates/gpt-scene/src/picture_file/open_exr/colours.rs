//! Which channels of which part are the picture's colours.

use std::collections::BTreeMap;

use exr::meta::header::Header;

/// Names of layers that hold the picture itself beside its ingredients, in lower case; the first that a file has is taken.
const BEAUTY: [&str; 8] = ["combined", "beauty", "rgba", "rgb", "composite", "image", "color", "colour"];

/// The meaning of a channel by the end of its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    Red,
    Green,
    Blue,
    Alpha,
    Luminance,
    /// (R − Y) / Y and (B − Y) / Y.
    RedDifference,
    BlueDifference,
    /// The first and the third number of a vector, whose second one is called as luminance is.
    X,
    Z,
}

impl Role {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "Y" => Self::Luminance,
            "RY" => Self::RedDifference,
            "BY" => Self::BlueDifference,
            "X" => Self::X,
            "Z" => Self::Z,
            _ => match name.to_ascii_lowercase().as_str() {
                "r" | "red" => Self::Red,
                "g" | "green" => Self::Green,
                "b" | "blue" => Self::Blue,
                "a" | "alpha" => Self::Alpha,
                _ => return None,
            },
        })
    }
}

/// How channels, by their places in the part, make a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mixture {
    /// Red, green and blue; 0 stands for one that is not there.
    Rgb([Option<usize>; 3]),
    Grey(usize),
    /// Luminance, and the differences of red and blue from it.
    LuminanceChroma([usize; 3]),
}

/// The choice, and what to say of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Colours {
    /// Its place among the file's parts.
    pub part: usize,
    pub mixture: Mixture,
    pub alpha: Option<usize>,
    /// The words before the channels' last one; empty for plain channels.
    pub layer: String,
    pub notes: Vec<String>,
}

/// The channels of one part whose names begin alike.
struct Group {
    part: usize,
    layer: String,
    roles: BTreeMap<Role, usize>,
    /// Places of all its channels.
    channels: Vec<usize>,
}

/// How well a group is a picture: less is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Plain,
    Layer,
    Luminance,
    Vector,
    Incomplete,
    Single,
    AlphaAlone,
}

impl Group {
    fn has(&self, roles: &[Role]) -> bool {
        roles.iter().all(|role| self.roles.contains_key(role))
    }

    fn kind(&self) -> Option<Kind> {
        let any = [Role::Red, Role::Green, Role::Blue].iter().any(|role| self.roles.contains_key(role));
        let without_alpha = self.channels.iter().filter(|channel| self.roles.get(&Role::Alpha) != Some(*channel)).count();
        Some(if self.has(&[Role::Red, Role::Green, Role::Blue]) {
            if self.layer.is_empty() { Kind::Plain } else { Kind::Layer }
        } else if self.has(&[Role::X, Role::Luminance, Role::Z]) {
            Kind::Vector
        } else if self.has(&[Role::Luminance]) {
            Kind::Luminance
        } else if any {
            Kind::Incomplete
        } else if without_alpha == 1 {
            Kind::Single
        } else if self.has(&[Role::Alpha]) {
            Kind::AlphaAlone
        } else {
            return None;
        })
    }

    fn mixture(&self, kind: Kind) -> Mixture {
        let of = |role: Role| self.roles.get(&role).copied();
        let first = self.channels.iter().copied().find(|channel| of(Role::Alpha) != Some(*channel));
        match (kind, of(Role::Luminance), of(Role::RedDifference), of(Role::BlueDifference)) {
            (Kind::Luminance, Some(y), Some(red), Some(blue)) => Mixture::LuminanceChroma([y, red, blue]),
            (Kind::Luminance, Some(y), ..) => Mixture::Grey(y),
            (Kind::Vector, y, ..) => Mixture::Rgb([of(Role::X), y, of(Role::Z)]),
            (Kind::Single, ..) => first.map_or(Mixture::Rgb([None; 3]), Mixture::Grey),
            _ => Mixture::Rgb([of(Role::Red), of(Role::Green), of(Role::Blue)]),
        }
    }

    /// Among groups of one kind, the name of the layer or the part says which is the picture.
    fn rank(&self, headers: &[Header]) -> usize {
        let part = headers[self.part].own_attributes.layer_name.as_ref().map(ToString::to_string).unwrap_or_default();
        let whole = if self.layer.is_empty() { part } else { self.layer.clone() };
        let last = whole.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
        BEAUTY.iter().position(|name| *name == last).unwrap_or(BEAUTY.len())
    }

    fn name(&self, headers: &[Header]) -> String {
        let part = headers[self.part].own_attributes.layer_name.as_ref().filter(|_| headers.len() > 1);
        match (part, self.layer.is_empty()) {
            (Some(part), true) => format!("{part}"),
            (Some(part), false) => format!("{part}/{}", self.layer),
            (None, true) => "the one without a name".to_owned(),
            (None, false) => self.layer.clone(),
        }
    }
}

impl Colours {
    /// The channels that are the picture, among all parts of a file.
    ///
    /// # Errors
    /// Which channels there are, where none is a picture.
    pub fn choose(headers: &[Header]) -> Result<Self, String> {
        let groups: Vec<Group> = (0..headers.len()).flat_map(|part| groups(part, &headers[part])).collect();
        let kinds: Vec<Option<Kind>> = groups.iter().map(Group::kind).collect();
        let Some(best) = kinds.iter().flatten().min().copied() else {
            let all = headers.iter().flat_map(|header| &header.channels.list).map(|channel| channel.name.to_string());
            let all: Vec<String> = all.take(12).collect();
            return Err(format!("has no channels of colours, such as R, G and B or Y; it has {}", all.join(", ")));
        };
        let mut rivals: Vec<&Group> =
            groups.iter().zip(&kinds).filter(|(_, kind)| **kind == Some(best)).map(|(group, _)| group).collect();
        rivals.sort_by_key(|group| group.rank(headers)); // stable: else the first in the file
        let taken = rivals[0];
        let mut notes = Vec::new();
        if rivals.len() > 1 {
            let names: Vec<String> = rivals.iter().map(|group| group.name(headers)).collect();
            notes.push(format!("of its layers {}, the picture is {}", list(&names), names[0]));
        }
        let name = |place: usize| headers[taken.part].channels.list[place].name.to_string();
        let mixture = taken.mixture(best);
        match (best, mixture) {
            (Kind::Vector, _) => notes.push("its channels X, Y and Z stand for red, green and blue".to_owned()),
            (Kind::Single, Mixture::Grey(place)) => notes.push(format!("its one channel {} is taken for a grey", name(place))),
            (Kind::AlphaAlone, _) => notes.push("it has an alpha and no colours: they are 0".to_owned()),
            (_, Mixture::Rgb(channels)) => {
                let lacking = ["R", "G", "B"].iter().zip(channels).filter(|(_, channel)| channel.is_none());
                let lacking: Vec<String> = lacking.map(|(name, _)| (*name).to_owned()).collect();
                if !lacking.is_empty() {
                    notes.push(format!("it has no channel {}, for which 0 stands", list(&lacking)));
                }
            }
            _ => {}
        }
        let alpha = taken.roles.get(&Role::Alpha).copied();
        Ok(Self { part: taken.part, mixture, alpha, layer: taken.layer.clone(), notes })
    }
}

fn groups(part: usize, header: &Header) -> Vec<Group> {
    let mut groups: BTreeMap<String, Group> = BTreeMap::new();
    for (place, channel) in header.channels.list.iter().enumerate() {
        let name = channel.name.to_string();
        let (layer, last) = name.rsplit_once('.').unwrap_or(("", &name));
        let group = groups.entry(layer.to_owned());
        let group =
            group.or_insert_with(|| Group { part, layer: layer.to_owned(), roles: BTreeMap::new(), channels: Vec::new() });
        group.channels.push(place);
        if let Some(role) = Role::of(last) {
            group.roles.entry(role).or_insert(place);
        }
    }
    groups.into_values().collect()
}

/// Names as a sentence has them.
fn list(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [name] => name.clone(),
        [names @ .., last] => format!("{} and {last}", names.join(", ")),
    }
}
