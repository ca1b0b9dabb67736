//! Stacks of thin films, absorbing ones too, in `f64`: characteristic matrices (Abelès 1950; Born & Wolf, 7th ed., 1.6),
//! and Airy's sum of reflections (Airy 1833) for a single film, which is another derivation of the same.
//!
//! Every length of the stack is far below the coherence length of the light: fields add. Complex indices are η + j k.

use super::complex::Complex;
use super::fresnel::{Polarized, normal_index};
use super::shares::Shares;
use std::f64::consts::TAU;

/// One film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Its complex index at the wavelength asked for.
    pub index: Complex,
    /// Its thickness [nm], at least 0.
    pub thickness_nm: f64,
}

/// Films between a transparent medium above, which light comes from, and a substrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stack<'a> {
    /// Index of the medium above, above 0.
    pub above: f64,
    /// From the top down; may be empty.
    pub layers: &'a [Layer],
    /// Complex index of the substrate, which is infinitely thick.
    pub below: Complex,
}

/// A medium as a wave of one direction and polarisation meets it.
#[derive(Clone, Copy, Debug)]
struct Medium {
    /// Component of the wave vector along the normal, over its value in vacuum.
    kappa: Complex,
    /// What the tangential field across the plane of the other field is divided by: 1 for s, N² for p. The admittance is
    /// κ for s and N²/κ for p.
    weight: Complex,
}

/// The polarisation whose continuous fields are E and κE (s) or H and κH/N² (p).
#[derive(Clone, Copy, Debug, PartialEq)]
enum Plane {
    S,
    P,
}

impl Medium {
    /// The medium of `index` behind a transparent one of index `above` with cosine `cos`.
    fn new(index: Complex, above: f64, cos: f64, plane: Plane) -> Self {
        let kappa = normal_index(cos, index.re / above, index.im / above) * above;
        Self { kappa, weight: if plane == Plane::S { Complex::ONE } else { index.square() } }
    }

    /// e^(jβ), and sin β · e^(jβ) / κ, for the phase β = 2π κ d / λ: both bounded however thick the layer is.
    fn passage(&self, depth: f64) -> (Complex, Complex) {
        let beta = self.kappa * depth;
        let once = beta.exp_j();
        let sine = if beta.norm_squared() < 1e-16 {
            Complex::ONE * depth
        } else {
            // (e^(2jβ) − 1) / 2j
            -((once.square() - Complex::ONE) * 0.5).times_j() / self.kappa
        };
        (once, sine)
    }
}

impl Stack<'_> {
    /// The shares per polarisation at a cosine in the medium above, in [0, 1], and the vacuum wavelength `lambda_nm`
    /// [nm], above 0. What reaches an absorbing substrate counts as transmitted: it is the power that crosses the last
    /// interface. Grazing incidence reflects everything.
    pub fn polarized(&self, cos_theta: f64, lambda_nm: f64) -> Polarized<Shares> {
        Polarized {
            s: self.plane(cos_theta, lambda_nm, Plane::S),
            p: self.plane(cos_theta, lambda_nm, Plane::P),
        }
    }

    /// The shares of unpolarised light; domain as [`Stack::polarized`].
    pub fn unpolarized(&self, cos_theta: f64, lambda_nm: f64) -> Shares {
        self.polarized(cos_theta, lambda_nm).unpolarized()
    }

    fn plane(&self, cos_theta: f64, lambda_nm: f64, plane: Plane) -> Shares {
        let cos = cos_theta.abs().min(1.0);
        if cos == 0.0 {
            return Shares::REFLECTED;
        }
        let medium = |index| Medium::new(index, self.above, cos, plane);
        let below = medium(self.below);
        // Continuous fields at the substrate times its weight, so that a κ of zero is no division. For both
        // polarisations u is the field itself, and v is κu over the weight.
        let (mut u, mut v) = (below.weight, below.kappa);
        let mut passed = 1.0;
        for layer in self.layers.iter().rev() {
            let Medium { kappa, weight } = medium(layer.index);
            let (once, sine) = Medium { kappa, weight }.passage(TAU * layer.thickness_nm / lambda_nm);
            // The characteristic matrix times e^(jβ), of which no element overflows.
            let cosine = (once.square() + Complex::ONE) * 0.5;
            let (first, second) = (weight * sine, kappa.square() / weight * sine);
            (u, v) = (u * cosine - (v * first).times_j(), v * cosine - (u * second).times_j());
            passed *= once.norm_squared();
        }
        let above = Medium::new(Complex::new(self.above, 0.0), self.above, cos, plane);
        let admittance = above.kappa.re / above.weight.re;
        let all = (u * admittance + v).norm_squared();
        if !(all > 0.0) {
            return Shares::REFLECTED;
        }
        // The power across the last interface is Re(u* v) there.
        let crossing = (below.weight.conjugate() * below.kappa).re;
        Shares {
            reflectance: (u * admittance - v).norm_squared() / all,
            transmittance: 4.0 * admittance * crossing * passed / all,
        }
    }
}

