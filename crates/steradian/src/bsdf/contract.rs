//! What every scattering function promises.
//!
//! ```text
//!            n = z
//!     wo     |     wi        wo: the known side, towards the sensor
//!       \    |    /          wi: the sampled side, towards the light
//!        \   |   /           both point away from the surface, in the local frame
//!   ______\__|__/______
//! ```
//!
//! `f` [sr⁻¹] contains no cosine. Randomness is an argument. Sampling that fails is `None`.

use crate::math::LocalDir;
use crate::spectrum::Sampled;
use crate::units::{Density, PdfSolidAngle, PerSteradian, Unitless};

/// What is transported along the path: radiance is scaled by (ηo/ηi)² through a refraction, power is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// From the sensor towards lights.
    Radiance,
    /// From lights towards the sensor.
    Importance,
}

impl Mode {
    /// The mode of the same path walked from its other end.
    #[must_use]
    pub fn adjoint(self) -> Self {
        match self {
            Self::Radiance => Self::Importance,
            Self::Importance => Self::Radiance,
        }
    }
}

/// Which side of the surface a sampled direction leaves to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Same side as `wo`.
    Reflection,
    /// Opposite side.
    Transmission,
}

/// Which sides are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// Reflection and transmission, chosen between in proportion to their power.
    Both,
    /// Reflection only.
    Reflection,
    /// Transmission only.
    Transmission,
}

impl Sides {
    /// Probability of choosing reflection where the reflectance is `r`.
    pub(crate) fn reflection_probability(self, r: f32) -> f32 {
        match self {
            Self::Both => r,
            Self::Reflection => 1.0,
            Self::Transmission => 0.0,
        }
    }

    /// Power that goes to a side over the probability of choosing it, where `power` is that side's share:
    /// one where the choice follows the power.
    pub(crate) fn weight(self, power: f32) -> f32 {
        match self {
            Self::Both => 1.0,
            Self::Reflection | Self::Transmission => power,
        }
    }
}

/// How wide the sampled lobe is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lobe {
    /// Lambertian or nearly so.
    Diffuse,
    /// Concentrated but continuous.
    Glossy,
    /// A discrete direction.
    Specular,
}

/// A direction drawn from a scattering function.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample {
    /// The sampled direction.
    pub wi: LocalDir,
    /// f·|cosθi|/p, formed analytically where f and p are closed forms; unbiased where both are estimated.
    /// For a discrete direction: the power ratio (times the radiance scale) over the probability of choosing it.
    pub weight: Sampled<Unitless>,
    /// Density of `wi` for multiple importance sampling; `Delta` for a discrete direction.
    pub density: Density,
    /// Side that `wi` leaves to.
    pub side: Side,
    /// Width of the lobe.
    pub lobe: Lobe,
    /// Relative index of refraction ηt/ηi that the sample crossed; 1 for reflection.
    pub eta: f32,
}

impl BsdfSample {
    /// A direction on the side of `wo`, drawn from the density `pdf` for the closed form `f`; `None` where the density
    /// vanishes.
    pub(crate) fn reflected(
        wi: LocalDir,
        f: Sampled<PerSteradian>,
        pdf: PdfSolidAngle,
        lobe: Lobe,
    ) -> Option<Self> {
        (pdf.0 > 0.0).then(|| Self {
            wi,
            weight: f.weight(wi.abs_cos_theta(), pdf),
            density: Density::SolidAngle(pdf),
            side: Side::Reflection,
            lobe,
            eta: 1.0,
        })
    }
}

/// Value and density of a pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluated {
    /// f [sr⁻¹], without the cosine and without discrete directions.
    pub f: Sampled<PerSteradian>,
    /// Density of `wi` among the continuous directions that are drawn for `wo`.
    pub pdf: PdfSolidAngle,
}

impl Evaluated {
    /// Directions that nothing is scattered between.
    pub(crate) const NOTHING: Self = Self { f: Sampled::ZERO, pdf: PdfSolidAngle(0.0) };
}

/// Which lobes of a BSDF are present: a purely specular one needs no light samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lobes {
    /// Scatters into a continuum of directions on the side of `wo`.
    pub reflection: bool,
    /// Scatters into a continuum of directions on the other side.
    pub transmission: bool,
}

impl Lobes {
    /// Whether any direction but discrete ones can be scattered into.
    pub fn is_continuous(self) -> bool {
        self.reflection || self.transmission
    }
}
