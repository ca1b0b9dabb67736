//! An interface with any finish: facets of either shape, a thin film, and the light that single scattering loses.

use super::albedo::Albedo;
use super::coating::Coating;
use super::contract::{BsdfSample, Lobe, Lobes, Mode, Side};
use super::dielectric::{Dielectric, radiance_scale};
use super::interface::Interface;
use super::specimen::{Claims, Energy, Specimen};
use crate::math::{LocalDir, Vec2, Vec3};
use crate::optics::compensation::{Coverage, Half, LossTable, Position, Split};
use crate::optics::fresnel::{self, Crossing};
use crate::optics::{Distribution, FacetShape, Microfacets, refraction};
use crate::spectrum::{LANES, Sampled};
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};
use std::f32::consts::FRAC_1_PI;

/// An interface between transparent media with a finish that [`Dielectric`] lacks.
///
/// Under a film the reflectance differs between wavelengths: the side is chosen by its mean, and each wavelength has its
/// own weight. Without contrast of the media only discrete directions are scattered into, as if it were smooth.
#[derive(Clone, Copy, Debug)]
pub struct FinishedDielectric<'a> {
    interface: Dielectric<Microfacets>,
    coating: Option<Coating>,
    compensation: Option<Compensation<'a>>,
}

/// The lobes of light that met more than one facet; see [`Split`].
#[derive(Clone, Copy, Debug)]
struct Compensation<'a> {
    table: &'a LossTable,
    at: [Position; LANES],
}

/// Value and density of a pair of directions.
struct Evaluation {
    f: Sampled<PerSteradian>,
    pdf: f32,
}

/// A lobe of light that met more than one facet.
struct Further {
    /// f [sr⁻¹] for importance.
    f: Sampled<Unitless>,
    /// What it gets of the light, averaged over the lanes: the probability of drawing from it.
    probability: f32,
}

impl<'a> FinishedDielectric<'a> {
    /// An interface, a film on it, and a table of what it loses; without the table this is lost. With a film, the table is
    /// over the wavenumber [nm⁻¹], else over the index.
    pub fn new(
        interface: Dielectric<Microfacets>,
        coating: Option<Coating>,
        losses: Option<&'a LossTable>,
    ) -> Self {
        let mut finished = Self { interface, coating, compensation: None };
        if let Some(table) = losses
            && !interface.is_specular()
        {
            let position = |lane| table.position(&interface.roughness, finished.coordinate(lane));
            let at = if coating.is_some() { std::array::from_fn(position) } else { [position(0); LANES] };
            finished.compensation = Some(Compensation { table, at });
        }
        finished
    }

