//! Filtered lookups in image pyramids.

use super::mapping::TexCoord2d;
use crate::color::Rgb;
use crate::image::{Image, Pyramid, Wrap};
use crate::math::Vec2;
use std::ops::{Add, Mul};

/// How a footprint is averaged over a picture (pbrt-v4 book, 10.4.3 and 10.4.4).
///
/// The first three look at a square footprint, whose width is twice the largest coordinate difference per
/// pixel, and choose the level whose texels are as wide: level = n − 1 + log₂(width) for n levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImageFilter {
    /// The nearest texel of the level, rounded down.
    Point,
    /// Four texels of the level, rounded down.
    Bilinear,
    /// Eight texels of the two nearest levels; between the finest and the next, the finest alone, as in pbrt-v4.
    Trilinear,
    /// An elliptical Gaussian (Heckbert 1989) over the two levels nearest to its shorter axis.
    Ewa {
        /// Largest ratio of the ellipse's axes, at least 1; thinner ellipses are widened. At most
        /// [`MAX_ANISOTROPY`], which bounds the work of a lookup.
        max_anisotropy: f32,
    },
}

/// Largest ratio of axes that a filter ellipse keeps.
pub const MAX_ANISOTROPY: f32 = 64.0;

/// Sharpness of the EWA Gaussian: e^(−2 r²) falls to 14 % at the ellipse's rim (pbrt-v4 book, 10.4.4).
const EWA_FALLOFF: f32 = 2.0;

/// What is read from a texel.
pub(super) trait Reading {
    /// A value that can be averaged; the default is zero.
    type Value: Copy + Default + Add<Output = Self::Value> + Mul<f32, Output = Self::Value>;
    /// The value of one texel.
    fn texel(image: &Image, x: i32, y: i32, wrap: Wrap) -> Self::Value;
    /// The bilinear average of four texels.
    fn bilerp(image: &Image, st: Vec2, wrap: Wrap) -> Self::Value;
}

/// Reads one number, [`Image::scalar`].
pub(super) struct Scalar;

/// Reads linear RGB, [`Image::rgb`].
pub(super) struct Color;

impl Reading for Scalar {
    type Value = f32;
    fn texel(image: &Image, x: i32, y: i32, wrap: Wrap) -> f32 {
        image.scalar_wrapped(x, y, wrap)
    }
    fn bilerp(image: &Image, st: Vec2, wrap: Wrap) -> f32 {
        image.bilerp_scalar(st, wrap)
    }
}

impl Reading for Color {
    type Value = Rgb;
    fn texel(image: &Image, x: i32, y: i32, wrap: Wrap) -> Rgb {
        image.rgb_wrapped(x, y, wrap)
    }
    fn bilerp(image: &Image, st: Vec2, wrap: Wrap) -> Rgb {
        image.bilerp_rgb(st, wrap)
    }
}

/// The average of a picture over the footprint of `c`, where t = 0 is the bottom of the picture.
pub(super) fn lookup<R: Reading>(
    pyramid: &Pyramid,
    filter: ImageFilter,
    wrap: Wrap,
    c: &TexCoord2d,
) -> R::Value {
    // Rows are stored from the top.
    let flip = |d: Vec2| Vec2::new(d.x, -d.y);
    let st = Vec2::new(c.st.x, 1.0 - c.st.y);
    if let ImageFilter::Ewa { max_anisotropy } = filter {
        return ewa::<R>(pyramid, wrap, st, flip(c.dstdx), flip(c.dstdy), max_anisotropy);
    }
    let width = 2.0 * c.dstdx.abs().max(c.dstdy.abs()).max_element();
    let top = pyramid.n_levels() - 1;
    let width = width.max(1e-8);
    if width >= 1.0 {
        return R::texel(pyramid.level(top), 0, 0, wrap);
    }
    // ⌊log₂ width⌋, which the number is stored with.
    let exponent = (width.to_bits() >> 23) as usize;
    let k = (top + exponent).saturating_sub(127);
    let image = pyramid.level(k);
    match filter {
        ImageFilter::Point => {
            let size = Vec2::new(image.width() as f32, image.height() as f32);
            let nearest = (st * size - 0.5).round();
            R::texel(image, nearest.x as i32, nearest.y as i32, wrap)
        }
        ImageFilter::Trilinear if k > 0 => {
            let between = width.log2() - (exponent as f32 - 127.0);
            R::bilerp(image, st, wrap) * (1.0 - between) + R::bilerp(pyramid.level(k + 1), st, wrap) * between
        }
        ImageFilter::Bilinear | ImageFilter::Trilinear | ImageFilter::Ewa { .. } => {
            R::bilerp(image, st, wrap)
        }
    }
}

