//! A metal with any finish: facets of either shape, a thin film, and the light that single scattering loses.

use super::albedo::Albedo;
use super::coating::Coating;
use super::conductor::{self, Conductor};
use super::contract::{BsdfSample, Lobe, Lobes, Side};
use super::interface::Interface;
use super::quadrature::GAUSS_LEGENDRE;
use super::specimen::{Claims, Energy, Specimen};
use crate::math::{LocalDir, Vec2, Vec3};
use crate::optics::compensation::{self, Coverage, Half, LossTable, Position};
use crate::optics::{Distribution, FacetShape, Microfacets, refraction};
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};
use std::f32::consts::FRAC_1_PI;

/// A metal with a finish that [`Conductor`] lacks, alike on both sides of the surface.
#[derive(Clone, Copy, Debug)]
pub struct FinishedConductor<'a> {
    metal: Conductor<Microfacets>,
    coating: Option<Coating>,
    compensation: Option<Compensation<'a>>,
}

/// The lobe of light that met more than one facet: m(ωo) m(ωi) / (π M) of a perfect mirror, and what the metal leaves
/// of it.
#[derive(Clone, Copy, Debug)]
struct Compensation<'a> {
    table: &'a LossTable,
    at: Position,
    mean_loss: f32,
    /// What further reflections leave.
    tint: Sampled<Unitless>,
    /// Hemispherical reflectance, averaged over the lanes.
    reflectance: f32,
}

/// Value and density of a pair of directions.
struct Evaluation {
    f: Sampled<PerSteradian>,
    pdf: f32,
}

impl<'a> FinishedConductor<'a> {
    /// A metal, a film on it, and a table of what a perfect mirror of its roughness loses; without the table this is lost.
    pub fn new(
        metal: Conductor<Microfacets>,
        coating: Option<Coating>,
        losses: Option<&'a LossTable>,
    ) -> Self {
        let mut finished = Self { metal, coating, compensation: None };
        if let Some(table) = losses
            && !metal.roughness.is_smooth()
        {
            let at = table.position(&metal.roughness, 0.0);
            let mean_loss = table.mean_loss(&at, Half::Above);
            let mean = finished.hemispherical_reflectance();
            let tint = mean.map(|f| compensation::further_reflections(f, mean_loss));
            finished.compensation =
                Some(Compensation { table, at, mean_loss, tint, reflectance: mean.mean() });
        }
        finished
    }

    /// f [sr⁻¹]; zero where the metal is smooth.
    pub fn eval(&self, wo: LocalDir, wi: LocalDir) -> Sampled<PerSteradian> {
        self.evaluate(wo, wi).map_or(Sampled::ZERO, |e| e.f)
    }

    /// Density of [`FinishedConductor::sample`]; zero where the metal is smooth.
    pub fn pdf(&self, wo: LocalDir, wi: LocalDir) -> PdfSolidAngle {
        PdfSolidAngle(self.evaluate(wo, wi).map_or(0.0, |e| e.pdf))
    }

