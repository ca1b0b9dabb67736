//! The wavelengths that one path carries, and the spectral values at them.

use crate::units::{PdfSolidAngle, PerSteradian, Quantity, Radiance, Unitless};
use std::marker::PhantomData;
use std::ops::{Add, AddAssign, Div, Index, Mul, MulAssign, Sub};

/// Wavelengths carried by one path: a hero and its companions (Wilkie et al. 2014).
pub const LANES: usize = 4;

/// The film's default spectral range [nm].
pub const LAMBDA_MIN: f32 = 360.0;
/// The film's default spectral range [nm].
pub const LAMBDA_MAX: f32 = 830.0;

/// The wavelengths of one path [nm] with their densities [nm⁻¹].
#[derive(Clone, Copy, Debug)]
pub struct Wavelengths {
    lambda: [f32; LANES],
    pdf: [f32; LANES],
    terminated: bool,
}

impl Wavelengths {
    /// Wavelengths distributed like the eye's sensitivity over 360–830 nm, stratified by one u in [0, 1).
    ///
    /// Density 0.0039398042 / cosh²(0.0072 (λ − 538)) (Radziszewski et al. 2009; constants as in pbrt-v4 book, 4.5.4).
    pub fn sample_visible(u: f32) -> Self {
        let mut s = Self { lambda: [0.0; LANES], pdf: [0.0; LANES], terminated: false };
        for i in 0..LANES {
            let mut up = u + i as f32 / LANES as f32;
            if up >= 1.0 {
                up -= 1.0;
            }
            let x = 0.856_910_62 - 1.827_502_0 * up;
            // atanh x = ½ ln((1 + x)/(1 − x)); |x| < 0.98.
            let atanh = 0.5 * ((1.0 + x) / (1.0 - x)).ln();
            s.lambda[i] = (538.0 - 138.888_889 * atanh).clamp(LAMBDA_MIN, LAMBDA_MAX);
            // [`Wavelengths::visible_pdf`], by 1/cosh² = 1 − tanh².
            s.pdf[i] = 0.003_939_804_2 * (1.0 - x * x);
        }
        s
    }

    /// Density of [`Wavelengths::sample_visible`] [nm⁻¹]; zero outside 360–830 nm.
    pub fn visible_pdf(lambda: f32) -> f32 {
        if !(LAMBDA_MIN..=LAMBDA_MAX).contains(&lambda) {
            return 0.0;
        }
        let c = (0.0072 * (lambda - 538.0)).cosh();
        0.003_939_804_2 / (c * c)
    }

    /// Wavelengths uniform over [`min`, `max`] nm, stratified by one u in [0, 1).
    pub fn sample_uniform(u: f32, min: f32, max: f32) -> Self {
        let range = max - min;
        let lambda = std::array::from_fn(|i| min + range * (u + i as f32 / LANES as f32).fract());
        Self { lambda, pdf: [1.0 / range; LANES], terminated: false }
    }

    /// The given wavelengths [nm], for measurements; their densities mean nothing.
    pub fn exactly(lambda: [f32; LANES]) -> Self {
        Self { lambda, pdf: [1.0; LANES], terminated: false }
    }

    /// The wavelengths [nm]; the first is the hero.
    pub fn lambda(&self) -> &[f32; LANES] {
        &self.lambda
    }

    /// Densities [nm⁻¹]; zero for companions that were dropped.
    pub fn pdf(&self) -> &[f32; LANES] {
        &self.pdf
    }

    /// Drops the companions when the path becomes dispersive: only the hero still contributes,
    /// with its density divided by the number of lanes that it now stands for.
    pub fn terminate_companions(&mut self) {
        if self.terminated {
            return;
        }
        self.terminated = true;
        self.pdf[1..].fill(0.0);
        self.pdf[0] /= LANES as f32;
    }

    /// Whether the companions were dropped.
    pub fn companions_terminated(&self) -> bool {
        self.terminated
    }
}

