//! The wavelengths that one path carries, and the spectral values at them.

use super::visible;
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
    /// Where the wavelengths lie among the nanometres of the default range, so that tables at 1 nm need not ask again: the
    /// number of the interval, [`OUTSIDE`] it beyond the range, and the fraction of it.
    cell: [u32; LANES],
    fraction: [f32; LANES],
    terminated: bool,
}

/// The interval of a wavelength outside of the default range: no table has that many entries.
const OUTSIDE: u32 = 1 << 30;

impl Wavelengths {
    /// Wavelengths for a picture in colour, distributed over 360–830 nm as [`Wavelengths::visible_pdf`] says; stratified by
    /// one u in [0, 1). Our deviation from pbrt-v4, whose density resembles the eye's sensitivity.
    #[inline]
    pub fn sample_visible(u: f32) -> Self {
        let (mut lambda, mut pdf) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let up = u + i as f32 / LANES as f32;
            let drawn = visible::draw(if up >= 1.0 { up - 1.0 } else { up });
            (lambda[i], pdf[i]) = (drawn.lambda, drawn.pdf);
        }
        Self::new(lambda, pdf)
    }

    #[inline]
    fn new(lambda: [f32; LANES], pdf: [f32; LANES]) -> Self {
        let (mut cell, mut fraction) = ([0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let x = lambda[i] - LAMBDA_MIN;
            // The end of the range belongs to the last interval.
            let floor = (x as i32).min((LAMBDA_MAX - LAMBDA_MIN) as i32 - 1);
            let inside = (0.0..=LAMBDA_MAX - LAMBDA_MIN).contains(&x);
            cell[i] = if inside { floor as u32 } else { OUTSIDE };
            fraction[i] = x - floor as f32;
        }
        Self { lambda, pdf, cell, fraction, terminated: false }
    }

    /// Values at the wavelengths, linear between those of a table at 360, 361, … 830 nm; zero outside.
    #[inline(always)]
    pub(super) fn look_up(&self, table: &[f32]) -> [f32; LANES] {
        let (mut low, mut high) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let at = self.cell[i] as usize;
            if let Some(&[a, b]) = table.get(at..at + 2) {
                (low[i], high[i]) = (a, b);
            }
        }
        let mut out = [0.0; LANES];
        for i in 0..LANES {
            out[i] = low[i] + self.fraction[i] * (high[i] - low[i]);
        }
        out
    }

    /// The wavelength `lane` among the rows of a table at 360, 361, … 830 nm: the row before it and how far beyond that
    /// row it lies; `None` outside.
    #[inline]
    pub(crate) fn row(&self, lane: usize) -> Option<(usize, f32)> {
        (self.cell[lane] != OUTSIDE).then(|| (self.cell[lane] as usize, self.fraction[lane]))
    }

    /// Density of [`Wavelengths::sample_visible`] [nm⁻¹]; zero outside 360–830 nm.
    pub fn visible_pdf(lambda: f32) -> f32 {
        if !(LAMBDA_MIN..=LAMBDA_MAX).contains(&lambda) {
            return 0.0;
        }
        visible::density(lambda)
    }

    /// Wavelengths uniform over [`min`, `max`] nm, stratified by one u in [0, 1).
    pub fn sample_uniform(u: f32, min: f32, max: f32) -> Self {
        let range = max - min;
        let lambda = std::array::from_fn(|i| min + range * (u + i as f32 / LANES as f32).fract());
        Self::new(lambda, [1.0 / range; LANES])
    }

    /// The given wavelengths [nm], for measurements; their densities mean nothing.
    pub fn exactly(lambda: [f32; LANES]) -> Self {
        Self::new(lambda, [1.0; LANES])
    }

    /// The wavelengths [nm]; the first is the hero.
    #[inline]
    pub fn lambda(&self) -> &[f32; LANES] {
        &self.lambda
    }

    /// Densities [nm⁻¹]; zero for companions that were dropped.
    #[inline]
    pub fn pdf(&self) -> &[f32; LANES] {
        &self.pdf
    }

    /// Drops the companions when the path becomes dispersive: only the hero still contributes,
    /// with its density divided by the number of lanes that it now stands for.
    #[inline]
    pub fn terminate_companions(&mut self) {
        if self.terminated {
            return;
        }
        self.terminated = true;
        self.pdf[1..].fill(0.0);
        self.pdf[0] /= LANES as f32;
    }

    /// Whether the companions were dropped.
    #[inline]
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
    #[inline]
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
    #[inline]
    pub const fn splat(x: f32) -> Self {
        Self { v: [x; LANES], tag: PhantomData }
    }

    /// From one value per wavelength.
    #[inline]
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
    #[inline]
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
    #[inline]
    pub const fn cast<R>(self) -> Sampled<R> {
        Sampled::from_array(self.v)
    }

    /// Largest value.
    #[inline]
    pub fn max(self) -> f32 {
        // A comparison each, where `f32::max` takes four: NaN is passed over either way.
        self.v.iter().fold(f32::NEG_INFINITY, |a, &b| if b > a { b } else { a })
    }

    /// Smallest value.
    #[inline]
    pub fn min(self) -> f32 {
        self.v.iter().fold(f32::INFINITY, |a, &b| a.min(b))
    }

    /// Mean over the wavelengths.
    #[inline]
    pub fn mean(self) -> f32 {
        self.v.iter().sum::<f32>() / LANES as f32
    }

    /// Whether the value is zero at every wavelength. NaN is not zero.
    #[inline]
    pub fn is_zero(self) -> bool {
        // Without branches: all lanes at once.
        self.v.iter().fold(true, |all, &x| all & (x == 0.0))
    }

    /// Whether every value is finite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.v.iter().all(|x| x.is_finite())
    }

    /// Limits every value to [lo, hi].
    #[must_use]
    #[inline]
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
    #[inline]
    pub fn weight(self, abs_cos: f32, pdf: PdfSolidAngle) -> Sampled<Unitless> {
        (self * (abs_cos / pdf.0)).cast()
    }

    /// f·|cosθ|·L/p: one sample of the directional integral of reflected radiance, A (31), B (2.26).
    #[inline]
    pub fn reflect(self, radiance: Sampled<Radiance>, abs_cos: f32, pdf: PdfSolidAngle) -> Sampled<Radiance> {
        self.weight(abs_cos, pdf) * radiance
    }
}