    /// A direction mirrored at a visible microfacet, or for light that met several one of a wide lobe; `None` when the
    /// mirrored one falls below the horizon.
    pub fn sample(&self, wo: LocalDir, uc: f32, u: Vec2) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let reflected = |wi, weight, density, lobe| BsdfSample {
            wi,
            weight,
            density,
            side: Side::Reflection,
            lobe,
            eta: 1.0,
        };
        if self.metal.roughness.is_smooth() {
            let wi = LocalDir::new_unchecked(Vec3::new(-wo.x, -wo.y, wo.z));
            return Some(reflected(wi, self.reflectance(wo.z), Density::Delta, Lobe::Specular));
        }
        let wi = match &self.compensation {
            Some(c) if uc < c.probability(wo) => c.table.sample_lobe(&c.at, Half::of(wo), u),
            _ => {
                let wm = self.metal.roughness.sample_visible(wo, u);
                LocalDir::new_unchecked(refraction::reflect(*wo, *wm))
            }
        };
        let e = self.evaluate(wo, wi)?;
        // Value and density share the distribution of facets, which cancels to rounding.
        let density = PdfSolidAngle(e.pdf);
        (e.pdf > 0.0).then(|| {
            let weight = e.f.weight(wi.abs_cos_theta(), density);
            reflected(wi, weight, Density::SolidAngle(density), Lobe::Glossy)
        })
    }

    /// ρ for light from `wi` where the metal is smooth.
    pub fn albedo(&self, wi: LocalDir) -> Option<Albedo> {
        self.metal.roughness.is_smooth().then(|| Albedo::reflecting(self.reflectance(wi.z)))
    }

    /// The bare interface that light meets first; `None` under a film.
    pub fn interface(&self) -> Option<Interface> {
        self.coating.is_none().then_some(Interface { eta: self.metal.eta, k: self.metal.k })
    }

    /// Which lobes are present.
    pub fn lobes(&self) -> Lobes {
        self.metal.lobes()
    }

    /// Widens a narrow lobe: a named bias against fireflies. What single scattering by the wider lobe loses stays lost.
    pub fn regularize(&mut self) {
        self.metal.regularize();
        self.compensation = None;
    }

    /// What holds for it: a perfect mirror loses nothing if it is smooth or compensated for.
    pub fn claims(&self) -> Claims {
        let smooth = self.metal.roughness.is_smooth();
        let compensated = self.compensation.is_some_and(|c| c.table.covers(&self.metal.roughness, 0.0));
        if !(smooth || compensated)
            || !conductor::is_lossless(self.metal.index_size(), |cos| self.reflectance(cos))
        {
            return Claims::CLOSED_FORM;
        }
        if smooth {
            Claims::LOSSLESS
        } else {
            Claims::CLOSED_FORM.with_energy(Energy::Lossless { tolerance: 0.01 })
        }
    }

    fn evaluate(&self, wo: LocalDir, wi: LocalDir) -> Option<Evaluation> {
        let wm = self.metal.halfway(wo, wi)?;
        let single = self.reflectance(wo.dot(*wm)) * self.metal.lossless_value(wo, wi, wm);
        let pdf = self.metal.density(wo, wm);
        let Some(c) = &self.compensation else {
            return Some(Evaluation { f: single.cast(), pdf });
        };
        let p = c.probability(wo);
        let f = single + c.tint * c.value(wo, wi);
        Some(Evaluation { f: f.cast(), pdf: (1.0 - p) * pdf + p * c.table.lobe_pdf(&c.at, wi) })
    }

    fn reflectance(&self, cos: f32) -> Sampled<Unitless> {
        match &self.coating {
            None => self.metal.fresnel(cos),
            Some(coating) => coating.on_conductor(cos, self.metal.eta, self.metal.k),
        }
    }

    /// ∫ 2μ F(μ) dμ.
    fn hemispherical_reflectance(&self) -> Sampled<Unitless> {
        GAUSS_LEGENDRE.iter().fold(Sampled::ZERO, |sum, &[mu, weight]| {
            sum + self.reflectance(mu as f32) * (2.0 * mu * weight) as f32
        })
    }
}

impl Compensation<'_> {
    /// The probability of drawing from this lobe: its share of the power.
    fn probability(&self, wo: LocalDir) -> f32 {
        let loss = self.table.loss(&self.at, wo);
        let further = loss * self.tint.mean();
        let all = further + (1.0 - loss) * self.reflectance;
        if all > 0.0 { further / all } else { 0.0 }
    }

    /// f [sr⁻¹] of a perfect mirror.
    fn value(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        if self.mean_loss == 0.0 {
            return 0.0;
        }
        self.table.loss(&self.at, wo) * self.table.loss(&self.at, wi) * FRAC_1_PI / self.mean_loss
    }
}

/// The tables that specimens refer to.
#[derive(Debug)]
pub struct ConductorTables(Vec<(Microfacets, LossTable)>);

impl Default for ConductorTables {
    fn default() -> Self {
        let table = |d| (d, LossTable::mirror(Coverage::One(d)));
        Self(COMPENSATED.map(|(_, _, shape, x, y)| table(Microfacets::new(shape, x, y))).into())
    }
}

/// What a compensated specimen is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Made {
    /// A perfect mirror.
    Mirror,
    /// Gold.
    Gold,
    /// Gold under an oxide.
    Oxidised,
}

