//! How thoroughly to examine.

use super::statistics;

/// How thoroughly to examine, and how sure to be.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Samples per direction and mode.
    pub samples: u32,
    /// Seed of the random numbers.
    pub seed: u64,
    /// How densely angles and pairs of directions are searched.
    pub coverage: Coverage,
    /// Probability of rejecting any law that holds, in the whole run.
    pub level: f64,
    /// Statistical tests in the whole run.
    pub tests: u32,
}

/// How densely angles and pairs of directions are searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coverage {
    /// A few angles, for tests that run often.
    Few,
    /// Angles from normal to grazing incidence on both sides.
    Full,
}

/// An upper estimate of the statistical tests that one subject takes.
const TESTS_PER_SUBJECT: u32 = 400;

impl Effort {
    /// For tests that run often: some 0.1 s for a closed form.
    pub const QUICK: Self =
        Self { samples: 1 << 15, seed: 1, coverage: Coverage::Few, level: 0.01, tests: TESTS_PER_SUBJECT };
    /// For a verdict: half a second for a closed form.
    pub const NORMAL: Self = Self { samples: 1 << 16, coverage: Coverage::Full, ..Self::QUICK };
    /// Sixteen times the samples.
    pub const THOROUGH: Self = Self { samples: 1 << 20, ..Self::NORMAL };

    /// The same effort as one of `subjects` in the run, which share the level.
    #[must_use]
    pub fn among(self, subjects: usize) -> Self {
        let subjects = u32::try_from(subjects.max(1)).unwrap_or(u32::MAX);
        Self { tests: TESTS_PER_SUBJECT.saturating_mul(subjects), ..self }
    }

    /// The same effort with other random numbers.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Level of each test: 1 − (1 − level)^(1/tests) (Šidák 1967).
    pub fn significance(&self) -> f64 {
        statistics::sidak(self.level, self.tests)
    }

    /// Two-sided normal deviate of the same level, for numbers with a standard error.
    pub fn sigmas(&self) -> f64 {
        statistics::two_sided_deviate(self.significance())
    }
}

impl Default for Effort {
    fn default() -> Self {
        Self::NORMAL
    }
}
