//! The table that all representations of materials hang on, and the kinds of lobes that it lists.

/// Index into [`crate::scene::Scene::materials`].
pub type MaterialId = usize;

/// The table of materials, one row each:
///
/// - the variant of [`MaterialKind`] with its parameters, those of which that hold numbers change from keyframe to keyframe;
/// - its type in scene files, which is also the name of its module in `load::file::material`;
/// - the lobes that it scatters by, each with its variant of [`LobeKind`] and type in `reference::bsdf`, the name of its files there
///   and in `shaders/shading/bsdf/`, the name of its number and of its switch in shaders, its [`LobeSupport`]; in parentheses, which slots of
///   [`LobeParameters`] hold which parameters, unless `MaterialKind::lobe` says that in words; and in brackets its
///   [parameters](LobeKind::parameters) beyond the slots: name, [`ParameterType`], and in WGSL the default of one that a lobe may go without.
///
/// `material_table!(what)` calls `what!` with all rows. Dispatch and constants elsewhere are made from them; modules are declared where they stand.
#[doc(hidden)]
#[macro_export]
macro_rules! material_table {
    ($what:ident) => {
        $what! {
            /// Lambert: f = ρ/π.
            Diffuse { reflectance: ColorInput } diffuse { Diffuse diffuse DIFFUSE Broad(color0: reflectance) }
            /// Perfect mirror.
            Mirror { reflectance: ColorInput } mirror { Mirror mirror MIRROR Delta(color0: reflectance) }
            /// Cosine-power lobe about the mirror direction: f = ρ (n+2)/(2π) cosⁿα.
            Glossy { reflectance: ColorInput, exponent: ColorInput } glossy {
                Glossy glossy GLOSSY Hemisphere(color0: reflectance, roughness: exponent)
            }
            /// Modified Phong (Lafortune and Willems 1994).
            Phong { diffuse: ColorInput, specular: ColorInput, exponent: ColorInput } phong {
                Phong phong PHONG Hemisphere(color0: diffuse, color1: specular, roughness: exponent)
            }
            /// Facets that Lambert's law holds for each, by Oren and Nayar (1994) or after them.
            OrenNayar { reflectance: ColorInput, roughness: ColorInput, model: RoughDiffuseModel } oren_nayar {
                OrenNayar oren_nayar OREN_NAYAR Broad
                QualitativeOrenNayar qualitative_oren_nayar QUALITATIVE_OREN_NAYAR Broad
                EnergyPreservingOrenNayar energy_preserving_oren_nayar ENERGY_PRESERVING_OREN_NAYAR Broad
            }
            /// A thin layer of particles that scatter light once (Blinn 1982), above a Lambert surface of reflectance `base`. `albedo` is the share of light that a
            /// particle scatters, `thickness` the optical one along the normal, and `anisotropy` the mean cosine of Henyey and Greenstein's phase function.
            Dust { albedo: ColorInput, thickness: ColorInput, anisotropy: f64, base: ColorInput } dust {
                Dust dust DUST Broad(color0: albedo, color1: base, roughness: thickness) [anisotropy: SignedScalar]
            }
            /// A sheet that Lambert's law holds for on both sides: f = ρ/π for light from the side that is seen, τ/π for light from the other one.
            /// A sum ρ + τ of more than 1 divides both.
            DiffuseTransmission { reflectance: ColorInput, transmittance: ColorInput } diffuse_transmission {
                DiffuseTransmission diffuse_transmission DIFFUSE_TRANSMISSION Sphere(color0: reflectance, color1: transmittance)
            }
            /// Smooth dielectric with exact Fresnel equations. `ior` is inside over outside, the outside being where the normal points; a `thin` one
            /// is a plate of both boundaries, which light crosses without changing its direction. Glass with a `film`, or of which `dispersion` says how `ior`, the
            /// index at the line d, depends on the wavelength, is not `thin`.
            Glass {
                ior: f64,
                reflectance: ColorInput,
                transmittance: ColorInput,
                thin: bool,
                film: Option<ThinFilm>,
                dispersion: Option<Dispersion>,
            } glass {
                Glass glass GLASS Delta
                ThinGlass thin_glass THIN_GLASS Delta
                SpectralGlass spectral_glass SPECTRAL_GLASS Delta [
                    iors: Color, thin_film_thickness: Scalar = "0.0", thin_film: Vector = "vec3<f32>(1.0, 0.0, 0.0)"
                ]
            }
            /// Rough dielectric; of a `thin` one every microfacet is a thin plate. Glass with a `film` or `dispersion` is not `thin`, nor of
            /// Phong's distribution.
            RoughGlass {
                ior: f64,
                facets: Microfacets,
                reflectance: ColorInput,
                transmittance: ColorInput,
                thin: bool,
                film: Option<ThinFilm>,
                dispersion: Option<Dispersion>,
            } rough_glass {
                RoughGlass rough_glass ROUGH_GLASS Sphere [width_across: Scalar = "lobe.roughness"]
                PhongGlass phong_glass PHONG_GLASS Sphere
                RoughThinGlass rough_thin_glass ROUGH_THIN_GLASS Sphere [width_across: Scalar = "lobe.roughness"]
                RoughSpectralGlass rough_spectral_glass ROUGH_SPECTRAL_GLASS Sphere [
                    iors: Color, width_across: Scalar = "lobe.roughness",
                    thin_film_thickness: Scalar = "0.0", thin_film: Vector = "vec3<f32>(1.0, 0.0, 0.0)"
                ]
            }
            /// A diffuse base below a dielectric surface; `nonlinear` takes account of how the colour deepens as light goes up and down within.
            Plastic { interface: PlasticInterface, reflectance: ColorInput, specular_reflectance: ColorInput, nonlinear: bool } plastic {
                Plastic plastic PLASTIC Broad [internal_reflectance: Scalar]
                RoughPlastic rough_plastic ROUGH_PLASTIC Broad [internal_reflectance: Scalar]
            }
            /// Conductor of microfacets, smooth where their width is 0. What it reflects is multiplied by `specular_reflectance`.
            Conductor { fresnel: ConductorFresnel, facets: Microfacets, specular_reflectance: ColorInput, film: Option<ThinFilm> } conductor {
                Conductor conductor CONDUCTOR Hemisphere [
                    width_across: Scalar = "lobe.roughness", specular_reflectance: Color = "WHITE",
                    thin_film_thickness: Scalar = "0.0", thin_film: Vector = "vec3<f32>(1.0, 0.0, 0.0)"
                ]
            }
            /// The material of glTF 2.0's Appendix B.
            Principled(principled: Box<Principled>) principled {
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
            /// Reflects nothing; what it emits is the material's `emission`.
            Emissive emissive {}
            /// w0·first + (1 − w0)·second.
            Blend { materials: [MaterialId; 2], weight: BlendWeight } blend {}
            /// Interfaces one above the other, and what lies between them.
            Layered(layers: Box<LayerStack>) layered {}
            /// The ray goes on as if nothing were there.
            Pass pass { Null null NULL_SURFACES Delta() }
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
    /// That side, in all directions and mostly evenly: a guide may take the place of its samples.
    Broad,
    /// Both sides.
    Sphere,
}

/// The columns of the table of materials about lobes.
macro_rules! lobes {
    ($($(#[$doc:meta])* $material:ident $(($($boxed:tt)*))? $({$($fields:tt)*})? $type_name:ident { $($lobe:ident $file:ident $number:ident $support:ident $(($($slots:tt)*))? $([$($parameters:tt)*])?)* })*) => {
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
