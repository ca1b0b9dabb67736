//! Piles of equal plates in diffuse light.

use super::super::shares::Shares;

/// What `count` plates (at least 0, not necessarily whole) with the given shares reflect and transmit together, for light that
/// forgets its direction between them.
///
/// Stokes (1862): with sinh δ = D/2r, sinh κ = D/2t and D² = (1 + r + t)(1 + r − t)(1 − r + t)(1 − r − t), the shares are
/// R = sinh Mκ / sinh(Mκ + δ) and T = sinh δ / sinh(Mκ + δ). Written so, nothing cancels where the plates hardly absorb, and
/// with decaying exponentials nothing overflows where they hardly transmit.
pub fn pile(plate: Shares, count: f64) -> Shares {
    let Shares { reflectance: r, transmittance: t } = plate;
    if count == 0.0 {
        return Shares { reflectance: 0.0, transmittance: 1.0 };
    }
    let d = ((1.0 + r + t) * (1.0 + r - t) * (1.0 - r + t) * (1.0 - r - t).max(0.0)).max(0.0).sqrt();
    if d == 0.0 {
        // Nothing is absorbed: the limit.
        let reflected = count * r;
        let whole = reflected + t;
        let share = if whole > 0.0 { reflected / whole } else { 1.0 };
        return Shares { reflectance: share, transmittance: 1.0 - share };
    }
    let delta = (0.5 * d / r).asinh();
    let depth = count * (0.5 * d / t).asinh();
    let whole = -(-2.0 * (depth + delta)).exp_m1();
    Shares {
        reflectance: (-delta).exp() * -(-2.0 * depth).exp_m1() / whole,
        transmittance: (-depth).exp() * -(-2.0 * delta).exp_m1() / whole,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Two bodies in diffuse light, one upon the other.
    fn added(upper: Shares, lower: Shares) -> Shares {
        let between = 1.0 / (1.0 - upper.reflectance * lower.reflectance);
        Shares {
            reflectance: upper.reflectance + upper.transmittance.powi(2) * lower.reflectance * between,
            transmittance: upper.transmittance * lower.transmittance * between,
        }
    }

    fn near(a: Shares, b: Shares) -> bool {
        (a.reflectance - b.reflectance).abs() < 1e-12 && (a.transmittance - b.transmittance).abs() < 1e-12
    }

    #[test]
    fn opaque_clear_and_absent_plates_have_their_limits() {
        let opaque = Shares { reflectance: 0.3, transmittance: 0.0 };
        assert!(near(pile(opaque, 0.7), opaque));
        let black = Shares { reflectance: 0.0, transmittance: 0.0 };
        assert!(near(pile(black, 2.0), black));
        let tint = Shares { reflectance: 0.0, transmittance: 0.5 };
        assert!(near(pile(tint, 1.5), Shares { reflectance: 0.0, transmittance: 0.5_f64.powf(1.5) }));
        let clear = Shares { reflectance: 0.2, transmittance: 0.8 };
        // Lossless plates: t/(t + (1 − t) M), and nearly lossless ones next to it.
        assert!((pile(clear, 0.5).transmittance - 0.8 / 0.9).abs() < 1e-15);
        let nearly = Shares { reflectance: 0.2, transmittance: 0.8 - 1e-13 };
        assert!((pile(nearly, 0.5).transmittance - 0.8 / 0.9).abs() < 1e-12);
        let window = Shares { reflectance: 0.0, transmittance: 1.0 };
        assert!(near(pile(window, 3.0), window));
    }

    proptest! {
        #[test]
        fn plates_add_by_inter_reflection(r in 0.0f64..1.0, share in 0.0f64..1.0, m in 0.0f64..3.0) {
            let plate = Shares { reflectance: r, transmittance: (1.0 - r) * share };
            prop_assert!(near(pile(plate, 1.0), plate));
            let (one_more, added) = (pile(plate, m + 1.0), added(plate, pile(plate, m)));
            prop_assert!(near(one_more, added), "{one_more:?} {added:?}");
        }
    }
}
