//! The film: which samples a pixel gets, what is kept of them, and the numbers they become.
//!
//! [`Film`] is immutable while rendering; [`FilmTile`]s hold the accumulators, each owned by one thread at a
//! time; [`Film::develop`] turns tiles into named layers.

pub mod bounds;
pub mod filter;
pub mod sensor;
pub mod tile;
pub mod recording;
pub mod develop;

pub use bounds::PixelBounds;
pub use develop::{Developed, Layer};
pub use filter::{Filter, FilterError, FilterKind, FilterSample};
pub use recording::{Film, FilmError, FilmKind, FilmSample, Recorded, SpectralBins, SurfaceLayers};
pub use sensor::{Sensor, SensorError, SensorSettings};
pub use tile::{Estimate, FilmTile};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::{ColorSpace, ColorSpaceKind};
    use crate::math::hash::{hash_words, to_unit};
    use crate::math::{Normal, Point, Vec2, Vec3};
    use crate::spectrum::{Sampled, Wavelengths};
    use crate::units::LUMENS_PER_WATT;

    fn film(kind: FilmKind, filter: FilterKind) -> Film {
        let space = ColorSpace::new(ColorSpaceKind::Srgb);
        let sensor = Sensor::new(SensorSettings::default(), &space).unwrap();
        let filter = Filter::new(filter, Vec2::splat(filter.default_radius())).unwrap();
        Film::new([6, 4], PixelBounds::full([6, 4]), filter, sensor, kind, space).unwrap()
    }

    fn u(words: &[u64]) -> f32 {
        to_unit(hash_words(words))
    }

    /// White light of luminance `y`.
    fn white(film: &Film, y: f32, w: &Wavelengths) -> Sampled<crate::units::Radiance> {
        let white = film.color_space().illuminant();
        white.sample(w) * (y / (LUMENS_PER_WATT * white.photometric_integral()))
    }

    #[test]
    fn a_white_scene_of_luminance_one_develops_to_one_through_every_filter() {
        for filter in [
            FilterKind::Box,
            FilterKind::Mitchell { b: 1.0 / 3.0, c: 1.0 / 3.0 },
            FilterKind::Sinc { tau: 3.0 },
        ] {
            let film = film(FilmKind::Rgb, filter);
            let mut tile = film.tile(film.bounds());
            let n = 4096;
            for i in 0..n {
                let w = film.sample_wavelengths((i as f32 + 0.5) / n as f32);
                let f = film.filter().sample(Vec2::new(u(&[i, 1]), u(&[i, 2])));
                let sample = FilmSample {
                    radiance: white(&film, 1.0, &w),
                    wavelengths: &w,
                    weight: f.weight,
                    surface: None,
                };
                assert_eq!(film.add_sample(&mut tile, [2, 3], &sample), Recorded::Kept);
            }
            let picture = film.develop([&tile]);
            for name in ["R", "G", "B"] {
                let plane = picture.layer(name).unwrap();
                // Noise of the colour from weights that vary by about one.
                assert!((plane[3 * 6 + 2] - 1.0).abs() < 0.05, "{filter:?} {name}: {}", plane[3 * 6 + 2]);
                assert_eq!(plane[0], 0.0);
            }
            assert_eq!(tile.samples([2, 3]), n as u32);
        }
    }

    #[test]
    fn bad_samples_are_dropped_and_reported() {
        let film = film(FilmKind::Rgb, FilterKind::Box);
        let mut tile = film.tile(film.bounds());
        let mut w = film.sample_wavelengths(0.4);
        let add = |tile: &mut FilmTile, w: &Wavelengths, l: [f32; 4]| {
            let sample =
                FilmSample { radiance: Sampled::from_array(l), wavelengths: w, weight: 1.0, surface: None };
            film.add_sample(tile, [0, 0], &sample)
        };
        assert_eq!(add(&mut tile, &w, [1.0, f32::NAN, 1.0, 1.0]), Recorded::NotFinite);
        assert_eq!(add(&mut tile, &w, [f32::INFINITY; 4]), Recorded::NotFinite);
        // What a dropped companion carries does not matter.
        w.terminate_companions();
        assert_eq!(add(&mut tile, &w, [1.0, f32::NAN, 1.0, 1.0]), Recorded::Kept);
        assert_eq!(tile.samples([0, 0]), 1);
        assert!(film.develop([&tile]).layers[0].values[0].is_finite());
    }

    #[test]
    fn spectral_bins_hold_mean_radiance_with_and_without_dispersion() {
        let bins = SpectralBins { count: 8, min: 400.0, max: 720.0 };
        let film = film(FilmKind::Spectral(bins), FilterKind::default());
        let radiance = |l: f32| 1.0 + 0.01 * (l - 400.0);
        let mut tile = film.tile(film.bounds());
        let n = 8000;
        for i in 0..n {
            let mut w = film.sample_wavelengths((i as f32 + 0.5) / n as f32);
            // Two paths of three are dispersive, whatever their wavelength.
            if i % 3 != 0 {
                w.terminate_companions();
            }
            let sample = FilmSample {
                radiance: Sampled::from_array(w.lambda().map(radiance)),
                wavelengths: &w,
                weight: 1.0,
                surface: None,
            };
            assert_eq!(film.add_sample(&mut tile, [1, 1], &sample), Recorded::Kept);
        }
        let picture = film.develop([&tile]);
        for bin in 0..8 {
            // The mean of a linear function over a bin is its value at the centre.
            let value = picture.layers[3 + bin].values[6 + 1];
            assert!((value / radiance(bins.centre(bin)) - 1.0).abs() < 2e-3, "{bin}: {value}");
        }
        assert_eq!(picture.layers[3].name, "S0.420,000nm");
        let attribute = |k| picture.attributes.iter().find(|a| a.0 == k).map(|a| a.1.as_str());
        assert_eq!(attribute("emissiveUnits"), Some("W.m^-2.sr^-1.nm^-1"));
        assert_eq!(attribute("spectralLayoutVersion"), Some("1.0"));
    }

    #[test]
    fn geometric_layers_average_the_covered_samples() {
        let film = film(FilmKind::GBuffer, FilterKind::Box);
        let mut tile = film.tile(film.bounds());
        let n = 4000;
        for i in 0..n {
            let w = film.sample_wavelengths((i as f32 + 0.5) / n as f32);
            let surface = SurfaceLayers {
                p: Point::new(1.0, 2.0, if i % 4 == 0 { 3.0 } else { 5.0 }),
                n: Normal::Z,
                ns: Normal::new(Vec3::X).unwrap(),
                uv: Vec2::new(0.25, 0.5),
                dz: Vec2::new(0.1, -0.1),
                albedo: Sampled::splat(0.8),
            };
            // Half of the samples see no surface.
            let sample = FilmSample {
                radiance: white(&film, if i % 2 == 0 { 3.0 } else { 1.0 }, &w),
                wavelengths: &w,
                weight: 1.0,
                surface: (i % 2 == 0).then_some(&surface),
            };
            assert_eq!(film.add_sample(&mut tile, [5, 0], &sample), Recorded::Kept);
        }
        let picture = film.develop([&tile]);
        let at = |name: &str| picture.layer(name).unwrap()[5];
        assert!((at("P.Z") - 4.0).abs() < 1e-5 && at("P.X") == 1.0 && at("N.Z") == 1.0 && at("Ns.X") == 1.0);
        assert!((at("u"), at("v"), at("dzdx"), at("dzdy")) == (0.25, 0.5, 0.1, -0.1));
        for c in ["R", "G", "B"] {
            assert!((at(c) - 2.0).abs() < 0.02, "{}", at(c));
            assert!((at(&format!("Albedo.{c}")) - 0.4).abs() < 4e-3, "{}", at(&format!("Albedo.{c}")));
            let relative = at(&format!("Variance.{c}")) / at(c);
            assert!((at(&format!("RelativeVariance.{c}")) / relative - 1.0).abs() < 1e-3);
        }
        assert_eq!(picture.layers.len(), 25);
    }

    #[test]
    fn tiles_in_any_order_make_the_same_picture() {
        let film = film(FilmKind::Rgb, FilterKind::default());
        let fill = |mut tile: FilmTile| {
            for pixel in tile.bounds().pixels() {
                for i in 0..3 {
                    let seed = [pixel[0] as u64, pixel[1] as u64, i];
                    let w = film.sample_wavelengths(u(&seed));
                    let f = film.filter().sample(Vec2::splat(u(&[seed[0], seed[1], i, 9])));
                    let sample = FilmSample {
                        radiance: white(&film, 1.0, &w),
                        wavelengths: &w,
                        weight: f.weight,
                        surface: None,
                    };
                    assert_eq!(film.add_sample(&mut tile, pixel, &sample), Recorded::Kept);
                }
            }
            tile
        };
        let tiles: Vec<FilmTile> = film.bounds().tiles(2).into_iter().map(|b| fill(film.tile(b))).collect();
        let whole = film.develop([&fill(film.tile(film.bounds()))]);
        let parts = film.develop(tiles.iter().rev());
        for (a, b) in whole.layers.iter().zip(&parts.layers) {
            assert_eq!(a.values, b.values);
        }
        let estimate = tiles[0].luminance([0, 0]).unwrap();
        assert!(estimate.variance_of_mean > 0.0 && tiles[0].luminance([5, 3]).is_none());
    }

    #[test]
    fn impossible_films_are_refused() {
        let good = film(FilmKind::Rgb, FilterKind::Box);
        let make = |bounds, kind| {
            let (filter, sensor, space) =
                (good.filter().clone(), good.sensor().clone(), good.color_space().clone());
            Film::new([6, 4], bounds, filter, sensor, kind, space)
        };
        let empty = PixelBounds { min: [6, 0], max: [9, 4] };
        assert!(matches!(make(empty, FilmKind::Rgb), Err(FilmError::Bounds(_))));
        let bins = SpectralBins { count: 4, min: 700.0, max: 400.0 };
        assert!(matches!(
            make(PixelBounds::full([6, 4]), FilmKind::Spectral(bins)),
            Err(FilmError::Bins { .. })
        ));
    }
}
