//! Plates with all their internal reflections, far thicker than the coherence length of the light: powers add.

use super::absorption::NaturalAbsorbance;
use super::fresnel::{Polarized, dielectric_polarized};
use super::refraction::refracted_cosine;
use super::shares::Shares;

/// A plate with smooth parallel faces of a weakly absorbing medium: its absorption is inside, and does not change the
/// reflectance of its faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// Index of the plate over the index of the medium in front, above 0.
    pub eta: f64,
    /// Index of the medium behind over the index of the medium in front, above 0; one for a window.
    pub eta_behind: f64,
    /// Absorbance along the normal.
    pub absorbance: NaturalAbsorbance,
}

impl Plate {
    /// A window: the same medium on both sides.
    pub fn window(eta: f64, absorbance: NaturalAbsorbance) -> Self {
        Self { eta, eta_behind: 1.0, absorbance }
    }

    /// The shares per polarisation at a cosine in front, in [0, 1]. Total reflection at the first face or grazing
    /// incidence reflects everything; at the second face it leaves no transmitted share.
    ///
    /// With the reflectances r, r′ of the faces and t = e^(−αd/cosθt) for one passage, the geometric series of all
    /// reflections sum to τ = (1 − r)(1 − r′) t / (1 − r r′ t²) and ρ = r + (1 − r)² r′ t² / (1 − r r′ t²)
    /// (Stokes 1862). A coherent sum is [`super::multilayer`]'s.
    pub fn polarized(&self, cos_theta: f64) -> Polarized<Shares> {
        let Some(cos_inside) = refracted_cosine(cos_theta, self.eta) else {
            return Polarized { s: Shares::REFLECTED, p: Shares::REFLECTED };
        };
        let passage = (self.absorbance * (1.0 / cos_inside)).transmittance();
        let front = dielectric_polarized(cos_theta, self.eta);
        let back = dielectric_polarized(cos_inside, self.eta_behind / self.eta);
        Polarized { s: sum(front.s, back.s, passage), p: sum(front.p, back.p, passage) }
    }

    /// The shares of unpolarised light, the mean of both polarisations at the end: each keeps its own series.
    pub fn unpolarized(&self, cos_theta: f64) -> Shares {
        self.polarized(cos_theta).unpolarized()
    }
}

fn sum(front: f64, back: f64, passage: f64) -> Shares {
    let rest = 1.0 - front * back * passage * passage;
    if front >= 1.0 || !(rest > 0.0) {
        return Shares::REFLECTED;
    }
    let entering = 1.0 - front;
    Shares {
        reflectance: front + entering * entering * back * passage * passage / rest,
        transmittance: entering * (1.0 - back) * passage / rest,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn window(eta: f64, depth: f64, degrees: f64) -> Shares {
        Plate::window(eta, NaturalAbsorbance::new(depth)).unpolarized(degrees.to_radians().cos())
    }

    #[test]
    fn clear_glass_has_the_checked_shares() {
        for (degrees, r, t, digits) in [
            (0.0, 0.076_923_1, 0.923_076_9, 5e-8),
            (45.0, 0.092_656, 0.907_344, 5e-7),
            (60.0, 0.151_872, 0.848_128, 5e-7),
            (75.0, 0.381_851, 0.618_149, 5e-7),
        ] {
            let s = window(1.5, 0.0, degrees);
            assert!(
                (s.reflectance - r).abs() < digits && (s.transmittance - t).abs() < digits,
                "{degrees}: {s:?}"
            );
            assert!(s.absorptance().abs() < 1e-15);
        }
        assert!((window(1.52, 0.0, 0.0).transmittance - 0.918_318).abs() < 5e-7);
        assert!((window(1.52, 0.0, 60.0).transmittance - 0.843_471).abs() < 5e-7);
    }

    #[test]
    fn tinted_glass_has_the_checked_shares() {
        for (degrees, r, t, a) in
            [(0.0, 0.070_221, 0.834_992, 0.094_787), (60.0, 0.137_917, 0.748_214, 0.113_869)]
        {
            let s = window(1.5, 0.1, degrees);
            let digits = 6e-7;
            assert!(
                (s.reflectance - r).abs() < digits && (s.transmittance - t).abs() < digits,
                "{degrees}: {s:?}"
            );
            assert!((s.absorptance() - a).abs() < digits, "{degrees}: {}", s.absorptance());
        }
    }

    #[test]
    fn grazing_light_and_light_beyond_a_critical_angle_do_not_pass() {
        let window = Plate::window(1.5, NaturalAbsorbance::new(0.3));
        assert_eq!(window.unpolarized(0.0), Shares::REFLECTED);
        let gap = Plate::window(1.0 / 1.5, NaturalAbsorbance::new(0.0));
        assert_eq!(gap.unpolarized(0.7), Shares::REFLECTED);
        // From glass of 1.5 through a plate of 1.8 towards air: refracted into the plate, and turned at its far face.
        let plate = Plate { eta: 1.2, eta_behind: 1.0 / 1.5, absorbance: NaturalAbsorbance::new(0.0) };
        let s = plate.unpolarized(0.7);
        assert!(s.transmittance == 0.0 && (s.reflectance - 1.0).abs() < 1e-15, "{s:?}");
    }

    proptest! {
        #[test]
        fn what_is_absorbed_is_what_the_series_of_passages_loses(cos in 0.01f64..1.0, eta in 1.0f64..3.0, depth in 0.0f64..5.0) {
            // (1 − r)(1 − t) Σ (r t)^k: another way to count than 1 − ρ − τ.
            let plate = Plate::window(eta, NaturalAbsorbance::new(depth));
            let cos_inside = (1.0 - (1.0 - cos * cos) / (eta * eta)).sqrt();
            let t = (-depth / cos_inside).exp();
            let shares = plate.polarized(cos);
            let r = dielectric_polarized(cos, eta);
            for (shares, r) in [(shares.s, r.s), (shares.p, r.p)] {
                let absorbed = (1.0 - r) * (1.0 - t) / (1.0 - r * t);
                prop_assert!((shares.absorptance() - absorbed).abs() < 1e-13);
            }
        }

        #[test]
        fn light_passes_a_plate_alike_in_both_directions(cos in 0.1f64..1.0, eta in 1.0f64..2.0, behind in 1.0f64..2.0, depth in 0.0f64..2.0) {
            let plate = Plate { eta, eta_behind: behind, absorbance: NaturalAbsorbance::new(depth) };
            let back = Plate { eta: eta / behind, eta_behind: 1.0 / behind, ..plate };
            let cos_behind = (1.0 - (1.0 - cos * cos) / (behind * behind)).sqrt();
            let (there, here) = (plate.unpolarized(cos), back.unpolarized(cos_behind));
            prop_assert!((there.transmittance - here.transmittance).abs() < 1e-12, "{there:?} {here:?}");
        }
    }
}
