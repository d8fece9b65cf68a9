//! The layers of the material of glTF 2.0's Appendix B, with its extensions for indices of refraction, specular, transmission, clearcoat, sheen,
//! anisotropy, diffuse transmission and iridescence.

use std::f64::consts::FRAC_1_PI;

use glam::{DVec2, DVec3};

use super::fresnel::{normal_incidence_reflectance, refract, schlick_reflectance};
use super::hemisphere::{hemisphere_pdf, sample_hemisphere};
use super::lookup::Lookup;
use super::microfacet::Facets;
use super::scatter::{BsdfSample, Density, Evaluation};
use super::sheen::Sheen;
use super::thin_film::ThinFilm;
use super::view::View;
use crate::math::Frame;
use crate::reference::intersect::{NormalTexel, UvSet};
use crate::scene::material::principled::{COAT_REFLECTANCE, LEAST_REFLECTED, MOST_REFLECTED, SHEEN_WEIGHT};
use crate::scene::material::{AlbedoTable, DELTA_ALPHA, SMALLEST_BEND, SMALLEST_SHEEN_ROUGHNESS};
use crate::scene::{self, ColorInput, MicrofacetDistribution};
use crate::spectrum::Spectrum;

/// With h the half vector, s = (1 − |wo·h|)⁵, D and G those of GGX, and M = D·G/(4·cosθo·cosθi):
///
/// ```text
/// metal       M · (c + (1 − c)·s)                            c: base colour
/// dielectric  w·F·M + (1 − w·max F) · ((1 − t)·B + t·c·T)   F = f + (1 − f)·s, f = min(((η − 1)/(η + 1))²·k, 1)
/// base        B = (1 − d)·c/π, d·e/π for light from the other side
/// surface     metallic · metal + (1 − metallic) · dielectric
/// sheen       fibres + (1 − max E) · surface                  the fibres and what they take: `Sheen`
/// material    coat·Fc·Mc + (1 − coat·Fc) · sheen              Fc = 0.04 + 0.96·(1 − cosθo)⁵
/// ```
///
/// On a surface with a film, F and c + (1 − c)·s are what it reflects over a base of as much reflectance along the normal, by its share
/// ([`ThinFilm`]). w and k are the specular factor and colour, t is the transmission, d the share of diffuse transmission and e its colour; there h is that of
/// wi mirrored in the surface. T is the microfacets' transmission: of a thin wall M mirrored in the
/// surface, else Walter's refraction. Its h is that of the facet which bends wi to wo; |wo·h| is taken on the side of air, and where a facet
/// reflects totally F is 1. With compensation, M is multiplied by 1 + F0·(1 − E)/E, E the share of light that white microfacets reflect seen at
/// θo, F0 what is reflected along the normal (Turquin 2019): light that one microfacet sends to another then leaves as what is reflected once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrincipledLayers {
    pub base: Spectrum,
    pub metallic: f64,
    pub ior: f64,
    pub specular: f64,
    pub specular_color: Spectrum,
    pub transmission: f64,
    /// The colour by which light goes through.
    pub tint: Spectrum,
    /// Share of the diffuse base that scatters light on, and the colour by which it does.
    pub diffuse_transmission: f64,
    pub diffuse_transmission_color: Spectrum,
    pub thin: bool,
    pub coat: f64,
    pub facets: Facets,
    pub coat_facets: Facets,
    /// The texel of the coat's own normal map.
    pub coat_texel: Option<NormalTexel>,
    /// Direction of the greater width: along the tangent, and across it towards the bitangent. Its length is
    /// 1.
    pub direction: DVec2,
    pub sheen: Sheen,
    /// With the share of the surface that it covers.
    pub film: Option<(ThinFilm, f64)>,
    pub compensates: bool,
}

/// The ways in which light is scattered, and the probability of sampling each.
#[derive(Debug, Clone, Copy)]
pub struct Shares {
    /// The frame of the coat's facets.
    coat_frame: Frame,
    /// Share of all light that the coat leaves to the rest.
    below_coat: f64,
    coat: f64,
    reflection: f64,
    diffuse: f64,
    diffuse_transmission: f64,
    transmission: f64,
}

/// A way in which light is scattered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    Coat,
    Reflection,
    /// By the diffuse base, to wo's side.
    Back,
    /// By the diffuse base, to the other side.
    On,
    Transmission,
}

