//! One wavelength of the leaf model.

use super::super::absorption::NaturalAbsorbance;
use super::super::attenuation::diffuse_transmittance;
use super::super::shares::Shares;
use super::interface::cone_transmittance;
use super::layers::pile;
use std::f64::consts::FRAC_PI_2;

/// Half-angle of the cone in which light is taken to arrive at the uppermost plate: 40°, in radians.
pub const TOP_CONE: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// The shares of a leaf at one wavelength, for light within 40° of the normal: its `structure` N counts the plates, at least
/// 1 and not necessarily whole, of relative index `n`, at least 1, which together have the natural absorbance `depth` along
/// the normal.
///
/// The generalised plate model (Allen, Gausman, Richardson & Thomas 1969; PROSPECT, Jacquemoud & Baret 1990): the first plate
/// receives the light within a cone of 40°, and diffuses it; N − 1 more plates follow, among which light is diffuse.
pub fn shares(structure: f64, n: f64, depth: NaturalAbsorbance) -> Shares {
    let passage = diffuse_transmittance(depth * structure.recip());
    let entering = cone_transmittance(FRAC_PI_2, n);
    // Reciprocity: diffuse light leaves by t/n².
    let leaving = entering / (n * n);
    let inside = 1.0 - leaving;
    let plate = |entering: f64| {
        let transmittance = entering * passage * leaving / (1.0 - (inside * passage).powi(2));
        Shares { reflectance: 1.0 - entering + inside * passage * transmittance, transmittance }
    };
    let (top, inner) = (plate(cone_transmittance(TOP_CONE, n)), plate(entering));
    let rest = pile(inner, structure - 1.0);
    let between = top.transmittance / (1.0 - rest.reflectance * inner.reflectance);
    Shares {
        reflectance: top.reflectance + between * rest.reflectance * inner.transmittance,
        transmittance: between * rest.transmittance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_leaf_without_absorbers_loses_nothing() {
        for structure in [1.0, 1.5, 2.7] {
            let s = shares(structure, 1.4, NaturalAbsorbance::new(0.0));
            assert!(s.absorptance().abs() < 1e-14, "{structure}: {s:?}");
        }
    }

    /// One plate of Allen's model, summed reflection by reflection.
    #[test]
    fn a_leaf_of_one_plate_is_the_series_of_its_passages() {
        let (n, depth) = (1.45, NaturalAbsorbance::new(0.3));
        let (enter, passage) = (cone_transmittance(TOP_CONE, n), diffuse_transmittance(depth));
        let leave = cone_transmittance(FRAC_PI_2, n) / (n * n);
        let (mut reflected, mut transmitted, mut inside) = (1.0 - enter, 0.0, enter);
        for _ in 0..200 {
            inside *= passage;
            transmitted += inside * leave;
            inside *= (1.0 - leave) * passage;
            reflected += inside * leave;
            inside *= 1.0 - leave;
        }
        let s = shares(1.0, n, depth);
        assert!((s.reflectance - reflected).abs() < 1e-14 && (s.transmittance - transmitted).abs() < 1e-14);
    }

    proptest! {
        #[test]
        fn more_absorber_never_brightens_a_leaf(n in 1.2f64..1.6, structure in 1.0f64..4.0, depth in 0.0f64..50.0) {
            let at = |depth| shares(structure, n, NaturalAbsorbance::new(depth));
            let (less, more) = (at(depth), at(depth * 1.1 + 1e-3));
            prop_assert!(more.reflectance <= less.reflectance && more.transmittance <= less.transmittance);
            prop_assert!(less.absorptance() > -1e-14 && more.reflectance >= 0.0 && more.transmittance >= 0.0);
        }
    }
}
