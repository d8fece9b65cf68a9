//! Values that people choose by name: in scene files, on the command line, in picture headers and in results.

/// A value that people choose by name. `choices!` makes an enum one.
pub trait Choice: Copy + PartialEq + 'static {
    /// Every value, in the order in which they are listed.
    const VALUES: &'static [Self];
    /// The names and meanings of [`Choice::VALUES`], in the same order.
    const NAMES: &'static [Named];
    /// The names alone.
    const WORDS: &'static [&'static str];

    /// The name of the value for people.
    fn name(self) -> &'static str;

    /// The value of this name.
    fn from_name(name: &str) -> Option<Self> {
        Self::VALUES.iter().copied().find(|value| value.name() == name)
    }
}

/// A name and what it stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Named {
    pub name: &'static str,
    /// The value's doc comment, with the blanks that begin its lines.
    pub doc: &'static str,
}

impl Named {
    /// The meaning of the name, in a sentence.
    pub fn help(&self) -> &'static str {
        self.doc.trim_start()
    }
}

/// Defines enums whose values people choose by name, `Variant = "name"`; the variants' doc comments are the help that people see.
#[doc(hidden)]
#[macro_export]
macro_rules! choices {
    ($($(#[$meta:meta])* $visibility:vis enum $type:ident { $($(#[doc = $doc:literal])+ $variant:ident = $name:literal,)+ })+) => {$(
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        $visibility enum $type { $($(#[doc = $doc])+ $variant,)+ }

        impl $type {
            /// Every value, in the order in which they are listed.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$variant),+];
        }

        impl $crate::choice::Choice for $type {
            const VALUES: &'static [Self] = &Self::ALL;
            const NAMES: &'static [$crate::choice::Named] = &[$($crate::choice::Named { name: $name, doc: concat!($($doc),+) }),+];
            const WORDS: &'static [&'static str] = &[$($name),+];

            fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                }
            }
        }

        impl serde::Serialize for $type {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str($crate::choice::Choice::name(*self))
            }
        }
    )+};
}
#[doc(hidden)]
pub use choices;

#[cfg(test)]
mod tests {
    use super::*;

    choices! {
        enum Fruit {
            /// Grows on
            /// trees.
            Apple = "apple",
            /// Is a berry.
            Banana = "yellow_one",
        }
    }

    #[test]
    fn names_and_values_belong_together() {
        assert_eq!(Fruit::from_name("yellow_one"), Some(Fruit::Banana));
        assert_eq!(Fruit::from_name("Banana"), None);
        assert_eq!(Fruit::ALL.map(Choice::name), ["apple", "yellow_one"]);
        assert_eq!(Fruit::NAMES[0], Named { name: "apple", doc: " Grows on trees." });
        assert_eq!(Fruit::NAMES[0].help(), "Grows on trees.");
        assert_eq!(serde_json::to_string(&Fruit::Banana).expect("a name"), "\"yellow_one\"");
    }
}
