//! How far a picture is from a reference, in numbers.

use super::error::ImageError;
use super::frame::{Frame, RgbPlanes};

/// What to do with the brightest pixels, whose noise would hide everything else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outliers {
    /// Nothing.
    Keep,
    /// Limit both pictures, per channel value, at this quantile of all of the reference's channel values, in [0, 1].
    LimitAtQuantile(f32),
}

/// Differences between an image and a reference over their R, G and B.
///
/// Pixels that are not finite in either are left out of everything and counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Mean of the image over mean of the reference, per channel; 1 when both are black.
    pub mean_ratio: [f64; 3],
    /// Mean of |x − r|.
    pub mae: f64,
    /// Mean of (x − r)².
    pub mse: f64,
    /// Mean of (x − r)²/(r² + ε) with ε = (0.01 · mean r)²: scaling both pictures changes nothing.
    pub rel_mse: f64,
    /// The same without the thousandth of the pixels, rounded down, whose differences are the largest.
    pub rel_mse_trimmed: f64,
    /// 95th percentile over 16 × 16 blocks and channels of |x̄ − r̄|/(r̄ + 0.02 · mean r), the relative difference
    /// of the block's means: noise averages out, a fault of one region does not.
    pub block_95: f64,
    /// The largest of the block differences.
    pub block_worst: f64,
    /// Pixels that are not finite in the image or in the reference.
    pub non_finite: usize,
    /// Pixels in all.
    pub pixels: usize,
}

/// Share of the pixels that [`Comparison::rel_mse_trimmed`] leaves out.
const TRIMMED: f64 = 0.001;

/// Blocks along each side.
const BLOCKS: usize = 16;

/// Compares the R, G and B of two frames of the same size.
///
/// # Errors
/// When the sizes differ or a channel is missing.
pub fn compare(image: &Frame, reference: &Frame, outliers: Outliers) -> Result<Comparison, ImageError> {
    let [width, height] = same_size(image, reference)?;
    let (x, r) = (image.rgb()?, reference.rgb()?);
    let limit = match outliers {
        Outliers::Keep => f32::INFINITY,
        Outliers::LimitAtQuantile(q) => quantile(&r, q),
    };
    let mut sums = Sums::default();
    let mut blocks = vec![Block::default(); BLOCKS * BLOCKS];
    for i in 0..x.len() {
        let (a, b) = (x.pixel(i), r.pixel(i));
        if !a.iter().chain(&b).all(|v| v.is_finite()) {
            continue;
        }
        let (column, row) = (i % width as usize, i / width as usize);
        let block = &mut blocks[block_of(row, height) * BLOCKS + block_of(column, width)];
        block.n += 1.0;
        sums.n += 1.0;
        for c in 0..3 {
            let (a, b) = (f64::from(a[c].min(limit)), f64::from(b[c].min(limit)));
            sums.image[c] += a;
            sums.reference[c] += b;
            sums.absolute += (a - b).abs();
            sums.squared += (a - b) * (a - b);
            block.image[c] += a;
            block.reference[c] += b;
        }
    }
    let n = sums.n.max(1.0);
    let mean = sums.reference.iter().sum::<f64>() / (3.0 * n);
    let epsilon = (0.01 * mean).powi(2);
    let mut relative = Vec::with_capacity(x.len());
    for i in 0..x.len() {
        let (a, b) = (x.pixel(i), r.pixel(i));
        if a.iter().chain(&b).all(|v| v.is_finite()) {
            let of_channel = |c: usize| {
                let (a, b) = (f64::from(a[c].min(limit)), f64::from(b[c].min(limit)));
                ratio((a - b) * (a - b), b * b + epsilon)
            };
            relative.push((of_channel(0) + of_channel(1) + of_channel(2)) / 3.0);
        }
    }
    let rel_mse = relative.iter().sum::<f64>() / n;
    relative.sort_by(f64::total_cmp);
    let kept = &relative[..relative.len() - (relative.len() as f64 * TRIMMED) as usize];
    let rel_mse_trimmed = kept.iter().sum::<f64>() / kept.len().max(1) as f64;
    let mut differences: Vec<f64> = blocks
        .iter()
        .filter(|b| b.n > 0.0)
        .flat_map(|b| {
            (0..3)
                .map(|c| ratio((b.image[c] - b.reference[c]).abs() / b.n, b.reference[c] / b.n + 0.02 * mean))
        })
        .collect();
    differences.sort_by(f64::total_cmp);
    let at = |q: f64| differences.get((q * (differences.len() as f64 - 1.0)).round() as usize).copied();
    let mean_ratio = std::array::from_fn(|c| match (sums.image[c], sums.reference[c]) {
        (0.0, 0.0) => 1.0,
        (a, b) => a / b,
    });
    Ok(Comparison {
        mean_ratio,
        mae: sums.absolute / (3.0 * n),
        mse: sums.squared / (3.0 * n),
        rel_mse,
        rel_mse_trimmed,
        block_95: at(0.95).unwrap_or(0.0),
        block_worst: at(1.0).unwrap_or(0.0),
        non_finite: x.len() - sums.n as usize,
        pixels: x.len(),
    })
}

