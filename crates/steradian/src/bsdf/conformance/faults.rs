//! Planted faults: mistakes that are made in renderers, each of which the suite must catch by a law named in advance.
//!
//! The module is compiled for tests only, so that no build for users carries any of it. `cargo xtask faults` prints which
//! laws catch which fault.

use super::*;
use crate::bsdf::modified_phong::{ModifiedPhong, PhongLobe, PhongNormalization, PhongSampling};
use crate::bsdf::{Albedo, BsdfSample, Claims, Lobe, Lobes, Side};
use crate::math::hash::{self, Pcg32};
use crate::math::{Vec2, Vec3};
use crate::optics::{fresnel, refraction};
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};
use rayon::prelude::*;
use std::f32::consts::{FRAC_1_PI, PI, TAU};
use std::fmt::Write as _;

/// A mistake that has been made in renderers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    // In any scattering function.
    DroppedCosine,
    CosineInValue,
    StaleDensity,
    UnnormalisedDensity,
    WeightOfTheHeroForAll,
    NanAtGrazing,
    SampleOnTheWrongSide,
    SideMislabelled,
    LobeNotDeclared,
    // In a rough interface.
    ReflectionJacobianMissing,
    RefractionJacobianSwapped,
    RefractionJacobianWithoutIndex,
    SquaredIndexForgotten,
    SquaredIndexInBothModes,
    IndexSwapped,
    OneSidedShadowing,
    MaskingOfWiTwice,
    FacetsNotNormalised,
    FresnelFromTheWrongSide,
    FresnelAtTheSurfaceNormal,
    SwappedChoice,
    // In a smooth interface, or one with discrete and continuous parts.
    ChoiceNotInTheWeight,
    DiscreteCountedInDensity,
    DiscreteWithADensity,
    // In lobes of Phong's kind.
    PrintedNormalisation,
    ClampedToTheHorizon,
    RedrawnUnderTheHorizon,
    WrongExponentInTheWarp,
    MoreThanArrives,
    // In layers and random walks.
    AbsorptionOneWayOnly,
    OneSidedRoulette,
}

/// What a fault is planted into.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Base {
    /// Coloured Lambertian reflection.
    Paint,
    /// A rough interface between air and glass.
    RoughGlass,
    /// A smooth one.
    SmoothGlass,
    /// Lambertian reflection that shares its light with a mirror.
    Gloss,
    /// B (2.35) about the halfway vector.
    PhongHalfway,
    /// A Phong lobe drawn by Shirley's and Wang's density.
    ShirleyWang,
    /// A Phong lobe about the mirror direction.
    PhongMirror,
    /// Lambertian reflection under an absorbing film.
    DarkVarnish,
    /// Lambertian reflection whose value is the end of a random walk.
    Walk,
}

impl Base {
    const ALL: [Self; 9] = [
        Self::Paint,
        Self::RoughGlass,
        Self::SmoothGlass,
        Self::Gloss,
        Self::PhongHalfway,
        Self::ShirleyWang,
        Self::PhongMirror,
        Self::DarkVarnish,
        Self::Walk,
    ];

    fn claims(self) -> Claims {
        match self {
            Self::SmoothGlass => Claims::LOSSLESS,
            Self::Walk => Claims::ESTIMATED,
            _ => Claims::CLOSED_FORM,
        }
    }
}