/// A direction, and the way in which light comes from there.
#[derive(Debug, Clone, Copy)]
pub struct Drawn {
    pub wi: DVec3,
    pub way: Way,
    /// Index of refraction on wi's side over that on wo's side.
    pub eta: f64,
}

/// Lambert's lobes of the dielectric's base, times π: of light from wo's side, and from the other one.
struct DiffuseBase {
    back: Spectrum,
    on: Spectrum,
}

/// Light at a facet.
struct Split {
    /// Reflected.
    reflected: Spectrum,
    /// Share that goes on to the dielectric's base.
    passed: f64,
}

impl PrincipledLayers {
    pub fn of(written: &scene::Principled, lookup: &Lookup) -> Self {
        let alpha = lookup.scalar(&written.roughness).powi(2);
        let strength = written.anisotropy.map_or(0.0, |anisotropy| lookup.scalar(&anisotropy));
        let (distribution, masking) = (MicrofacetDistribution::Ggx, written.masking);
        let isotropic = |alpha: f64| Facets { alpha: DVec2::splat(alpha), distribution, masking, anisotropic: false };
        let mut facets = isotropic(alpha);
        if written.anisotropy.is_some() {
            facets.anisotropic = true;
            facets.alpha.x = alpha + (1.0 - alpha) * strength * strength;
            if facets.alpha.x >= DELTA_ALPHA {
                facets.alpha = facets.alpha.max(DVec2::splat(DELTA_ALPHA));
            }
        }
        let coat_texel = written.coat_normal_map.map(|map| NormalTexel {
            texel: lookup.color(&ColorInput::Texture(map.texture)).to_vector(),
            scale: map.scale,
            set: UvSet::of_directions(&lookup.scene.textures[map.texture]),
        });
        let turned = written.anisotropy_rotation_degrees.to_radians();
        let direction = written.anisotropy_direction.and_then(|map| {
            let texel = lookup.color(&ColorInput::Texture(map)).to_vector().truncate();
            (texel * 2.0 - 1.0).try_normalize()
        });
        Self {
            base: lookup.color(&written.base_color),
            metallic: lookup.scalar(&written.metallic),
            ior: written.ior,
            specular: lookup.scalar(&written.specular),
            specular_color: lookup.color(&written.specular_color),
            transmission: lookup.scalar(&written.let_through()),
            tint: if written.subsurface.is_some() { Spectrum::WHITE } else { lookup.color(&written.base_color) },
            diffuse_transmission: lookup.scalar(&written.diffuse_transmission),
            diffuse_transmission_color: lookup.color(&written.diffuse_transmission_color),
            thin: written.thin,
            coat: lookup.scalar(&written.clearcoat),
            facets,
            coat_facets: isotropic(lookup.scalar(&written.clearcoat_roughness).powi(2)),
            coat_texel,
            direction: DVec2::new(turned.cos(), turned.sin()).rotate(direction.unwrap_or(DVec2::X)),
            sheen: Sheen {
                color: lookup.color(&written.sheen_color),
                roughness: lookup.scalar(&written.sheen_roughness).max(SMALLEST_SHEEN_ROUGHNESS),
            },
            film: ThinFilm::of(written.thin_film.as_ref(), lookup).map(|film| (film, lookup.scalar(&written.thin_film_share))),
            compensates: written.energy_compensation,
        }
    }

    /// Transmitted light goes on as if the wall had no thickness.
    fn is_thin(&self) -> bool {
        self.thin || (self.ior - 1.0).abs() < SMALLEST_BEND
    }

    /// Index of refraction beyond over that on wo's side.
    fn eta_beyond(&self, view: &View) -> f64 {
        if view.front { self.ior } else { 1.0 / self.ior }
    }

    /// The shares of light that a facet reflects and lets through, seen at an angle of the given cosine.
    /// `eta` is 1 where light does not change the medium.
    fn split(&self, cosine: f64, eta: f64) -> Split {
        // On the side of air. None: total reflection.
        let outside = if eta < 1.0 { 1.0 - (1.0 - cosine * cosine) / (eta * eta) } else { cosine * cosine };
        if outside <= 0.0 && eta < 1.0 {
            return Split { reflected: Spectrum::WHITE, passed: 0.0 };
        }
        let outside = outside.max(0.0).sqrt().min(1.0);
        let normal_incidence = (normal_incidence_reflectance(self.ior) * self.specular_color).min(Spectrum::WHITE);
        let dielectric = self.fresnel(outside, normal_incidence) * self.specular;
        let metal = self.fresnel(cosine.min(1.0), self.base);
        let reflected = metal * self.metallic + dielectric * (1.0 - self.metallic);
        Split { reflected, passed: (1.0 - self.metallic) * (1.0 - dielectric.max_component()) }
    }

