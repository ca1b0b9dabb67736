//! RGB colour spaces.

use super::fit::{FitBasis, to_sigmoid};
use super::triple::{Chromaticity, Rgb, Xyz};
use crate::spectrum::{Dense, RgbAlbedo, RgbIlluminant, RgbUnbounded, Sigmoid, Spectrum, cie, named};
use glam::{DMat3, DVec3, Mat3, Vec3};
use thiserror::Error;

/// The colour spaces of scene files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorSpaceKind {
    /// sRGB and Rec. 709 primaries, D65.
    #[default]
    Srgb,
    /// DCI-P3 primaries with D65 (Display P3), as pbrt has it.
    DciP3,
    /// Rec. 2020 primaries, D65.
    Rec2020,
    /// ACES 2065-1 (AP0) primaries, the ACES white of about D60.
    Aces2065_1,
}

impl ColorSpaceKind {
    /// Every kind.
    pub const ALL: [Self; 4] = [Self::Srgb, Self::DciP3, Self::Rec2020, Self::Aces2065_1];

    /// The kind that pbrt calls `name`, in any case; `None` if there is none.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|k| k.name().eq_ignore_ascii_case(name))
    }

    /// pbrt's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::DciP3 => "dci-p3",
            Self::Rec2020 => "rec2020",
            Self::Aces2065_1 => "aces2065-1",
        }
    }

    /// Chromaticities of red, green and blue.
    pub fn primaries(self) -> [Chromaticity; 3] {
        match self {
            Self::Srgb => [(0.64, 0.33), (0.3, 0.6), (0.15, 0.06)],
            Self::DciP3 => [(0.68, 0.32), (0.265, 0.69), (0.15, 0.06)],
            Self::Rec2020 => [(0.708, 0.292), (0.17, 0.797), (0.131, 0.046)],
            Self::Aces2065_1 => [(0.7347, 0.2653), (0.0, 1.0), (0.0001, -0.077)],
        }
        .map(|(x, y)| Chromaticity::new(x, y))
    }

    /// Name of the spectrum that is white.
    pub fn illuminant_name(self) -> &'static str {
        match self {
            Self::Srgb | Self::DciP3 | Self::Rec2020 => "stdillum-D65",
            Self::Aces2065_1 => "illum-acesD60",
        }
    }
}

/// An RGB reflectance has a component outside [0, 1], or one that is not a number.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("rgb reflectance ({} {} {}) must lie in [0, 1]", .0.0.x, .0.0.y, .0.0.z)]
pub struct OutOfRange(pub Rgb);

/// An RGB colour space: primaries, the spectrum of its white, and the spectra that stand for its triples.
#[derive(Clone, Debug)]
pub struct ColorSpace {
    kind: ColorSpaceKind,
    xyz_from_rgb: Mat3,
    rgb_from_xyz: Mat3,
    white: Chromaticity,
    /// Relative XYZ (divided by white) of the primaries, for the fit.
    relative_from_rgb: DMat3,
    illuminant: Spectrum,
    dense_illuminant: Dense,
    basis: Box<FitBasis>,
}

impl ColorSpace {
    /// The colour space of a kind; its white is that of its illuminant's spectrum.
    pub fn new(kind: ColorSpaceKind) -> Self {
        // The tables of the source tree are complete (tested); equal energy is the defined fallback of nothing.
        let source = named(kind.illuminant_name()).unwrap_or(Spectrum::Constant(1.0));
        let dense = source.densely_sampled();
        let [x, y, z] = cie::tristimulus_integral(|l| dense.at(l));
        let white = DVec3::new(x, y, z) / f64::from(cie::Y_INTEGRAL);
        let xyz_from_rgb = matrix_to_xyz(kind.primaries(), white);
        let rgb_from_xyz = xyz_from_rgb.inverse();
        let sum = white.element_sum();
        Self {
            kind,
            xyz_from_rgb: xyz_from_rgb.as_mat3(),
            rgb_from_xyz: rgb_from_xyz.as_mat3(),
            white: Chromaticity::new((white.x / sum) as f32, (white.y / sum) as f32),
            relative_from_rgb: DMat3::from_diagonal(white.recip()) * xyz_from_rgb,
            illuminant: Spectrum::Dense(dense.clone()),
            basis: Box::new(FitBasis::new(|l| dense.at(l))),
            dense_illuminant: dense,
        }
    }