    /// f [sr⁻¹]; over η² for radiance through the interface.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        self.evaluate(wo, wi, mode).map_or(Sampled::ZERO, |e| e.f)
    }

    /// Density of [`FinishedDielectric::sample`]; zero where the interface is smooth.
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        // The density does not depend on what is transported.
        PdfSolidAngle(self.evaluate(wo, wi, Mode::Importance).map_or(0.0, |e| e.pdf))
    }

    /// A direction mirrored or refracted at a visible microfacet, or for light that met several one of a wide lobe on
    /// either side; `None` when the former falls to the wrong side.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        if self.interface.is_specular() {
            return self.sample_specular(wo, uc, mode);
        }
        let (wi, side, eta) = self.choose(wo, uc, u)?;
        if wo.same_hemisphere(wi) != (side == Side::Reflection) {
            return None;
        }
        let e = self.evaluate(wo, wi, mode)?;
        let density = PdfSolidAngle(e.pdf);
        // Value and density share the distribution of facets, which cancels to rounding.
        (e.pdf > 0.0).then(|| BsdfSample {
            wi,
            weight: e.f.weight(wi.abs_cos_theta(), density),
            density: Density::SolidAngle(density),
            side,
            lobe: Lobe::Glossy,
            eta,
        })
    }

    /// ρ and τ for light from `wi` where only discrete directions are scattered into.
    pub fn albedo(&self, wi: LocalDir) -> Option<Albedo> {
        self.interface.is_specular().then(|| {
            let reflectance = self.reflectance(wi.z);
            Albedo { reflectance, transmittance: reflectance.map(|r| (1.0 - r).max(0.0)) }
        })
    }

    /// The bare interface that light meets first; `None` under a film.
    pub fn interface(&self) -> Option<Interface> {
        self.coating.is_none().then(|| Interface::clear(self.interface.eta))
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        self.interface.lobes()
    }

    /// Widens a narrow lobe: a named bias against fireflies. What single scattering by the wider lobe loses stays lost.
    pub fn regularize(&mut self) {
        self.interface.regularize();
        self.compensation = None;
    }

    /// What holds for it: nothing is lost if it is smooth or compensated for.
    pub fn claims(&self) -> Claims {
        if self.interface.is_specular() {
            return Claims::LOSSLESS;
        }
        let covered = |c: Compensation<'_>| {
            (0..LANES).all(|i| c.table.covers(&self.interface.roughness, self.coordinate(i)))
        };
        if self.compensation.is_some_and(covered) {
            Claims::CLOSED_FORM.with_energy(Energy::Lossless { tolerance: 0.01 })
        } else {
            Claims::CLOSED_FORM
        }
    }

    fn evaluate(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Option<Evaluation> {
        if self.interface.is_specular() || wo.z == 0.0 || wi.z == 0.0 {
            return None;
        }
        let (mut f, mut pdf) = (Sampled::ZERO, 0.0);
        if let Some(met) = self.interface.meet(wo, wi) {
            let share = self.share(met.side, met.thin_cos);
            f = share * met.f;
            pdf = share.mean() * met.pdf;
        }
        if let Some(c) = &self.compensation {
            let further = self.further(c, wo, wi);
            f += further.f;
            pdf = (1.0 - c.loss(wo).mean()) * pdf + further.probability * c.table.lobe_pdf(&c.at[0], wi);
        }
        if wo.z * wi.z < 0.0 {
            f = f * radiance_scale(mode, self.eta_beyond(wo));
        }
        Some(Evaluation { f: f.cast(), pdf })
    }

    /// A direction, the side that it must lie on, and the index that it crosses.
    fn choose(&self, wo: LocalDir, uc: f32, u: Vec2) -> Option<(LocalDir, Side, f32)> {
        let mut uc = uc;
        if let Some(c) = &self.compensation {
            let (reflected, transmitted) =
                (self.further(c, wo, wo).probability, self.further(c, wo, -wo).probability);
            let from = Half::of(wo);
            if uc < reflected {
                return Some((c.table.sample_lobe(&c.at[0], from, u), Side::Reflection, 1.0));
            }
            if uc < reflected + transmitted {
                let wi = c.table.sample_lobe(&c.at[0], from.opposite(), u);
                return Some((wi, Side::Transmission, self.eta_beyond(wo)));
            }
            let p = c.loss(wo).mean();
            uc = (uc - p) / (1.0 - p);
        }
        let wm = self.interface.roughness.sample_visible(wo, u);
        let cos = wo.dot(*wm);
        if uc < self.reflectance(cos).mean() {
            let wi = LocalDir::new_unchecked(refraction::reflect(*wo, *wm));
            return Some((wi, Side::Reflection, 1.0));
        }
        let crossing = Crossing::new(cos, self.interface.eta);
        let wi = LocalDir::new_unchecked(crossing.refract(*wo, *wm)?);
        Some((wi, Side::Transmission, crossing.eta))
    }

    fn sample_specular(&self, wo: LocalDir, uc: f32, mode: Mode) -> Option<BsdfSample> {
        let reflectance = self.reflectance(wo.z);
        let p = reflectance.mean();
        if uc < p {
            return Some(BsdfSample {
                wi: LocalDir::new_unchecked(Vec3::new(-wo.x, -wo.y, wo.z)),
                weight: reflectance / p,
                density: Density::Delta,
                side: Side::Reflection,
                lobe: Lobe::Specular,
                eta: 1.0,
            });
        }
        let crossing = Crossing::new(wo.z, self.interface.eta);
        let transmittance = self.share(Side::Transmission, wo.z);
        Some(BsdfSample {
            wi: LocalDir::new_unchecked(crossing.refract(*wo, Vec3::Z)?),
            weight: transmittance * (radiance_scale(mode, crossing.eta) / (1.0 - p)),
            density: Density::Delta,
            side: Side::Transmission,
            lobe: Lobe::Specular,
            eta: crossing.eta,
        })
    }

    /// The share of light that a facet sends to a side.
    fn share(&self, side: Side, cos: f32) -> Sampled<Unitless> {
        let reflectance = self.reflectance(cos);
        match side {
            Side::Reflection => reflectance,
            Side::Transmission => reflectance.map(|r| (1.0 - r).max(0.0)),
        }
    }

    fn reflectance(&self, cos: f32) -> Sampled<Unitless> {
        match &self.coating {
            None => Sampled::splat(fresnel::dielectric(cos, self.interface.eta)),
            Some(coating) => coating.on_dielectric(cos, self.interface.eta),
        }
    }

    fn eta_beyond(&self, wo: LocalDir) -> f32 {
        if wo.z > 0.0 { self.interface.eta } else { 1.0 / self.interface.eta }
    }

    /// What the table of losses is over, besides directions and roughness.
    fn coordinate(&self, lane: usize) -> f32 {
        self.coating.map_or(self.interface.eta, |c| 1.0 / c.lambda[lane])
    }

    /// The lobe from `wo` to the side of `wi`.
    fn further(&self, c: &Compensation<'_>, wo: LocalDir, wi: LocalDir) -> Further {
        let (from, to) = (Half::of(wo), Half::of(wi));
        let lane = |at: &Position| {
            let table = c.table;
            let (above, below) = (table.mean_loss(at, Half::Above), table.mean_loss(at, Half::Below));
            let t = Split::new(self.interface.eta, table.transmittance(at), above, below).transmitted(from);
            let power = table.loss(at, wo) * if from == to { 1.0 - t } else { t };
            let mean = if to == Half::Above { above } else { below };
            let f = if mean > 0.0 { power * table.loss(at, wi) * FRAC_1_PI / mean } else { 0.0 };
            [f, power]
        };
        if self.coating.is_none() {
            let [f, probability] = lane(&c.at[0]);
            return Further { f: Sampled::splat(f), probability };
        }
        let lanes = c.at.map(|at| lane(&at));
        Further {
            f: Sampled::from_fn(|i| lanes[i][0]),
            probability: Sampled::<Unitless>::from_fn(|i| lanes[i][1]).mean(),
        }
    }
}