/// Every fault, what it is planted into, and the law that must catch it.
const PLANTED: &[(Fault, Base, Law)] = {
    use {Base::*, Fault::*};
    &[
        (DroppedCosine, Paint, Law::WeightIsRatio),
        (CosineInValue, Paint, Law::Reciprocity),
        (StaleDensity, Paint, Law::DensityOfSample),
        (UnnormalisedDensity, Paint, Law::DensityMass),
        (WeightOfTheHeroForAll, Paint, Law::WeightIsRatio),
        (NanAtGrazing, Paint, Law::Finite),
        (SampleOnTheWrongSide, Paint, Law::SamplesFollowDensity),
        (SideMislabelled, Paint, Law::Bookkeeping),
        (LobeNotDeclared, Paint, Law::Bookkeeping),
        (ReflectionJacobianMissing, RoughGlass, Law::DensityMass),
        (RefractionJacobianSwapped, RoughGlass, Law::SamplesFollowDensity),
        (RefractionJacobianWithoutIndex, RoughGlass, Law::DensityMass),
        (SquaredIndexForgotten, RoughGlass, Law::Adjoint),
        (SquaredIndexInBothModes, RoughGlass, Law::Adjoint),
        (IndexSwapped, RoughGlass, Law::SamplesFollowDensity),
        (OneSidedShadowing, RoughGlass, Law::Reciprocity),
        (MaskingOfWiTwice, RoughGlass, Law::Reciprocity),
        (FacetsNotNormalised, RoughGlass, Law::DensityMass),
        (FresnelFromTheWrongSide, RoughGlass, Law::Reciprocity),
        (FresnelAtTheSurfaceNormal, RoughGlass, Law::Reciprocity),
        (SwappedChoice, RoughGlass, Law::SamplesFollowDensity),
        (ChoiceNotInTheWeight, SmoothGlass, Law::Lossless),
        (SquaredIndexForgotten, SmoothGlass, Law::Adjoint),
        (DiscreteCountedInDensity, Gloss, Law::DensityMass),
        (DiscreteWithADensity, Gloss, Law::DensityOfSample),
        (PrintedNormalisation, PhongHalfway, Law::Energy),
        (ClampedToTheHorizon, ShirleyWang, Law::SamplesFollowDensity),
        (RedrawnUnderTheHorizon, ShirleyWang, Law::DensityMass),
        (WrongExponentInTheWarp, PhongMirror, Law::SamplesFollowDensity),
        (MoreThanArrives, PhongMirror, Law::Energy),
        (AbsorptionOneWayOnly, DarkVarnish, Law::Reciprocity),
        (OneSidedRoulette, Walk, Law::AnswersAgree),
    ]
};

/// A scattering function, with a fault or without.
#[derive(Clone, Copy, Debug)]
struct Planted {
    base: Base,
    fault: Option<Fault>,
    seed: u64,
}

const ALPHA: f32 = 0.4;
const ETA: f32 = 1.5;
const EXPONENT: f32 = 10.0;
const PAINT: Sampled<Unitless> = Sampled::from_array([0.1, 0.8, 0.4, 0.6]);
/// Share of the mirror in the glossy base.
const MIRROR: f32 = 0.3;
/// Optical thickness of the varnish.
const THICKNESS: f32 = 0.5;
/// Share of light that goes on at each event of the walk, and the events at most.
const GOES_ON: f32 = 0.6;

impl Planted {
    fn has(&self, fault: Fault) -> bool {
        self.fault == Some(fault)
    }

    fn phong(&self) -> ModifiedPhong {
        let (lobe, sampling) = match self.base {
            Base::PhongHalfway => (PhongLobe::Halfway, PhongSampling::Lobe),
            Base::ShirleyWang => (PhongLobe::Mirror, PhongSampling::ShirleyWang),
            _ => (PhongLobe::Mirror, PhongSampling::Lobe),
        };
        let printed = self.has(Fault::PrintedNormalisation);
        ModifiedPhong {
            diffuse: if self.has(Fault::MoreThanArrives) {
                Sampled::from_array([0.0, 0.0, 0.2, 0.0])
            } else {
                Sampled::ZERO
            },
            specular: Sampled::ONE,
            exponent: EXPONENT,
            lobe,
            normalization: if printed { PhongNormalization::Printed } else { PhongNormalization::Exact },
            sampling,
        }
    }

