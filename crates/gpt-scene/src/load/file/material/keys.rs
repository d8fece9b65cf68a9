//! The contract of every type of material, and the keys that all have.

use super::opacity::Opacity;
use crate::load::error::SceneError;
use crate::load::file::colour::Colour;
use crate::load::file::keyframes::InterpolationName;
use crate::load::file::light_group::LightGroupName;
use crate::load::file::light_link::WrittenLink;
use crate::load::file::reference::TextureName;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, IndexOfRefraction, Located, NonNegative, Number};
use crate::load::file::writer::Writer;
use crate::scene::{ColorInput, Emission, MaterialKind};

/// Meaning of a material's keys.
pub trait MaterialKeys {
    /// Tables without their `name` and `type`, which tests render.
    const EXAMPLES: &'static [&'static str];

    /// How it scatters light.
    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError>;

    /// The keys of this type alone that say the same, a line each; nothing for a material of another type.
    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String;

    /// Emission of the material on its own.
    fn emission(&self, common: &CommonKeys<'_>, resolver: &Resolver<'_>) -> Result<Option<Emission>, SceneError> {
        match (common.emission, common.emission_two_sided) {
            (Some(emission), two_sided) => {
                let two_sided = two_sided.is_some_and(|two_sided| two_sided.value);
                Ok(emission_of(resolver.colour(&emission.value)?, two_sided))
            }
            (None, Some(two_sided)) => Err(resolver.error(&two_sided.place, "`emission_two_sided` needs the key `emission`")),
            (None, None) => Ok(None),
        }
    }

    /// True where the material scatters light on both sides.
    fn two_sided(&self, common: &CommonKeys<'_>, _resolver: &Resolver<'_>) -> Result<bool, SceneError> {
        Ok(common.two_sided.is_none_or(|two_sided| two_sided.value))
    }

    /// Checks what it says of other materials, once all are known.
    fn check_parts(&self, _resolver: &Resolver<'_>) -> Result<(), SceneError> {
        Ok(())
    }
}

/// A material's keys, of which keyframes state some.
pub trait KeyedMaterial: MaterialKeys + Sized {
    type Keyframe: MaterialKeyframe;

    fn keyframes(&self) -> Option<&Located<Vec<Located<Self::Keyframe>>>>;

    fn interpolation(&self) -> Option<&Located<InterpolationName>>;

    /// The keys with those in their place that the keyframe states and that are chosen by their names.
    fn at(&self, keyframe: &Self::Keyframe, chosen: &dyn Fn(&str) -> bool) -> Self;

    /// The keys that every material has.
    fn shared(&self) -> CommonKeys<'_>;
}

/// Keys of a material at a frame.
pub trait MaterialKeyframe {
    /// `frame` and `time`.
    fn times(&self) -> (Option<Number>, Option<Number>);

    /// The names of the keys that it states.
    fn stated(&self) -> Vec<&'static str>;
}

/// None where no light is sent out.
pub fn emission_of(radiance: ColorInput, two_sided: bool) -> Option<Emission> {
    let dark = matches!(radiance, ColorInput::Constant(radiance) if radiance.max_component() == 0.0);
    (!dark).then_some(Emission { radiance, two_sided })
}

/// Index of refraction, that of common glass where none is written.
pub fn ior_or_default(written: Option<Checked<IndexOfRefraction>>) -> f64 {
    written.map_or(1.5, |ior| ior.0)
}

/// The error of a material that does not reflect and yet has the key `emission`.
pub fn only_for_reflecting(emission: &Located<Colour<NonNegative>>, resolver: &Resolver<'_>) -> SceneError {
    let message = "`emission` is for materials that reflect; an emissive one has `radiance`, and pass emits nothing";
    resolver.error(&emission.place, message)
}

/// The keys that every material has.
pub struct CommonKeys<'a> {
    pub name: &'a Located<String>,
    pub normal_map: Option<&'a Located<TextureName>>,
    pub normal_scale: Option<&'a Located<Number>>,
    pub bump_map: Option<&'a Located<TextureName>>,
    pub bump_scale: Option<&'a Located<Number>>,
    pub normal_shadowing: Option<&'a Located<bool>>,
    pub normal_mirroring: Option<&'a Located<bool>>,
    pub emission: Option<&'a Located<Colour<NonNegative>>>,
    pub emission_two_sided: Option<&'a Located<bool>>,
    pub opacity: Option<&'a Located<Opacity>>,
    pub two_sided: Option<&'a Located<bool>>,
    pub interior: Option<&'a Located<String>>,
    pub light_group: Option<&'a Located<LightGroupName>>,
    pub link: WrittenLink<'a>,
}