    /// Which colour space this is.
    pub fn kind(&self) -> ColorSpaceKind {
        self.kind
    }

    /// Chromaticity of white.
    pub fn white(&self) -> Chromaticity {
        self.white
    }

    /// The spectrum of white, normalised to Y = 1, at 1 nm over 360–830 nm.
    pub fn illuminant(&self) -> &Spectrum {
        &self.illuminant
    }

    /// XYZ of a triple; (1, 1, 1) has Y = 1.
    pub fn xyz_from_rgb(&self, rgb: Rgb) -> Xyz {
        Xyz(self.xyz_from_rgb * rgb.0)
    }

    /// The triple that shows `xyz`; components leave [0, ∞) for colours outside the gamut.
    pub fn rgb_from_xyz(&self, xyz: Xyz) -> Rgb {
        Rgb(self.rgb_from_xyz * xyz.0)
    }

    /// Columns: XYZ of the red, green and blue primary at the luminances that add up to white.
    pub fn xyz_from_rgb_matrix(&self) -> &Mat3 {
        &self.xyz_from_rgb
    }

    /// The inverse of [`ColorSpace::xyz_from_rgb_matrix`].
    pub fn rgb_from_xyz_matrix(&self) -> &Mat3 {
        &self.rgb_from_xyz
    }

    /// Y of a triple, in the triple's own unit.
    pub fn luminance(&self, rgb: Rgb) -> f32 {
        (self.xyz_from_rgb * rgb.0).y
    }

    /// The reflectance that shows `rgb` under the colour space's white.
    pub fn albedo(&self, rgb: Rgb) -> Result<Spectrum, OutOfRange> {
        if !rgb.0.to_array().iter().all(|c| (0.0..=1.0).contains(c)) {
            return Err(OutOfRange(rgb));
        }
        Ok(Spectrum::RgbAlbedo(RgbAlbedo { sigmoid: self.sigmoid(rgb) }))
    }

    /// A smooth function of any size that shows `rgb` as if it were a reflectance. Negative components count as zero.
    pub fn unbounded(&self, rgb: Rgb) -> Spectrum {
        let Factored { scale, shape } = Factored::new(rgb);
        Spectrum::RgbUnbounded(RgbUnbounded { scale, sigmoid: self.sigmoid(shape) })
    }

    /// Light that shows `rgb`: the white's spectrum, filtered and scaled. Negative components count as zero.
    pub fn illuminant_rgb(&self, rgb: Rgb) -> Spectrum {
        let Factored { scale, shape } = Factored::new(rgb);
        Spectrum::RgbIlluminant(RgbIlluminant {
            scale,
            sigmoid: self.sigmoid(shape),
            illuminant: self.dense_illuminant.clone(),
        })
    }

    /// The smooth reflectance that shows `rgb` ∈ [0, 1]³ under the colour space's white; components are clamped.
    ///
    /// A direct fit of some microseconds, for the constants of a scene; the upsampling table serves texels.
    pub fn sigmoid(&self, rgb: Rgb) -> Sigmoid {
        let rgb = clamped(rgb);
        if rgb.0.x == rgb.0.y && rgb.0.y == rgb.0.z {
            return Sigmoid::constant(rgb.0.x);
        }
        let target = self.relative_xyz(rgb);
        to_sigmoid(self.basis.fit(target).coefficients)
    }

    pub(super) fn basis(&self) -> &FitBasis {
        &self.basis
    }

    /// The triple that a reflectance shows, by the quadrature of the fit.
    #[cfg(test)]
    pub(super) fn shown_by(&self, s: Sigmoid) -> Rgb {
        let c = DVec3::new(f64::from(s.c0), f64::from(s.c1), f64::from(s.c2));
        Rgb((self.relative_from_rgb.inverse() * self.basis.relative_xyz(c)).as_vec3())
    }

    pub(super) fn relative_xyz(&self, rgb: Rgb) -> DVec3 {
        self.relative_from_rgb * rgb.0.as_dvec3()
    }
}

/// A triple as twice its largest component times a triple in [0, ½]³, where reflectances are smoothest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factored {
    /// Twice the largest component; zero for black.
    pub scale: f32,
    /// The triple divided by `scale`.
    pub shape: Rgb,
}