    /// f of the base.
    fn value(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        if wo.z == 0.0 || wi.z == 0.0 {
            return Sampled::ZERO;
        }
        let lambert = |rho: Sampled<Unitless>| {
            if wo.same_hemisphere(wi) { (rho * FRAC_1_PI).cast() } else { Sampled::ZERO }
        };
        match self.base {
            Base::Paint => lambert(PAINT),
            Base::Gloss => lambert(PAINT * (1.0 - MIRROR)),
            Base::RoughGlass => self.facets(wo, wi, mode).map_or(Sampled::ZERO, |e| Sampled::splat(e.value)),
            Base::SmoothGlass => Sampled::ZERO,
            Base::PhongHalfway | Base::ShirleyWang | Base::PhongMirror => self.phong().eval(wo, wi),
            Base::DarkVarnish => {
                let passed = |w: LocalDir| (-THICKNESS / w.abs_cos_theta()).exp();
                let out = if self.has(Fault::AbsorptionOneWayOnly) { 1.0 } else { passed(wo) };
                lambert(PAINT * (out * passed(wi)))
            }
            Base::Walk => lambert(PAINT * self.walked(wo, wi)),
        }
    }

    /// (1 − r) Σ r^k = 1, by a walk that goes on with the probability ½ instead of r.
    fn walked(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        let key = hash::hash_floats(&[wo.x, wo.y, wo.z, wi.x, wi.y, wi.z]);
        let mut rng = Pcg32::new(hash::combine(self.seed, key), 3);
        let (mut sum, mut weight) = (0.0, 1.0);
        loop {
            sum += weight * (1.0 - GOES_ON);
            if rng.next_f32() >= 0.5 {
                return sum;
            }
            // What survives stands for what did not.
            weight *= if self.has(Fault::OneSidedRoulette) { GOES_ON } else { GOES_ON / 0.5 };
        }
    }

    /// Density of the base's continuous directions.
    fn density(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        let cosine = if wo.same_hemisphere(wi) { wi.abs_cos_theta() * FRAC_1_PI } else { 0.0 };
        match self.base {
            Base::Paint | Base::DarkVarnish | Base::Walk => cosine,
            Base::Gloss if self.has(Fault::DiscreteCountedInDensity) => cosine,
            Base::Gloss => (1.0 - MIRROR) * cosine,
            Base::RoughGlass => self.facets(wo, wi, Mode::Radiance).map_or(0.0, |e| e.density),
            Base::SmoothGlass => 0.0,
            Base::PhongHalfway | Base::ShirleyWang | Base::PhongMirror => self.phong().pdf(wo, wi).0,
        }
    }

