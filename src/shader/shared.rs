//! Structs and constants that Rust writes and WGSL reads, declared once in Rust and emitted as WGSL.

use std::fmt::Write as _;

/// The WGSL type of a field.
pub trait WgslType {
    /// Its name.
    fn name() -> String;
}

macro_rules! wgsl_types {
    ($($rust:ty => $wgsl:literal),* $(,)?) => {
        $(impl WgslType for $rust {
            fn name() -> String {
                $wgsl.to_owned()
            }
        })*
    };
}

wgsl_types!(u32 => "u32", f32 => "f32", [u32; 2] => "vec2<u32>", [u32; 4] => "vec4<u32>", [f32; 2] => "vec2<f32>", [f32; 4] => "vec4<f32>");

impl<const COUNT: usize> WgslType for [[f32; 4]; COUNT] {
    fn name() -> String {
        format!("array<vec4<f32>, {COUNT}>")
    }
}

impl<const COUNT: usize, const ROWS: usize> WgslType for [[[f32; 4]; COUNT]; ROWS] {
    fn name() -> String {
        format!("array<array<vec4<f32>, {COUNT}>, {ROWS}>")
    }
}

/// A struct that a buffer holds.
pub trait SharedStruct {
    /// Its declaration in WGSL. A test holds its layout, by naga, against Rust's.
    fn wgsl() -> String;
    /// Name and offset in bytes of every field, as Rust has them.
    fn fields() -> Vec<(&'static str, usize)>;
}

/// Declares a struct for Rust and WGSL alike.
macro_rules! shared_struct {
    ($(#[$meta:meta])* pub struct $name:ident { $($(#[$field_meta:meta])* pub $field:ident: $type:ty,)* }) => {
        $(#[$meta])*
        #[repr(C)]
        #[derive(Debug, Clone, Copy, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
        pub struct $name {
            $($(#[$field_meta])* pub $field: $type,)*
        }

        impl $crate::shader::shared::SharedStruct for $name {
            fn wgsl() -> String {
                $crate::shader::shared::declare(
                    stringify!($name),
                    &[$((stringify!($field), <$type as $crate::shader::shared::WgslType>::name())),*],
                )
            }

            fn fields() -> Vec<(&'static str, usize)> {
                vec![$((stringify!($field), std::mem::offset_of!($name, $field))),*]
            }
        }
    };
}
pub(crate) use shared_struct;

/// A struct's declaration in WGSL.
pub fn declare(name: &str, fields: &[(&str, String)]) -> String {
    let mut text = format!("struct {name} {{\n");
    for (field, kind) in fields {
        let _ = writeln!(text, "    {field}: {kind},");
    }
    text + "}\n"
}

/// The value of a constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Constant {
    U32(u32),
    F32(f32),
}

/// Constants under the names that WGSL has for them.
pub type Constants = Vec<(&'static str, Constant)>;

/// Declares an enum of numbers for Rust, and its values as constants for WGSL: `Variant = 3 as NAME_IN_WGSL`.
macro_rules! shared_kinds {
    ($(#[$meta:meta])* $visibility:vis enum $name:ident { $($(#[$variant_meta:meta])* $variant:ident = $value:literal as $wgsl:ident,)* }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u32)]
        $visibility enum $name {
            $($(#[$variant_meta])* $variant = $value,)*
        }

        impl $name {
            /// Every kind as a constant of WGSL.
            pub fn constants() -> $crate::shader::shared::Constants {
                vec![$((stringify!($wgsl), $crate::shader::shared::Constant::U32($value))),*]
            }
        }
    };
}
pub(crate) use shared_kinds;

/// Declares constants for Rust, and lists them for WGSL under the same names: `const NAME: u32 = 3;`.
macro_rules! shared_constants {
    ($list:ident { $($(#[$meta:meta])* $visibility:vis const $name:ident: $type:ident = $value:expr;)* }) => {
        $($(#[$meta])* $visibility const $name: $type = $value;)*

        /// The constants above, for WGSL.
        pub fn $list() -> $crate::shader::shared::Constants {
            vec![$((stringify!($name), $crate::shader::shared::Constant::from($name))),*]
        }
    };
}
pub(crate) use shared_constants;

impl From<u32> for Constant {
    fn from(value: u32) -> Self {
        Self::U32(value)
    }
}

impl From<f32> for Constant {
    fn from(value: f32) -> Self {
        Self::F32(value)
    }
}

/// A constant's declaration in WGSL, in digits that read back as the same number.
pub fn declare_constant(name: &str, value: Constant) -> String {
    match value {
        Constant::U32(value) => format!("const {name}: u32 = {value}u;\n"),
        Constant::F32(value) => format!("const {name}: f32 = {value:?}f;\n"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    shared_struct! {
        /// For the test.
        pub struct Pair {
            pub first: [f32; 4],
            pub second: [u32; 2],
            pub third: [u32; 2],
        }
    }

    #[test]
    fn a_struct_is_declared_for_both() {
        assert_eq!(Pair::wgsl(), "struct Pair {\n    first: vec4<f32>,\n    second: vec2<u32>,\n    third: vec2<u32>,\n}\n");
        assert_eq!(Pair::fields(), [("first", 0), ("second", 16), ("third", 24)]);
    }

    #[test]
    fn constants_keep_their_digits() {
        assert_eq!(declare_constant("A", Constant::U32(u32::MAX)), "const A: u32 = 4294967295u;\n");
        assert_eq!(declare_constant("B", Constant::F32(1.0e-4)), "const B: f32 = 0.0001f;\n");
    }
}
