//! Light that goes to and fro: enclosures whose multiple reflections have a closed form.

use std::f64::consts::PI;

/// The net exchange factor of two grey diffuse surfaces that see only each other, the first one convex: the flux over A₁ (M₁ − M₂) for
/// black-body exitances M, 1/(1/ε₁ + (A₁/A₂)(1/ε₂ − 1)) (Christiansen 1883; endless parallel plates for A₁ = A₂, concentric spheres
/// and cylinders otherwise). Emissivities in (0, 1], `area_ratio` = A₁/A₂ in (0, 1].
pub fn two_surface_exchange(emissivity1: f64, emissivity2: f64, area_ratio: f64) -> f64 {
    1.0 / (1.0 / emissivity1 + area_ratio * (1.0 / emissivity2 - 1.0))
}

/// The radiance at every point of a closed space whose walls all emit `emitted` evenly and reflect `reflectance` of what they
/// receive, in [0, 1): L = L_e Σ ρᵏ = L_e/(1 − ρ), whatever its shape (the grey furnace; Shirley 1991).
pub fn grey_furnace(emitted: f64, reflectance: f64) -> f64 {
    emitted / (1.0 - reflectance)
}

/// The mean irradiance of the walls of a closed convex space by reflected light alone, A and all walls of diffuse reflectance ρ in
/// [0, 1): E = Φ ρ/(A(1 − ρ)), for a flux Φ that arrives evenly at first (Sumpner 1892; the mean that CIE 171:2006 takes for the internally
/// reflected component of its case 5.8). Exact as a mean only where each reflection keeps the mean, as it does for any distribution
/// when ρ is the same everywhere: flux is conserved.
pub fn mean_reflected_irradiance(flux: f64, area: f64, reflectance: f64) -> f64 {
    flux * reflectance / (area * (1.0 - reflectance))
}

/// The radiance of the wall of a sphere of radius `r` with a point source of flux Φ at its centre, after all reflections:
/// L = Φρ/(4π²r²(1 − ρ)), even everywhere. The lamp itself adds none: it has no area.
pub fn point_source_in_sphere(flux: f64, r: f64, reflectance: f64) -> f64 {
    flux * reflectance / (4.0 * PI * PI * r * r * (1.0 - reflectance))
}

/// An integrating sphere: a diffuse wall with openings, into which light comes that meets the wall first.
///
/// Since the view factor within a sphere is the share of its area ([`super::view_factor::within_sphere`]), the radiance is
/// the same everywhere and each reflection gives back the mean reflectance ρ̄ of the sphere (Jacquez & Kuppenheim, JOSA 45, 460 (1955);
/// Labsphere's "Integrating Sphere Theory" names M).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegratingSphere {
    /// Area of the whole sphere, openings included [m²], above 0.
    pub area: f64,
    /// Reflectance of the wall, in [0, 1].
    pub wall: f64,
    /// Share of the area that is open, in [0, 1): nothing comes back from there.
    pub ports: f64,
}

/// What closes a port of an integrating sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Its diffuse reflectance, in [0, 1].
    pub reflectance: f64,
    /// Share of the sphere's area that it takes, in [0, 1), apart from the open ports.
    pub share: f64,
}

impl IntegratingSphere {
    /// The sphere multiplier M = ρ/(1 − ρ(1 − f)): the wall's radiance over that of a perfect diffuser of the same area that the
    /// same flux lights once. Infinite for a white sphere without ports.
    pub fn multiplier(&self) -> f64 {
        self.wall / (1.0 - self.wall * (1.0 - self.ports))
    }

    /// The radiance of the wall [W·m⁻²·sr⁻¹ or cd·m⁻²] by a flux [W or lm] that meets the wall first: L = Φ/(πA) M.
    pub fn radiance(&self, flux: f64) -> f64 {
        flux / (PI * self.area) * self.multiplier()
    }

    /// The multiplier for light that meets the sample first, M = ρ_s/(1 − ρ̄) with the mean ρ̄ = ρ(1 − f − f_s) + ρ_s f_s.
    pub fn multiplier_with(&self, sample: Sample) -> f64 {
        let mean = self.wall * (1.0 - self.ports - sample.share) + sample.reflectance * sample.share;
        sample.reflectance / (1.0 - mean)
    }

    /// What a single-beam instrument reads as the reflectance of a sample that takes the place of a standard: the ratio of the signals
    /// times the standard's reflectance. It differs from the truth because the sample changes the sphere too.
    pub fn single_beam_reading(&self, sample: Sample, standard: Sample) -> f64 {
        standard.reflectance * self.multiplier_with(sample) / self.multiplier_with(standard)
    }