impl Factored {
    /// Splits a triple; pbrt-v4 book, 4.6.6.
    pub fn new(rgb: Rgb) -> Self {
        let scale = 2.0 * rgb.max().max(0.0);
        let shape = if scale > 0.0 { rgb * (1.0 / scale) } else { Rgb::default() };
        Self { scale, shape }
    }
}

/// Limits each component to [0, 1]; NaN becomes zero.
pub(super) fn clamped(rgb: Rgb) -> Rgb {
    // `Vec3::clamp` would keep a NaN.
    Rgb(rgb.0.max(Vec3::ZERO).min(Vec3::ONE))
}

/// The matrix whose columns are the primaries, scaled so that (1, 1, 1) is `white` (SMPTE RP 177).
fn matrix_to_xyz(primaries: [Chromaticity; 3], white: DVec3) -> DMat3 {
    let [r, g, b] = primaries.map(|p| {
        let (x, y) = (f64::from(p.x), f64::from(p.y));
        DVec3::new(x, y, 1.0 - x - y)
    });
    let m = DMat3::from_cols(r, g, b);
    m * DMat3::from_diagonal(m.inverse() * white)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(space: &ColorSpace, reflectance: impl Fn(f32) -> f32) -> Rgb {
        let xyz = cie::tristimulus_integral(|l| reflectance(l) * space.illuminant().at(l));
        let xyz = xyz.map(|v| (v / f64::from(cie::Y_INTEGRAL)) as f32);
        space.rgb_from_xyz(Xyz::new(xyz[0], xyz[1], xyz[2]))
    }

    /// Largest error of a component over a grid of the cube, for the targets that `keep` selects.
    fn worst_round_trip(space: &ColorSpace, keep: impl Fn(Rgb) -> bool) -> f32 {
        let n = 10;
        let mut worst = 0.0_f32;
        for i in 0..=n {
            for j in 0..=n {
                for k in 0..=n {
                    let rgb = Rgb(glam::UVec3::new(i, j, k).as_vec3() / n as f32);
                    if keep(rgb) {
                        let s = space.sigmoid(rgb);
                        worst = worst.max((shown(space, |l| s.at(l)).0 - rgb.0).abs().max_element());
                    }
                }
            }
        }
        worst
    }

    #[test]
    fn every_srgb_reflectance_shows_its_triple() {
        // Measured 1.8e-5 over the whole cube: what single precision and the node spacing leave.
        let worst = worst_round_trip(&ColorSpace::new(ColorSpaceKind::Srgb), |_| true);
        assert!(worst < 5e-5, "{worst}");
    }

    #[test]
    fn srgb_fits_agree_with_the_published_coefficients() {
        // At 400, 450, … 700 nm, from the coefficient table that Jakob & Hanika published (as in mitsuba 3.9.1,
        // srgb.coeff), whose own interpolation error is of the order of 10⁻³.
        let space = ColorSpace::new(ColorSpaceKind::Srgb);
        for (rgb, published) in [
            (Rgb::new(0.63, 0.065, 0.05), [0.1193, 0.0595, 0.0548, 0.0876, 0.3275, 0.898, 0.9817]),
            (Rgb::new(0.14, 0.45, 0.091), [0.0233, 0.095, 0.3326, 0.4591, 0.255, 0.0632, 0.0166]),
            (Rgb::new(0.2, 0.4, 0.8), [0.8991, 0.7745, 0.5648, 0.377, 0.2775, 0.2433, 0.2564]),
            (Rgb::new(0.725, 0.71, 0.68), [0.6613, 0.6827, 0.6992, 0.7112, 0.7193, 0.7236, 0.7243]),
            (Rgb::new(0.5, 0.0, 0.5), [0.9681, 0.4749, 0.0801, 0.0616, 0.1693, 0.8939, 0.9889]),
        ] {
            let s = space.sigmoid(rgb);
            for (i, expected) in published.into_iter().enumerate() {
                let ours = s.at(400.0 + 50.0 * i as f32);
                assert!((ours - expected).abs() < 1.5e-3, "{rgb:?}: {ours} {expected}");
            }
        }
    }

    #[test]
    fn unsaturated_reflectances_of_the_wide_spaces_show_their_triples() {
        // The corners of the wide gamuts are lasers or imaginary: no reflectance shows them. Within the sRGB
        // gamut all of them must do as well as sRGB.
        let srgb = ColorSpace::new(ColorSpaceKind::Srgb);
        for kind in [ColorSpaceKind::DciP3, ColorSpaceKind::Rec2020, ColorSpaceKind::Aces2065_1] {
            let space = ColorSpace::new(kind);
            let worst = worst_round_trip(&space, |rgb| {
                srgb.rgb_from_xyz(space.xyz_from_rgb(rgb))
                    .0
                    .to_array()
                    .iter()
                    .all(|c| (0.02..=0.9).contains(c))
            });
            assert!(worst < 1e-4, "{kind:?}: {worst}");
        }
    }

    #[test]
    fn white_is_one_one_one() {
        for kind in ColorSpaceKind::ALL {
            let space = ColorSpace::new(kind);
            let xyz = cie::tristimulus_integral(|l| space.illuminant().at(l))
                .map(|v| (v / f64::from(cie::Y_INTEGRAL)) as f32);
            let rgb = space.rgb_from_xyz(Xyz::new(xyz[0], xyz[1], xyz[2]));
            assert!((rgb.0 - Vec3::ONE).abs().max_element() < 1e-5, "{kind:?}: {rgb:?}");
            assert!((space.luminance(Rgb::new(1.0, 1.0, 1.0)) - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn srgb_has_the_published_matrix() {
        // IEC 61966-2-1 with its rounded D65 white; ours follows the spectrum's.
        let published = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
        let m = *ColorSpace::new(ColorSpaceKind::Srgb).xyz_from_rgb_matrix();
        for (row, published) in published.iter().enumerate() {
            for (col, &value) in published.iter().enumerate() {
                assert!(
                    (m.col(col)[row] - value).abs() < 3e-4,
                    "row {row} column {col}: {}",
                    m.col(col)[row]
                );
            }
        }
    }

    #[test]
    fn albedo_rejects_what_is_no_reflectance() {
        let space = ColorSpace::new(ColorSpaceKind::Srgb);
        for rgb in [Rgb::new(1.01, 0.0, 0.0), Rgb::new(0.0, -0.01, 0.0), Rgb::new(0.0, 0.0, f32::NAN)] {
            assert!(space.albedo(rgb).is_err());
        }
        assert_eq!(
            space.albedo(Rgb::new(2.0, 0.5, 0.0)).unwrap_err().to_string(),
            "rgb reflectance (2 0.5 0) must lie in [0, 1]"
        );
        assert_eq!(space.albedo(Rgb::new(0.25, 0.25, 0.25)).unwrap().constant_value(), Some(0.25));
    }

    #[test]
    fn rgb_light_has_the_luminance_and_colour_of_its_triple() {
        for kind in ColorSpaceKind::ALL {
            let space = ColorSpace::new(kind);
            let rgb = Rgb::new(12.0, 10.0, 7.0);
            let light = space.illuminant_rgb(rgb);
            let xyz =
                cie::tristimulus_integral(|l| light.at(l)).map(|v| (v / f64::from(cie::Y_INTEGRAL)) as f32);
            let seen = space.rgb_from_xyz(Xyz::new(xyz[0], xyz[1], xyz[2]));
            assert!((seen.0 / rgb.0 - 1.0).abs().max_element() < 1e-4, "{kind:?} {seen:?}");
            // The normalisation of lights knows the illuminant alone.
            assert!((light.photometric_integral() / cie::Y_INTEGRAL - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn unbounded_triples_keep_their_size() {
        let space = ColorSpace::new(ColorSpaceKind::Srgb);
        let rgb = Rgb::new(3.0, 40.0, 0.5);
        let s = space.unbounded(rgb);
        let seen = shown(&space, |l| s.at(l));
        assert!((seen.0 - rgb.0).abs().max_element() < 40.0 * 5e-5, "{seen:?}");
        assert_eq!(space.unbounded(Rgb::default()).at(555.0), 0.0);
        assert!((space.unbounded(Rgb::new(3.0, 3.0, 3.0)).constant_value().unwrap() - 3.0).abs() < 1e-6);
    }

    #[test]
    fn names_are_those_of_scene_files() {
        for kind in ColorSpaceKind::ALL {
            assert_eq!(ColorSpaceKind::from_name(kind.name()), Some(kind));
        }
        assert_eq!(ColorSpaceKind::from_name("sRGB"), Some(ColorSpaceKind::Srgb));
        assert_eq!(ColorSpaceKind::from_name("adobe"), None);
    }
}
