//! The relations between quantities of light: each a method of the quantity that it begins with, and no others.
//!
//! What a relation needs besides is a typed argument, so that a distance cannot be taken for an area, nor a solid angle for a
//! projected one, which is where factors of π are lost. Every relation holds in every part of the spectrum and never mixes
//! two. Intervals scale with the values; the arguments count as exact.
//!
//! ```
//! use steradian::units::{Cosine, Luminance, LuminousIntensity, Metres, ProjectedSolidAngle};
//! let below_a_candle = LuminousIntensity::exact(1.0).at(Metres(0.5), Cosine::ONE);
//! assert_eq!(below_a_candle.to_string(), "4 lx");
//! let under_the_sky = Luminance::exact(1000.0).from_directions(ProjectedSolidAngle::HEMISPHERE);
//! assert_eq!(under_the_sky.to_string(), "3141.593 lx");
//! ```
//!
//! An irradiance has lost the directions, and no solid angle makes it a radiance:
//!
//! ```compile_fail,E0599
//! use steradian::units::{Illuminance, SolidAngle};
//! let luminance = Illuminance::exact(100.0).over_solid_angle(SolidAngle::HEMISPHERE);
//! ```
//!
//! A solid angle is not a projected one:
//!
//! ```compile_fail,E0308
//! use steradian::units::{Luminance, SolidAngle};
//! let illuminance = Luminance::exact(100.0).from_directions(SolidAngle::HEMISPHERE);
//! ```
//!
//! Lumens are no watts without a spectrum:
//!
//! ```compile_fail,E0308
//! use steradian::units::{Efficacy, Illuminance, Irradiance, Luminous, Measured, Radiant};
//! let irradiance: Measured<Irradiance, Radiant> = Illuminance::exact(100.0);
//! ```

use super::extent::{
    Bandwidth, Cosine, ForeshortenedArea, Metres, ProjectedSolidAngle, Reflectance, Seconds, SolidAngle,
    SquareMetres,
};
use super::kind::{
    AlphaOpic, Energy, EquivalentDaylight, Exitance, Flux, Intensity, Irradiance, Luminous, Radiant,
    Spectral, Unit, Weighted,
};
use super::measured::Measured;
use super::quantity::Radiance;
use std::f64::consts::PI;
use std::fmt;
use std::marker::PhantomData;

impl<D> Measured<Energy, D>
where
    Energy: Unit<D>,
    Flux: Unit<D>,
{
    /// The mean flux over a time, Φ = dQ/dt, A (15).
    #[must_use]
    pub fn over_time(self, time: Seconds) -> Measured<Flux, D> {
        Measured::new(self.estimate().scaled(1.0 / time.0))
    }
}

impl<D> Measured<Flux, D>
where
    Energy: Unit<D>,
    Flux: Unit<D>,
    Intensity: Unit<D>,
    Irradiance: Unit<D>,
    Exitance: Unit<D>,
{
    /// The energy that a constant flux carries in a time, A (15).
    #[must_use]
    pub fn during(self, time: Seconds) -> Measured<Energy, D> {
        Measured::new(self.estimate().scaled(time.0))
    }

    /// The mean intensity of a point that sends it into a solid angle, I = dΦ/dω, A (19).
    #[must_use]
    pub fn over_solid_angle(self, directions: SolidAngle) -> Measured<Intensity, D> {
        Measured::new(self.estimate().scaled(1.0 / directions.0))
    }

    /// The mean irradiance of an area on which it arrives, E = dΦ/dA, A (17).
    #[must_use]
    pub fn arriving_on(self, area: SquareMetres) -> Measured<Irradiance, D> {
        Measured::new(self.estimate().scaled(1.0 / area.0))
    }

    /// The mean exitance of an area that it leaves, M = dΦ/dA, A (22).
    #[must_use]
    pub fn leaving(self, area: SquareMetres) -> Measured<Exitance, D> {
        Measured::new(self.estimate().scaled(1.0 / area.0))
    }
}

impl<D> Measured<Intensity, D>
where
    Flux: Unit<D>,
    Intensity: Unit<D>,
    Irradiance: Unit<D>,
    Radiance: Unit<D>,
{
    /// The flux into directions that all have this intensity, A (19).
    #[must_use]
    pub fn into_solid_angle(self, directions: SolidAngle) -> Measured<Flux, D> {
        Measured::new(self.estimate().scaled(directions.0))
    }

    /// The irradiance of a surface at a distance, tilted so that its normal and the ray make the cosine, E = I cosθ / r²,
    /// A (20), (23), (26); zero from behind.
    #[must_use]
    pub fn at(self, distance: Metres, cosine: Cosine) -> Measured<Irradiance, D> {
        Measured::new(self.estimate().scaled(cosine.facing() / (distance.0 * distance.0)))
    }

    /// The mean radiance of the surface that it comes from, L = dI / (dA cosθ), A (21).
    #[must_use]
    pub fn from_area(self, area: ForeshortenedArea) -> Measured<Radiance, D> {
        Measured::new(self.estimate().scaled(1.0 / area.0))
    }
}