fn ewa<R: Reading>(
    pyramid: &Pyramid,
    wrap: Wrap,
    st: Vec2,
    a: Vec2,
    b: Vec2,
    max_anisotropy: f32,
) -> R::Value {
    let (major, mut minor) = if a.length_squared() < b.length_squared() { (b, a) } else { (a, b) };
    let (long, mut short) = (major.length(), minor.length());
    let limit = max_anisotropy.clamp(1.0, MAX_ANISOTROPY);
    if short > 0.0 && short * limit < long {
        let scale = long / (short * limit);
        minor *= scale;
        short *= scale;
    }
    if short.is_nan() || short <= 0.0 {
        return R::bilerp(pyramid.level(0), st, wrap);
    }
    let top = pyramid.n_levels() - 1;
    let level = (top as f32 + short.log2()).max(0.0);
    if level >= top as f32 + 1.0 {
        return R::texel(pyramid.level(top), 0, 0, wrap);
    }
    let (floor, between) = (level.floor(), level.fract());
    let at = |k: usize| {
        if k > top {
            R::texel(pyramid.level(top), 0, 0, wrap)
        } else {
            ewa_level::<R>(pyramid.level(k), wrap, st, major, minor)
        }
    };
    let k = floor as usize;
    at(k) * (1.0 - between) + at(k + 1) * between
}