/// The shares of one `layer` between the medium of index `above` and a substrate `below`, by summing the amplitudes of
/// all internal reflections: r = (r₀₁ + r₁₂ e^(2jβ)) / (1 + r₀₁ r₁₂ e^(2jβ)), β = 2π N₁ d cosθ₁ / λ; domain as
/// [`Stack::polarized`].
///
/// The sum needs the partial amplitudes of either face, which do not exist where light runs along the film (κ₁ = 0):
/// there [`Stack`] has the limit.
pub fn airy(above: f64, layer: Layer, below: Complex, cos_theta: f64, lambda_nm: f64) -> Polarized<Shares> {
    let cos = cos_theta.abs().min(1.0);
    let plane = |plane| {
        let [m0, m1, m2] =
            [Complex::new(above, 0.0), layer.index, below].map(|index| Medium::new(index, above, cos, plane));
        // r = (κ w′ − κ′ w)/(κ w′ + κ′ w) and t = 2 κ w′/(…) for the field that is E in s and H in p.
        let reflected = |a: Medium, b: Medium| {
            let (first, second) = (a.kappa * b.weight, b.kappa * a.weight);
            (first - second) / (first + second)
        };
        let (r01, r12) = (reflected(m0, m1), reflected(m1, m2));
        let once = (m1.kappa * (TAU * layer.thickness_nm / lambda_nm)).exp_j();
        let all = Complex::ONE + r01 * r12 * once.square();
        let r = (r01 + r12 * once.square()) / all;
        let t = (Complex::ONE + r01) * (Complex::ONE + r12) * once / all;
        let admittance = |m: Medium| (m.kappa / m.weight).re;
        Shares {
            reflectance: r.norm_squared(),
            transmittance: t.norm_squared() * admittance(m2) / admittance(m0),
        }
    };
    Polarized { s: plane(Plane::S), p: plane(Plane::P) }
}

#[cfg(test)]
mod tests {
    use super::super::films::{Film, reflectance_conductor, reflectance_dielectric};
    use super::super::fresnel::{conductor_polarized, dielectric_polarized};
    use super::*;
    use proptest::prelude::*;

    fn glass(eta: f64) -> Complex {
        Complex::new(eta, 0.0)
    }

    fn layer(index: Complex, thickness_nm: f64) -> Layer {
        Layer { index, thickness_nm }
    }

    fn near(a: Shares, b: Shares, tolerance: f64) -> bool {
        (a.reflectance - b.reflectance).abs() < tolerance
            && (a.transmittance - b.transmittance).abs() < tolerance
    }

    #[test]
    fn a_quarter_wave_coat_and_a_soap_film_have_the_checked_values() {
        let coat = layer(glass(1.38), 550.0 / (4.0 * 1.38));
        let stack = Stack { above: 1.0, layers: &[coat], below: glass(1.52) };
        assert!((stack.unpolarized(1.0, 550.0).reflectance - 0.012_600_79).abs() < 5e-9);
        let soap = Stack { above: 1.0, layers: &[layer(glass(1.33), 300.0)], below: glass(1.0) };
        let at_45 = soap.polarized(std::f64::consts::FRAC_1_SQRT_2, 550.0);
        assert!((at_45.s.reflectance - 0.091_779_12).abs() < 5e-9, "{at_45:?}");
        assert!((at_45.p.reflectance - 0.004_750_70).abs() < 5e-9, "{at_45:?}");
    }