impl<D> Measured<Radiance, D>
where
    Intensity: Unit<D>,
    Irradiance: Unit<D>,
    Exitance: Unit<D>,
    Radiance: Unit<D>,
{
    /// The irradiance by directions that all have this radiance, E = L ∫ cosθ dω, A (24), (30).
    #[must_use]
    pub fn from_directions(self, directions: ProjectedSolidAngle) -> Measured<Irradiance, D> {
        Measured::new(self.estimate().scaled(directions.0))
    }

    /// The intensity of an area that has this radiance, I = L A cosθ, A (21).
    #[must_use]
    pub fn of_area(self, area: ForeshortenedArea) -> Measured<Intensity, D> {
        Measured::new(self.estimate().scaled(area.0))
    }

    /// The exitance of a surface that has this radiance in all directions, M = πL, from A (22).
    #[must_use]
    pub fn lambertian_exitance(self) -> Measured<Exitance, D> {
        Measured::new(self.estimate().scaled(PI))
    }
}

impl<D> Measured<Irradiance, D>
where
    Flux: Unit<D>,
    Irradiance: Unit<D>,
    Exitance: Unit<D>,
{
    /// The flux on an area that is lit evenly, A (17).
    #[must_use]
    pub fn on_area(self, area: SquareMetres) -> Measured<Flux, D> {
        Measured::new(self.estimate().scaled(area.0))
    }

    /// The exitance that a surface reflects, M = ρE, B (2.14).
    #[must_use]
    pub fn reflected(self, reflectance: Reflectance) -> Measured<Exitance, D> {
        Measured::new(self.estimate().scaled(reflectance.value()))
    }
}

impl<D> Measured<Exitance, D>
where
    Flux: Unit<D>,
    Exitance: Unit<D>,
    Radiance: Unit<D>,
{
    /// The flux that leaves an area, A (22).
    #[must_use]
    pub fn of_area(self, area: SquareMetres) -> Measured<Flux, D> {
        Measured::new(self.estimate().scaled(area.0))
    }

    /// The radiance in all directions of a perfectly diffuse surface, L = M/π, from A (22), (33).
    #[must_use]
    pub fn lambertian_radiance(self) -> Measured<Radiance, D> {
        Measured::new(self.estimate().scaled(1.0 / PI))
    }
}

impl<K: Unit<Spectral> + Unit<Radiant>> Measured<K, Spectral> {
    /// What a band holds in which the spectral quantity is constant.
    #[must_use]
    pub fn in_band(self, width: Bandwidth) -> Measured<K, Radiant> {
        Measured::new(self.estimate().scaled(width.0))
    }
}

/// How much one watt of a given spectral composition counts for in a domain [lm·W⁻¹; W·W⁻¹ for α-opic domains], at least 0:
/// the luminous efficacy of radiation and its like (CIE S 017, 17-21-090). It belongs to a spectrum;
/// [`crate::spectrum::photometry`] makes it.
pub struct Efficacy<D> {
    value: f64,
    domain: PhantomData<D>,
}

impl<D: Weighted> Efficacy<D> {
    /// A known efficacy, at least 0.
    pub const fn new(value: f64) -> Self {
        Self { value, domain: PhantomData }
    }

    /// Its value [lm·W⁻¹; W·W⁻¹ for α-opic domains].
    pub const fn value(self) -> f64 {
        self.value
    }
}

// By hand: a derived copy would ask the same of the tag.
impl<D> Clone for Efficacy<D> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<D> Copy for Efficacy<D> {}

impl<D> PartialEq for Efficacy<D> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

/// `683.002 lm·W⁻¹`.
impl<D: Weighted> fmt::Display for Efficacy<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.value, D::EFFICACY_UNIT)
    }
}

impl<D: Weighted> fmt::Debug for Efficacy<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl<K: Unit<Radiant>> Measured<K, Radiant> {
    /// What radiation of known efficacy counts for in another domain, monochromatic light for one: X_v = K X_e.
    #[must_use]
    pub fn weighted<D: Weighted>(self, efficacy: Efficacy<D>) -> Measured<K, D>
    where
        K: Unit<D>,
    {
        Measured::new(self.estimate().scaled(efficacy.value))
    }
}

impl<K: Unit<Luminous> + Unit<Radiant>> Measured<K, Luminous> {
    /// The radiant quantity behind a photometric one, of radiation of known efficacy, which must be above 0.
    #[must_use]
    pub fn unweighted(self, efficacy: Efficacy<Luminous>) -> Measured<K, Radiant> {
        Measured::new(self.estimate().scaled(1.0 / efficacy.value))
    }
}

