//! Examples that each variant hands to the conformance suite, with what it claims about them.

/// What a variant claims to hold for a specimen; the suite tests the claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Claims {
    /// ρ + τ = 1 for every incident direction.
    pub lossless: bool,
    /// Values and densities are closed forms, and `density` is that of the samples. Otherwise values are
    /// unbiased estimates, and the density is only an approximation for multiple importance sampling.
    pub closed_form: bool,
}

impl Claims {
    /// A closed form that may absorb.
    pub const CLOSED_FORM: Self = Self { lossless: false, closed_form: true };
    /// A closed form that absorbs nothing.
    pub const LOSSLESS: Self = Self { lossless: true, closed_form: true };
    /// An estimate by random walks.
    pub const ESTIMATED: Self = Self { lossless: false, closed_form: false };
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
