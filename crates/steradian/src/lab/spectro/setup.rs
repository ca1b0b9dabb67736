//! What the spectrophotometer is told.

use super::sphere::Sphere;
use crate::lab::probe::Angles;

/// How light falls on the sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Incidence {
    /// A beam from one direction; above 90° to the normal it comes from below.
    Beam(Angles),
    /// The same radiance from everywhere on one side.
    Diffuse(Face),
}

/// A side of the sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// That of the normal.
    Above,
    /// The other one.
    Below,
}

/// How numbers come about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// In closed form where the material has one, else by sampling.
    Auto,
    /// In closed form only.
    Exact,
    /// By photons, one after the other.
    Sampled,
}

/// A detector for the reflectance factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The middle of its cone.
    pub direction: Angles,
    /// Half-angle of the cone [degrees], above 0; the cone stays above the horizon.
    pub half_angle: f64,
}

impl View {
    /// What the cone catches of the flux from a perfect diffuser: its projected solid angle over π, sin²κ cosθ.
    pub fn of_perfect_diffuser(&self) -> f64 {
        self.half_angle.to_radians().sin().powi(2) * self.direction.theta.to_radians().cos()
    }
}

/// What is to be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// Wavelengths [nm].
    pub wavelengths: Vec<f32>,
    /// Each in turn.
    pub incidences: Vec<Incidence>,
    /// How.
    pub method: Method,
    /// Also the reflectance factor in this cone, by sampling.
    pub view: Option<View>,
    /// What a real sphere would read; an ideal one reads the truth.
    pub sphere: Option<Sphere>,
}

/// Why nothing can be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpectroError {
    /// The material cannot be looked at.
    #[error(transparent)]
    Probe(#[from] crate::lab::probe::ProbeError),
    /// There is no closed form.
    #[error("material \"{0}\" has no closed form of its reflectance: measure it by sampling")]
    NoClosedForm(String),
    /// The reflectance factor needs samples.
    #[error("a reflectance factor is measured by sampling only")]
    FactorBySampling,
    /// The viewing cone is empty or reaches below the horizon.
    #[error("a viewing cone of {half_angle}° about {theta}° is not above the horizon")]
    Cone {
        /// Its half-angle [degrees].
        half_angle: f64,
        /// Angle of its middle to the normal [degrees].
        theta: f64,
    },
    /// Light along the surface does not arrive.
    #[error("light from 90° runs along the surface")]
    Grazing,
    /// The sphere's numbers make no sense.
    #[error(
        "a sphere has a wall of reflectance from 0 to below 1, a port between 0 and 1, and a standard above 0 and up to 1"
    )]
    Sphere,
}

impl Setup {
    pub(super) fn check(&self) -> Result<(), SpectroError> {
        for incidence in &self.incidences {
            if let Incidence::Beam(angles) = incidence
                && (angles.theta - 90.0).abs() < 1e-6
            {
                return Err(SpectroError::Grazing);
            }
        }
        if let Some(View { direction, half_angle }) = self.view {
            let theta = direction.theta;
            if !(half_angle > 0.0 && theta >= 0.0 && theta + half_angle <= 90.0) {
                return Err(SpectroError::Cone { half_angle, theta });
            }
            if self.method == Method::Exact {
                return Err(SpectroError::FactorBySampling);
            }
        }
        let is_lawful = |s: &Sphere| {
            (0.0..1.0).contains(&s.wall)
                && s.port > 0.0
                && s.port < 1.0
                && s.standard > 0.0
                && s.standard <= 1.0
        };
        if self.sphere.as_ref().is_some_and(|s| !is_lawful(s)) { Err(SpectroError::Sphere) } else { Ok(()) }
    }
}