impl<K, A: AlphaOpic> Measured<K, A>
where
    K: Unit<A> + Unit<EquivalentDaylight<A>>,
{
    /// As much daylight as has the same effect, in lx or cd·m⁻²: the quantity over K_α,v(D65) (CIE S 026, 3.11).
    #[must_use]
    pub fn equivalent_daylight(self) -> Measured<K, EquivalentDaylight<A>> {
        Measured::new(self.estimate().scaled(1.0 / A::DAYLIGHT_EFFICACY))
    }
}

#[cfg(test)]
mod tests {
    use super::super::kind::{Melanopic, Scotopic};
    use super::super::{Estimate, Illuminance, LuminousFlux, RadiantEnergy};
    use super::*;

    #[test]
    fn a_laser_pulse_through_all_quantities() {
        // 1 J in 10 ns is 100 MW; into 10⁻⁶ sr 10¹⁴ W/sr; at 1 km and 60° 5·10⁷ W/m².
        let flux = RadiantEnergy::exact(1.0).over_time(Seconds(1e-8));
        assert!((flux.value() / 1e8 - 1.0).abs() < 1e-12 && flux.during(Seconds(1e-8)).value() == 1.0);
        let intensity = flux.over_solid_angle(SolidAngle(1e-6));
        let irradiance = intensity.at(Metres(1e3), Cosine::of_degrees(60.0));
        assert!((irradiance.value() / 5e7 - 1.0).abs() < 1e-12);
        assert_eq!(intensity.at(Metres(1.0), Cosine::of_degrees(100.0)).value(), 0.0);
        // The fluxes at both ends of a tube of rays agree: E dA = I dω with dω = dA cosθ/r².
        let area = SquareMetres(0.5);
        let caught = area.foreshortened(Cosine::of_degrees(60.0)).solid_angle(Metres(1e3));
        let (there, here) = (irradiance.on_area(area), intensity.into_solid_angle(caught));
        assert!((there.value() / here.value() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_lambertian_panel_keeps_its_flux() {
        // 3000 lm from 0.36 m²: M = Φ/A, L = M/π, I = LA, and ∫ I cosθ dω = πI is the flux again.
        let area = SquareMetres(0.36);
        let luminance = LuminousFlux::exact(3000.0).leaving(area).lambertian_radiance();
        assert_eq!(luminance.to_string(), "2652.582 cd·m⁻²");
        let normal = luminance.of_area(area.foreshortened(Cosine::ONE));
        assert!((normal.value() * PI - 3000.0).abs() < 1e-9);
        let back = luminance.lambertian_exitance().of_area(area);
        assert!((back.value() - 3000.0).abs() < 1e-9);
        assert!(
            (normal.from_area(area.foreshortened(Cosine::ONE)).value() / luminance.value() - 1.0).abs()
                < 1e-12
        );
    }

    #[test]
    fn a_grey_wall_reflects_the_sky() {
        let sky = Illuminance::new(Estimate { value: 10_000.0, half_width: 50.0 });
        let wall = sky.reflected(Reflectance::new(0.3).unwrap());
        assert_eq!(wall.to_string(), "3000 ± 15 lm·m⁻²");
        assert_eq!(wall.lambertian_radiance().to_string(), "955 ± 5 cd·m⁻²");
        assert_eq!(LuminousFlux::exact(6.0).arriving_on(SquareMetres(2.0)), Illuminance::exact(3.0));
    }

    #[test]
    fn domains_meet_only_by_an_efficacy() {
        let green = Measured::<Irradiance, Radiant>::exact(2.0);
        let efficacy = Efficacy::<Luminous>::new(683.0);
        assert_eq!(
            (efficacy.to_string(), green.weighted(efficacy).to_string()),
            ("683 lm·W⁻¹".into(), "1366 lx".into())
        );
        assert_eq!(green.weighted(efficacy).unweighted(efficacy), green);
        let dark = green.weighted(Efficacy::<Scotopic>::new(1700.0));
        assert_eq!(format!("{dark:?}"), "scotopic illuminance 3400 lx");
        let band = Measured::<Irradiance, Spectral>::exact(0.5).in_band(Bandwidth(10.0));
        assert_eq!(band.to_string(), "5 W·m⁻²");
    }

    #[test]
    fn daylight_is_its_own_equivalent() {
        // 1000 lx of D65 are 1.3262 W/m² for melanopsin (CIE S 026).
        let melanopic = Measured::<Irradiance, Melanopic>::exact(1.3262);
        assert_eq!(format!("{melanopic:?}"), "melanopic irradiance 1.3262 W·m⁻²");
        let edi = melanopic.equivalent_daylight();
        assert_eq!(format!("{edi:?}"), "melanopic equivalent daylight (D65) illuminance 1000 lx");
    }
}