    /// f and density of a rough interface, Walter et al. 2007, with normals drawn in proportion to D cosθ.
    fn facets(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Option<Facets> {
        let reflected = wo.same_hemisphere(wi);
        let eta = match (reflected, wo.z > 0.0) {
            (true, _) => 1.0,
            (false, true) => ETA,
            (false, false) => 1.0 / ETA,
        };
        let bent = if self.has(Fault::IndexSwapped) { 1.0 / eta } else { eta };
        let half = LocalDir::new(*wo + *wi * bent)?;
        let wm = if half.z < 0.0 { -half } else { half };
        let (om, im) = (wo.dot(*wm), wi.dot(*wm));
        if om * wo.z <= 0.0 || im * wi.z <= 0.0 || wm.z <= 0.0 {
            return None;
        }
        let r = self.reflectance(wo, om);
        let d = self.distribution(wm);
        let g = self.masking(wo, wi);
        let cosines = wo.abs_cos_theta() * wi.abs_cos_theta();
        let share = if self.has(Fault::SwappedChoice) { 1.0 - r } else { r };
        if reflected {
            let jacobian = if self.has(Fault::ReflectionJacobianMissing) { 1.0 } else { 4.0 * om.abs() };
            return Some(Facets { value: d * g * r / (4.0 * cosines), density: d * wm.z / jacobian * share });
        }
        let root = im + if self.has(Fault::RefractionJacobianWithoutIndex) { om } else { om / bent };
        let numerator = if self.has(Fault::RefractionJacobianSwapped) { om.abs() } else { im.abs() };
        let jacobian = numerator / (root * root);
        let scale = if self.scales(mode) { 1.0 / (eta * eta) } else { 1.0 };
        Some(Facets {
            value: d * g * (1.0 - r) * om.abs() * jacobian / cosines * scale,
            density: d * wm.z * jacobian * (1.0 - share),
        })
    }

    /// Whether refraction scales by (ηo/ηi)².
    fn scales(&self, mode: Mode) -> bool {
        match mode {
            Mode::Radiance => !self.has(Fault::SquaredIndexForgotten),
            Mode::Importance => self.has(Fault::SquaredIndexInBothModes),
        }
    }

    fn reflectance(&self, wo: LocalDir, om: f32) -> f32 {
        if self.has(Fault::FresnelFromTheWrongSide) {
            fresnel::dielectric(om.abs(), ETA)
        } else if self.has(Fault::FresnelAtTheSurfaceNormal) {
            fresnel::dielectric(wo.z, ETA)
        } else {
            fresnel::dielectric(om, ETA)
        }
    }

    /// D(wm) of Trowbridge and Reitz.
    fn distribution(&self, wm: LocalDir) -> f32 {
        let a2 = ALPHA * ALPHA;
        let t = wm.sin2_theta() + a2 * wm.cos2_theta();
        // The constant of the wrong member of the family.
        let norm = if self.has(Fault::FacetsNotNormalised) { TAU } else { PI };
        a2 / (norm * t * t)
    }

    fn masking(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        let lambda = |w: LocalDir| {
            let tan2 = w.sin2_theta() / w.cos2_theta();
            0.5 * ((1.0 + ALPHA * ALPHA * tan2).sqrt() - 1.0)
        };
        if self.has(Fault::OneSidedShadowing) {
            1.0 / (1.0 + lambda(wo))
        } else if self.has(Fault::MaskingOfWiTwice) {
            1.0 / (1.0 + lambda(wo) + 2.0 * lambda(wi))
        } else {
            1.0 / (1.0 + lambda(wo) + lambda(wi))
        }
    }

    fn draw_facets(&self, wo: LocalDir, uc: f32, u: Vec2) -> Option<(LocalDir, f32)> {
        let tan2 = ALPHA * ALPHA * u.x / (1.0 - u.x);
        let cos = 1.0 / (1.0 + tan2).sqrt();
        let (sin, phi) = ((1.0 - cos * cos).max(0.0).sqrt(), TAU * u.y);
        let wm = Vec3::new(sin * phi.cos(), sin * phi.sin(), cos);
        let om = wo.dot(wm);
        if om * wo.z <= 0.0 {
            return None;
        }
        let r = self.reflectance(wo, om);
        let crossing = fresnel::Crossing::new(om, ETA);
        let (wi, eta) = if uc < r {
            (refraction::reflect(*wo, wm), 1.0)
        } else {
            (crossing.refract(*wo, wm)?, crossing.eta)
        };
        let wi = LocalDir::new(wi)?;
        (wi.same_hemisphere(wo) == (uc < r)).then_some((wi, eta))
    }

    /// A sample of a lobe of Phong's kind.
    fn draw_phong(&self, wo: LocalDir, uc: f32, u: Vec2) -> Option<LocalDir> {
        let mirrored = Vec3::new(-wo.x, -wo.y, wo.z);
        let about = |cos: f32, phi: f32| {
            let frame = crate::math::Frame::from_z(mirrored);
            let sin = (1.0 - cos * cos).max(0.0).sqrt();
            LocalDir::new(frame.s * (sin * phi.cos()) + frame.t * (sin * phi.sin()) + frame.n * cos)
        };
        match self.fault {
            Some(Fault::ClampedToTheHorizon) => {
                let cos = half_angle_cosine(u.x);
                let w = about(cos, TAU * u.y)?;
                // Lifted to just above the horizon.
                if w.same_hemisphere(wo) {
                    Some(w)
                } else {
                    LocalDir::new(Vec3::new(w.x, w.y, 0.01 * wo.z.signum()))
                }
            }
            Some(Fault::RedrawnUnderTheHorizon) => {
                let mut rng = Pcg32::new(u64::from(u.x.to_bits()) << 32 | u64::from(u.y.to_bits()), 1);
                (0..100)
                    .filter_map(|_| about(half_angle_cosine(rng.next_f32()), TAU * rng.next_f32()))
                    .find(|w| w.same_hemisphere(wo))
            }
            Some(Fault::WrongExponentInTheWarp) => {
                // B (2.47) has n + 1.
                about(u.x.powf(1.0 / EXPONENT), TAU * u.y).filter(|w| w.same_hemisphere(wo))
            }
            _ => self.phong().sample(wo, uc, u).map(|s| s.wi),
        }
    }

    fn discrete(&self, wo: LocalDir, uc: f32, mode: Mode) -> Option<BsdfSample> {
        let mirrored = LocalDir::new_unchecked(Vec3::new(-wo.x, -wo.y, wo.z));
        let reflected = |weight: Sampled<Unitless>| BsdfSample {
            wi: mirrored,
            weight,
            density: Density::Delta,
            side: Side::Reflection,
            lobe: Lobe::Specular,
            eta: 1.0,
        };
        if self.base == Base::Gloss {
            let mut s = reflected(Sampled::ONE);
            if self.has(Fault::DiscreteWithADensity) {
                s.density = Density::SolidAngle(PdfSolidAngle(1.0));
            }
            return Some(s);
        }
        let crossing = fresnel::Crossing::new(wo.z, ETA);
        let r = crossing.reflectance;
        // Neither way is ever rare, and the weight makes up for it.
        let p = 0.1 + 0.8 * r;
        let over = |p: f32| if self.has(Fault::ChoiceNotInTheWeight) { 1.0 } else { 1.0 / p };
        if uc < p {
            return Some(reflected(Sampled::splat(r * over(p))));
        }
        let scale = if self.scales(mode) { 1.0 / (crossing.eta * crossing.eta) } else { 1.0 };
        Some(BsdfSample {
            wi: LocalDir::new(crossing.refract(*wo, Vec3::Z)?)?,
            weight: Sampled::splat((1.0 - r) * over(1.0 - p) * scale),
            side: Side::Transmission,
            eta: crossing.eta,
            ..reflected(Sampled::ZERO)
        })
    }
}

/// f and density of a rough interface, both [sr⁻¹].
struct Facets {
    value: f32,
    density: f32,
}

/// cos of the angle to the mirror direction by Shirley's and Wang's warp.
fn half_angle_cosine(u: f32) -> f32 {
    (2.0 * (1.0 - u).powf(1.0 / (EXPONENT + 2.0)).acos()).cos()
}

impl Scatterer for Planted {
    fn eval(&self, wo: LocalDir, wi: LocalDir, mode: Mode) -> Sampled<PerSteradian> {
        if self.has(Fault::NanAtGrazing) {
            // 0/0 in the surface.
            let cosines = wo.z * wi.z;
            return self.value(wo, wi, mode) * cosines / cosines;
        }
        let cosine = if self.has(Fault::CosineInValue) { wi.abs_cos_theta() } else { 1.0 };
        self.value(wo, wi, mode) * cosine
    }

