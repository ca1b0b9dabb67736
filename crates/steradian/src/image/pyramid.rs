//! A picture at successively halved resolutions (Williams 1983), for lookups over large footprints.

use super::error::ImageError;
use super::picture::Image;
use rayon::prelude::*;

/// A picture and its reduced copies, each in the precision and encoding of the original.
///
/// The finest level is the picture as decoded. Level k ≥ 1 has P/2ᵏ texels along an axis, where P is the
/// axis' length rounded up to a power of two, and each of its texels is the mean over the area that it
/// covers: the mean of the picture is the same at every level. pbrt-v4 enlarges the finest level to P as
/// well, which costs up to four times the memory and leaves the levels' scale the same.
#[derive(Clone, Debug)]
pub struct Pyramid {
    levels: Vec<Image>,
}

impl Pyramid {
    /// Builds all levels down to 1 × 1. An alpha channel that is one everywhere is dropped first, as in pbrt-v4.
    ///
    /// # Errors
    /// Never for a picture that exists; the signature is that of [`Image::from_f32`].
    pub fn new(image: Image) -> Result<Self, ImageError> {
        let image = if image.is_opaque() { image.without_alpha() } else { image };
        let (w, h) = (image.width().next_power_of_two(), image.height().next_power_of_two());
        let n_levels = 1 + w.max(h).ilog2();
        let channels = image.layout().channels();
        let mut levels = Vec::with_capacity(n_levels as usize);
        let mut finer = Linear::default();
        levels.push(image);
        for k in 1..n_levels {
            let (width, height) = ((w >> k).max(1), (h >> k).max(1));
            let base = &levels[0];
            let reduced = if k == 1 {
                // The finest level is read row by row: a float copy of it would cost four times an 8-bit picture.
                let row = |y: usize, out: &mut [f32]| base.read_row(y as u32, out);
                reduce(base.width(), base.height(), width, height, channels, row)
            } else {
                let length = finer.width as usize * channels;
                let row = |y: usize, out: &mut [f32]| {
                    out.copy_from_slice(&finer.values[y * length..(y + 1) * length]);
                };
                reduce(finer.width, finer.height, width, height, channels, row)
            };
            finer = Linear { width, height, values: reduced };
            levels.push(levels[0].like(width, height, &finer.values)?);
        }
        Ok(Self { levels })
    }

    /// Number of levels, at least one; the last has a single texel.
    pub fn n_levels(&self) -> usize {
        self.levels.len()
    }

    /// The picture at level `k`, 0 the finest. A level that does not exist is a broken invariant.
    pub fn level(&self, k: usize) -> &Image {
        &self.levels[k]
    }

    /// Memory of all texels [B].
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(Image::bytes).sum()
    }
}

/// Linear values of one level, before they are rounded to the stored precision.
#[derive(Default)]
struct Linear {
    width: u32,
    height: u32,
    values: Vec<f32>,
}

/// The source texels under one target texel, and the part of the target that each covers.
struct Span {
    start: usize,
    weights: [f32; 3],
}

impl Span {
    /// The source texels of which some part is covered, each with its weight.
    #[inline]
    fn covered(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        (self.start..).zip(self.weights).filter(|&(_, weight)| weight > 0.0)
    }
}

/// Target texel i of m covers [i·n/m, (i+1)·n/m) of n source texels; n/m ≤ 2 touches at most three.
fn spans(n: u32, m: u32) -> Vec<Span> {
    let (n, m) = (u64::from(n), u64::from(m));
    (0..m)
        .map(|i| {
            // Positions in units of 1/m source texels are integers: the weights are exact.
            let (begin, end) = (i * n, (i + 1) * n);
            let start = begin / m;
            let weights = std::array::from_fn(|k| {
                let (left, right) = ((start + k as u64) * m, (start + k as u64 + 1) * m);
                let overlap = right.min(end).saturating_sub(left.max(begin));
                overlap as f32 / n as f32
            });
            Span { start: start as usize, weights }
        })
        .collect()
}