    /// The share that a layer reflects by its reflectance along the normal: by Schlick's approximation, or as a film on it does.
    fn fresnel(&self, cosine: f64, normal_incidence: Spectrum) -> Spectrum {
        let plain = schlick_reflectance(cosine, normal_incidence);
        match self.film {
            Some((film, share)) => plain.lerp(film.reflectance_over(cosine, normal_incidence), share),
            None => plain,
        }
    }

    /// The ratio of indices that reflection is judged by: 1 where no light comes from within.
    fn eta_of_reflection(&self, view: &View) -> f64 {
        if self.transmission > 0.0 && !self.is_thin() { self.eta_beyond(view) } else { 1.0 }
    }

    /// Light comes from within what the surface encloses.
    fn is_within(&self, view: &View) -> bool {
        !view.front && self.transmission > 0.0 && !self.is_thin()
    }

    /// The coat lies on the outside.
    fn coat_reflectance(&self, view: &View, cosine: f64) -> f64 {
        if self.is_within(view) { 0.0 } else { self.coat * schlick_reflectance(cosine, Spectrum::grey(COAT_REFLECTANCE)).r() }
    }

    /// Share of light that fibres leave to what lies below.
    fn below_sheen(&self, cosine_o: f64, cosine_i: f64) -> f64 {
        1.0 - self.sheen.taken(cosine_o).max(self.sheen.taken(cosine_i))
    }

    /// By how much more is reflected for what microfacets send to each other; nothing where light comes from within or goes there.
    fn compensation(&self, view: &View, cosine: f64) -> Spectrum {
        if !self.compensates || self.eta_of_reflection(view) != 1.0 {
            return Spectrum::WHITE;
        }
        let alpha = self.facets.alpha.min_element();
        let once = AlbedoTable::of_facets(self.facets.masking).at(cosine, alpha.sqrt());
        let normal_incidence = (normal_incidence_reflectance(self.ior) * self.specular_color).min(Spectrum::WHITE);
        let [metal, dielectric] = [self.base, normal_incidence].map(|layer| self.fresnel(1.0, layer));
        let reflected = metal * self.metallic + dielectric * (self.specular * (1.0 - self.metallic));
        Spectrum::WHITE + reflected * ((1.0 - once) / once)
    }

    pub fn shares(&self, view: &View) -> Shares {
        let cosine = view.wo.dot(view.normal()).clamp(0.0, 1.0);
        let eta = self.eta_of_reflection(view);
        let coat_frame = view.coat_frame(self.coat_texel);
        let coat = self.coat_reflectance(view, view.wo.dot(coat_frame.normal).clamp(0.0, 1.0));
        let Split { reflected, passed } = self.split(cosine, eta);
        let possible = if eta < 1.0 { 1.0 } else { self.metallic.max((1.0 - self.metallic) * self.specular) };
        // The fibres stand on the outside, and are sampled as the diffuse base is.
        let taken = if self.is_within(view) { 0.0 } else { self.sheen.taken(cosine) };
        let reflection = reflected.max_component().max(LEAST_REFLECTED * possible) * (1.0 - taken);
        let passed = passed.max((1.0 - self.metallic) * (1.0 - MOST_REFLECTED)) * (1.0 - taken);
        let DiffuseBase { back, on } = self.diffuse_base(view);
        let diffuse = passed * back.max_component() + taken;
        let diffuse_transmission = passed * on.max_component() * eta * eta;
        let transmission = passed * self.transmission * self.tint.max_component();
        let sum = coat + (1.0 - coat) * (reflection + diffuse + diffuse_transmission + transmission);
        let of = |share: f64| if sum > 0.0 { share / sum } else { 0.0 };
        Shares {
            coat_frame,
            below_coat: 1.0 - coat,
            coat: of(coat),
            reflection: of((1.0 - coat) * reflection),
            diffuse: of((1.0 - coat) * diffuse),
            diffuse_transmission: of((1.0 - coat) * diffuse_transmission),
            transmission: of((1.0 - coat) * transmission),
        }
    }

    fn frame(&self, view: &View) -> Frame {
        view.turned_facet_frame(self.facets.anisotropic, self.direction)
    }

