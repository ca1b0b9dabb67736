//! Where axes are marked, and with which numbers.

/// Marks of an axis and how their numbers are written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    /// Lower and upper end of the axis; the lower is below the upper.
    pub(super) range: [f64; 2],
    /// Marked values within the range, ascending.
    pub(super) at: Vec<f64>,
    /// Step of a linear axis; `None` for powers of ten.
    step: Option<f64>,
}

impl Ticks {
    /// A linear axis over the range with about `count` marks, widened to whole steps unless `exact`.
    pub(super) fn linear(range: [f64; 2], count: usize, ends: Ends) -> Self {
        let [lo, hi] = proper(range);
        Self::stepped([lo, hi], nice((hi - lo) / count.max(1) as f64), ends)
    }

    /// A linear axis with marks at multiples of a step.
    pub(super) fn stepped(range: [f64; 2], step: f64, ends: Ends) -> Self {
        let [mut lo, mut hi] = proper(range);
        // Rounding must not add a step to a range that ends on one.
        let slack = 1e-9;
        if ends == Ends::OnMarks {
            lo = (lo / step + slack).floor() * step;
            hi = (hi / step - slack).ceil() * step;
        }
        let (first, last) = ((lo / step - slack).ceil() as i64, (hi / step + slack).floor() as i64);
        Self { range: [lo, hi], at: (first..=last).map(|i| i as f64 * step).collect(), step: Some(step) }
    }

    /// A logarithmic axis up to the power of ten at or above `max`, `decades` long.
    pub(super) fn logarithmic(max: f64, decades: i32) -> Self {
        let top = if max > 0.0 && max.is_finite() { (max.log10() - 1e-9).ceil() as i32 } else { 0 };
        let bottom = top - decades.max(1);
        Self {
            range: [10_f64.powi(bottom), 10_f64.powi(top)],
            at: (bottom..=top).map(|e| 10_f64.powi(e)).collect(),
            step: None,
        }
    }

    /// Where a value lies between the ends, 0 to 1; values beyond a logarithmic axis' lower end lie on it.
    pub(super) fn fraction(&self, x: f64) -> f64 {
        let [lo, hi] = self.range;
        match self.step {
            Some(_) => (x - lo) / (hi - lo),
            None => (x.max(lo) / lo).log10() / (hi / lo).log10(),
        }
    }

    /// The number at a mark.
    pub(super) fn label(&self, x: f64) -> String {
        let Some(step) = self.step else { return power_of_ten(x) };
        let largest = self.range[0].abs().max(self.range[1].abs());
        if largest >= 1e5 || step < 1e-4 {
            return scientific(x, step);
        }
        let decimals = (-(step * 1.000_001).log10().floor()).max(0.0) as usize;
        // A step such as 0.25 needs one digit more than its first.
        let decimals =
            decimals + usize::from(((step * 10_f64.powi(decimals as i32)).fract() - 0.5).abs() < 0.1);
        minus(format!("{x:.decimals$}"))
    }
}

/// Whether an axis ends where its data end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ends {
    /// On the data.
    Exact,
    /// On the next marks.
    OnMarks,
}

/// A range that has a length: of a single value, one around it.
fn proper([lo, hi]: [f64; 2]) -> [f64; 2] {
    if !(lo.is_finite() && hi.is_finite()) {
        return [0.0, 1.0];
    }
    if hi - lo > 1e-12 * lo.abs().max(hi.abs()) {
        [lo, hi]
    } else if lo == 0.0 {
        [0.0, 1.0]
    } else {
        let half = 0.5 * lo.abs();
        [lo - half, lo + half]
    }
}

/// The next of 1, 2, 2.5, 5 times a power of ten.
fn nice(x: f64) -> f64 {
    let power = 10_f64.powf(x.log10().floor());
    let lead = x / power;
    let lead = [1.0, 2.0, 2.5, 5.0].into_iter().find(|n| lead <= n * (1.0 + 1e-9)).unwrap_or(10.0);
    lead * power
}

fn power_of_ten(x: f64) -> String {
    let exponent = x.log10().round() as i32;
    match exponent {
        0 => "1".to_owned(),
        1..=3 => format!("{x:.0}"),
        -3..=-1 => format!("{x:.*}", -exponent as usize),
        _ => format!("10{}", superscript(exponent)),
    }
}

fn scientific(x: f64, step: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let exponent = x.abs().log10().floor() as i32;
    let decimals = (exponent - step.log10().floor() as i32).clamp(0, 6) as usize;
    let lead = x / 10_f64.powi(exponent);
    minus(format!("{lead:.decimals$}·10{}", superscript(exponent)))
}

fn minus(text: String) -> String {
    if text.starts_with('-') { text.replacen('-', "−", 1) } else { text }
}

fn superscript(exponent: i32) -> String {
    exponent
        .to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '0' => '⁰',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '4' => '⁴',
            '5' => '⁵',
            '6' => '⁶',
            '7' => '⁷',
            '8' => '⁸',
            _ => '⁹',
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(t: &Ticks) -> Vec<String> {
        t.at.iter().map(|x| t.label(*x)).collect()
    }

    #[test]
    fn axes_are_marked_as_people_would() {
        assert_eq!(
            labels(&Ticks::linear([0.0, 0.93], 5, Ends::OnMarks)),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(labels(&Ticks::stepped([0.0, 90.0], 15.0, Ends::Exact)).last().unwrap(), "90");
        assert_eq!(
            labels(&Ticks::linear([-1.0, 0.0], 4, Ends::OnMarks)),
            ["−1.00", "−0.75", "−0.50", "−0.25", "0.00"]
        );
        assert_eq!(labels(&Ticks::linear([0.0, 4e6], 2, Ends::OnMarks)), ["0", "2·10⁶", "4·10⁶"]);
        assert_eq!(labels(&Ticks::logarithmic(30.0, 5)), ["0.001", "0.01", "0.1", "1", "10", "100"]);
        assert_eq!(labels(&Ticks::logarithmic(1e-7, 1)), ["10⁻⁸", "10⁻⁷"]);
    }

    #[test]
    fn a_constant_has_an_axis_too() {
        assert_eq!(Ticks::linear([0.0, 0.0], 4, Ends::OnMarks).range, [0.0, 1.0]);
        let around = Ticks::linear([1.5, 1.5], 4, Ends::OnMarks).range;
        assert!(around[0] < 1.5 && around[1] > 1.5);
    }

    proptest! {
        #[test]
        fn a_linear_axis_covers_its_data_with_a_handful_of_marks(a in -1e6_f64..1e6, length in 1e-3_f64..1e6) {
            let t = Ticks::linear([a, a + length], 5, Ends::OnMarks);
            prop_assert!(t.range[0] <= a + 1e-6 * length && t.range[1] >= a + length * (1.0 - 1e-6));
            prop_assert!((2..=8).contains(&t.at.len()), "{:?}", t);
            let written = labels(&t);
            prop_assert!(written.windows(2).all(|w| w[0] != w[1]), "{:?}", written);
        }
    }
}