/// Means over the areas of `width` × `height` texels; `row` writes a row of the source.
fn reduce(
    src_width: u32,
    src_height: u32,
    width: u32,
    height: u32,
    channels: usize,
    row: impl Fn(usize, &mut [f32]) + Sync,
) -> Vec<f32> {
    let (columns, rows) = (spans(src_width, width), spans(src_height, height));
    let mut out = vec![0.0; width as usize * height as usize * channels];
    let length = src_width as usize * channels;
    let scratch = || (vec![0.0; length], vec![0.0; length]);
    out.par_chunks_exact_mut(width as usize * channels).zip(&rows).for_each_init(
        scratch,
        |(line, sum), (target, span)| {
            sum.fill(0.0);
            for (dy, weight) in span.covered() {
                row(dy, line);
                sum.iter_mut().zip(line.iter()).for_each(|(sum, value)| *sum += weight * value);
            }
            for (texel, span) in target.chunks_exact_mut(channels).zip(&columns) {
                for (dx, weight) in span.covered() {
                    let source = &sum[dx * channels..(dx + 1) * channels];
                    texel.iter_mut().zip(source).for_each(|(texel, value)| *texel += weight * value);
                }
            }
        },
    );
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::encoding::ColorEncoding;
    use crate::image::picture::Layout;
    use crate::math::hash::Pcg32;

    fn mean(image: &Image) -> f64 {
        let v = image.to_linear();
        v.iter().map(|&x| f64::from(x)).sum::<f64>() / v.len() as f64
    }

    #[test]
    fn every_level_has_the_mean_of_the_picture() {
        let mut rng = Pcg32::new(7, 1);
        for (w, h) in [(16, 16), (17, 5), (1, 9), (31, 33), (3, 1)] {
            let values: Vec<f32> = (0..w * h * 3).map(|_| rng.next_f32() * 10.0).collect();
            let pyramid = Pyramid::new(Image::from_f32(w, h, Layout::Rgb, values).unwrap()).unwrap();
            let expected = mean(pyramid.level(0));
            for k in 0..pyramid.n_levels() {
                let got = mean(pyramid.level(k));
                assert!((got / expected - 1.0).abs() < 1e-5, "{w}x{h} level {k}: {got} for {expected}");
            }
            let top = pyramid.level(pyramid.n_levels() - 1);
            assert_eq!((top.width(), top.height()), (1, 1));
        }
    }

    #[test]
    fn eight_bit_pictures_stay_eight_bit_and_average_light_not_codes() {
        // Black and white in equal parts reflect half of the light: code 188 in sRGB, not 128.
        let codes: Vec<u8> = (0..64).map(|i| if (i / 8 + i) % 2 == 0 { 255 } else { 0 }).collect();
        let pyramid =
            Pyramid::new(Image::from_u8(8, 8, Layout::Gray, codes, ColorEncoding::Srgb).unwrap()).unwrap();
        assert_eq!(pyramid.bytes(), 64 + 16 + 4 + 1);
        for k in 1..4 {
            assert_eq!(ColorEncoding::Srgb.quantize(pyramid.level(k).texel(0, 0, 0)), 188);
        }
    }

    #[test]
    fn level_sizes_halve_from_the_next_power_of_two() {
        let image = Image::from_f32(5, 9, Layout::Gray, vec![0.5; 45]).unwrap();
        let pyramid = Pyramid::new(image).unwrap();
        let sizes: Vec<_> =
            (0..pyramid.n_levels()).map(|k| (pyramid.level(k).width(), pyramid.level(k).height())).collect();
        assert_eq!(sizes, [(5, 9), (4, 8), (2, 4), (1, 2), (1, 1)]);
    }

    #[test]
    fn a_reduced_texel_is_the_area_average_below_it() {
        let image = Image::from_f32(3, 1, Layout::Gray, vec![1.0, 2.0, 4.0]).unwrap();
        let pyramid = Pyramid::new(image).unwrap();
        // Two texels over three: each covers one whole and half of the middle one.
        let level = pyramid.level(1);
        assert!((level.texel(0, 0, 0) - (1.0 + 0.5 * 2.0) / 1.5).abs() < 1e-6);
        assert!((level.texel(1, 0, 0) - (0.5 * 2.0 + 4.0) / 1.5).abs() < 1e-6);
    }
}
