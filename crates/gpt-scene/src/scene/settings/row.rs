//! How a table of settings becomes a struct and rows that can be looped over.

/// Defines a struct of settings, its default, and a list of [`super::table::Setting`], a row each. A row is
///
/// ```text
/// /// Help.
/// name: Type = default { column: value, … }
/// ```
///
/// and its columns are the fields of `Setting` that are not filled in here.
macro_rules! settings {
    ($(#[$meta:meta])* pub struct $struct:ident, $list:ident {
        $($(#[doc = $doc:literal])+ $name:ident: $type:ty = $default:expr => { $($column:ident: $value:expr),+ $(,)? })+
    }) => {
        $(#[$meta])*
        pub struct $struct {
            $($(#[doc = $doc])+ pub $name: $type,)+
        }

        impl Default for $struct {
            fn default() -> Self {
                Self { $($name: $default),+ }
            }
        }

        /// Every setting, in the order in which they are listed.
        pub static $list: &[Setting] = &[$(Setting {
            name: stringify!($name),
            doc: concat!($($doc),+),
            get: |settings| <$type as Field>::to_value(settings.$name),
            set: |settings, value| {
                if let Some(value) = <$type as Field>::from_value(value) {
                    settings.$name = value;
                }
            },
            $($column: $value),+
        }),+];
    };
}
pub(super) use settings;
