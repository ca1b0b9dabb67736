//! Skies and the sun as the scene states them.

use super::value::SpectrumDesc;
use crate::light::{Atmosphere, Moment, Place, SkyModel};
use crate::math::Vec3;
use crate::scene::source::Span;

/// A sky.
#[derive(Clone, Debug)]
pub struct SkyDesc {
    /// Where its light comes from.
    pub kind: SkyKindDesc,
    /// Where up and north are.
    pub horizon: HorizonDesc,
    /// Where the sun stands; there for every model that needs it.
    pub sun: Option<SunPlaceDesc>,
    /// Reflectance of the ground below the horizon, in [0, 1]; `None` for no ground.
    pub ground: Option<f32>,
}

/// The kinds of sky.
#[derive(Clone, Debug)]
pub enum SkyKindDesc {
    /// A distribution of luminance, of any spectrum and amount.
    Distribution {
        /// How its luminance varies.
        model: SkyModel,
        /// Its colour (the colour space's white), or the radiance of the zenith.
        spectrum: SpectrumDesc,
    },
    /// The CIE clear sky with the absolute spectra of a cloudless atmosphere.
    Cloudless {
        /// What the light goes through; its ground is also that of the sky, where it has one.
        atmosphere: Atmosphere,
        /// Angular radius of the sun's disk [degrees], in [0.01, 10]; `None` for the sky alone.
        sun: Option<f32>,
    },
}

/// The sun's disk.
#[derive(Clone, Debug)]
pub struct SunDesc {
    /// Irradiance of a plane that faces it (the colour space's white).
    pub irradiance: SpectrumDesc,
    /// Angular radius [degrees] (0.2666), in [0.01, 10].
    pub angular_radius: f32,
    /// Where up and north are.
    pub horizon: HorizonDesc,
    /// Where it stands.
    pub place: SunPlaceDesc,
}

/// Where up and north are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HorizonDesc {
    /// To the zenith (0, 0, 1), in light space, not zero.
    pub up: Vec3,
    /// Azimuth of the scene's +y, or of +z where up is nearer to y [degrees, from north through east] (0).
    pub north: f32,
}

/// Where the sun stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPlaceDesc {
    /// The statement.
    pub position: SunPositionDesc,
    /// The parameter that says so.
    pub span: Span,
}

/// The ways to say where the sun stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SunPositionDesc {
    /// In this direction of light space, not zero.
    Towards(Vec3),
    /// Where it is seen from a place on the earth at a time.
    SeenFrom {
        /// The place.
        place: Place,
        /// The time.
        moment: Moment,
    },
}
