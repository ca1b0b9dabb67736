//! Whether a scattering function obeys the laws that light transport relies on.
//!
//! The suite returns findings with their evidence, and what the claims let expect of them; what to do about a law that
//! does not hold is the caller's matter. It runs over the specimens of every variant in the tests, and over any
//! [`Bsdf`](super::Bsdf) for a user.

mod effort;
mod evidence;
mod grazing;
mod power;
mod reciprocity;
mod rounding;
mod scatterer;
mod sphere;
mod statistics;
mod survey;

pub use effort::{Coverage, Effort};
pub use evidence::{Evidence, Expectation, Finding, Law};
pub use power::{Answer, Estimate, Power, albedo};
pub use scatterer::Scatterer;

use super::contract::Mode;
use super::specimen::{Energy, Specimen};
use crate::math::{LocalDir, Vec3, warp};
use survey::Bench;

/// What the suite found out about one scattering function.
#[derive(Clone, Debug, PartialEq)]
pub struct Examination {
    /// All laws at all directions, with the evidence.
    pub findings: Vec<Finding>,
    /// ρ and τ over the angle of incidence: first from above the surface, then from below.
    pub powers: Vec<Power>,
}

impl Examination {
    /// Findings that are not as the claims let expect.
    pub fn contradictions(&self) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(|f| !f.is_as_claimed())
    }

    /// The finding of a law that was nearest to breaking it, or broke it most.
    pub fn worst(&self, law: Law) -> Option<&Finding> {
        self.findings
            .iter()
            .filter(|f| f.law == law)
            .reduce(|a, b| if b.evidence.strain() > a.evidence.strain() { b } else { a })
    }
}

/// Polar angles of the fixed direction [°]: for power with all laws about samples, and for samples of radiance.
fn angles(coverage: Coverage) -> (&'static [f32], &'static [f32]) {
    match coverage {
        Coverage::Few => (&[0.0, 65.0, 87.0, 140.0], &[40.0, 110.0]),
        Coverage::Full => (
            &[0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0, 85.0, 89.0, 180.0, 135.0, 110.0, 93.0],
            &[0.0, 50.0, 86.0, 130.0, 95.0],
        ),
    }
}

/// Examines every law that the specimen claims, for directions above and below the surface, at each wavelength.
pub fn examine<B: Scatterer>(specimen: &Specimen<B>, effort: &Effort) -> Examination {
    let bench = Bench { bsdf: specimen.bsdf, claims: specimen.claims, effort };
    let mut findings = Vec::new();
    let mut powers = Vec::new();
    let (for_power, for_radiance) = angles(effort.coverage);
    let modes = for_power.iter().map(|t| (t, Mode::Importance));
    for (index, (theta, mode)) in modes.chain(for_radiance.iter().map(|t| (t, Mode::Radiance))).enumerate() {
        let index = index as u64;
        // Azimuths turn by the golden angle.
        let phi = 0.7 + 2.399_963 * index as f32;
        let wo = LocalDir::new_unchecked(warp::spherical_direction(theta.to_radians(), phi));
        let survey = bench.survey(wo, mode, index);
        bench.judge_sampling(&survey, &mut findings);
        if mode == Mode::Importance {
            powers.push(bench.judge_power(&survey, index, &mut findings));
        }
    }
    if specimen.claims.energy == Energy::Unbounded {
        findings.extend(brightest(specimen, effort, &findings));
    }
    bench.judge_reciprocity(&mut findings);
    bench.judge_grazing(&mut findings);
    Examination { findings, powers }
}

/// The claim that more light returns than arrives must be shown at one direction at least: among those that were examined, or
/// nearer to the horizon, where a narrow lobe over the cosine of the light begins to.
fn brightest<B: Scatterer>(specimen: &Specimen<B>, effort: &Effort, findings: &[Finding]) -> Option<Finding> {
    let energy = findings.iter().filter(|f| f.law == Law::Energy);
    let worst = energy.reduce(|a, b| if b.evidence.strain() > a.evidence.strain() { b } else { a })?;
    let grazing = [1e-3, 1e-6, 1e-9, 1e-12].into_iter().map(|z: f32| {
        let wo = LocalDir::new_unchecked(Vec3::new((1.0 - z * z).sqrt(), 0.0, z));
        let power = albedo(&specimen.bsdf, wo, effort.samples, effort.seed);
        let observed = power.value - effort.sigmas() * power.error;
        Finding::new(Law::Energy, wo, Mode::Importance, Evidence::Bound { observed, limit: 1.0 })
    });
    let shown = std::iter::once(*worst).chain(grazing).find(|f| !f.holds()).unwrap_or(*worst);
    Some(shown.expecting(Expectation::Broken))
}

#[cfg(test)]
mod faults;
#[cfg(test)]
mod tests;