    #[test]
    fn a_quarter_wave_mirror_reflects_as_its_closed_form() {
        // (H L)^m on glass: R = ((n0 − n_s (nH/nL)^2m)/(n0 + n_s (nH/nL)^2m))² (Born & Wolf, 1.6, 99–101).
        let (high, low) =
            (layer(glass(2.35), 550.0 / (4.0 * 2.35)), layer(glass(1.38), 550.0 / (4.0 * 1.38)));
        for pairs in [1_usize, 2, 5, 9] {
            let layers = [high, low].repeat(pairs);
            let ratio = 1.52 * (2.35_f64 / 1.38).powi(2 * i32::try_from(pairs).unwrap());
            let expected = ((1.0 - ratio) / (1.0 + ratio)).powi(2);
            let r =
                Stack { above: 1.0, layers: &layers, below: glass(1.52) }.unpolarized(1.0, 550.0).reflectance;
            assert!((r - expected).abs() < 1e-12, "{pairs}: {r} {expected}");
        }
    }

    #[test]
    fn a_bare_substrate_is_fresnels() {
        for cos in [1.0, 0.7, 0.2, 0.01] {
            let metal =
                Stack { above: 1.33, layers: &[], below: Complex::new(0.43, 2.455) }.polarized(cos, 550.0);
            let fresnel = conductor_polarized(cos, 0.43 / 1.33, 2.455 / 1.33);
            assert!(
                (metal.s.reflectance - fresnel.s).abs() < 1e-14
                    && (metal.p.reflectance - fresnel.p).abs() < 1e-14
            );
            let window = Stack { above: 1.0, layers: &[], below: glass(1.5) }.polarized(cos, 550.0);
            let fresnel = dielectric_polarized(cos, 1.5);
            assert!(
                (window.s.reflectance - fresnel.s).abs() < 1e-14
                    && (window.p.reflectance - fresnel.p).abs() < 1e-14
            );
        }
        let grazing = Stack { above: 1.0, layers: &[layer(glass(1.4), 10.0)], below: glass(1.5) }
            .unpolarized(0.0, 550.0);
        assert_eq!(grazing, Shares::REFLECTED);
    }

    #[test]
    fn a_thick_absorbing_layer_hides_what_is_below_it() {
        let gold = Complex::new(0.43, 2.455);
        let stack =
            Stack { above: 1.0, layers: &[layer(gold, 1e6), layer(glass(1.3), 80.0)], below: glass(1.5) };
        let (hidden, metal) = (stack.polarized(0.6, 550.0), conductor_polarized(0.6, 0.43, 2.455));
        assert!(
            (hidden.s.reflectance - metal.s).abs() < 1e-14 && (hidden.p.reflectance - metal.p).abs() < 1e-14
        );
        assert_eq!(hidden.unpolarized().transmittance, 0.0);
    }

