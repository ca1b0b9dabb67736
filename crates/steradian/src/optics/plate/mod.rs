//! The generalised plate model of leaves: reflectance and transmittance from what a leaf holds (PROSPECT, Jacquemoud & Baret
//! 1990, with the constituents of its versions D and PRO, Féret et al. 2017 and 2021).
//!
//! The model is about shares of power: it says nothing about directions. What the constituents absorb is read from the
//! published table, see [`Coefficients`].

mod coefficients;
mod interface;
mod layers;
mod leaf;

pub use coefficients::{Absorber, Coefficients, CoefficientsError};
pub use interface::cone_transmittance;
pub use layers::pile;
pub use leaf::{TOP_CONE, shares};

use super::absorption::NaturalAbsorbance;
use super::shares::Shares;

/// What a leaf consists of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaf {
    /// Structure N: number of plates, at least 1.
    pub structure: f64,
    /// Amounts by [`Absorber::ALL`] in the units of [`Absorber`], at least 0.
    pub amounts: [f64; 8],
}

impl Leaf {
    /// A leaf of this structure that absorbs nothing.
    pub fn new(structure: f64) -> Self {
        Self { structure, amounts: [0.0; 8] }
    }

    /// The same leaf with this much of an absorber, in the unit of [`Absorber`].
    #[must_use]
    pub fn with(mut self, absorber: Absorber, amount: f64) -> Self {
        self.amounts[absorber as usize] = amount;
        self
    }

    /// The shares of light from within 40° of the normal that it reflects and transmits at a wavelength [nm]; `None` where the
    /// table has no data.
    pub fn shares(&self, coefficients: &Coefficients, lambda: f64) -> Option<Shares> {
        let optics = coefficients.at(lambda, &self.amounts)?;
        Some(shares(self.structure, optics.index, NaturalAbsorbance::new(optics.depth)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// The table of PROSPECT-PRO, which is not part of the project.
    fn published() -> Option<Coefficients> {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/prospect-pro-coefficients.txt");
        let Ok(text) = std::fs::read_to_string(&path) else {
            println!("skipped: there is no {}", path.display());
            return None;
        };
        Some(Coefficients::parse(&text).unwrap())
    }

    fn leaf(structure: f64, [chlorophyll, carotenoids, anthocyanins, brown, water, dry]: [f64; 6]) -> Leaf {
        Leaf { structure, amounts: [chlorophyll, carotenoids, anthocyanins, brown, water, dry, 0.0, 0.0] }
    }

    #[test]
    fn published_leaves_have_their_published_spectra() {
        let Some(table) = published() else { return };
        assert_eq!(table.range(), (400.0, 2500.0));
        assert!(Absorber::ALL.iter().all(|a| table.has(*a)));
        let healthy = leaf(1.5, [40.0, 8.0, 0.0, 0.0, 0.015, 0.009]);
        let red = leaf(1.5, [20.0, 8.0, 20.0, 0.0, 0.012, 0.008]);
        let senescent = leaf(1.8, [5.0, 5.0, 0.0, 0.5, 0.002, 0.01]);
        let wavelengths = [450.0, 550.0, 680.0, 800.0, 1450.0, 2200.0];
        let check = |name: &str, leaf: &Leaf, expected: [[f64; 2]; 6]| {
            for (lambda, [r, t]) in wavelengths.into_iter().zip(expected) {
                let s = leaf.shares(&table, lambda).unwrap();
                assert!(
                    (s.reflectance - r).abs() < 2e-6 && (s.transmittance - t).abs() < 2e-6,
                    "{name} at {lambda} nm: {s:?}, expected {r}/{t}"
                );
            }
        };
        check(
            "healthy",
            &healthy,
            [
                [0.041251, 0.001399],
                [0.151166, 0.150252],
                [0.036002, 0.005272],
                [0.442341, 0.474429],
                [0.121504, 0.155602],
                [0.126856, 0.212914],
            ],
        );
        check(
            "red",
            &red,
            [
                [0.041384, 0.001908],
                [0.048326, 0.022981],
                [0.049521, 0.032561],
                [0.446634, 0.478813],
                [0.146763, 0.187406],
                [0.148573, 0.244399],
            ],
        );
        check(
            "senescent",
            &senescent,
            [
                [0.062437, 0.020162],
                [0.245094, 0.182141],
                [0.170367, 0.126872],
                [0.449064, 0.390587],
                [0.345349, 0.328197],
                [0.246075, 0.292302],
            ],
        );
    }

    /// A table without a source: pigment below 600 nm, water above.
    const SYNTHETIC: &str = "lambda nrefrac SAC_CHL SAC_EWT\n400 1.5 0.1 0\n600 1.45 0 0\n1000 1.4 0 40\n";

    #[test]
    fn constituents_absorb_where_their_columns_say() {
        let table = Coefficients::parse(SYNTHETIC).unwrap();
        let green = Leaf::new(1.6).with(Absorber::Chlorophyll, 30.0).with(Absorber::Water, 0.02);
        let at = |leaf: &Leaf, lambda| leaf.shares(&table, lambda).unwrap();
        assert!(at(&green, 600.0).absorptance().abs() < 1e-14);
        // Absorbance 3 of chlorophyll at 400 nm, 0.8 of water at 1000 nm.
        for (lambda, index, depth) in [(400.0, 1.5, 3.0), (1000.0, 1.4, 0.8), (500.0, 1.475, 1.5)] {
            let (found, expected) = (at(&green, lambda), shares(1.6, index, NaturalAbsorbance::new(depth)));
            assert!(
                (found.reflectance - expected.reflectance).abs() < 1e-14
                    && (found.transmittance - expected.transmittance).abs() < 1e-14,
                "{lambda}: {found:?} {expected:?}"
            );
        }
        let dry = Leaf { amounts: [30.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], ..green };
        assert!(at(&dry, 1000.0).absorptance().abs() < 1e-14);
        assert_eq!(green.shares(&table, 399.0), None);
    }
}
