//! What verification found out, and what follows from it.

use crate::bsdf::conformance::{Evidence, Examination, Expectation, Finding, Law};
use crate::bsdf::{Albedo, Claims, Mode, Reciprocity};
use crate::math::warp;
use crate::spectrum::LANES;

/// What verification found out about each subject, in the order of the subjects.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The subjects.
    pub subjects: Vec<SubjectReport>,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Probability of rejecting any law that holds, in the whole run.
    pub level: f64,
}

/// Which verdicts are good enough.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acceptance {
    /// The laws hold: what is expected of a material that light is computed with.
    Lawful,
    /// What is claimed is true, also where a law is claimed to be broken: what is expected of teaching examples.
    AsDeclared,
}

impl Report {
    /// Whether every subject is accepted.
    pub fn passes(&self, acceptance: Acceptance) -> bool {
        self.subjects.iter().all(|s| s.passes(acceptance))
    }
}

/// The result for one subject.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// All laws hold. Where reciprocity is not claimed, it was reported and not judged.
    Lawful,
    /// Claims are true, and some of them say that a law is broken or a bias was chosen.
    BrokenAsDeclared,
    /// A claim is false.
    Contradicted,
    /// There is nothing to examine: a mix, whose parts are examined, or a mere boundary.
    NotExamined,
}

/// What was found of a law over all directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// It holds.
    Holds,
    /// It does not hold, as claimed.
    BrokenAsDeclared,
    /// It does not hold, and nothing was claimed.
    Reported,
    /// What was found contradicts the claim.
    Contradicted,
}

/// Where a subject comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A built-in specimen: what it claims to break must be seen broken.
    Specimen,
    /// A scene's material: its class may break a law that its parameters leave whole.
    Material,
}

/// What was found out about one subject.
#[derive(Clone, Debug, PartialEq)]
pub struct SubjectReport {
    /// Name of the specimen or the material.
    pub name: String,
    /// Where it comes from.
    pub origin: Origin,
    /// What a reader should know about how it was examined.
    pub note: Option<String>,
    /// What is claimed; `None` where there is nothing to examine.
    pub claims: Option<Claims>,
    /// Examinations, at one place and set of wavelengths each.
    pub inspections: Vec<Inspection>,
    /// ρ and τ over the angle of incidence, by the material's own albedo.
    pub over_angle: Vec<AlbedoAt>,
    /// ρ and τ over wavelength, by the material's own albedo; empty for specimens, whose wavelengths have no numbers.
    pub over_wavelength: Vec<AlbedoAt>,
}

/// One examination.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// Texture coordinates.
    pub uv: [f32; 2],
    /// Wavelengths of the lanes [nm]; `None` for specimens.
    pub wavelengths: Option<[f32; LANES]>,
    /// What was found.
    pub examination: Examination,
}

/// ρ and τ for light from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlbedoAt {
    /// Angle of incidence [°], above 90 from below the surface.
    pub theta: f64,
    /// Wavelengths [nm]; `None` for specimens.
    pub wavelengths: Option<[f32; LANES]>,
    /// ρ and τ per wavelength.
    pub albedo: Albedo,
}

/// The pair of directions that differs most between its two ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstPair {
    /// The two directions as (θ, φ) [°].
    pub directions: [[f64; 2]; 2],
    /// η² f(wo, wi) [sr⁻¹], or power for discrete directions.
    pub there: f64,
    /// f(wi, wo) [sr⁻¹], likewise.
    pub back: f64,
    /// Largest difference that rounding or chance explains.
    pub tolerance: f64,
    /// Wavelength [nm], where it has a number.
    pub wavelength: Option<f32>,
}

impl WorstPair {
    /// |there − back| over the larger one.
    pub fn relative(&self) -> f64 {
        let larger = self.there.abs().max(self.back.abs());
        if larger > 0.0 { (self.there - self.back).abs() / larger } else { 0.0 }
    }

    /// The tolerance over the larger one.
    pub fn relative_tolerance(&self) -> f64 {
        let larger = self.there.abs().max(self.back.abs());
        if larger > 0.0 { self.tolerance / larger } else { 0.0 }
    }
}

/// The largest ρ + τ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brightest {
    /// ρ + τ: by quadrature for closed forms, by sampling for estimates.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
    /// Angle of incidence [°].
    pub theta: f64,
    /// Wavelength [nm], where it has a number.
    pub wavelength: Option<f32>,
}

impl SubjectReport {
    /// The result.
    pub fn verdict(&self) -> Verdict {
        let standings = || Law::ALL.into_iter().filter_map(|law| self.standing(law));
        if self.inspections.is_empty() {
            Verdict::NotExamined
        } else if standings().any(|s| s == Standing::Contradicted) {
            Verdict::Contradicted
        } else if standings().any(|s| s == Standing::BrokenAsDeclared) {
            Verdict::BrokenAsDeclared
        } else {
            Verdict::Lawful
        }
    }

