//! How long, how far, how large: what quantities of light are divided by.

use std::f64::consts::PI;

/// A duration [s], above 0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Seconds(pub f64);

/// A distance [m], above 0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Metres(pub f64);

/// An area [m²], above 0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct SquareMetres(pub f64);

/// An area as it is seen from a direction, A cosθ [m²], at least 0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct ForeshortenedArea(pub f64);

/// A width of a spectral band [nm], above 0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Bandwidth(pub f64);

/// A solid angle ω [sr], in [0, 4π].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct SolidAngle(pub f64);

/// A projected solid angle ∫ cosθ dω [sr] over directions above a surface, in [0, π].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct ProjectedSolidAngle(pub f64);

/// The cosine of an angle to a surface normal, in [−1, 1].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Cosine(f64);

/// A share of power that a surface gives back, in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Reflectance(f64);

impl SquareMetres {
    /// The area that is seen at the cosine, A (14); zero from behind.
    pub fn foreshortened(self, cosine: Cosine) -> ForeshortenedArea {
        ForeshortenedArea(self.0 * cosine.facing())
    }
}

impl ForeshortenedArea {
    /// Its solid angle at a distance that is large against it, dω = dA cosθ / r², A (14).
    pub fn solid_angle(self, distance: Metres) -> SolidAngle {
        SolidAngle(self.0 / (distance.0 * distance.0))
    }
}

impl SolidAngle {
    /// All directions on one side of a plane: 2π, A (8).
    pub const HEMISPHERE: Self = Self(2.0 * PI);
    /// All directions: 4π, A (8).
    pub const SPHERE: Self = Self(4.0 * PI);

    /// The projected solid angle of directions that are all at this cosine, dω cosθ of A (30); zero below the horizon.
    pub fn projected(self, cosine: Cosine) -> ProjectedSolidAngle {
        ProjectedSolidAngle(self.0 * cosine.facing())
    }
}

impl ProjectedSolidAngle {
    /// All directions on one side of a plane: π.
    pub const HEMISPHERE: Self = Self(PI);

    /// The share of the hemisphere's, in [0, 1]: the configuration factor of what fills these directions.
    pub fn configuration_factor(self) -> f64 {
        self.0 / PI
    }
}

impl Cosine {
    /// Along the normal.
    pub const ONE: Self = Self(1.0);

    /// A cosine; `None` outside [−1, 1].
    pub fn new(cosine: f64) -> Option<Self> {
        (-1.0..=1.0).contains(&cosine).then_some(Self(cosine))
    }

    /// Of an angle [°].
    pub fn of_degrees(degrees: f64) -> Self {
        Self(degrees.to_radians().cos())
    }

    /// Its value, in [−1, 1].
    pub fn value(self) -> f64 {
        self.0
    }

    /// Its value on the side of the normal, zero behind: the clamp of A (26).
    pub fn facing(self) -> f64 {
        self.0.max(0.0)
    }
}

impl Reflectance {
    /// A share; `None` outside [0, 1].
    pub fn new(share: f64) -> Option<Self> {
        (0.0..=1.0).contains(&share).then_some(Self(share))
    }

    /// Its value, in [0, 1].
    pub fn value(self) -> f64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_seen_or_lit_from_behind() {
        let behind = Cosine::of_degrees(120.0);
        assert_eq!(SquareMetres(2.0).foreshortened(behind).0, 0.0);
        assert_eq!(SolidAngle::HEMISPHERE.projected(behind).0, 0.0);
        assert!((SquareMetres(2.0).foreshortened(Cosine::of_degrees(60.0)).0 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn shares_and_cosines_outside_their_range_are_refused() {
        assert!(Reflectance::new(1.01).is_none() && Reflectance::new(-0.01).is_none());
        assert!(Reflectance::new(f64::NAN).is_none() && Reflectance::new(1.0).is_some());
        assert!(Cosine::new(1.01).is_none() && Cosine::new(-1.0).is_some());
    }
}