/// The Gaussian average over the ellipse with the axes `major` and `minor` around `st`, in texels of `image`.
fn ewa_level<R: Reading>(image: &Image, wrap: Wrap, st: Vec2, major: Vec2, minor: Vec2) -> R::Value {
    let size = Vec2::new(image.width() as f32, image.height() as f32);
    let (center, major, minor) = (st * size - 0.5, major * size, minor * size);
    // The ellipse A x² + B x y + C y² = 1, with one texel added to its extent so that it never falls between
    // texels (Heckbert 1989, 3.5.8).
    let a = major.y * major.y + minor.y * minor.y + 1.0;
    let b = -2.0 * (major.x * major.y + minor.x * minor.y);
    let c = major.x * major.x + minor.x * minor.x + 1.0;
    let inv_f = 1.0 / (a * c - b * b * 0.25);
    let (a, b, c) = (a * inv_f, b * inv_f, c * inv_f);
    let inv_det = 1.0 / (4.0 * a * c - b * b);
    let extent = Vec2::new((c * inv_det).sqrt(), (a * inv_det).sqrt()) * 2.0;
    let (low, high) = ((center - extent).ceil(), (center + extent).floor());
    let mut sum = R::Value::default();
    let mut sum_of_weights = 0.0;
    for y in low.y as i32..=high.y as i32 {
        let dy = y as f32 - center.y;
        for x in low.x as i32..=high.x as i32 {
            let dx = x as f32 - center.x;
            let r2 = a * dx * dx + b * dx * dy + c * dy * dy;
            if r2 < 1.0 {
                // Shifted so that it reaches zero at the rim.
                let weight = (-EWA_FALLOFF * r2).exp() - (-EWA_FALLOFF).exp();
                sum = sum + R::texel(image, x, y, wrap) * weight;
                sum_of_weights += weight;
            }
        }
    }
    if sum_of_weights > 0.0 {
        sum * (1.0 / sum_of_weights)
    } else {
        // Coordinates so large that no texel centre can be told from its neighbour.
        R::bilerp(image, st, wrap)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Layout;
    use proptest::prelude::*;
    use std::f32::consts::TAU;

    fn pyramid(w: u32, h: u32, f: impl Fn(f32, f32) -> f32) -> Pyramid {
        let values = (0..w * h)
            .map(|i| f(((i % w) as f32 + 0.5) / w as f32, ((i / w) as f32 + 0.5) / h as f32))
            .collect();
        Pyramid::new(Image::from_f32(w, h, Layout::Gray, values).unwrap()).unwrap()
    }

    fn coordinates(st: Vec2, dstdx: Vec2, dstdy: Vec2) -> TexCoord2d {
        TexCoord2d { st, dstdx, dstdy }
    }

    const ALL: [ImageFilter; 4] = [
        ImageFilter::Point,
        ImageFilter::Bilinear,
        ImageFilter::Trilinear,
        ImageFilter::Ewa { max_anisotropy: 8.0 },
    ];

    proptest! {
        #[test]
        fn every_filter_reproduces_a_constant_under_any_footprint(
            s in -5.0_f32..5.0, t in -5.0_f32..5.0,
            e in -24.0_f32..27.0, ratio in 0.0_f32..1.0, angle in 0.0_f32..TAU,
        ) {
            let pyramid = pyramid(19, 6, |_, _| 0.75);
            let axis = Vec2::from_angle(angle) * e.exp2();
            let c = coordinates(Vec2::new(s, t), axis, axis.perp() * ratio);
            for filter in ALL {
                for wrap in [Wrap::REPEAT, Wrap::CLAMP, Wrap::OctahedralSphere] {
                    let v = lookup::<Scalar>(&pyramid, filter, wrap, &c);
                    prop_assert!((v - 0.75).abs() < 1e-4, "{filter:?} {wrap:?}: {v}");
                }
            }
        }
    }

    #[test]
    fn the_picture_hangs_upright() {
        let pyramid = pyramid(4, 4, |_, t| if t < 0.5 { 1.0 } else { 0.0 });
        for filter in ALL {
            let v = |t| {
                lookup::<Scalar>(
                    &pyramid,
                    filter,
                    Wrap::CLAMP,
                    &coordinates(Vec2::new(0.5, t), Vec2::ZERO, Vec2::ZERO),
                )
            };
            assert_eq!((v(0.875), v(0.125)), (1.0, 0.0), "{filter:?}: row 0 is at t = 1");
        }
    }

    #[test]
    fn a_footprint_of_the_whole_picture_reads_its_mean() {
        let pyramid = pyramid(33, 20, |s, t| (s * 9.0).sin() + t);
        let top = pyramid.level(pyramid.n_levels() - 1).scalar(0, 0);
        let c = coordinates(Vec2::new(0.3, 0.1), Vec2::X, Vec2::Y);
        for filter in ALL {
            assert!((lookup::<Scalar>(&pyramid, filter, Wrap::REPEAT, &c) - top).abs() < 1e-6, "{filter:?}");
        }
    }

    #[test]
    fn the_level_follows_the_width_of_the_footprint() {
        // Each level of this picture is distinguishable: a single bright texel is diluted by 4 per level.
        let pyramid = pyramid(16, 16, |s, t| if s < 1.0 / 16.0 && t < 1.0 / 16.0 { 1.0 } else { 0.0 });
        let at = |filter, width: f32| {
            let c =
                coordinates(Vec2::new(0.5 / 16.0, 15.5 / 16.0), Vec2::X * width * 0.5, Vec2::Y * width * 0.5);
            lookup::<Scalar>(&pyramid, filter, Wrap::CLAMP, &c)
        };
        for k in 0..4_i32 {
            let width = 2.0_f32.powi(k) / 16.0;
            assert_eq!(at(ImageFilter::Point, width), 0.25_f32.powi(k), "level {k}");
            assert_eq!(at(ImageFilter::Point, width * 1.9), 0.25_f32.powi(k), "level {k}, rounded down");
        }
        let halfway = 2.0_f32.powf(1.5) / 16.0;
        let fine = at(ImageFilter::Trilinear, 2.0 / 16.0);
        let coarse = at(ImageFilter::Trilinear, 4.0 / 16.0);
        assert!((at(ImageFilter::Trilinear, halfway) - 0.5 * (fine + coarse)).abs() < 1e-6);
    }

    #[test]
    fn a_round_ellipse_agrees_with_trilinear_on_a_smooth_picture() {
        let pyramid = pyramid(128, 128, |s, t| 0.5 + 0.25 * (TAU * s).sin() + 0.25 * (TAU * t).cos());
        for i in 0..50 {
            let st = Vec2::new((i as f32 * 0.37).fract(), (i as f32 * 0.73).fract());
            let width = 0.02 + 0.0005 * i as f32;
            // The square's half-width is the pixel's extent, the ellipse's radius too.
            let c = coordinates(st, Vec2::X * width, Vec2::Y * width);
            let round =
                lookup::<Scalar>(&pyramid, ImageFilter::Ewa { max_anisotropy: 8.0 }, Wrap::REPEAT, &c);
            let square = lookup::<Scalar>(&pyramid, ImageFilter::Trilinear, Wrap::REPEAT, &c);
            assert!((round - square).abs() < 0.02, "{st} {width}: {round} {square}");
        }
    }

    #[test]
    fn an_ellipse_blurs_along_its_long_axis_only() {
        let stripes = pyramid(64, 64, |s, _| if (s * 16.0) as i32 % 2 == 0 { 1.0 } else { 0.0 });
        let ewa = ImageFilter::Ewa { max_anisotropy: 16.0 };
        let (long, short) = (8.0 / 64.0, 0.5 / 64.0);
        let on_stripe = Vec2::new(2.0 / 64.0, 0.5);
        let along = lookup::<Scalar>(
            &stripes,
            ewa,
            Wrap::REPEAT,
            &coordinates(on_stripe, Vec2::Y * long, Vec2::X * short),
        );
        let across = lookup::<Scalar>(
            &stripes,
            ewa,
            Wrap::REPEAT,
            &coordinates(on_stripe, Vec2::X * long, Vec2::Y * short),
        );
        assert!(along > 0.95, "{along}");
        assert!((across - 0.5).abs() < 0.1, "{across}");
    }

    #[test]
    fn an_oblique_ellipse_leans_the_way_its_footprint_does() {
        // Diagonal stripes s + t = const, with t upwards: constant along (1, −1).
        let stripes =
            pyramid(64, 64, |s, down| if ((s + 1.0 - down) * 16.0) as i32 % 2 == 0 { 1.0 } else { 0.0 });
        let ewa = ImageFilter::Ewa { max_anisotropy: 16.0 };
        let st = Vec2::new(0.5 + 1.0 / 32.0, 0.5);
        let (long, short) = (8.0 / 64.0, 0.5 / 64.0);
        let with = coordinates(st, Vec2::new(1.0, -1.0) * long, Vec2::new(1.0, 1.0) * short);
        let against = coordinates(st, Vec2::new(1.0, 1.0) * long, Vec2::new(1.0, -1.0) * short);
        assert!(lookup::<Scalar>(&stripes, ewa, Wrap::REPEAT, &with) > 0.9);
        assert!((lookup::<Scalar>(&stripes, ewa, Wrap::REPEAT, &against) - 0.5).abs() < 0.1);
    }

    #[test]
    fn hostile_coordinates_return_promptly() {
        let pyramid = pyramid(64, 64, |s, _| s);
        for st in [Vec2::splat(1e9), Vec2::new(-1e30, 1e30), Vec2::splat(f32::INFINITY)] {
            for d in [1e-30, 1.0, 1e8, 3e38, f32::INFINITY] {
                for filter in
                    [ImageFilter::Ewa { max_anisotropy: 1e30 }, ImageFilter::Trilinear, ImageFilter::Point]
                {
                    let c = coordinates(st, Vec2::X * d, Vec2::Y * d * 1e-6);
                    let v = lookup::<Scalar>(&pyramid, filter, Wrap::REPEAT, &c);
                    assert!(!st.is_finite() || (-1e-6..1.0).contains(&v), "{filter:?} {st} {d}: {v}");
                }
            }
        }
    }
}