impl<Q> Index<usize> for Sampled<Q> {
    type Output = f32;
    #[inline]
    fn index(&self, lane: usize) -> &f32 {
        &self.v[lane]
    }
}

impl<Q> Add for Sampled<Q> {
    type Output = Self;
    #[inline]
    fn add(self, rhs: Self) -> Self {
        Self::from_fn(|i| self.v[i] + rhs.v[i])
    }
}

impl<Q> AddAssign for Sampled<Q> {
    #[inline]
    fn add_assign(&mut self, rhs: Self) {
        *self = *self + rhs;
    }
}

impl<Q> Sub for Sampled<Q> {
    type Output = Self;
    #[inline]
    fn sub(self, rhs: Self) -> Self {
        Self::from_fn(|i| self.v[i] - rhs.v[i])
    }
}

impl<Q> Mul<f32> for Sampled<Q> {
    type Output = Self;
    #[inline]
    fn mul(self, rhs: f32) -> Self {
        self.map(|x| x * rhs)
    }
}

impl<Q> Div<f32> for Sampled<Q> {
    type Output = Self;
    #[inline]
    fn div(self, rhs: f32) -> Self {
        self.map(|x| x / rhs)
    }
}

/// A ratio times a quantity is that quantity.
impl<Q> Mul<Sampled<Q>> for Sampled<Unitless> {
    type Output = Sampled<Q>;
    #[inline]
    fn mul(self, rhs: Sampled<Q>) -> Sampled<Q> {
        Sampled::from_fn(|i| self.v[i] * rhs.v[i])
    }
}

impl MulAssign for Sampled<Unitless> {
    #[inline]
    fn mul_assign(&mut self, rhs: Self) {
        *self = *self * rhs;
    }
}

impl Div for Sampled<Unitless> {
    type Output = Self;
    #[inline]
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
