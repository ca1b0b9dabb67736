//! Where the sun stands.

use super::moment::Moment;

/// A place on the earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Geographic latitude [°], north positive, in [-90, 90].
    pub latitude: f64,
    /// Geographic longitude [°], east positive, in [-180, 180].
    pub longitude: f64,
}

/// Where the sun is seen from a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolarPosition {
    /// Height of its centre above the horizon [°], raised by refraction at 1010 hPa and 10 °C.
    pub elevation: f64,
    /// The same without an atmosphere [°].
    pub true_elevation: f64,
    /// Compass direction [°], from north through east, in [0, 360).
    pub azimuth: f64,
    /// Distance [astronomical units].
    pub distance: f64,
}

impl SolarPosition {
    /// The sun at a place and time, good to 0.01° (refraction near the horizon apart) from 1900 to 2100.
    ///
    /// The theory of low accuracy of Meeus, Astronomical Algorithms (1998), chapters 12, 13, 22 and 25, parallax included;
    /// refraction by Sæmundsson (1986), chapter 16. Dynamical time is taken for universal time: the sun moves 0.001° in
    /// the minute or so between them.
    pub fn at(place: &Place, moment: &Moment) -> Self {
        let days = moment.days();
        let t = days / 36_525.0;
        let mean_longitude = 280.466_46 + t * (36_000.769_83 + t * 0.000_303_2);
        let anomaly = (357.529_11 + t * (35_999.050_29 - t * 0.000_153_7)).to_radians();
        let eccentricity = 0.016_708_634 - t * (0.000_042_037 + t * 0.000_000_126_7);
        let centre = (1.914_602 - t * (0.004_817 + t * 0.000_014)) * anomaly.sin()
            + (0.019_993 - t * 0.000_101) * (2.0 * anomaly).sin()
            + 0.000_289 * (3.0 * anomaly).sin();
        let true_anomaly = anomaly + centre.to_radians();
        let distance =
            1.000_001_018 * (1.0 - eccentricity * eccentricity) / (1.0 + eccentricity * true_anomaly.cos());

        // Aberration, and the largest terms of nutation.
        let node = (125.04 - 1934.136 * t).to_radians();
        let nutation = -0.004_78 * node.sin();
        let longitude = (mean_longitude + centre - 0.005_69 + nutation).to_radians();
        let obliquity = (23.439_291 - 0.013_004_2 * t + 0.002_56 * node.cos()).to_radians();
        let declination = (obliquity.sin() * longitude.sin()).asin();
        let right_ascension = (obliquity.cos() * longitude.sin()).atan2(longitude.cos());

        let sidereal =
            280.460_618_37 + 360.985_647_366_29 * days + t * t * 0.000_387_933 + nutation * obliquity.cos();
        let hour_angle = (sidereal + place.longitude).to_radians() - right_ascension;
        let latitude = place.latitude.to_radians();
        // In the frame of south, west and zenith.
        let south =
            hour_angle.cos() * latitude.sin() * declination.cos() - latitude.cos() * declination.sin();
        let west = hour_angle.sin() * declination.cos();
        let zenith =
            latitude.sin() * declination.sin() + latitude.cos() * declination.cos() * hour_angle.cos();
        let geocentric = zenith.clamp(-1.0, 1.0).asin();
        let parallax = 8.794 / 3600.0 / distance;
        let true_elevation = geocentric.to_degrees() - parallax * geocentric.cos();
        Self {
            elevation: true_elevation + refraction(true_elevation),
            true_elevation,
            azimuth: (west.atan2(south).to_degrees() + 180.0).rem_euclid(360.0),
            distance,
        }
    }
}