/// Mutable references to the common keys.
pub struct CommonKeysMut<'a> {
    pub name: &'a mut Located<String>,
    pub normal_map: &'a mut Option<Located<TextureName>>,
    pub normal_scale: &'a mut Option<Located<Number>>,
    pub bump_map: &'a mut Option<Located<TextureName>>,
    pub bump_scale: &'a mut Option<Located<Number>>,
    pub normal_shadowing: &'a mut Option<Located<bool>>,
    pub normal_mirroring: &'a mut Option<Located<bool>>,
    pub emission: &'a mut Option<Located<Colour<NonNegative>>>,
    pub emission_two_sided: &'a mut Option<Located<bool>>,
    pub two_sided: &'a mut Option<Located<bool>>,
    pub interior: &'a mut Option<Located<String>>,
}

/// Declares a material's `Keys`: its own and those that every material has. Serde cannot tell unknown keys from those of a struct within.
/// After `own two_sided`, the key of that name is among its own and means something else.
macro_rules! material_keys {
    (own two_sided $(#[$doc:meta])* { $($fields:tt)* }) => {
        $crate::load::file::material::keys::material_keys!(@struct [$(#[$doc])*] [$($fields)*] []);
    };
    (@struct [$(#[$doc:meta])*] [$($(#[$field_doc:meta])* $field:ident: $type:ty,)*]
     [$($(#[$last_doc:meta])* $last:ident: $last_type:ty,)*]) => {
        #[derive(Debug, Clone, Default, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields, expecting = "a table")]
        #[schemars(extend("dependentRequired" = {
            "emission_two_sided": ["emission"], "normal_scale": ["normal_map"], "bump_scale": ["bump_map"],
            "interpolation": ["keyframes"]
        }))]
        $(#[$doc])*
        pub struct Keys {
            /// Name by which shapes and blends refer to the material.
            #[schemars(extend("minLength" = 1))]
            pub name: $crate::load::file::value::Located<String>,
            $($(#[$field_doc])* pub $field: $type,)*
            /// A texture of tangent-space normals whose color_space is "linear".
            pub normal_map: Option<$crate::load::file::value::Located<$crate::load::file::reference::TextureName>>,
            /// With `normal_map`: multiplies its red and green, after they are taken from 0 to 1 to -1 to 1; 1 when left out.
            pub normal_scale: Option<$crate::load::file::value::Located<$crate::load::file::value::Number>>,
            /// In place of a normal map: a texture of heights, of noise or an image whose color_space is "linear". Meshes, rectangles and boxes can have one.
            pub bump_map: Option<$crate::load::file::value::Located<$crate::load::file::reference::TextureName>>,
            /// With `bump_map`: the height that 1 stands for, in scene units along the normal; 1 when left out.
            pub bump_scale: Option<$crate::load::file::value::Located<$crate::load::file::value::Number>>,
            /// With `normal_map` or `bump_map`: light fades that the surface itself would hide from a normal that is bent towards it.
            pub normal_shadowing: Option<$crate::load::file::value::Located<bool>>,
            /// With `normal_shadowing`: a normal that is bent away from the viewer is mirrored about the surface's own, which takes its place otherwise.
            pub normal_mirroring: Option<$crate::load::file::value::Located<bool>>,
            /// Radiance the surface sends out by itself, besides what it reflects.
            pub emission: Option<$crate::load::file::value::Located<
                $crate::load::file::colour::Colour<$crate::load::file::value::NonNegative>,
            >>,
            /// Emission leaves the front only, unless this is true.
            pub emission_two_sided: Option<$crate::load::file::value::Located<bool>>,
            /// How much of the surface there is: light goes straight through the rest, to shadows too. 1 when left out.
            pub opacity: Option<$crate::load::file::value::Located<$crate::load::file::material::opacity::Opacity>>,
            /// A `[[medium]]` that fills closed shapes of this material: it is behind their fronts.
            pub interior: Option<$crate::load::file::value::Located<String>>,
            /// The light group in which `--aov groups` keeps the material's emission apart; "rest" when left out.
            pub light_group: Option<$crate::load::file::value::Located<$crate::load::file::light_group::LightGroupName>>,
            /// The receivers that surfaces of the material light, by the names that objects give them (`receiver`); all when left out.
            pub lights_only: Option<$crate::load::file::light_link::ReceiverNames>,
            /// In place of `lights_only`: the receivers that surfaces of the material do not light.
            pub lights_all_but: Option<$crate::load::file::light_link::ReceiverNames>,
            /// Keys of the material's own type, and `emission`, at frames (`--frame`, `--frames`, `--time`); without a frame the other keys hold.
            #[schemars(extend("minItems" = 1))]
            pub keyframes: Option<$crate::load::file::value::Located<Vec<$crate::load::file::value::Located<Keyframe>>>>,
            /// How keyframes lead from one to the next; "linear" when left out.
            pub interpolation: Option<$crate::load::file::value::Located<$crate::load::file::keyframes::InterpolationName>>,
            $($(#[$last_doc])* pub $last: $last_type,)*
        }

        /// The material at a frame. Keys that it does not state go through the keyframes that do, or stay as the material has them.
        #[derive(Debug, Clone, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields, expecting = "a table such as { frame = 10, emission = 2 }")]
        #[schemars(inline, extend("oneOf" = [{ "required": ["frame"] }, { "required": ["time"] }], "minProperties" = 2))]
        pub struct Keyframe {
            /// Number of the frame, not necessarily a whole one; or `time`.
            pub frame: Option<$crate::load::file::value::Number>,
            /// Seconds after the start.
            pub time: Option<$crate::load::file::value::Number>,
            $($(#[$field_doc])* pub $field: Option<$type>,)*
            /// Radiance the surface sends out by itself.
            pub emission: Option<$crate::load::file::value::Located<
                $crate::load::file::colour::Colour<$crate::load::file::value::NonNegative>,
            >>,
        }

        impl $crate::load::file::material::keys::MaterialKeyframe for Keyframe {
            fn times(&self) -> (Option<$crate::load::file::value::Number>, Option<$crate::load::file::value::Number>) {
                (self.frame, self.time)
            }

            fn stated(&self) -> Vec<&'static str> {
                let named = [$((stringify!($field), self.$field.is_some()),)* ("emission", self.emission.is_some())];
                named.into_iter().filter(|(_, is_stated)| *is_stated).map(|(name, _)| name).collect()
            }
        }

        impl $crate::load::file::material::keys::KeyedMaterial for Keys {
            type Keyframe = Keyframe;

            fn keyframes(&self) -> Option<&$crate::load::file::value::Located<Vec<$crate::load::file::value::Located<Keyframe>>>> {
                self.keyframes.as_ref()
            }

            fn interpolation(&self) -> Option<&$crate::load::file::value::Located<$crate::load::file::keyframes::InterpolationName>> {
                self.interpolation.as_ref()
            }

            fn at(&self, keyframe: &Keyframe, chosen: &dyn Fn(&str) -> bool) -> Self {
                let mut keys = self.clone();
                $(if let Some(stated) = keyframe.$field.as_ref().filter(|_| chosen(stringify!($field))) {
                    keys.$field = stated.clone();
                })*
                if let Some(stated) = keyframe.emission.as_ref().filter(|_| chosen("emission")) {
                    keys.emission = Some(stated.clone());
                }
                keys
            }

            fn shared(&self) -> $crate::load::file::material::keys::CommonKeys<'_> {
                self.common()
            }
        }

        impl Keys {
            pub fn common(&self) -> $crate::load::file::material::keys::CommonKeys<'_> {
                $crate::load::file::material::keys::CommonKeys {
                    name: &self.name,
                    normal_map: self.normal_map.as_ref(),
                    normal_scale: self.normal_scale.as_ref(),
                    bump_map: self.bump_map.as_ref(),
                    bump_scale: self.bump_scale.as_ref(),
                    normal_shadowing: self.normal_shadowing.as_ref(),
                    normal_mirroring: self.normal_mirroring.as_ref(),
                    emission: self.emission.as_ref(),
                    emission_two_sided: self.emission_two_sided.as_ref(),
                    opacity: self.opacity.as_ref(),
                    two_sided: self.two_sided.as_ref(),
                    interior: self.interior.as_ref(),
                    light_group: self.light_group.as_ref(),
                    link: $crate::load::file::light_link::WrittenLink {
                        only: self.lights_only.as_ref(),
                        all_but: self.lights_all_but.as_ref(),
                    },
                }
            }

            pub fn common_mut(&mut self) -> $crate::load::file::material::keys::CommonKeysMut<'_> {
                $crate::load::file::material::keys::CommonKeysMut {
                    name: &mut self.name,
                    normal_map: &mut self.normal_map,
                    normal_scale: &mut self.normal_scale,
                    bump_map: &mut self.bump_map,
                    bump_scale: &mut self.bump_scale,
                    normal_shadowing: &mut self.normal_shadowing,
                    normal_mirroring: &mut self.normal_mirroring,
                    emission: &mut self.emission,
                    emission_two_sided: &mut self.emission_two_sided,
                    two_sided: &mut self.two_sided,
                    interior: &mut self.interior,
                }
            }

            pub fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
                use $crate::load::file::reference::NamesTextures;
                $(self.$field.each_texture(visit);)*
                self.normal_map.each_texture(visit);
                self.bump_map.each_texture(visit);
                self.emission.each_texture(visit);
                self.opacity.each_texture(visit);
            }
        }
    };
    ($(#[$doc:meta])* { $($fields:tt)* }) => {
        $crate::load::file::material::keys::material_keys!(@struct [$(#[$doc])*] [$($fields)*] [
            /// Both sides scatter light, unless this is false: then the back is black.
            two_sided: Option<$crate::load::file::value::Located<bool>>,
        ]);
    };
}
pub(super) use material_keys;
