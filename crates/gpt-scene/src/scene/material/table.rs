//! The table that all representations of materials hang on, and the kinds of lobes that it lists.

/// Index into [`crate::scene::Scene::materials`].
pub type MaterialId = usize;

/// The table of materials, one row each:
///
/// - the variant of [`MaterialKind`];
/// - its type in scene files, which is also the name of its module in `load::file::material`;
/// - the lobes that it scatters by, each with its variant of [`LobeKind`] and type in `reference::bsdf`, the name of its files there
///   and in `shaders/shading/bsdf/`, the name of its number and of its switch in shaders, its [`LobeSupport`],
///   and its [parameters](LobeKind::parameters) beyond the slots of [`LobeParameters`]: name,
///   [`ParameterType`], and in WGSL the default of one that a lobe may go without.
///
/// `material_table!(what)` calls `what!` with all rows. Dispatch and constants elsewhere are made from them; modules are declared where they stand.
#[doc(hidden)]
#[macro_export]
macro_rules! material_table {
    ($what:ident) => {
        $what! {
            Diffuse diffuse { Diffuse diffuse DIFFUSE Hemisphere }
            Mirror mirror { Mirror mirror MIRROR Delta }
            Glossy glossy { Glossy glossy GLOSSY Hemisphere }
            Phong phong { Phong phong PHONG Hemisphere }
            OrenNayar oren_nayar {
                OrenNayar oren_nayar OREN_NAYAR Hemisphere
                QualitativeOrenNayar qualitative_oren_nayar QUALITATIVE_OREN_NAYAR Hemisphere
                EnergyPreservingOrenNayar energy_preserving_oren_nayar ENERGY_PRESERVING_OREN_NAYAR Hemisphere
            }
            Dust dust { Dust dust DUST Hemisphere [anisotropy: SignedScalar] }
            DiffuseTransmission diffuse_transmission { DiffuseTransmission diffuse_transmission DIFFUSE_TRANSMISSION Sphere }
            Glass glass {
                Glass glass GLASS Delta
                ThinGlass thin_glass THIN_GLASS Delta
                SpectralGlass spectral_glass SPECTRAL_GLASS Delta [
                    iors: Color, thin_film_thickness: Scalar = "0.0", thin_film: Vector = "vec3<f32>(1.0, 0.0, 0.0)"
                ]
            }
            RoughGlass rough_glass {
                RoughGlass rough_glass ROUGH_GLASS Sphere [width_across: Scalar = "lobe.roughness"]
                PhongGlass phong_glass PHONG_GLASS Sphere
                RoughThinGlass rough_thin_glass ROUGH_THIN_GLASS Sphere [width_across: Scalar = "lobe.roughness"]
                RoughSpectralGlass rough_spectral_glass ROUGH_SPECTRAL_GLASS Sphere [
                    iors: Color, width_across: Scalar = "lobe.roughness",
                    thin_film_thickness: Scalar = "0.0", thin_film: Vector = "vec3<f32>(1.0, 0.0, 0.0)"
                ]
            }
            Plastic plastic {
                Plastic plastic PLASTIC Hemisphere [internal_reflectance: Scalar]
                RoughPlastic rough_plastic ROUGH_PLASTIC Hemisphere [internal_reflectance: Scalar]
            }
            Conductor conductor {
                Conductor conductor CONDUCTOR Hemisphere [
                    width_across: Scalar = "lobe.roughness", specular_reflectance: Color = "WHITE",
                    thin_film_thickness: Scalar = "0.0", thin_film: Vector = "vec3<f32>(1.0, 0.0, 0.0)"
                ]
            }
            Principled principled {
                Principled principled PRINCIPLED Sphere [
                    metallic: Scalar, specular: Scalar, transmission: Scalar, coat: Scalar, coat_roughness: Scalar,
                    anisotropy: Scalar, rotation: Vector,
                    sheen_color: Color = "BLACK", sheen_roughness: Scalar = "0.0",
                    coat_texel: Vector = "vec3<f32>(0.0)", coat_scale: SignedScalar = "0.0",
                    direction_texel: Vector = "vec3<f32>(0.0)",
                    diffuse_transmission: Scalar = "0.0", diffuse_transmission_color: Color = "BLACK",
                    thin_film_share: Scalar = "0.0",
                    thin_film_thickness: Scalar = "0.0", thin_film: Vector = "vec3<f32>(1.0, 0.0, 0.0)",
                    iors: Color = "Spectrum(lobe.ior)"
                ]
            }
            Emissive emissive {}
            Blend blend {}
            Layered layered {}
            Pass pass { Null null NULL_SURFACES Delta }
        }
    };
}
#[doc(hidden)]
pub use material_table;

/// The directions that a lobe scatters into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LobeSupport {
    /// Single directions, which no light sample finds.
    Delta,
    /// The side of the surface that light leaves from.
    Hemisphere,
    /// Both sides.
    Sphere,
}

/// The columns of the table of materials about lobes.
macro_rules! lobes {
    ($($material:ident $type_name:ident { $($lobe:ident $file:ident $number:ident $support:ident $([$($parameters:tt)*])?)* })*) => {
        /// The ways to scatter light that materials are made of.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u32)]
        pub enum LobeKind { $($($lobe,)*)* }

        impl LobeKind {
            /// In the order of their numbers.
            pub const ALL: &'static [Self] = &[$($(Self::$lobe,)*)*];

            /// The name of the lobe's file in `shaders/shading/bsdf/`, and in the names of the functions there.
            pub fn file(self) -> &'static str {
                match self { $($(Self::$lobe => stringify!($file),)*)* }
            }

            /// The name of its number in shaders, and of the switch that compiles it.
            pub fn switch(self) -> &'static str {
                match self { $($(Self::$lobe => stringify!($number),)*)* }
            }

            /// The directions that it scatters into.
            pub fn support(self) -> LobeSupport {
                match self { $($(Self::$lobe => LobeSupport::$support,)*)* }
            }
        }
    };
}
material_table!(lobes);