    /// D·G2/(4·cosθo) and the density of the reflected direction.
    fn mirror_terms(facets: &Facets, wo: DVec3, wi: DVec3, m: DVec3) -> (f64, f64) {
        let unshadowed = facets.distribution(m) / (4.0 * wo.z);
        (unshadowed * facets.shadowing_masking(wo, wi), unshadowed * facets.masking(wo))
    }

    fn evaluate_reflection(&self, view: &View, wi: DVec3, shares: &Shares) -> Evaluation {
        let frame = self.frame(view);
        let (wo, local) = (frame.to_local(view.wo), frame.to_local(wi));
        let m = (wo + local).normalize();
        let Split { reflected, passed } = self.split(wo.dot(m), self.eta_of_reflection(view));
        let mut value = self.diffuse_base(view).back * (passed * FRAC_1_PI * local.z);
        let mut pdf = shares.diffuse * hemisphere_pdf(view, local.z);
        if !self.facets.are_smooth() {
            let (shadowed, density) = Self::mirror_terms(&self.facets, wo, local, m);
            value += reflected * self.compensation(view, wo.z) * shadowed;
            pdf += shares.reflection * density;
        }
        if !self.sheen.is_none() && !self.is_within(view) {
            value = value * self.below_sheen(wo.z, local.z) + self.sheen.value(wo, local);
        }
        value *= shares.below_coat;
        Evaluation { value, pdf }
    }

    /// The coat reflects light from `wi`, as its own normal and the true surface lie.
    fn coat_reflects(view: &View, wi: DVec3, shares: &Shares) -> bool {
        wi.dot(view.geometric_normal) > 0.0 && wi.dot(shares.coat_frame.normal) > 0.0
    }

    /// Reflection by the coat, from a direction from which it reflects.
    fn evaluate_coat(&self, view: &View, wi: DVec3, shares: &Shares) -> Evaluation {
        if self.coat_facets.are_smooth() || shares.coat <= 0.0 {
            return Evaluation::default();
        }
        let (wo, local) = (shares.coat_frame.to_local(view.wo), shares.coat_frame.to_local(wi));
        let (shadowed, density) = Self::mirror_terms(&self.coat_facets, wo, local, (wo + local).normalize());
        Evaluation { value: Spectrum::grey((1.0 - shares.below_coat) * shadowed), pdf: shares.coat * density }
    }

    /// Directions within the denser medium are η² times as many as those outside that lead there, so there the share 1 − 1/η² of what would be
    /// scattered on comes back: light is kept, and could go the other way.
    fn diffuse_base(&self, view: &View) -> DiffuseBase {
        let eta_squared = self.eta_of_reflection(view).powi(2);
        let share = 1.0 - self.transmission;
        let on = self.diffuse_transmission_color * (share * self.diffuse_transmission);
        let back = self.base * (share * (1.0 - self.diffuse_transmission)) + on * (1.0 - eta_squared).max(0.0);
        DiffuseBase { back, on: on * (1.0 / eta_squared).min(1.0) }
    }

    /// Light from the other side of the surface: what the diffuse base scatters on, and what the microfacets let through.
    fn evaluate_far_side(&self, view: &View, wi: DVec3, shares: &Shares) -> Evaluation {
        let mut sum = self.evaluate_transmission(view, wi, shares).unwrap_or_default();
        if shares.diffuse_transmission > 0.0 {
            let (wo, local) = (view.frame.to_local(view.wo), view.frame.to_local(wi));
            let cosine = -local.z;
            let m = (wo + local.with_z(cosine)).normalize();
            // By the angle within the denser medium from either side, so that light goes both ways alike.
            let eta = self.eta_of_reflection(view);
            let passed = self.split(wo.dot(m), eta.min(1.0 / eta)).passed * self.below_sheen(wo.z, cosine);
            sum.value += self.diffuse_base(view).on * (shares.below_coat * passed * FRAC_1_PI * cosine);
            sum.pdf += shares.diffuse_transmission * hemisphere_pdf(view, cosine);
        }
        sum
    }

