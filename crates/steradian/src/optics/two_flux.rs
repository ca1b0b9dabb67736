//! The two-flux model of Kubelka and Munk: a teaching model. It is not transport: all light is taken to be diffuse, everywhere.

use super::hemispherical::diffuse_reflectance;
use super::shares::Shares;

/// A layer by its coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoFlux {
    /// K: absorption coefficient of diffuse light [length⁻¹], at least 0.
    pub absorption: f64,
    /// S: backscattering coefficient of diffuse light [length⁻¹], at least 0.
    pub scattering: f64,
    /// d: thickness [length], at least 0; may be infinite.
    pub thickness: f64,
}

impl TwoFlux {
    /// The reflectance of an infinite layer with the ratio `k` = K/S, at least 0: R∞ = a − √(a² − 1) with a = 1 + k (Kubelka &
    /// Munk 1931).
    pub fn infinite(k: f64) -> f64 {
        // Without the difference of like numbers.
        1.0 / (1.0 + k + (k * (k + 2.0)).sqrt())
    }

    /// The coefficients that a medium of this single-scattering albedo in [0, 1] and mean cosine is commonly given, for
    /// lengths in units of the mean free path: K = 2 (1 − ω) and S = ¾ ω (1 − g) − ¼ (1 − ω), not below 0 (van Gemert & Star
    /// 1987). From diffusion theory, hence for ω near 1.
    pub fn of_medium(albedo: f64, anisotropy: f64, depth: f64) -> Self {
        Self {
            absorption: 2.0 * (1.0 - albedo),
            scattering: (0.75 * albedo * (1.0 - anisotropy) - 0.25 * (1.0 - albedo)).max(0.0),
            thickness: depth,
        }
    }

    /// The shares of diffuse light on the layer alone: R = sinh b S d / D and T = b / D with D = a sinh b S d + b cosh b S d,
    /// a = 1 + K/S, b = √(a² − 1) (Kubelka 1948).
    pub fn shares(&self) -> Shares {
        let Self { absorption, scattering, thickness } = *self;
        if thickness.is_infinite() {
            return match (absorption > 0.0, scattering > 0.0) {
                (_, true) => {
                    Shares { reflectance: Self::infinite(absorption / scattering), transmittance: 0.0 }
                }
                (true, false) => Shares { reflectance: 0.0, transmittance: 0.0 },
                (false, false) => Shares { reflectance: 0.0, transmittance: 1.0 },
            };
        }
        let (k, s) = (absorption * thickness, scattering * thickness);
        if s == 0.0 {
            return Shares { reflectance: 0.0, transmittance: (-k).exp() };
        }
        // b S d = √(K d (K d + 2 S d)).
        let x = (k * (k + 2.0 * s)).sqrt();
        if x < 1e-8 {
            // sinh x = x and cosh x = 1 to the last digit.
            let denominator = 1.0 + k + s;
            return Shares { reflectance: s / denominator, transmittance: 1.0 / denominator };
        }
        // Times 2 e^(−x), so that nothing overflows.
        let (sinh, cosh) = (-(-2.0 * x).exp_m1(), 1.0 + (-2.0 * x).exp());
        let denominator = (k + s) * sinh + x * cosh;
        Shares { reflectance: s * sinh / denominator, transmittance: 2.0 * x * (-x).exp() / denominator }
    }

    /// The reflectance over a surface of diffuse reflectance `below`, in [0, 1].
    pub fn over(&self, below: f64) -> f64 {
        let Shares { reflectance, transmittance } = self.shares();
        reflectance + transmittance * transmittance * below / (1.0 - reflectance * below)
    }
}

/// A smooth boundary about a layer, with what it reflects (Saunderson 1942).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saunderson {
    /// k₁, the share of the light from outside that it reflects.
    pub outside: f64,
    /// k₂, the share of the diffuse light from inside that it reflects.
    pub inside: f64,
}

impl Saunderson {
    /// The boundary of a medium with this relative index, above 0, for diffuse light.
    pub fn of_index(eta: f64) -> Self {
        Self { outside: diffuse_reflectance(eta), inside: diffuse_reflectance(1.0 / eta) }
    }