/// Values of the quantity `Q` at the wavelengths of one path.
#[repr(C, align(16))]
pub struct Sampled<Q> {
    v: [f32; LANES],
    tag: PhantomData<Q>,
}

impl<Q> Clone for Sampled<Q> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<Q> Copy for Sampled<Q> {}

impl<Q> PartialEq for Sampled<Q> {
    fn eq(&self, other: &Self) -> bool {
        self.v == other.v
    }
}

impl<Q: Quantity> std::fmt::Debug for Sampled<Q> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?} {}", self.v, Q::UNIT)
    }
}

impl<Q> Default for Sampled<Q> {
    fn default() -> Self {
        Self::ZERO
    }
}

impl<Q> Sampled<Q> {
    /// Zero at every wavelength.
    pub const ZERO: Self = Self::splat(0.0);

    /// The same value at every wavelength.
    pub const fn splat(x: f32) -> Self {
        Self { v: [x; LANES], tag: PhantomData }
    }

    /// From one value per wavelength.
    pub const fn from_array(v: [f32; LANES]) -> Self {
        Self { v, tag: PhantomData }
    }

    /// From a function of the lane index.
    #[inline]
    pub fn from_fn(mut f: impl FnMut(usize) -> f32) -> Self {
        // A loop: `array::from_fn` is not always inlined, and then not vectorised.
        let mut v = [0.0; LANES];
        for (lane, v) in v.iter_mut().enumerate() {
            *v = f(lane);
        }
        Self::from_array(v)
    }

    /// The values, one per wavelength.
    pub const fn to_array(self) -> [f32; LANES] {
        self.v
    }

    /// Applies `f` per wavelength.
    #[must_use]
    #[inline]
    pub fn map(self, mut f: impl FnMut(f32) -> f32) -> Self {
        Self::from_fn(|lane| f(self.v[lane]))
    }

    /// The same numbers as another quantity. Each use is a change of unit and deserves its reason.
    pub const fn cast<R>(self) -> Sampled<R> {
        Sampled::from_array(self.v)
    }

    /// Largest value.
    pub fn max(self) -> f32 {
        self.v.iter().fold(f32::NEG_INFINITY, |a, &b| a.max(b))
    }

    /// Smallest value.
    pub fn min(self) -> f32 {
        self.v.iter().fold(f32::INFINITY, |a, &b| a.min(b))
    }

    /// Mean over the wavelengths.
    pub fn mean(self) -> f32 {
        self.v.iter().sum::<f32>() / LANES as f32
    }

    /// Whether the value is zero at every wavelength. NaN is not zero.
    pub fn is_zero(self) -> bool {
        self.v.iter().all(|&x| x == 0.0)
    }

    /// Whether every value is finite.
    pub fn is_finite(self) -> bool {
        self.v.iter().all(|x| x.is_finite())
    }

    /// Limits every value to [lo, hi].
    #[must_use]
    pub fn clamp(self, lo: f32, hi: f32) -> Self {
        self.map(|x| x.clamp(lo, hi))
    }
}

impl Sampled<Unitless> {
    /// One at every wavelength.
    pub const ONE: Self = Self::splat(1.0);

    /// e^x per wavelength.
    #[must_use]
    pub fn exp(self) -> Self {
        self.map(f32::exp)
    }
}

impl Sampled<PerSteradian> {
    /// f·|cosθ|/p: the weight of a direction drawn with density p, B (2.27).
    pub fn weight(self, abs_cos: f32, pdf: PdfSolidAngle) -> Sampled<Unitless> {
        (self * (abs_cos / pdf.0)).cast()
    }

    /// f·|cosθ|·L/p: one sample of the directional integral of reflected radiance, A (31), B (2.26).
    pub fn reflect(self, radiance: Sampled<Radiance>, abs_cos: f32, pdf: PdfSolidAngle) -> Sampled<Radiance> {
        self.weight(abs_cos, pdf) * radiance
    }
}