/// By how much the air of the standard conditions raises what stands at a true elevation [°].
fn refraction(true_elevation: f64) -> f64 {
    // What stands deeper is not seen, and the formula is not meant for it.
    if true_elevation < -1.0 {
        return 0.0;
    }
    let h = true_elevation;
    1.02 / 60.0 / (h + 10.3 / (h + 5.11)).to_radians().tan()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time: &str, latitude: f64, longitude: f64) -> SolarPosition {
        SolarPosition::at(&Place { latitude, longitude }, &Moment::parse(time).unwrap())
    }

    #[test]
    fn places_are_those_of_the_solar_position_algorithm() {
        // The first is the example of NREL's SPA (Reda and Andreas 2004), whose refraction at 820 hPa and 11 °C, 0.01633°, makes
        // its zenith angle of 50.11162° one of 50.12795° without air. The others are by pvlib 0.16.1, `solarposition.spa_python`
        // at 1010 hPa and 10 °C: true elevation, apparent elevation, azimuth, distance.
        for (time, latitude, longitude, true_elevation, elevation, azimuth, distance) in [
            ("2003-10-17T12:30:30-07:00", 39.742476, -105.1786, 90.0 - 50.12795, 39.8922, 194.34024, 0.99654),
            ("2026-06-21T12:00:00+02:00", 48.1, 11.6, 61.1532, 61.1626, 142.0895, 1.01620),
            ("2026-12-21T09:00:00+01:00", 59.33, 18.07, 0.5033, 0.9196, 142.6209, 0.98377),
            ("2000-03-20T06:30:00Z", 0.0, 0.0, 5.6361, 5.7831, 90.0179, 0.99595),
            ("2026-09-23T15:00:00+10:00", -33.87, 151.21, 33.7344, 33.7596, 296.5031, 1.00352),
            ("1950-07-04T10:00:00-05:00", 41.9, -87.6, 49.1109, 49.1255, 103.7412, 1.01671),
            ("2050-02-10T08:00:00+09:00", 35.7, 139.7, 15.2076, 15.2680, 120.8008, 0.98666),
            ("2026-06-21T23:59:00+02:00", 69.65, 18.96, 3.4693, 3.6774, 349.1958, 1.01623),
            ("2099-11-11T11:11:00Z", -54.8, -68.3, 21.9907, 22.0320, 89.5435, 0.99034),
            ("1901-05-05T12:00:00Z", 51.48, 0.0, 54.6441, 54.6561, 181.4000, 1.00894),
        ] {
            let sun = at(time, latitude, longitude);
            assert!((sun.true_elevation - true_elevation).abs() < 0.01, "{time}: {sun:?}");
            assert!((sun.elevation - elevation).abs() < 0.01, "{time}: {sun:?}");
            let turn = (sun.azimuth - azimuth) * sun.elevation.to_radians().cos();
            assert!(turn.abs() < 0.01, "{time}: {sun:?}");
            assert!((sun.distance - distance).abs() < 1e-4, "{time}: {sun:?}");
        }
    }

    #[test]
    fn equinoxes_and_solstices_have_their_geometry() {
        // At the March equinox of 2026 (14:46 UT) the sun is on the equator: it stands overhead where it is solar noon, 90° away
        // at the poles, but for refraction and parallax.
        let equinox = "2026-03-20T14:46Z";
        assert!(at(equinox, 90.0, 0.0).true_elevation.abs() < 0.01);
        assert!(at(equinox, -90.0, 0.0).true_elevation.abs() < 0.01);
        // At the June solstice (08:25 UT) it stands 23.44° high at the north pole all day long, and as deep at the other.
        for longitude in [-120.0, 0.0, 77.0] {
            let pole = at("2026-06-21T08:25Z", 90.0, longitude);
            assert!((pole.true_elevation - 23.436).abs() < 0.01, "{pole:?}");
            assert!((at("2026-06-21T08:25Z", -90.0, longitude).true_elevation + 23.436).abs() < 0.01);
        }
        // East in the morning and west in the afternoon; through north at noon in the south.
        assert!((at("2026-03-20T06:30Z", 0.0, 0.0).azimuth - 90.0).abs() < 0.5);
        assert!((at("2026-03-20T17:30Z", 0.0, 0.0).azimuth - 270.0).abs() < 0.5);
        let noon = at("2026-12-21T12:00Z", -60.0, 0.0);
        assert!(noon.azimuth < 2.0 || noon.azimuth > 358.0, "{noon:?}");
    }

    #[test]
    fn refraction_on_the_horizon_is_half_a_degree() {
        // 34′ of the horizontal refraction raises a sun that is below by it to the horizon.
        assert!((refraction(-0.575) - 0.575).abs() < 0.02, "{}", refraction(-0.575));
        assert!(refraction(90.0).abs() < 1e-3 && refraction(-40.0) == 0.0);
    }
}