    /// The substitution error: the reading over the sample's true reflectance, less 1; zero for a sample like the standard,
    /// negative for a darker one.
    pub fn substitution_error(&self, sample: Sample, standard: Sample) -> f64 {
        self.single_beam_reading(sample, standard) / sample.reflectance - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::super::view_factor::{Enclosed, within_sphere};
    use super::*;

    #[test]
    fn the_sphere_multiplier_has_the_checked_value() {
        let sphere = IntegratingSphere { area: 1.0, wall: 0.9, ports: 0.05 };
        assert!((sphere.multiplier() - 6.206_90).abs() < 5e-6, "{}", sphere.multiplier());
        // The sum of reflections, one after the other.
        let series: f64 = (0..2000).map(|k| 0.9 * (0.9_f64 * 0.95).powi(k)).sum();
        assert!((sphere.multiplier() / series - 1.0).abs() < 1e-12);
        assert!((sphere.radiance(PI) - sphere.multiplier()).abs() < 1e-12);
    }

    #[test]
    fn a_dark_sample_reads_darker_in_a_single_beam() {
        let sphere = IntegratingSphere { area: 1.0, wall: 0.97, ports: 0.02 };
        let white = Sample { reflectance: 0.99, share: 0.01 };
        let dark = Sample { reflectance: 0.2, share: 0.01 };
        assert!(sphere.substitution_error(white, white).abs() < 1e-15);
        // (1 − ρ̄_white)/(1 − ρ̄_dark) = 0.0492/0.0571 of these numbers.
        let mean = |s: f64| 0.97 * 0.97 + s * 0.01;
        let expected = (1.0 - mean(0.99)) / (1.0 - mean(0.2)) - 1.0;
        assert!((sphere.substitution_error(dark, white) - expected).abs() < 1e-12);
        assert!((-0.15..-0.13).contains(&expected), "{expected}");
    }

    #[test]
    fn a_point_source_in_a_sphere_is_a_sphere_without_ports() {
        let (flux, r, rho) = (4.0 * PI * PI, 1.0, 0.5);
        assert!((point_source_in_sphere(flux, r, rho) - 1.0).abs() < 1e-14);
        let sphere = IntegratingSphere { area: 4.0 * PI * r * r, wall: rho, ports: 0.0 };
        assert!((sphere.radiance(flux) - point_source_in_sphere(flux, r, rho)).abs() < 1e-14);
        // Its reflected irradiance is the mean of the walls of any space: E = πL less the direct light.
        let direct = flux * within_sphere(1.0, r);
        let reflected = mean_reflected_irradiance(flux, sphere.area, rho);
        assert!((PI * sphere.radiance(flux) / rho - direct - reflected).abs() < 1e-12);
    }

    #[test]
    fn the_mean_formula_has_the_checked_values() {
        let golden = [
            (0.05, 5.48),
            (0.1, 11.57),
            (0.2, 26.04),
            (0.3, 44.64),
            (0.4, 69.44),
            (0.5, 104.17),
            (0.6, 156.25),
            (0.7, 243.06),
            (0.8, 416.67),
            (0.9, 937.50),
            (0.95, 1979.17),
        ];
        for (rho, lux) in golden {
            assert!((mean_reflected_irradiance(10_000.0, 96.0, rho) - lux).abs() < 5.1e-3, "{rho}");
        }
    }

    #[test]
    fn exchange_is_what_two_radiosity_balances_say() {
        // Inner sphere r = 1 of ε 0.8, outer one r = 2 of ε 0.3: solve B = εM + (1 − ε) F B directly.
        let (e1, e2, f) = (0.8, 0.3, Enclosed::concentric_spheres(1.0, 2.0));
        let (m1, m2) = (3.0, 1.0);
        // B₂ = ε₂M₂ + (1 − ε₂)(F₂₁B₁ + F₂₂B₂) and B₁ = ε₁M₁ + (1 − ε₁)B₂.
        let (r1, r2) = (1.0 - e1, 1.0 - e2);
        let b2 = (e2 * m2 + r2 * f.outer_to_inner * e1 * m1)
            / (1.0 - r2 * f.outer_to_outer - r2 * f.outer_to_inner * r1);
        let b1 = e1 * m1 + r1 * b2;
        assert!((two_surface_exchange(e1, e2, 0.25) * (m1 - m2) - (b1 - b2)).abs() < 1e-12);
        assert_eq!(two_surface_exchange(1.0, 1.0, 1.0), 1.0);
    }

    #[test]
    fn the_furnace_solves_its_own_balance() {
        let l = grey_furnace(0.3, 0.7);
        assert!((l - (0.3 + 0.7 * l)).abs() < 1e-14 && (l - 1.0).abs() < 1e-14);
    }
}