    fn evaluate_transmission(&self, view: &View, wi: DVec3, shares: &Shares) -> Option<Evaluation> {
        if self.facets.are_smooth() || shares.transmission == 0.0 {
            return None;
        }
        let frame = self.frame(view);
        let (wo, local) = (frame.to_local(view.wo), frame.to_local(wi));
        let (shadowed, density, cosine, eta) = if self.is_thin() {
            let mirrored = DVec3::new(local.x, local.y, -local.z);
            let m = (wo + mirrored).normalize();
            let (shadowed, density) = Self::mirror_terms(&self.facets, wo, mirrored, m);
            (shadowed, density, wo.dot(m), 1.0)
        } else {
            let eta = self.eta_beyond(view);
            let sum = (wo + local * eta).try_normalize()?;
            let m = if sum.z < 0.0 { -sum } else { sum };
            let (cos_o, cos_i) = (wo.dot(m), local.dot(m));
            if cos_o <= 0.0 || cos_i >= 0.0 {
                return None;
            }
            let common = self.facets.distribution(m) * cos_o * -cos_i / (wo.z * (cos_o + eta * cos_i).powi(2));
            let shadowed = common * self.facets.shadowing_masking(wo, local);
            (shadowed, common * self.facets.masking(wo) * eta * eta, cos_o, eta)
        };
        let passed = self.split(cosine, eta).passed * self.below_sheen(wo.z, -local.z);
        let value = self.tint * (shares.below_coat * passed * self.transmission * shadowed);
        Some(Evaluation { value, pdf: shares.transmission * density })
    }

    /// A direction of the microfacets' transmission.
    fn transmitted(&self, view: &View, u1: f64, u2: f64) -> Option<DVec3> {
        let frame = self.frame(view);
        let wo = frame.to_local(view.wo);
        let m = self.facets.sample_visible(wo, u1, u2);
        let local = if self.is_thin() {
            let mirrored = m * (2.0 * wo.dot(m)) - wo;
            DVec3::new(mirrored.x, mirrored.y, -mirrored.z)
        } else {
            refract(wo, m, self.eta_beyond(view))?
        };
        Some(frame.to_world(local).normalize())
    }

    /// About what is reflected, and let through, seen along the normal.
    pub fn sampling_weight(&self) -> f64 {
        let Split { reflected, passed } = self.split(1.0, 1.0);
        let coat = 0.04 * self.coat;
        let scattered_on = (1.0 - self.transmission) * self.diffuse_transmission;
        let base = self.base * (1.0 - scattered_on) + self.diffuse_transmission_color * scattered_on;
        coat + (1.0 - coat) * (reflected + base * passed).max_component() + SHEEN_WEIGHT * self.sheen.color.max_component()
    }

    /// The share of reflection by the diffuse layer in [`PrincipledLayers::sampling_weight`], about: that of samples which go in all
    /// directions above the surface.
    pub fn broad_share(&self) -> f64 {
        let share = (1.0 - self.metallic) * (1.0 - self.transmission) * (1.0 - self.diffuse_transmission);
        let weight = self.sampling_weight();
        if weight > 0.0 { (share * self.base.max_component() / weight).min(1.0) } else { 0.0 }
    }

    pub fn is_delta(&self) -> bool {
        let on = self.diffuse_transmission_color * self.diffuse_transmission;
        let strongest = (self.base * (1.0 - self.diffuse_transmission)).max(on).max_component();
        let diffuse = (1.0 - self.metallic) * (1.0 - self.transmission) * strongest;
        self.facets.are_smooth() && diffuse == 0.0 && self.sheen.is_none() && (self.coat == 0.0 || self.coat_facets.are_smooth())
    }