impl Compensation<'_> {
    /// The share of light from `w` that single scattering loses.
    fn loss(&self, w: LocalDir) -> Sampled<Unitless> {
        Sampled::from_fn(|i| self.table.loss(&self.at[i], w))
    }
}

/// The tables that specimens refer to.
#[derive(Debug)]
pub struct DielectricTables {
    plain: Vec<LossTable>,
    filmed: LossTable,
}

/// A compensated specimen: its name, index, shape and widths.
type Compensated = (&'static str, f32, FacetShape, f32, f32);

const COMPENSATED: [Compensated; 8] = [
    ("dielectric GGX 0.01, compensated", 1.5, FacetShape::TrowbridgeReitz, 0.01, 0.01),
    ("dielectric GGX 0.5, compensated", 1.5, FacetShape::TrowbridgeReitz, 0.5, 0.5),
    ("dielectric GGX 1, compensated", 1.5, FacetShape::TrowbridgeReitz, 1.0, 1.0),
    ("dielectric GGX 1, less dense, compensated", 0.6, FacetShape::TrowbridgeReitz, 1.0, 1.0),
    ("dielectric GGX brushed, compensated", 1.5, FacetShape::TrowbridgeReitz, 0.2, 0.6),
    ("dielectric Beckmann 0.2, compensated", 2.4, FacetShape::Beckmann, 0.2, 0.2),
    ("dielectric Beckmann 1, compensated", 1.5, FacetShape::Beckmann, 1.0, 1.0),
    ("dielectric Beckmann brushed, compensated", 1.5, FacetShape::Beckmann, 0.6, 0.2),
];

fn interface(eta: f32, shape: FacetShape, x: f32, y: f32) -> Dielectric<Microfacets> {
    Dielectric { eta, roughness: Microfacets::new(shape, x, y) }
}

/// Rough glass under a film.
fn filmed() -> Dielectric<Microfacets> {
    interface(1.5, FacetShape::TrowbridgeReitz, 0.5, 0.5)
}

/// A film that reflects about a sixth, at wavelengths near enough to each other that weights are even: the mean of uneven
/// ones takes more samples than the suite's quick run has.
const FILM: Coating =
    Coating { eta: Sampled::splat(1.9), thickness_nm: 180.0, lambda: [430.0, 445.0, 460.0, 475.0] };

impl Default for DielectricTables {
    fn default() -> Self {
        let plain = COMPENSATED.map(|(_, eta, shape, x, y)| {
            LossTable::interface(Coverage::One(Microfacets::new(shape, x, y)), eta, eta)
        });
        let filmed = filmed();
        let visible = [1.0 / 700.0, 1.0 / 400.0];
        Self {
            plain: plain.into(),
            filmed: LossTable::filmed(
                Coverage::One(filmed.roughness),
                visible,
                FILM.thickness_nm,
                |_| filmed.eta,
                |_| FILM.eta[0],
            ),
        }
    }
}

impl<'a> FinishedDielectric<'a> {
    /// Examples for the conformance suite.
    pub fn specimens(tables: &'a DielectricTables) -> impl Iterator<Item = Specimen<Self>> + use<'a> {
        let lossless = Claims::CLOSED_FORM.with_energy(Energy::Lossless { tolerance: 0.01 });
        let beckmann = |eta, x, y| interface(eta, FacetShape::Beckmann, x, y);
        let smooth = |eta| beckmann(eta, 0.0, 0.0);
        let single = [
            ("dielectric Beckmann 0.01", Claims::CLOSED_FORM, beckmann(1.5, 0.01, 0.01), None),
            ("dielectric Beckmann 0.5", Claims::CLOSED_FORM, beckmann(1.5, 0.5, 0.5), None),
            ("dielectric Beckmann, less dense", Claims::CLOSED_FORM, beckmann(0.7, 0.3, 0.3), None),
            ("dielectric Beckmann brushed", Claims::CLOSED_FORM, beckmann(1.5, 0.2, 0.6), None),
            ("dielectric with film, smooth", Claims::LOSSLESS, smooth(1.5), Some(FILM)),
            ("dielectric with film", Claims::CLOSED_FORM, filmed(), Some(FILM)),
        ]
        .map(|(name, claims, b, film)| Specimen::new(name, claims, Self::new(b, film, None)));
        let compensated =
            COMPENSATED.iter().zip(&tables.plain).map(move |(&(name, eta, shape, x, y), table)| {
                Specimen::new(name, lossless, Self::new(interface(eta, shape, x, y), None, Some(table)))
            });
        let filmed = Self::new(filmed(), Some(FILM), Some(&tables.filmed));
        single.into_iter().chain(compensated).chain([Specimen::new(
            "dielectric with film, compensated",
            lossless,
            filmed,
        )])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::{Bsdf, conformance};
    use crate::math::warp;
    use crate::optics::TrowbridgeReitz;
    use crate::optics::films::{self, Film};

    fn at(degrees: f32) -> LocalDir {
        LocalDir::new_unchecked(warp::spherical_direction(degrees.to_radians(), 0.7))
    }

    /// From above and from below, both at 0°, 30°, 60° and 80°.
    const ANGLES: [f32; 8] = [0.0, 30.0, 60.0, 80.0, 180.0, 150.0, 120.0, 100.0];

    fn assert_lossless(bsdf: FinishedDielectric<'_>, name: &str) {
        assert_eq!(bsdf.claims().energy, Energy::Lossless { tolerance: 0.01 }, "{name}");
        for degrees in ANGLES {
            let total = conformance::albedo(&Bsdf::FinishedDielectric(bsdf), at(degrees), 100_000, 5);
            // Equivalence at 95 %.
            let off = (total.value - 1.0).abs() + 1.96 * total.error;
            assert!(off < 0.01, "{name} {degrees}: {total:?}");
        }
    }

    #[test]
    fn compensated_glass_of_any_roughness_loses_nothing_on_either_side() {
        use FacetShape::{Beckmann, TrowbridgeReitz};
        for (eta, shape, x, y) in [
            (1.5, TrowbridgeReitz, 1.0, 1.0),
            (1.5, TrowbridgeReitz, 0.15, 0.15),
            (0.75, TrowbridgeReitz, 0.6, 0.1),
            (1.5, Beckmann, 1.0, 1.0),
            (2.4, Beckmann, 0.4, 0.4),
        ] {
            let b = interface(eta, shape, x, y);
            let table = LossTable::interface(Coverage::One(b.roughness), eta, eta);
            assert_lossless(
                FinishedDielectric::new(b, None, Some(&table)),
                &format!("{eta} {shape:?} {x} {y}"),
            );
        }
    }

    #[test]
    fn dispersive_and_textured_glass_keeps_its_claim() {
        let table = LossTable::interface(Coverage::Isotropic(FacetShape::TrowbridgeReitz), 1.48, 1.62);
        for (eta, alpha) in [(1.52, 0.3), (1.6, 0.85)] {
            let b = interface(eta, FacetShape::TrowbridgeReitz, alpha, alpha);
            assert_lossless(FinishedDielectric::new(b, None, Some(&table)), &format!("{eta} {alpha}"));
        }
    }

    #[test]
    fn compensated_glass_is_reciprocal_through_the_interface() {
        let b = interface(1.5, FacetShape::TrowbridgeReitz, 0.9, 0.4);
        let table = LossTable::interface(Coverage::One(b.roughness), 1.5, 1.5);
        let glass = FinishedDielectric::new(b, None, Some(&table));
        for (o, i) in [(10.0, 130.0_f32), (80.0, 175.0), (35.0, 95.0), (20.0, 70.0), (170.0, 100.0)] {
            let (wo, wi) =
                (at(o), LocalDir::new_unchecked(warp::spherical_direction(i.to_radians(), 2.0_f32)));
            let eta2 = if wo.z * wi.z < 0.0 { 2.25 } else { 1.0 };
            let there = glass.eval(wo, wi, Mode::Radiance)[0] * eta2;
            let back = glass.eval(wi, wo, Mode::Radiance)[0];
            assert!((there / back - 1.0).abs() < 1e-4, "{o} {i}: {there} {back}");
        }
    }

    #[test]
    fn a_film_of_no_thickness_changes_nothing() {
        let none = Coating { thickness_nm: 0.0, ..FILM };
        let filmed = FinishedDielectric::new(filmed(), Some(none), None);
        let bare = Dielectric { eta: 1.5, roughness: TrowbridgeReitz::new(0.5, 0.5) };
        for (wo, wi) in [(at(10.0), at(60.0)), (at(40.0), at(150.0)), (at(100.0), at(20.0))] {
            let (a, b) = (filmed.eval(wo, wi, Mode::Radiance)[2], bare.eval(wo, wi, Mode::Radiance)[2]);
            assert!((a - b).abs() <= 1e-4 * b, "{a} {b}");
            let (a, b) = (filmed.pdf(wo, wi).0, bare.pdf(wo, wi).0);
            assert!((a - b).abs() <= 1e-4 * b, "{a} {b}");
        }
    }

    #[test]
    fn a_film_between_equal_media_mirrors_or_lets_light_straight_through() {
        let film = FinishedDielectric::new(interface(1.0, FacetShape::Beckmann, 0.2, 0.2), Some(FILM), None);
        assert_eq!((film.claims(), film.lobes().is_continuous()), (Claims::LOSSLESS, false));
        let s = film.sample(at(50.0), 0.999, Vec2::splat(0.5), Mode::Radiance).unwrap();
        assert!((*s.wi + *at(50.0)).length() < 1e-6 && s.density.is_delta(), "{s:?}");
        assert!(film.albedo(at(50.0)).unwrap().reflectance.min() > 0.01);
    }

    #[test]
    fn each_wavelength_of_a_smooth_film_gets_its_own_reflectance() {
        let coating = Coating { lambda: [430.0, 500.0, 590.0, 680.0], ..FILM };
        let bsdf =
            FinishedDielectric::new(interface(1.5, FacetShape::Beckmann, 0.0, 0.0), Some(coating), None);
        let expected = |lane: usize| {
            let film = Film { eta: 1.9, thickness_nm: 180.0 };
            films::reflectance_dielectric(at(40.0).z, film, 1.5, coating.lambda[lane])
        };
        let mean = (0..4).map(expected).sum::<f32>() / 4.0;
        let reflected = bsdf.sample(at(40.0), 0.0, Vec2::splat(0.5), Mode::Importance).unwrap();
        let transmitted = bsdf.sample(at(40.0), 0.999, Vec2::splat(0.5), Mode::Importance).unwrap();
        for lane in 0..4 {
            assert!((reflected.weight[lane] * mean - expected(lane)).abs() < 1e-5);
            assert!((transmitted.weight[lane] * (1.0 - mean) - (1.0 - expected(lane))).abs() < 1e-5);
        }
    }
}