    /// Whether the result is good enough.
    pub fn passes(&self, acceptance: Acceptance) -> bool {
        match self.verdict() {
            Verdict::Lawful | Verdict::NotExamined => true,
            Verdict::BrokenAsDeclared => acceptance == Acceptance::AsDeclared,
            Verdict::Contradicted => false,
        }
    }

    /// What was found of a law; `None` where it was not examined.
    pub fn standing(&self, law: Law) -> Option<Standing> {
        let findings = || self.findings().map(|(_, f)| f).filter(move |f| f.law == law);
        findings().next()?;
        let named_bias = self.claims.is_some_and(|c| c.has_named_bias());
        Some(if findings().any(|f| self.contradicts(f)) {
            Standing::Contradicted
        } else if findings().any(|f| f.expectation == Expectation::Broken && !f.holds()) {
            Standing::BrokenAsDeclared
        } else if findings().all(Finding::holds) {
            Standing::Holds
        } else if named_bias && law != Law::Reciprocity {
            Standing::BrokenAsDeclared
        } else {
            Standing::Reported
        })
    }

    /// The finding that strains a law most, with its inspection.
    pub fn worst(&self, law: Law) -> Option<(&Inspection, &Finding)> {
        self.findings().filter(|(_, f)| f.law == law).reduce(|a, b| {
            let key = |f: &Finding| (self.contradicts(f), f.evidence.strain());
            if key(b.1) > key(a.1) { b } else { a }
        })
    }

    /// The laws that were examined, and how many of them hold.
    pub fn counts(&self) -> [usize; 2] {
        let examined = Law::ALL.into_iter().filter_map(|law| self.standing(law));
        let held = examined.clone().filter(|&s| s == Standing::Holds).count();
        [held, examined.count()]
    }

    /// The pair of directions that strains reciprocity most.
    pub fn worst_pair(&self) -> Option<WorstPair> {
        // Continuous pairs before discrete ones, whose power is known from samples only; a contradiction before either.
        let key = |f: &Finding| (self.contradicts(f), f.mode == Mode::Radiance, f.evidence.strain());
        let pairs = self.findings().filter(|(_, f)| f.law == Law::Reciprocity);
        let (inspection, f) = pairs.reduce(|a, b| if key(b.1) > key(a.1) { b } else { a })?;
        let Evidence::Equality { observed, expected, tolerance } = f.evidence else { return None };
        Some(WorstPair {
            directions: [degrees(f.wo), degrees(f.wi?)],
            there: expected,
            back: observed,
            tolerance,
            wavelength: inspection.wavelength(f.lane),
        })
    }

    /// Where most of the light returns.
    pub fn brightest(&self) -> Option<Brightest> {
        let closed = self.claims.is_some_and(|c| c.is_closed_form());
        let all = self.inspections.iter().flat_map(|inspection| {
            inspection.examination.powers.iter().flat_map(move |p| {
                let (answer, error) =
                    if closed { (p.integrated, p.integrated_error) } else { (p.sampled, p.total_error) };
                (0..LANES).map(move |lane| Brightest {
                    value: answer.total(lane),
                    error: error[lane],
                    theta: degrees(p.wi)[0],
                    wavelength: inspection.wavelength(Some(lane)),
                })
            })
        });
        // Of like values the one nearest to the normal.
        all.reduce(|a, b| if b.value > a.value + 1e-5 { b } else { a })
    }

    /// Whether reciprocity is not claimed.
    pub fn reports_reciprocity(&self) -> bool {
        self.claims.is_some_and(|c| c.reciprocity == Reciprocity::Reported)
    }

    fn contradicts(&self, f: &Finding) -> bool {
        let lawless = self.origin == Origin::Material && f.expectation == Expectation::Broken;
        !(f.is_as_claimed() || lawless)
    }

    fn findings(&self) -> impl Iterator<Item = (&Inspection, &Finding)> {
        self.inspections.iter().flat_map(|i| i.examination.findings.iter().map(move |f| (i, f)))
    }
}

impl Inspection {
    /// The wavelength of a lane [nm], where it has a number.
    pub fn wavelength(&self, lane: Option<usize>) -> Option<f32> {
        Some(self.wavelengths?[lane?])
    }
}

/// (θ, φ) of a direction [°].
pub fn degrees(w: crate::math::LocalDir) -> [f64; 2] {
    let (theta, phi) = warp::spherical_angles(*w);
    [f64::from(theta).to_degrees(), f64::from(phi).to_degrees()]
}