/// The size of both frames' windows [px].
///
/// # Errors
/// When they differ.
pub(super) fn same_size(a: &Frame, b: &Frame) -> Result<[u32; 2], ImageError> {
    let size = |f: &Frame| [f.window().width, f.window().height];
    if size(a) == size(b) { Ok(size(a)) } else { Err(ImageError::SizeMismatch { a: size(a), b: size(b) }) }
}

#[derive(Default)]
struct Sums {
    n: f64,
    image: [f64; 3],
    reference: [f64; 3],
    absolute: f64,
    squared: f64,
}

#[derive(Clone, Default)]
struct Block {
    n: f64,
    image: [f64; 3],
    reference: [f64; 3],
}

fn block_of(i: usize, n: u32) -> usize {
    i * BLOCKS / n as usize
}

/// a/b where no difference is no relative difference, of black too.
fn ratio(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / b }
}

fn quantile(planes: &RgbPlanes<'_>, q: f32) -> f32 {
    let mut values: Vec<f32> =
        [planes.r, planes.g, planes.b].concat().into_iter().filter(|v| v.is_finite()).collect();
    let Some(last) = values.len().checked_sub(1) else { return f32::INFINITY };
    let k = (f64::from(q.clamp(0.0, 1.0)) * last as f64).round() as usize;
    *values.select_nth_unstable_by(k, f32::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::ColorSpaceKind;
    use crate::math::hash::Pcg32;

    fn noise(seed: u64, factor: f32) -> Frame {
        let mut rng = Pcg32::new(seed, 1);
        let values: Vec<f32> = (0..64 * 48 * 3).map(|_| factor * (0.1 + rng.next_f32())).collect();
        Frame::from_rgb([64, 48], ColorSpaceKind::Srgb, |i| {
            [values[3 * i], values[3 * i + 1], values[3 * i + 2]]
        })
        .unwrap()
    }

    fn constant(rgb: [f32; 3]) -> Frame {
        Frame::from_rgb([64, 48], ColorSpaceKind::Srgb, |_| rgb).unwrap()
    }

    #[test]
    fn a_picture_equals_itself() {
        let c = compare(&noise(1, 1.0), &noise(1, 1.0), Outliers::Keep).unwrap();
        assert_eq!((c.mean_ratio, c.mae, c.mse, c.rel_mse, c.block_worst), ([1.0; 3], 0.0, 0.0, 0.0, 0.0));
        let black = compare(&constant([0.0; 3]), &constant([0.0; 3]), Outliers::Keep).unwrap();
        assert_eq!((black.mean_ratio, black.rel_mse, black.block_95), ([1.0; 3], 0.0, 0.0));
    }

    #[test]
    fn metrics_of_constants_are_their_formulas() {
        let c = compare(&constant([1.1, 2.0, 3.0]), &constant([1.0, 2.0, 4.0]), Outliers::Keep).unwrap();
        assert!((c.mean_ratio[0] - 1.1).abs() < 1e-6 && (c.mean_ratio[2] - 0.75).abs() < 1e-6);
        assert!((c.mae - (0.1 + 0.0 + 1.0) / 3.0).abs() < 1e-6);
        assert!((c.mse - (0.01 + 0.0 + 1.0) / 3.0).abs() < 1e-6);
        let epsilon = (0.01 * 7.0 / 3.0_f64).powi(2);
        let relative = (0.01 / (1.0 + epsilon) + 1.0 / (16.0 + epsilon)) / 3.0;
        assert!((c.rel_mse - relative).abs() < 1e-6);
        assert!((c.block_worst - 1.0 / (4.0 + 0.02 * 7.0 / 3.0)).abs() < 1e-6);
    }

    #[test]
    fn one_pixel_in_a_thousand_is_trimmed() {
        let frame = |at: &dyn Fn(usize) -> f32| {
            Frame::from_rgb([40, 25], ColorSpaceKind::Srgb, |i| [at(i); 3]).unwrap()
        };
        let trimmed = |bright: usize| {
            let image = frame(&|i| if i < bright { 1e3 } else { 2.2 });
            compare(&image, &frame(&|_| 2.0), Outliers::Keep).unwrap().rel_mse_trimmed
        };
        // (0.2/2)² over 1 + 0.01².
        let expected = 0.01 / 1.0001;
        assert!((trimmed(1) / expected - 1.0).abs() < 1e-5, "{}", trimmed(1));
        // Of two such pixels one counts.
        assert!(trimmed(2) > 100.0, "{}", trimmed(2));
    }

    #[test]
    fn relative_metrics_do_not_change_with_exposure() {
        let dim = compare(&noise(1, 1.0), &noise(2, 1.0), Outliers::Keep).unwrap();
        let bright = compare(&noise(1, 256.0), &noise(2, 256.0), Outliers::Keep).unwrap();
        assert!((dim.rel_mse / bright.rel_mse - 1.0).abs() < 1e-6);
        assert!((bright.mse / dim.mse / 65536.0 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn broken_pixels_are_counted_and_do_not_spread() {
        let mut image = noise(1, 1.0);
        let mut red = image.channel("R").unwrap().to_vec();
        red[17] = f32::NAN;
        red[99] = f32::INFINITY;
        image.push_channel("R", red).unwrap();
        let c = compare(&image, &noise(1, 1.0), Outliers::Keep).unwrap();
        assert_eq!((c.non_finite, c.mse), (2, 0.0));
    }

    #[test]
    fn limited_outliers_do_not_decide() {
        let mut image = noise(1, 1.0);
        let mut red = image.channel("R").unwrap().to_vec();
        red[17] = 1e9;
        image.push_channel("R", red).unwrap();
        let kept = compare(&image, &noise(1, 1.0), Outliers::Keep).unwrap();
        let limited = compare(&image, &noise(1, 1.0), Outliers::LimitAtQuantile(0.999)).unwrap();
        assert!(kept.mean_ratio[0] > 1e4);
        assert!((limited.mean_ratio[0] - 1.0).abs() < 1e-3, "{limited:?}");
    }

    #[test]
    fn a_fault_of_one_region_shows_in_the_worst_block() {
        let values = |i: usize| if i % 64 < 4 && i / 64 < 3 { [0.5; 3] } else { [1.0; 3] };
        let image = Frame::from_rgb([64, 48], ColorSpaceKind::Srgb, values).unwrap();
        let c = compare(&image, &constant([1.0; 3]), Outliers::Keep).unwrap();
        assert!((c.block_worst - 0.5 / 1.02).abs() < 1e-6);
        assert_eq!(c.block_95, 0.0, "one block of 256 is less than five per cent");
    }

    #[test]
    fn different_sizes_cannot_be_compared() {
        let small = Frame::from_rgb([2, 2], ColorSpaceKind::Srgb, |_| [0.0; 3]).unwrap();
        assert!(matches!(
            compare(&small, &constant([0.0; 3]), Outliers::Keep),
            Err(ImageError::SizeMismatch { .. })
        ));
    }
}