impl<Q> Index<usize> for Sampled<Q> {
    type Output = f32;
    fn index(&self, lane: usize) -> &f32 {
        &self.v[lane]
    }
}

impl<Q> Add for Sampled<Q> {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        Self::from_fn(|i| self.v[i] + rhs.v[i])
    }
}

impl<Q> AddAssign for Sampled<Q> {
    fn add_assign(&mut self, rhs: Self) {
        *self = *self + rhs;
    }
}

impl<Q> Sub for Sampled<Q> {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        Self::from_fn(|i| self.v[i] - rhs.v[i])
    }
}

impl<Q> Mul<f32> for Sampled<Q> {
    type Output = Self;
    fn mul(self, rhs: f32) -> Self {
        self.map(|x| x * rhs)
    }
}

impl<Q> Div<f32> for Sampled<Q> {
    type Output = Self;
    fn div(self, rhs: f32) -> Self {
        self.map(|x| x / rhs)
    }
}

/// A ratio times a quantity is that quantity.
impl<Q> Mul<Sampled<Q>> for Sampled<Unitless> {
    type Output = Sampled<Q>;
    fn mul(self, rhs: Sampled<Q>) -> Sampled<Q> {
        Sampled::from_fn(|i| self.v[i] * rhs.v[i])
    }
}

impl MulAssign for Sampled<Unitless> {
    fn mul_assign(&mut self, rhs: Self) {
        *self = *self * rhs;
    }
}

impl Div for Sampled<Unitless> {
    type Output = Self;
    fn div(self, rhs: Self) -> Self {
        Self::from_fn(|i| self.v[i] / rhs.v[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn visible_density_integrates_to_one_and_samples_follow_it() {
        let n = 47_000;
        let step = (LAMBDA_MAX - LAMBDA_MIN) / n as f32;
        let mass: f64 = (0..n)
            .map(|i| f64::from(Wavelengths::visible_pdf(LAMBDA_MIN + (i as f32 + 0.5) * step) * step))
            .sum();
        assert!((mass - 1.0).abs() < 1e-4, "{mass}");
        // ∫ g dλ estimated by importance sampling, for g = λ: (830² − 360²)/2.
        let m = 20_000;
        let mut sum = 0.0_f64;
        for i in 0..m {
            let w = Wavelengths::sample_visible((i as f32 + 0.5) / m as f32);
            for lane in 0..LANES {
                sum += f64::from(w.lambda()[lane] / w.pdf()[lane]) / LANES as f64;
            }
        }
        let exact = (830.0_f64.powi(2) - 360.0_f64.powi(2)) / 2.0;
        assert!((sum / f64::from(m) / exact - 1.0).abs() < 1e-3, "{}", sum / f64::from(m) / exact);
    }

    #[test]
    fn samples_carry_their_density() {
        for i in 0..1000 {
            let w = Wavelengths::sample_visible((i as f32 + 0.5) / 1000.0);
            for (&lambda, &pdf) in w.lambda().iter().zip(w.pdf()) {
                assert!((LAMBDA_MIN..=LAMBDA_MAX).contains(&lambda));
                assert!((pdf / Wavelengths::visible_pdf(lambda) - 1.0).abs() < 1e-4, "{lambda}: {pdf}");
            }
        }
    }

    #[test]
    fn dropping_companions_keeps_the_estimator_unbiased() {
        let m = 20_000;
        let mut sum = 0.0_f64;
        for i in 0..m {
            let mut w = Wavelengths::sample_uniform((i as f32 + 0.5) / m as f32, 400.0, 700.0);
            w.terminate_companions();
            w.terminate_companions();
            for lane in 0..LANES {
                if w.pdf()[lane] > 0.0 {
                    sum += f64::from(1.0 / w.pdf()[lane]) / LANES as f64;
                }
            }
        }
        assert!((sum / f64::from(m) - 300.0).abs() < 0.01, "{}", sum / f64::from(m));
    }
}