    fn pdf(&self, wo: LocalDir, wi: LocalDir, _: Mode) -> PdfSolidAngle {
        let factor = if self.has(Fault::UnnormalisedDensity) { 1.1 } else { 1.0 };
        PdfSolidAngle(self.density(wo, wi) * factor)
    }

    fn sample(&self, wo: LocalDir, uc: f32, u: Vec2, mode: Mode) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        if self.base == Base::SmoothGlass || (self.base == Base::Gloss && uc < MIRROR) {
            return self.discrete(wo, uc, mode);
        }
        let (mut wi, eta) = match self.base {
            Base::RoughGlass => self.draw_facets(wo, uc, u)?,
            Base::PhongHalfway | Base::ShirleyWang | Base::PhongMirror => (self.draw_phong(wo, uc, u)?, 1.0),
            _ => {
                let up = warp::cosine_hemisphere(u);
                (if wo.z > 0.0 { up } else { -up }, 1.0)
            }
        };
        let mut pdf = self.pdf(wo, wi, mode);
        if !(pdf.0 > 0.0) {
            return None;
        }
        // Weights agree with the faulty f and density, so that only physics can tell.
        let mut weight = if self.base == Base::Walk {
            PAINT
        } else {
            self.eval(wo, wi, mode).weight(wi.abs_cos_theta(), pdf)
        };
        let mut side = if wo.same_hemisphere(wi) { Side::Reflection } else { Side::Transmission };
        match self.fault {
            Some(Fault::DroppedCosine) => weight = weight / wi.abs_cos_theta(),
            Some(Fault::StaleDensity) => pdf.0 *= 0.9,
            Some(Fault::WeightOfTheHeroForAll) => weight = Sampled::splat(weight[0]),
            Some(Fault::SampleOnTheWrongSide) if uc < 0.1 => {
                wi = LocalDir::new_unchecked(Vec3::new(wi.x, wi.y, -wi.z));
            }
            Some(Fault::SideMislabelled) => side = Side::Transmission,
            _ => {}
        }
        Some(BsdfSample { wi, weight, density: Density::SolidAngle(pdf), side, lobe: Lobe::Glossy, eta })
    }

