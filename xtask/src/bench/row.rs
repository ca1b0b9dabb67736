//! A measured figure and what it is measured against.

/// One line of the report: ours against a peer's, or ours against a bound.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// Heading under which the line stands.
    pub(crate) section: &'static str,
    /// What was measured, on what.
    pub(crate) name: String,
    /// Our figure, the median over the repetitions.
    pub(crate) ours: f64,
    /// The peer's figure, likewise; NaN without a peer.
    pub(crate) peer: f64,
    /// Unit of both.
    pub(crate) unit: &'static str,
    /// What the comparison came to; NaN without a peer.
    pub(crate) ratio: f64,
    /// Smallest and largest ratio of a repetition.
    pub(crate) spread: [f64; 2],
    /// What is asked for.
    pub(crate) target: Target,
    /// How it was measured, who the peer is, what to know when reading the figure.
    pub(crate) note: String,
}

/// What a figure must reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Target {
    /// The ratio must not fall below.
    RatioAtLeast(f64),
    /// Our figure must not exceed.
    AtMost(f64),
    /// Our figure must not fall below.
    AtLeast(f64),
    /// Printed for orientation.
    None,
}

impl Row {
    /// A comparison from interleaved repetitions `[ours, peer]`, larger being better: the ratio is the median of
    /// ours/peer over the repetitions.
    pub(crate) fn compared(
        section: &'static str,
        name: impl Into<String>,
        unit: &'static str,
        pairs: &[[f64; 2]],
        target: Target,
    ) -> Self {
        let column = |i: usize| median(&mut pairs.iter().map(|p| p[i]).collect::<Vec<_>>());
        let mut ratios: Vec<f64> = pairs.iter().map(|[a, b]| a / b).collect();
        let ratio = median(&mut ratios);
        let spread = match (ratios.first(), ratios.last()) {
            (Some(&lo), Some(&hi)) => [lo, hi],
            _ => [f64::NAN; 2],
        };
        let name = name.into();
        Self {
            section,
            name,
            ours: column(0),
            peer: column(1),
            unit,
            ratio,
            spread,
            target,
            note: String::new(),
        }
    }

    /// A figure of ours alone.
    pub(crate) fn alone(
        section: &'static str,
        name: impl Into<String>,
        unit: &'static str,
        ours: f64,
        target: Target,
    ) -> Self {
        let (name, nan) = (name.into(), f64::NAN);
        Self {
            section,
            name,
            ours,
            peer: nan,
            unit,
            ratio: nan,
            spread: [nan; 2],
            target,
            note: String::new(),
        }
    }

    /// The same with a remark.
    #[must_use]
    pub(crate) fn noted(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// Whether the target is reached; `None` without one.
    pub(crate) fn met(&self) -> Option<bool> {
        match self.target {
            Target::RatioAtLeast(x) => Some(self.ratio >= x),
            Target::AtMost(x) => Some(self.ours <= x),
            Target::AtLeast(x) => Some(self.ours >= x),
            Target::None => None,
        }
    }
}

/// The middle value, or the mean of the two middle ones; sorts `values`. NaN when empty.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    match n {
        0 => f64::NAN,
        _ => (values[(n - 1) / 2] + values[n / 2]) / 2.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ratio_is_the_median_over_the_repetitions() {
        let row =
            Row::compared("s", "n", "1/s", &[[2.0, 1.0], [9.0, 3.0], [4.0, 4.0]], Target::RatioAtLeast(2.0));
        assert_eq!((row.ours, row.peer, row.ratio, row.spread), (4.0, 3.0, 2.0, [1.0, 3.0]));
        assert_eq!(row.met(), Some(true));
        assert_eq!(Row::alone("s", "n", "B", 3.0, Target::AtMost(2.0)).met(), Some(false));
        assert_eq!(median(&mut [4.0, 1.0]), 2.5);
    }
}