    proptest! {
        #[test]
        fn airys_sum_and_the_matrix_agree_to_1e_12(
            cos in 0.02f64..1.0, above in 1.0f64..1.8, eta in 0.1f64..3.0, k in prop_oneof![Just(0.0), 0.0f64..4.0],
            eta_below in 0.1f64..4.0, k_below in prop_oneof![Just(0.0), 0.0f64..6.0], d in 0.0f64..500.0,
        ) {
            let film = layer(Complex::new(eta, k), d);
            let below = Complex::new(eta_below, k_below);
            // Near κ = 0 the partial amplitudes of Airy's form lose digits.
            for n in [eta, eta_below] {
                prop_assume!((n * n - above * above * (1.0 - cos * cos)).abs() > 1e-2);
            }
            let matrix = Stack { above, layers: &[film], below }.polarized(cos, 550.0);
            let sum = airy(above, film, below, cos, 550.0);
            prop_assert!(near(matrix.s, sum.s, 1e-12) && near(matrix.p, sum.p, 1e-12), "{matrix:?} {sum:?}");
        }

        #[test]
        fn a_stack_without_absorption_loses_nothing(
            cos in 0.0f64..1.0, above in 1.0f64..2.0, below in 1.0f64..2.0,
            films in prop::collection::vec((1.0f64..2.6, 0.0f64..300.0), 0..12), lambda in 360.0f64..830.0,
        ) {
            let layers: Vec<_> = films.iter().map(|&(n, d)| layer(glass(n), d)).collect();
            let shares = Stack { above, layers: &layers, below: glass(below) }.polarized(cos, lambda);
            prop_assert!(shares.s.absorptance().abs() < 1e-10 && shares.p.absorptance().abs() < 1e-10, "{shares:?}");
        }

        #[test]
        fn an_absorbing_stack_takes_power_and_gives_none(
            cos in 0.0f64..1.0, k_below in 0.0f64..5.0,
            films in prop::collection::vec((0.1f64..2.6, 0.0f64..5.0, 0.0f64..300.0), 0..8), lambda in 360.0f64..830.0,
        ) {
            let layers: Vec<_> = films.iter().map(|&(n, k, d)| layer(Complex::new(n, k), d)).collect();
            let shares = Stack { above: 1.0, layers: &layers, below: Complex::new(0.8, k_below) }.polarized(cos, lambda);
            for s in [shares.s, shares.p] {
                prop_assert!(s.absorptance() > -1e-10 && s.reflectance >= 0.0 && s.transmittance >= 0.0, "{s:?}");
            }
        }

        #[test]
        fn a_half_wave_layer_is_absent(n in 1.1f64..2.5, below in 1.0f64..2.0, k in 0.0f64..3.0, cos in 0.1f64..1.0, order in 1u32..4) {
            let cos_inside = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
            let half_wave = layer(glass(n), f64::from(order) * 550.0 / (2.0 * n * cos_inside));
            let below = Complex::new(below, k);
            let with = Stack { above: 1.0, layers: &[half_wave], below }.polarized(cos, 550.0);
            let without = Stack { above: 1.0, layers: &[], below }.polarized(cos, 550.0);
            prop_assert!(near(with.s, without.s, 1e-12) && near(with.p, without.p, 1e-12));
        }

        #[test]
        fn a_stack_transmits_alike_in_both_directions(
            cos in 0.1f64..1.0, below in 1.0f64..2.0,
            films in prop::collection::vec((0.3f64..2.6, 0.0f64..2.0, 0.0f64..100.0), 1..6),
        ) {
            let mut layers: Vec<_> = films.iter().map(|&(n, k, d)| layer(Complex::new(n, k), d)).collect();
            let down = Stack { above: 1.0, layers: &layers, below: glass(below) }.polarized(cos, 550.0);
            layers.reverse();
            let cos_below = (1.0 - (1.0 - cos * cos) / (below * below)).sqrt();
            let up = Stack { above: below, layers: &layers, below: glass(1.0) }.polarized(cos_below, 550.0);
            prop_assert!((down.s.transmittance - up.s.transmittance).abs() < 1e-12);
            prop_assert!((down.p.transmittance - up.p.transmittance).abs() < 1e-12);
        }

        #[test]
        fn films_for_rendering_agree_with_the_matrix(
            cos in 0.0f32..1.0, n in 0.5f32..2.6, d in 0.0f32..1000.0, eta in 0.4f32..3.0, k in 0.0f32..6.0, lambda in 360.0f32..830.0,
        ) {
            let film = layer(glass(f64::from(n)), f64::from(d));
            let shares = |below| {
                Stack { above: 1.0, layers: &[film], below }.unpolarized(f64::from(cos), f64::from(lambda)).reflectance
            };
            let film = Film { eta: n, thickness_nm: d };
            let dielectric = f64::from(reflectance_dielectric(cos, film, eta, lambda));
            let expected = shares(glass(f64::from(eta)));
            prop_assert!((dielectric - expected).abs() < 2e-5, "{dielectric} {expected}");
            let metal = f64::from(reflectance_conductor(cos, film, eta, k, lambda));
            let expected = shares(Complex::new(f64::from(eta), f64::from(k)));
            prop_assert!((metal - expected).abs() < 2e-5, "{metal} {expected}");
        }
    }
}