    pub fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        self.evaluate_by(view, wi, &self.shares(view))
    }

    /// With shares that are known.
    pub fn evaluate_by(&self, view: &View, wi: DVec3, shares: &Shares) -> Evaluation {
        let below = if view.reflects(wi) {
            self.evaluate_reflection(view, wi, shares)
        } else if view.transmits(wi) {
            self.evaluate_far_side(view, wi, shares)
        } else {
            Evaluation::default()
        };
        if !Self::coat_reflects(view, wi, shares) {
            return below;
        }
        let coat = self.evaluate_coat(view, wi, shares);
        Evaluation { value: below.value + coat.value, pdf: below.pdf + coat.pdf }
    }

    /// The facets that send light this way cannot be told from a smooth surface: there is one direction.
    pub fn is_smooth(&self, way: Way) -> bool {
        match way {
            Way::Coat => self.coat_facets.are_smooth(),
            Way::Reflection | Way::Transmission => self.facets.are_smooth(),
            Way::Back | Way::On => false,
        }
    }

    /// A direction that light comes from, drawn by the shares. None where none is possible.
    pub fn draw(&self, view: &View, shares: &Shares, u_lobe: f64, u1: f64, u2: f64) -> Option<Drawn> {
        let below_reflection = shares.coat + shares.reflection;
        let below_diffuse = below_reflection + shares.diffuse;
        let below_diffuse_transmission = below_diffuse + shares.diffuse_transmission;
        let far_side = shares.diffuse_transmission + shares.transmission;
        let way = if u_lobe < shares.coat {
            Way::Coat
        } else if u_lobe < below_reflection {
            Way::Reflection
        } else if u_lobe < below_diffuse || far_side == 0.0 {
            Way::Back
        } else if u_lobe < below_diffuse_transmission || shares.transmission == 0.0 {
            Way::On
        } else {
            Way::Transmission
        };
        let is_smooth = self.is_smooth(way);
        let wi = match way {
            Way::Coat if is_smooth => view.mirrored_about(shares.coat_frame.normal),
            Way::Coat => reflected(&self.coat_facets, &shares.coat_frame, view, u1, u2),
            Way::Reflection if is_smooth => view.mirrored(),
            Way::Reflection => reflected(&self.facets, &self.frame(view), view, u1, u2),
            Way::Back => view.frame.to_world(sample_hemisphere(view, u1, u2)),
            Way::On => {
                let local = sample_hemisphere(view, u1, u2);
                view.frame.to_world(local.with_z(-local.z))
            }
            Way::Transmission if is_smooth && self.is_thin() => -view.wo,
            Way::Transmission if is_smooth => refract(view.wo, view.normal(), self.eta_beyond(view))?,
            Way::Transmission => self.transmitted(view, u1, u2)?,
        };
        // A facet that is seen from the other side would be taken for the other way.
        let leaves_as_drawn = match way {
            Way::Coat => Self::coat_reflects(view, wi, shares),
            Way::Reflection | Way::Back => view.reflects(wi),
            Way::Transmission if is_smooth && self.is_thin() => true,
            Way::On | Way::Transmission => view.transmits(wi),
        };
        let enters = matches!(way, Way::On | Way::Transmission) && !self.is_thin() && self.transmission > 0.0;
        let eta = if enters { self.eta_beyond(view) } else { 1.0 };
        leaves_as_drawn.then_some(Drawn { wi, way, eta })
    }

    /// The part of light that comes this one way from a single direction, and the probability of the way.
    pub fn of_smooth(&self, view: &View, shares: &Shares, Drawn { wi, way, eta }: Drawn) -> (Spectrum, f64) {
        let cosine = view.wo.dot(view.normal());
        match way {
            Way::Coat => (Spectrum::grey(1.0 - shares.below_coat), shares.coat),
            Way::Reflection => {
                let reflected = self.split(cosine, self.eta_of_reflection(view)).reflected;
                let below_sheen = if self.is_within(view) { 1.0 } else { self.below_sheen(cosine, cosine) };
                (reflected * (shares.below_coat * below_sheen), shares.reflection)
            }
            Way::Transmission => {
                let passed = self.split(cosine, eta).passed * self.below_sheen(cosine, wi.dot(view.normal()).abs());
                (self.tint * (shares.below_coat * passed * self.transmission / (eta * eta)), shares.transmission)
            }
            Way::Back | Way::On => unreachable!("the diffuse base has no single directions"),
        }
    }

    pub fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let shares = self.shares(view);
        let drawn = self.draw(view, &shares, u_lobe, u1, u2)?;
        if self.is_smooth(drawn.way) {
            let (value, probability) = self.of_smooth(view, &shares, drawn);
            return drawn.with_weight(value / probability, Density::Delta);
        }
        let Evaluation { value, pdf } = self.evaluate_by(view, drawn.wi, &shares);
        if pdf > 0.0 { drawn.with_weight(value / pdf, Density::SolidAngle(pdf)) } else { None }
    }
}

impl Drawn {
    /// None where a facet that reflects totally lets nothing through.
    pub fn with_weight(self, weight: Spectrum, density: Density) -> Option<BsdfSample> {
        let is_something = self.way != Way::Transmission || weight.max_component() > 0.0;
        is_something.then_some(BsdfSample { wi: self.wi, weight, density, eta: self.eta, is_null: false })
    }
}

/// The mirror direction of a facet drawn from those that are seen.
fn reflected(facets: &Facets, frame: &Frame, view: &View, u1: f64, u2: f64) -> DVec3 {
    let wo = frame.to_local(view.wo);
    let m = facets.sample_visible(wo, u1, u2);
    frame.to_world(m * (2.0 * wo.dot(m)) - wo).normalize()
}