    /// What is seen from outside of an opaque body of reflectance `r`: k₁ + (1 − k₁)(1 − k₂) r / (1 − k₂ r).
    pub fn seen(&self, r: f64) -> f64 {
        self.outside + (1.0 - self.outside) * (1.0 - self.inside) * r / (1.0 - self.inside * r)
    }

    /// The shares of a layer between two such boundaries.
    pub fn between(&self, layer: Shares) -> Shares {
        let Self { outside: k1, inside: k2 } = *self;
        let Shares { reflectance: r, transmittance: t } = layer;
        let passes = (1.0 - k1) * (1.0 - k2);
        let again = (1.0 - k2 * r).powi(2) - (k2 * t).powi(2);
        if !(again > 0.0) {
            return Shares { reflectance: 1.0, transmittance: 0.0 };
        }
        Shares {
            reflectance: k1 + passes * (r * (1.0 - k2 * r) + k2 * t * t) / again,
            transmittance: passes * t / again,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LAYER: TwoFlux = TwoFlux { absorption: 0.1, scattering: 1.0, thickness: 1.0 };

    #[test]
    fn layers_have_the_checked_shares() {
        let s = LAYER.shares();
        assert!((s.reflectance - 0.461_033_62).abs() < 5e-9 && (s.transmittance - 0.445_284_21).abs() < 5e-9);
        assert!((LAYER.over(0.5) - 0.589_872_07).abs() < 5e-9);
        assert!((TwoFlux::infinite(0.1) - 0.641_742_43).abs() < 5e-9);
        let boundary = Saunderson { outside: 0.04, inside: 0.5963 };
        assert!((boundary.seen(0.5) - 0.316_093_18).abs() < 5e-9);
    }

    #[test]
    fn limits_are_met() {
        let at = |absorption, scattering, thickness| TwoFlux { absorption, scattering, thickness }.shares();
        assert!((at(0.1, 1.0, 1e4).reflectance - TwoFlux::infinite(0.1)).abs() < 1e-12);
        let clear = at(0.0, 1.0, 3.0);
        assert!((clear.reflectance - 0.75).abs() < 1e-15 && clear.absorptance().abs() < 1e-15);
        assert!((at(1e-13, 3.0, 1.0).reflectance - 0.75).abs() < 1e-12);
        let shares = |reflectance, transmittance| Shares { reflectance, transmittance };
        assert_eq!(at(2.0, 0.0, 1.0), shares(0.0, (-2.0_f64).exp()));
        assert_eq!(at(0.1, 1.0, f64::INFINITY), shares(TwoFlux::infinite(0.1), 0.0));
        assert_eq!(at(0.1, 0.0, f64::INFINITY), shares(0.0, 0.0));
        assert_eq!(at(0.0, 0.0, f64::INFINITY), shares(0.0, 1.0));
        assert_eq!(at(3.0, 1.0, 0.0), shares(0.0, 1.0));
        assert_eq!(TwoFlux::infinite(0.0), 1.0);
    }

    proptest! {
        /// The differential equations: a layer on a thin one, to first order.
        #[test]
        fn layers_add(k in 0.0f64..3.0, s in 0.0f64..3.0, share in 0.01f64..0.99, below in 0.0f64..1.0) {
            let part = |thickness: f64| TwoFlux { absorption: k, scattering: s, thickness };
            let whole = part(1.0).over(below);
            prop_assert!((part(share).over(part(1.0 - share).over(below)) - whole).abs() < 1e-7);
            let thin = 1e-7;
            let slope = (part(thin).over(below) - below) / thin;
            let expected = s * (1.0 + below * below) - 2.0 * (k + s) * below;
            prop_assert!((slope - expected).abs() < 1e-4, "{slope} {expected}");
        }

        #[test]
        fn one_boundary_around_an_opaque_layer_is_saundersons(k in 0.1f64..3.0, eta in 1.0f64..2.0) {
            let boundary = Saunderson::of_index(eta);
            let r = TwoFlux::infinite(k);
            let opaque = Shares { reflectance: r, transmittance: 0.0 };
            prop_assert!((boundary.between(opaque).reflectance - boundary.seen(r)).abs() < 1e-14);
            let clear = boundary.between(Shares { reflectance: 0.3, transmittance: 0.7 });
            prop_assert!(clear.absorptance().abs() < 1e-13);
        }
    }
}
