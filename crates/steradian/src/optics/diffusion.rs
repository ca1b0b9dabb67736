//! Diffusion with two point sources, one of them a mirror image: a teaching model of light under a surface.

use super::hemispherical::diffuse_reflectance;

/// The share of a beam that a half-space gives back as diffuse light, by the dipole of Farrell, Patterson & Wilson (1992) as
/// Jensen, Marschner, Levoy & Hanrahan (2001) use it: ½ α′ (1 + e^(−4/3 A √(3(1 − α′)))) e^(−√(3(1 − α′))), in [0, 1].
///
/// `reduced_albedo` α′ is [`reduced_albedo`]'s, in [0, 1]; `eta` is the relative index, at least 1. The boundary is in
/// A = (1 + F)/(1 − F), where F is the mean reflectance from inside: its closed form instead of the usual fit, so that no
/// boundary is none. The share enters the medium already: the first reflection is not part of it.
pub fn dipole_reflectance(reduced_albedo: f64, eta: f64) -> f64 {
    let inside = diffuse_reflectance(1.0 / eta);
    let a = (1.0 + inside) / (1.0 - inside);
    let x = (3.0 * (1.0 - reduced_albedo)).max(0.0).sqrt();
    0.5 * reduced_albedo * (1.0 + (-4.0 / 3.0 * a * x).exp()) * (-x).exp()
}

/// The single-scattering albedo of the isotropic medium that stands for one with the mean cosine g: ω(1 − g)/(1 − ω g), by
/// similarity. `albedo` in [0, 1], `anisotropy` in (−1, 1).
pub fn reduced_albedo(albedo: f64, anisotropy: f64) -> f64 {
    albedo * (1.0 - anisotropy) / (1.0 - albedo * anisotropy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dipole_has_the_checked_value_and_limits() {
        assert!((dipole_reflectance(0.9, 1.0) - 0.3856).abs() < 5e-5);
        assert_eq!(dipole_reflectance(1.0, 1.5), 1.0);
        assert_eq!(dipole_reflectance(0.0, 1.5), 0.0);
        assert!(dipole_reflectance(0.9, 1.5) < dipole_reflectance(0.9, 1.0));
    }

    #[test]
    fn the_mean_internal_reflectance_is_near_the_usual_fit() {
        // −1.440/η² + 0.710/η + 0.668 + 0.0636 η (Egan & Hilgeman 1979).
        for eta in [1.2_f64, 1.4, 1.6] {
            let fit = -1.44 / (eta * eta) + 0.71 / eta + 0.668 + 0.0636 * eta;
            assert!((fit - diffuse_reflectance(1.0 / eta)).abs() < 3e-3, "{eta}");
        }
    }

    #[test]
    fn similarity_keeps_the_albedo_of_isotropic_media() {
        assert_eq!(reduced_albedo(0.7, 0.0), 0.7);
        assert_eq!(reduced_albedo(1.0, 0.9), 1.0);
        assert!((reduced_albedo(0.9, 0.5) - 0.45 / 0.55).abs() < 1e-15);
    }
}
