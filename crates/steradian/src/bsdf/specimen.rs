//! Examples that each variant hands to the conformance suite, and what a scattering function claims about itself.

/// What a scattering function claims to hold; the suite tests the claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Claims {
    /// What becomes of the light.
    pub energy: Energy,
    /// Whether both ways along a path are alike.
    pub reciprocity: Reciprocity,
    /// How values come about.
    pub values: Values,
}

/// What becomes of the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Energy {
    /// ρ + τ = 1 for every incident direction, within `tolerance`: 0.002, or 0.01 where compensation is tabulated.
    Lossless {
        /// Largest |ρ + τ − 1|.
        tolerance: f64,
    },
    /// ρ + τ ≤ 1, B (2.19).
    Passive,
    /// May return more light than arrives: no law of nature. The suite expects to find a direction that shows it.
    Unbounded,
}

/// Whether f(wo, wi) η² = f(wi, wo), B (2.18).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reciprocity {
    /// It holds.
    Exact,
    /// It holds approximately: the worst pair is reported and not judged.
    Reported,
    /// It does not hold, and the suite expects to find a pair that shows it.
    Broken,
}

/// How values come about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// Values and densities are closed forms, and `density` is that of the samples.
    ClosedForm,
    /// Values are unbiased estimates, and the density is only an approximation for multiple importance sampling.
    Estimated,
    /// Estimates that a named choice biases, so that values and samples disagree: it is shown and not judged.
    Biased,
    /// The closed form of such estimates.
    BiasedClosedForm,
}

impl Claims {
    /// A closed form that may absorb.
    pub const CLOSED_FORM: Self =
        Self { energy: Energy::Passive, reciprocity: Reciprocity::Exact, values: Values::ClosedForm };
    /// A closed form that absorbs nothing.
    pub const LOSSLESS: Self = Self { energy: Energy::Lossless { tolerance: 0.002 }, ..Self::CLOSED_FORM };
    /// An estimate by random walks.
    pub const ESTIMATED: Self = Self { values: Values::Estimated, ..Self::CLOSED_FORM };
    /// The same, with values that a named choice biases.
    pub const BIASED: Self = Self { values: Values::Biased, ..Self::CLOSED_FORM };

    /// The closed form of such values.
    pub const BIASED_CLOSED_FORM: Self = Self { values: Values::BiasedClosedForm, ..Self::CLOSED_FORM };

    /// The same claims with another one about energy.
    #[must_use]
    pub const fn with_energy(self, energy: Energy) -> Self {
        Self { energy, ..self }
    }

    /// The same claims with another one about reciprocity.
    #[must_use]
    pub const fn with_reciprocity(self, reciprocity: Reciprocity) -> Self {
        Self { reciprocity, ..self }
    }

    /// Whether a named choice biases the values.
    pub fn has_named_bias(&self) -> bool {
        matches!(self.values, Values::Biased | Values::BiasedClosedForm)
    }

    /// Whether values come about by random walks.
    pub fn is_random(&self) -> bool {
        matches!(self.values, Values::Estimated | Values::Biased)
    }

    /// Whether values and densities are closed forms, without a bias between them.
    pub fn is_closed_form(&self) -> bool {
        self.values == Values::ClosedForm
    }
}

/// A scattering function for the suite.
#[derive(Clone, Copy, Debug)]
pub struct Specimen<B> {
    /// Name in reports.
    pub name: &'static str,
    /// The scattering function.
    pub bsdf: B,
    /// What is claimed to hold.
    pub claims: Claims,
}

impl<B> Specimen<B> {
    /// A named specimen with its claims.
    pub fn new(name: &'static str, claims: Claims, bsdf: B) -> Self {
        Self { name, bsdf, claims }
    }

    /// The same specimen of a wider type.
    pub fn map<C>(self, f: impl FnOnce(B) -> C) -> Specimen<C> {
        Specimen { name: self.name, bsdf: f(self.bsdf), claims: self.claims }
    }
}
