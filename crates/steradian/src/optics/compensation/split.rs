//! How a loss is divided between the sides of an interface, and what metals keep of it.

use super::half::Half;

/// Which share of the loss of an interface is given back to the other side.
///
/// With f(i → o) = (1 − t) m m / (πM) on the side of the light and t m m / (πM) beyond, each with the M of the side that it
/// leaves to, nothing is lost whatever t is, and reflection is reciprocal. Transmission is so, f(i → o) / ηo² =
/// f(o → i) / ηi², exactly if t₁ η₁² M₁ = t₂ η₂² M₂: one degree of freedom remains. The hemispherical transmittances T of
/// the smooth interface obey T₁ η₁² = T₂ η₂², so that t₁ = T₁ M₂ / max(M₁, M₂) and its counterpart solve it, between
/// zero and one; where both sides lose alike, the loss is split as diffuse light is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    above: f32,
    below: f32,
}

impl Split {
    /// From the index below over above, the smooth interface's hemispherical transmittance from above, and the mean losses.
    pub fn new(eta: f32, transmittance: f32, mean_above: f32, mean_below: f32) -> Self {
        let largest = mean_above.max(mean_below).max(f32::MIN_POSITIVE);
        let eta2 = eta * eta;
        // From below it is transmittance / η², neither of which exceeds one but for interpolation.
        let transmittance = transmittance.clamp(0.0, eta2.min(1.0));
        Self {
            above: transmittance * (mean_below / largest),
            below: transmittance / eta2 * (mean_above / largest),
        }
    }

    /// t for light from a half.
    pub fn transmitted(&self, from: Half) -> f32 {
        match from {
            Half::Above => self.above,
            Half::Below => self.below,
        }
    }
}

/// What of the loss of a perfect mirror a metal gives back: F̄² Ē / (1 − F̄ (1 − Ē)) for all further reflections, each
/// with the hemispherical reflectance F̄, when a share Ē leaves after each (Hill 2018; Kulla & Conty 2017). One for F̄ = 1.
pub fn further_reflections(f_mean: f32, mean_loss: f32) -> f32 {
    let e = 1.0 - mean_loss;
    // Zero over zero for a mirror that nothing leaves.
    f_mean * f_mean * e / (1.0 - f_mean * mean_loss).max(f32::MIN_POSITIVE)
}