    fn albedo(&self, wi: LocalDir) -> Albedo {
        Albedo::by_sampling(|uc, u| self.sample(wi, uc, u, Mode::Importance))
    }

    fn lobes(&self) -> Lobes {
        let continuous = self.base != Base::SmoothGlass && !self.has(Fault::LobeNotDeclared);
        Lobes { reflection: continuous, transmission: self.base == Base::RoughGlass }
    }

    fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }
}

fn caught(base: Base, fault: Option<Fault>) -> Vec<Law> {
    let specimen = Specimen::new("", base.claims(), Planted { base, fault, seed: 1 });
    let effort = Effort::QUICK.among(PLANTED.len());
    let examination = examine(&specimen, &effort);
    Law::ALL.into_iter().filter(|&law| examination.contradictions().any(|f| f.law == law)).collect()
}

#[test]
fn planted_faults_are_caught_by_the_law_they_break() {
    let rows: Vec<_> =
        PLANTED.par_iter().with_max_len(1).map(|&(f, base, _)| caught(base, Some(f))).collect();
    let mut matrix = format!("{:56}", "fault");
    for law in Law::ALL {
        let _ = write!(matrix, " {:>7}", &law.name()[..law.name().len().min(7)]);
    }
    let mut missed = String::new();
    for ((fault, base, law), caught) in PLANTED.iter().zip(&rows) {
        let _ = write!(matrix, "\n{:56}", format!("{fault:?} in {base:?}"));
        for column in Law::ALL {
            let mark = match (caught.contains(&column), column == *law) {
                (true, true) => "CAUGHT",
                (true, false) => "caught",
                (false, true) => "MISSED",
                (false, false) => ".",
            };
            let _ = write!(matrix, " {mark:>7}");
        }
        if !caught.contains(law) {
            let _ = writeln!(missed, "{fault:?} in {base:?} does not break {law:?}, but {caught:?}");
        }
    }
    println!("kill matrix: {} faults\n{matrix}\n", PLANTED.len());
    assert!(missed.is_empty(), "{missed}");
}

#[test]
fn functions_without_a_fault_obey_every_law() {
    for base in Base::ALL {
        let caught = caught(base, None);
        assert!(caught.is_empty(), "{base:?}: {caught:?}");
    }
}

#[test]
fn every_law_is_the_first_to_catch_something_or_is_implied() {
    // Laws that no fault of the list names are tested by the false claims, or follow from others.
    let named: Vec<Law> = Law::ALL.into_iter().filter(|l| PLANTED.iter().any(|p| p.2 == *l)).collect();
    let others: Vec<Law> = Law::ALL.into_iter().filter(|l| !named.contains(l)).collect();
    assert_eq!(others, [Law::ScatteringProbability]);
}
