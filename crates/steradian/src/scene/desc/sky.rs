//! Skies and the sun as the scene states them.

use super::value::SpectrumDesc;
use crate::light::{Moment, Place, SkyModel};
use crate::math::Vec3;
use crate::scene::source::Span;

/// A sky.
#[derive(Clone, Debug)]
pub struct SkyDesc {
    /// How its luminance varies.
    pub model: SkyModel,
    /// Its colour (the colour space's white), or the radiance of the zenith.
    pub spectrum: SpectrumDesc,
    /// Where up and north are.
    pub horizon: HorizonDesc,
    /// Where the sun stands; there for every model that needs it.
    pub sun: Option<SunPlaceDesc>,
    /// Reflectance of the ground below the horizon, in [0, 1]; `None` for no ground.
    pub ground: Option<f32>,
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