/// A compensated specimen: its name, what it is made of, the shape of its facets and their widths.
type Compensated = (&'static str, Made, FacetShape, f32, f32);

const COMPENSATED: [Compensated; 9] = [
    ("conductor GGX 0.01, compensated", Made::Mirror, FacetShape::TrowbridgeReitz, 0.01, 0.01),
    ("conductor GGX 0.5, compensated", Made::Mirror, FacetShape::TrowbridgeReitz, 0.5, 0.5),
    ("conductor GGX 1, compensated", Made::Mirror, FacetShape::TrowbridgeReitz, 1.0, 1.0),
    ("conductor GGX brushed, compensated", Made::Mirror, FacetShape::TrowbridgeReitz, 0.15, 0.6),
    ("conductor GGX 0.7 gold, compensated", Made::Gold, FacetShape::TrowbridgeReitz, 0.7, 0.7),
    ("conductor Beckmann 0.1, compensated", Made::Mirror, FacetShape::Beckmann, 0.1, 0.1),
    ("conductor Beckmann 1, compensated", Made::Mirror, FacetShape::Beckmann, 1.0, 1.0),
    ("conductor Beckmann brushed, compensated", Made::Mirror, FacetShape::Beckmann, 0.6, 0.15),
    ("conductor with film, compensated", Made::Oxidised, FacetShape::TrowbridgeReitz, 0.4, 0.4),
];

/// An interference colour on metal.
const OXIDE: Coating = Coating {
    eta: Sampled::from_array([2.4, 2.35, 2.3, 2.28]),
    thickness_nm: 120.0,
    lambda: [430.0, 500.0, 590.0, 680.0],
};

fn gold(roughness: Microfacets) -> Conductor<Microfacets> {
    Conductor {
        eta: Sampled::from_array([1.37, 1.46, 0.35, 0.13]),
        k: Sampled::from_array([1.77, 1.95, 2.71, 4.07]),
        roughness,
    }
}

impl<'a> FinishedConductor<'a> {
    /// Examples for the conformance suite.
    pub fn specimens(tables: &'a ConductorTables) -> impl Iterator<Item = Specimen<Self>> + use<'a> {
        let mirror = |roughness| Conductor { eta: Sampled::ZERO, k: Sampled::splat(1e4), roughness };
        let lossless = Claims::CLOSED_FORM.with_energy(Energy::Lossless { tolerance: 0.01 });
        let beckmann = |x, y| Microfacets::new(FacetShape::Beckmann, x, y);
        let plain = [
            ("conductor Beckmann 0.01", beckmann(0.01, 0.01), None),
            ("conductor Beckmann 0.5", beckmann(0.5, 0.5), None),
            ("conductor Beckmann 1", beckmann(1.0, 1.0), None),
            ("conductor Beckmann brushed", beckmann(0.15, 0.6), None),
            ("conductor with film, smooth", Microfacets::SMOOTH, Some(OXIDE)),
            ("conductor with film", Microfacets::new(FacetShape::TrowbridgeReitz, 0.2, 0.2), Some(OXIDE)),
        ]
        .map(|(name, roughness, film)| {
            Specimen::new(name, Claims::CLOSED_FORM, Self::new(gold(roughness), film, None))
        });
        let compensated =
            COMPENSATED.iter().zip(&tables.0).map(move |((name, made, ..), (roughness, table))| {
                let of = |metal, film| Self::new(metal, film, Some(table));
                match made {
                    Made::Mirror => Specimen::new(name, lossless, of(mirror(*roughness), None)),
                    Made::Gold => Specimen::new(name, Claims::CLOSED_FORM, of(gold(*roughness), None)),
                    Made::Oxidised => {
                        Specimen::new(name, Claims::CLOSED_FORM, of(gold(*roughness), Some(OXIDE)))
                    }
                }
            });
        plain.into_iter().chain(compensated)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::{Bsdf, conformance};
    use crate::math::warp;
    use crate::optics::{TrowbridgeReitz, films};

    const MIRROR: Sampled<Unitless> = Sampled::splat(1e4);

    fn at(degrees: f32) -> LocalDir {
        LocalDir::new_unchecked(warp::spherical_direction(degrees.to_radians(), 0.7))
    }

    fn mirror(shape: FacetShape, x: f32, y: f32) -> Conductor<Microfacets> {
        Conductor { eta: Sampled::ZERO, k: MIRROR, roughness: Microfacets::new(shape, x, y) }
    }

    #[test]
    fn compensated_mirrors_of_any_roughness_reflect_everything() {
        use FacetShape::{Beckmann, TrowbridgeReitz};
        for (shape, x, y) in [
            (TrowbridgeReitz, 1.0, 1.0),
            (TrowbridgeReitz, 0.2, 0.2),
            (TrowbridgeReitz, 0.02, 0.7),
            (Beckmann, 1.0, 1.0),
            (Beckmann, 0.3, 0.1),
        ] {
            let metal = mirror(shape, x, y);
            let table = LossTable::mirror(Coverage::One(metal.roughness));
            let bsdf = Bsdf::FinishedConductor(FinishedConductor::new(metal, None, Some(&table)));
            assert_eq!(bsdf.claims().energy, Energy::Lossless { tolerance: 0.01 });
            for degrees in [0.0, 30.0, 60.0, 80.0, 110.0] {
                let rho = conformance::albedo(&bsdf, at(degrees), 60_000, 5);
                // Equivalence at 95 %.
                let off = (rho.value - 1.0).abs() + 1.96 * rho.error;
                assert!(off < 0.01, "{shape:?} {x} {y} {degrees}: {rho:?}");
            }
        }
    }

    #[test]
    fn uncompensated_mirror_loses_what_its_table_says() {
        // GGX at α = 1, masking correlated with height; 0.307 at 0° were it not.
        let metal = mirror(FacetShape::TrowbridgeReitz, 1.0, 1.0);
        let table = LossTable::mirror(Coverage::One(metal.roughness));
        let position = table.position(&metal.roughness, 0.0);
        let bsdf = Bsdf::FinishedConductor(FinishedConductor::new(metal, None, None));
        for degrees in [0.0, 30.0, 60.0, 80.0] {
            let rho = conformance::albedo(&bsdf, at(degrees), 60_000, 5);
            let expected = 1.0 - f64::from(table.loss(&position, at(degrees)));
            assert!((rho.value - expected).abs() < 1e-3 + 4.0 * rho.error, "{degrees}: {rho:?} {expected}");
            assert!(rho.value < 0.75, "{rho:?}");
        }
    }

    #[test]
    fn compensated_metal_absorbs_more_than_a_single_reflection_does() {
        let roughness = Microfacets::new(FacetShape::TrowbridgeReitz, 0.8, 0.8);
        let table = LossTable::mirror(Coverage::One(roughness));
        let with = Bsdf::FinishedConductor(FinishedConductor::new(gold(roughness), None, Some(&table)));
        let without = Bsdf::FinishedConductor(FinishedConductor::new(gold(roughness), None, None));
        for degrees in [0.0, 60.0] {
            let [with, without] = [&with, &without].map(|b| b.albedo(at(degrees)).reflectance);
            for lane in 0..4 {
                let once = fresnel_at(&gold(roughness), lane);
                assert!(with[lane] > without[lane] + 0.01, "{with:?} {without:?}");
                assert!(with[lane] < once, "{with:?} {once}");
            }
        }
        fn fresnel_at(metal: &Conductor<Microfacets>, lane: usize) -> f32 {
            // The largest reflectance of a facet up to 85°.
            (0..=85).map(|d| metal.fresnel((d as f32).to_radians().cos())[lane]).fold(0.0, f32::max)
        }
    }

    #[test]
    fn a_film_of_no_thickness_changes_nothing() {
        let roughness = Microfacets::new(FacetShape::TrowbridgeReitz, 0.3, 0.3);
        let none = Coating { thickness_nm: 0.0, ..OXIDE };
        let bare = Conductor {
            roughness: TrowbridgeReitz::new(0.3, 0.3),
            eta: gold(roughness).eta,
            k: gold(roughness).k,
        };
        let filmed = FinishedConductor::new(gold(roughness), Some(none), None);
        for (wo, wi) in [(at(10.0), at(60.0)), (at(40.0), -at(130.0)), (at(80.0), at(20.0))] {
            let (a, b) = (filmed.eval(wo, wi), bare.eval(wo, wi));
            for lane in 0..4 {
                assert!((a[lane] - b[lane]).abs() <= 1e-4 * b[lane], "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn a_smooth_film_colours_the_mirror_direction() {
        let metal = gold(Microfacets::SMOOTH);
        let bsdf = FinishedConductor::new(metal, Some(OXIDE), None);
        let s = bsdf.sample(at(35.0), 0.5, Vec2::splat(0.5)).unwrap();
        for lane in 0..4 {
            let film = films::Film { eta: OXIDE.eta[lane], thickness_nm: OXIDE.thickness_nm };
            let cos = at(35.0).z;
            let r =
                films::reflectance_conductor(cos, film, metal.eta[lane], metal.k[lane], OXIDE.lambda[lane]);
            assert_eq!(s.weight[lane], r);
        }
    }

    #[test]
    fn a_table_for_other_facets_is_no_ground_for_a_claim() {
        let table = LossTable::mirror(Coverage::One(Microfacets::new(FacetShape::Beckmann, 0.3, 0.3)));
        let metal = mirror(FacetShape::Beckmann, 0.5, 0.5);
        assert_eq!(FinishedConductor::new(metal, None, Some(&table)).claims(), Claims::CLOSED_FORM);
        // Nor is one for a metal that absorbs.
        let gold = gold(Microfacets::new(FacetShape::Beckmann, 0.3, 0.3));
        assert_eq!(FinishedConductor::new(gold, None, Some(&table)).claims(), Claims::CLOSED_FORM);
    }

    #[test]
    fn textured_widths_keep_the_claim_and_the_density() {
        let table = LossTable::mirror(Coverage::Isotropic(FacetShape::TrowbridgeReitz));
        for alpha in [0.05, 0.4, 0.93] {
            let metal = mirror(FacetShape::TrowbridgeReitz, alpha, alpha);
            let bsdf = FinishedConductor::new(metal, None, Some(&table));
            assert_eq!(bsdf.claims().energy, Energy::Lossless { tolerance: 0.01 });
            let effort = conformance::Effort::QUICK;
            let specimen = Specimen::new("textured", bsdf.claims(), Bsdf::FinishedConductor(bsdf));
            let examination = conformance::examine(&specimen, &effort);
            let wrong: Vec<String> = examination.contradictions().map(|f| f.to_string()).collect();
            assert!(wrong.is_empty(), "{alpha}: {wrong:?}");
        }
    }
}
