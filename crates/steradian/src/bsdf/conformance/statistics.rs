//! The few statistics that a verdict needs.

/// Running mean and variance (Welford 1962).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    n: u64,
    mean: f64,
    squares: f64,
}

impl Moments {
    /// As after `n` zeros.
    pub(super) fn zeros(n: u32) -> Self {
        Self { n: u64::from(n), ..Self::default() }
    }

    pub(super) fn add(&mut self, x: f64) {
        self.n += 1;
        let d = x - self.mean;
        self.mean += d / self.n as f64;
        self.squares += d * (x - self.mean);
    }

    pub(super) fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard error of the mean.
    pub(super) fn error(&self) -> f64 {
        (self.squares / (self.n.max(2) - 1) as f64 / self.n.max(1) as f64).sqrt()
    }
}

/// Pearson's test of counts against expectations.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChiSquared {
    pub(super) statistic: f64,
    pub(super) degrees_of_freedom: u32,
    /// Probability of a statistic at least as large when the counts follow the expectations.
    pub(super) p: f64,
}

/// Share of the samples by which quadrature may be wrong in all margins together.
const MARGIN: f64 = 5e-4;

impl ChiSquared {
    /// Cells that expect fewer than five counts, or less than a tenth of the mean, are pooled into one: margins of a lobe, in
    /// which the expectation is known worst.
    pub(super) fn test(observed: &[f64], expected: &[f64]) -> Self {
        let filled = expected.iter().filter(|&&e| e >= 5.0).count().max(1);
        let least = (0.1 * expected.iter().sum::<f64>() / filled as f64).max(5.0);
        let (mut statistic, mut cells) = (0.0, 0_u32);
        let mut pool = (0.0, 0.0);
        for (&o, &e) in observed.iter().zip(expected) {
            if e < least {
                pool = (pool.0 + o, pool.1 + e);
            } else {
                statistic += (o - e) * (o - e) / e;
                cells += 1;
            }
        }
        let mut strays = 1.0;
        let allowance = MARGIN * observed.iter().sum::<f64>();
        if pool.1 >= 5.0 {
            let off = ((pool.0 - pool.1).abs() - allowance).max(0.0);
            statistic += off * off / pool.1;
            cells += 1;
        } else if pool.0 > pool.1 {
            // Too few for a χ² limit: P(X ≥ o) of a Poisson variable, which is the lower gamma function.
            strays = (1.0 - upper_gamma(pool.0, pool.1 + allowance)).max(0.0);
        }
        let degrees_of_freedom = cells.saturating_sub(1).max(1);
        let p = upper_gamma(f64::from(degrees_of_freedom) / 2.0, statistic / 2.0);
        // Two tests in one.
        Self { statistic, degrees_of_freedom, p: if strays < p { (2.0 * strays).min(1.0) } else { p } }
    }
}

/// Level of each of `tests` independent tests that together reject a true law with probability `level` (Šidák 1967).
pub(super) fn sidak(level: f64, tests: u32) -> f64 {
    -f64::exp_m1(f64::ln_1p(-level) / f64::from(tests.max(1)))
}

/// z with P(|Z| > z) = `p` for a standard normal Z, 0 < p < 1: bisection of Q(½, z²/2) = p.
pub(super) fn two_sided_deviate(p: f64) -> f64 {
    let (mut low, mut high) = (0.0_f64, 40.0_f64);
    for _ in 0..60 {
        let z = 0.5 * (low + high);
        if upper_gamma(0.5, 0.5 * z * z) > p {
            low = z;
        } else {
            high = z;
        }
    }
    0.5 * (low + high)
}

/// Regularised upper incomplete gamma function Q(a, x) for a > 0, x ≥ 0: series below the mean, Lentz's
/// continued fraction above it (Abramowitz & Stegun 6.5.29, 6.5.31).
fn upper_gamma(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let front = (a * x.ln() - x - ln_gamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-15 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return (1.0 - sum * front).max(0.0);
    }
    const TINY: f64 = 1e-300;
    let mut b = x + 1.0 - a;
    let (mut c, mut d) = (1.0 / TINY, 1.0 / b);
    let mut h = d;
    for i in 1..10_000 {
        let i = f64::from(i);
        let an = -i * (i - a);
        b += 2.0;
        d = 1.0 / (an * d + b).abs().max(TINY).copysign(an * d + b);
        c = b + an / c;
        h *= d * c;
        if (d * c - 1.0).abs() < 1e-15 {
            break;
        }
    }
    (front * h).min(1.0)
}

/// ln Γ(x) for x > 0: Stirling's series, shifted to where eight digits need four terms.
fn ln_gamma(mut x: f64) -> f64 {
    let mut shift = 0.0;
    while x < 10.0 {
        shift += x.ln();
        x += 1.0;
    }
    let r = 1.0 / (x * x);
    let series = (1.0 / 12.0 - r * (1.0 / 360.0 - r * (1.0 / 1260.0 - r / 1680.0))) / x;
    (x - 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln() + series - shift
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::distribution::ContinuousCDF;

    #[test]
    fn levels_and_deviates_agree_with_an_independent_library() {
        let normal = statrs::distribution::Normal::standard();
        for p in [0.5, 0.05, 1e-3, 1e-7] {
            let z = two_sided_deviate(p);
            assert!((2.0 * normal.sf(z) / p - 1.0).abs() < 1e-6, "{p}: {z}");
        }
        let each = sidak(0.01, 1000);
        assert!((1.0 - (1.0 - each).powi(1000) - 0.01).abs() < 1e-12, "{each}");
    }

    #[test]
    fn counts_where_next_to_none_may_be_are_found_and_chance_is_not_accused() {
        let expected = [1000.0, 1000.0, 1.5, 2.5];
        let p = |strays| ChiSquared::test(&[1000.0, 1000.0, 0.0, strays], &expected).p;
        // With the margin 1.0: P(X ≥ 9 | 5) = 0.0681, P(X ≥ 40 | 5) < 1e-20.
        assert!((p(9.0) - 2.0 * 0.0682).abs() < 1e-3, "{}", p(9.0));
        assert!(p(40.0) < 1e-12 && p(4.0) > 0.5);
    }

    #[test]
    fn survival_of_chi_squared_agrees_with_an_independent_library() {
        for k in [1.0, 2.0, 7.0, 50.0, 900.0] {
            let reference = statrs::distribution::ChiSquared::new(k).unwrap();
            for factor in [0.1, 0.7, 1.0, 1.2, 1.6] {
                let x = k * factor;
                let (p, q) = (upper_gamma(k / 2.0, x / 2.0), reference.sf(x));
                assert!((p - q).abs() < 1e-9, "{k} {x}: {p} {q}");
            }
        }
    }
}
