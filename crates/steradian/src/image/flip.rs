//! LDR-ꟻLIP: the difference that a viewer perceives when alternating between two pictures
//! (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020).

use super::compare::same_size;
use super::error::ImageError;
use super::frame::Frame;
use std::f32::consts::PI;

/// Pixels per degree of visual angle of a 0.7 m wide 4K display seen from 0.7 m, the paper's default.
pub const DEFAULT_PIXELS_PER_DEGREE: f32 = 67.020_64;

/// Perceived difference per pixel, in [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct FlipMap {
    /// Width [px].
    pub width: u32,
    /// Height [px].
    pub height: u32,
    /// Differences, rows from the top.
    pub values: Vec<f32>,
}

impl FlipMap {
    /// Mean difference: the number to report.
    pub fn mean(&self) -> f64 {
        self.values.iter().map(|&v| f64::from(v)).sum::<f64>() / self.values.len().max(1) as f64
    }
}

/// The perceived difference between two frames, read as linear sRGB and limited to [0, 1] as a display does.
/// What is not a number counts as black.
///
/// # Errors
/// When the sizes differ or a channel is missing.
pub fn flip(image: &Frame, reference: &Frame, pixels_per_degree: f32) -> Result<FlipMap, ImageError> {
    let [width, height] = same_size(image, reference)?;
    let a = Perceived::of(image, width, height, pixels_per_degree)?;
    let b = Perceived::of(reference, width, height, pixels_per_degree)?;
    let c_max = hyab(hunt(lab([0.0, 1.0, 0.0])), hunt(lab([0.0, 0.0, 1.0]))).powf(COLOR_EXPONENT);
    let values = (0..a.lab.len())
        .map(|i| {
            let color = compress(hyab(a.lab[i], b.lab[i]).powf(COLOR_EXPONENT), c_max);
            let edge = (a.edges[i] - b.edges[i]).abs();
            let point = (a.points[i] - b.points[i]).abs();
            let feature = (edge.max(point) * std::f32::consts::FRAC_1_SQRT_2).powf(FEATURE_EXPONENT).min(1.0);
            // A difference of features amplifies the difference of colours (equation 9 of the paper).
            color.powf(1.0 - feature)
        })
        .collect();
    Ok(FlipMap { width, height, values })
}

/// q_c of the paper.
const COLOR_EXPONENT: f32 = 0.7;
/// q_f of the paper.
const FEATURE_EXPONENT: f32 = 0.5;

/// Maps colour distances to [0, 1]: the fraction p_c = 0.4 of the largest distance to p_t = 0.95.
fn compress(distance: f32, largest: f32) -> f32 {
    const P_C: f32 = 0.4;
    const P_T: f32 = 0.95;
    let knee = P_C * largest;
    if distance < knee {
        P_T / knee * distance
    } else {
        P_T + (distance - knee) / (largest - knee) * (1.0 - P_T)
    }
}

/// What the eye makes of one picture.
struct Perceived {
    /// Hunt-adjusted L*a*b* of the picture blurred by the contrast sensitivity of the eye.
    lab: Vec<[f32; 3]>,
    /// Magnitude of edges.
    edges: Vec<f32>,
    /// Magnitude of points.
    points: Vec<f32>,
}

impl Perceived {
    fn of(frame: &Frame, width: u32, height: u32, ppd: f32) -> Result<Self, ImageError> {
        let rgb = frame.rgb()?;
        let mut planes = [(); 3].map(|()| Vec::with_capacity(rgb.len()));
        for i in 0..rgb.len() {
            let displayed = |v: f32| if v.is_nan() { 0.0 } else { v.clamp(0.0, 1.0) };
            let opponent = opponent_from_rgb(rgb.pixel(i).map(displayed));
            planes.iter_mut().zip(opponent).for_each(|(plane, v)| plane.push(v));
        }
        let width = width as usize;
        let height = height as usize;
        let luminance: Vec<f32> = planes[0].iter().map(|y| (y + 16.0) / 116.0).collect();
        let blurred: [Vec<f32>; 3] =
            std::array::from_fn(|c| contrast_sensitivity(&planes[c], width, height, &SENSITIVITY[c], ppd));
        let lab = (0..rgb.len())
            .map(|i| {
                let rgb = rgb_from_opponent([blurred[0][i], blurred[1][i], blurred[2][i]]);
                hunt(lab(rgb.map(|v| v.clamp(0.0, 1.0))))
            })
            .collect();
        let (edges, points) = features(&luminance, width, height, ppd);
        Ok(Self { lab, edges, points })
    }
}

/// A sum of Gaussians a √(π/b) exp(−π² x²/b) in degrees: contrast sensitivity of the achromatic, red–green and
/// blue–yellow channel (table 1 of the paper).
const SENSITIVITY: [[(f32, f32); 2]; 3] =
    [[(1.0, 0.0047), (0.0, 1e-5)], [(1.0, 0.0053), (0.0, 1e-5)], [(34.1, 0.04), (13.5, 0.025)]];

/// The widest b, which sets the radius of all kernels: three standard deviations.
const WIDEST: f32 = 0.04;

fn contrast_sensitivity(
    plane: &[f32],
    width: usize,
    height: usize,
    terms: &[(f32, f32); 2],
    ppd: f32,
) -> Vec<f32> {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * ppd).ceil() as i32;
    let mut out = vec![0.0; plane.len()];
    let mut total = 0.0;
    for &(a, b) in terms.iter().filter(|(a, _)| *a > 0.0) {
        let kernel: Vec<f32> =
            (-radius..=radius).map(|i| (-(PI * i as f32 / ppd).powi(2) / b).exp()).collect();
        let sum: f32 = kernel.iter().sum();
        // Each Gaussian of the sum is separable, the sum is not.
        let weight = a * (PI / b).sqrt() * sum * sum;
        let kernel: Vec<f32> = kernel.into_iter().map(|v| v / sum).collect();
        let blurred = convolve(plane, width, height, &kernel, &kernel);
        out.iter_mut().zip(blurred).for_each(|(o, v)| *o += weight * v);
        total += weight;
    }
    out.iter_mut().for_each(|v| *v /= total);
    out
}

/// Magnitudes of the first and second derivative of luminance at the width of the eye's feature detectors,
/// 0.082° (section 4.2 of the paper).
fn features(luminance: &[f32], width: usize, height: usize, ppd: f32) -> (Vec<f32>, Vec<f32>) {
    let sigma = 0.5 * 0.082 * ppd;
    let radius = (3.0 * sigma).ceil() as i32;
    let gaussian = |i: i32| (-((i * i) as f32) / (2.0 * sigma * sigma)).exp();
    let kernel = |f: &dyn Fn(f32) -> f32| -> Vec<f32> {
        let raw: Vec<f32> = (-radius..=radius).map(|i| f(i as f32) * gaussian(i)).collect();
        // Positive weights sum to one and negative ones to minus one.
        let positive: f32 = raw.iter().filter(|v| **v > 0.0).sum();
        let negative: f32 = -raw.iter().filter(|v| **v < 0.0).sum::<f32>();
        raw.into_iter()
            .map(|v| if v > 0.0 { v / positive } else { v / negative.max(f32::MIN_POSITIVE) })
            .collect()
    };
    let smooth = kernel(&|_| 1.0);
    let edge = kernel(&|x| -x);
    let point = kernel(&|x| x * x / (sigma * sigma) - 1.0);
    let magnitude = |derivative: &[f32]| {
        let x = convolve(luminance, width, height, derivative, &smooth);
        let y = convolve(luminance, width, height, &smooth, derivative);
        x.into_iter().zip(y).map(|(x, y)| x.hypot(y)).collect()
    };
    (magnitude(&edge), magnitude(&point))
}

/// Separable convolution by odd kernels; edge pixels continue beyond the picture.
fn convolve(plane: &[f32], width: usize, height: usize, across: &[f32], down: &[f32]) -> Vec<f32> {
    let along_rows = |row: &[f32], out: &mut [f32]| {
        let radius = across.len() / 2;
        for (x, o) in out.iter_mut().enumerate() {
            *o = if x >= radius && x + radius < width {
                row[x - radius..=x + radius].iter().zip(across).map(|(v, k)| v * k).sum()
            } else {
                let at = |k: usize| row[(x + k).saturating_sub(radius).min(width - 1)];
                across.iter().enumerate().map(|(k, w)| w * at(k)).sum()
            };
        }
    };
    let mut rows = vec![0.0; plane.len()];
    for (row, out) in plane.chunks_exact(width).zip(rows.chunks_exact_mut(width)) {
        along_rows(row, out);
    }
    let mut out = vec![0.0; plane.len()];
    let radius = down.len() / 2;
    for (y, line) in out.chunks_exact_mut(width).enumerate() {
        for (k, w) in down.iter().enumerate() {
            let source = (y + k).saturating_sub(radius).min(height - 1) * width;
            line.iter_mut().zip(&rows[source..source + width]).for_each(|(o, v)| *o += w * v);
        }
    }
    out
}

/// XYZ from linear sRGB (IEC 61966-2-1).
const XYZ_FROM_RGB: [[f32; 3]; 3] = [
    [0.412_456_4, 0.357_576_1, 0.180_437_5],
    [0.212_672_9, 0.715_152_2, 0.072_175],
    [0.019_333_9, 0.119_192, 0.950_304_1],
];

/// Linear sRGB from XYZ (IEC 61966-2-1).
const RGB_FROM_XYZ: [[f32; 3]; 3] = [
    [3.240_454_2, -1.537_138_5, -0.498_531_4],
    [-0.969_266, 1.876_010_8, 0.041_556],
    [0.055_643_4, -0.204_025_9, 1.057_225_2],
];

/// XYZ of white, (1, 1, 1) in sRGB.
const WHITE: [f32; 3] = [0.950_470_1, 1.0, 1.088_830_1];

fn transform(m: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// YCxCz, a linear cousin of L*a*b* in which blurring is meaningful.
fn opponent_from_rgb(rgb: [f32; 3]) -> [f32; 3] {
    let xyz = transform(&XYZ_FROM_RGB, rgb);
    let [x, y, z] = std::array::from_fn(|i| xyz[i] / WHITE[i]);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn rgb_from_opponent([luma, cx, cz]: [f32; 3]) -> [f32; 3] {
    let y = (luma + 16.0) / 116.0;
    let relative = [y + cx / 500.0, y, y - cz / 200.0];
    transform(&RGB_FROM_XYZ, std::array::from_fn(|i| relative[i] * WHITE[i]))
}

/// CIE 1976 L*a*b* of linear sRGB.
fn lab(rgb: [f32; 3]) -> [f32; 3] {
    const DELTA: f32 = 6.0 / 29.0;
    let xyz = transform(&XYZ_FROM_RGB, rgb);
    let [x, y, z] = std::array::from_fn(|i| {
        let t = xyz[i] / WHITE[i];
        if t > DELTA * DELTA * DELTA { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The Hunt effect: colours look less saturated in the dark (equation 4 of the paper).
fn hunt([l, a, b]: [f32; 3]) -> [f32; 3] {
    [l, 0.01 * l * a, 0.01 * l * b]
}

/// The HyAB distance (Abasi, Tehran, Fairchild 2020), made for large differences.
fn hyab(p: [f32; 3], q: [f32; 3]) -> f32 {
    (p[0] - q[0]).abs() + (p[1] - q[1]).hypot(p[2] - q[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::ColorSpaceKind;
    use crate::math::hash::Pcg32;

    fn frame(f: impl Fn(usize, usize) -> [f32; 3]) -> Frame {
        Frame::from_rgb([48, 40], ColorSpaceKind::Srgb, |i| f(i % 48, i / 48)).unwrap()
    }

    fn mean(a: &Frame, b: &Frame) -> f64 {
        flip(a, b, DEFAULT_PIXELS_PER_DEGREE).unwrap().mean()
    }

    fn noise(seed: u64, amplitude: f32) -> Frame {
        let mut rng = Pcg32::new(seed, 2);
        let v: Vec<f32> = (0..48 * 40).map(|_| 0.4 + amplitude * (rng.next_f32() - 0.5)).collect();
        frame(|x, y| [v[y * 48 + x]; 3])
    }

    #[test]
    fn equal_pictures_do_not_differ_and_the_order_does_not_matter() {
        let (a, b) = (noise(1, 0.5), noise(2, 0.5));
        assert_eq!(mean(&a, &a), 0.0);
        assert_eq!(mean(&a, &b), mean(&b, &a));
    }

    #[test]
    fn green_against_blue_is_the_largest_difference() {
        let v = mean(&frame(|_, _| [0.0, 1.0, 0.0]), &frame(|_, _| [0.0, 0.0, 1.0]));
        assert!((v - 1.0).abs() < 1e-4, "{v}");
    }

    #[test]
    fn black_against_white_is_what_its_formula_says() {
        // HyAB = 100; 100^0.7 = 25.119; c_max = 203.27^0.7 = 41.26; 0.95 + 0.05 (25.119 − 16.50)/(41.26 − 16.50).
        let v = mean(&frame(|_, _| [0.0; 3]), &frame(|_, _| [1.0; 3]));
        assert!((v - 0.9674).abs() < 3e-4, "{v}");
    }

    #[test]
    fn it_agrees_with_the_authors_implementation() {
        // Means and pixels (0, 0), (24, 20), (47, 39) by flip-evaluator 1.7 for the same pictures, linear input.
        let picture = |p: f64| {
            frame(move |x, y| {
                let patch = if (x / 8 + y / 8).is_multiple_of(2) { 0.0 } else { 0.3 };
                let (x, y) = (x as f64, y as f64);
                let r = 0.5 + 0.4 * (0.3 * x + p).sin() * (0.2 * y).cos();
                let g = 0.5 + 0.4 * (0.17 * x * (1.0 + p)).sin();
                let b = 0.3 + 0.2 * (0.5 * y + 2.0 * p).cos() + patch * p;
                [r, g, b].map(|v| v.clamp(0.0, 1.0) as f32)
            })
        };
        for (p, q, expected) in [
            (0.0, 0.5, [0.777_349_2, 0.445_157, 0.757_331_97, 0.968_764_66]),
            (0.0, 0.05, [0.242_569_34, 0.082_793_29, 0.320_175_35, 0.218_753_59]),
            (0.2, 1.0, [0.767_847_4, 0.652_819_34, 0.970_875_44, 0.229_520_3]),
        ] {
            let map = flip(&picture(p), &picture(q), DEFAULT_PIXELS_PER_DEGREE).unwrap();
            let at = |x: usize, y: usize| map.values[y * 48 + x];
            let got = [map.mean() as f32, at(0, 0), at(24, 20), at(47, 39)];
            assert!((0..4).all(|i| (got[i] - expected[i]).abs() < 2e-3), "{p} {q}: {got:?} for {expected:?}");
        }
    }

    #[test]
    fn a_larger_error_is_perceived_as_larger() {
        let base = frame(|_, _| [0.4; 3]);
        let series: Vec<f64> = [0.02, 0.1, 0.4, 0.8].iter().map(|&a| mean(&noise(3, a), &base)).collect();
        assert!(series.windows(2).all(|w| w[0] < w[1]), "{series:?}");
    }

    #[test]
    fn fine_chromatic_patterns_blur_into_their_mean() {
        // Blue and yellow of one pixel alternate at 33 cycles per degree, far beyond the eye's resolution;
        // in patches of 12 pixels the same colours are seen.
        let pattern = |n: usize| {
            frame(
                move |x, y| if (x / n + y / n).is_multiple_of(2) { [0.3, 0.3, 0.6] } else { [0.3, 0.3, 0.0] },
            )
        };
        let average = frame(|_, _| [0.3; 3]);
        let (fine, coarse) = (mean(&pattern(1), &average), mean(&pattern(12), &average));
        assert!(fine < 0.4 * coarse, "{fine} {coarse}");
    }

    #[test]
    fn an_edge_that_is_missing_counts_more_than_its_colour() {
        let step = frame(|x, _| if x < 24 { [0.2; 3] } else { [0.3; 3] });
        let flat = frame(|_, _| [0.2; 3]);
        let map = flip(&step, &flat, DEFAULT_PIXELS_PER_DEGREE).unwrap();
        let row = &map.values[20 * 48..21 * 48];
        assert!(row[25] > 1.2 * row[47], "{} beside the edge, {} far from it", row[25], row[47]);
    }

    #[test]
    fn values_stay_in_range_for_any_input() {
        let wild = frame(|x, y| match (x + y) % 4 {
            0 => [f32::NAN, 1e9, -5.0],
            1 => [f32::INFINITY; 3],
            2 => [0.0; 3],
            _ => [0.5, 0.9, 0.1],
        });
        let map = flip(&wild, &noise(1, 0.5), DEFAULT_PIXELS_PER_DEGREE).unwrap();
        assert!(map.values.iter().all(|v| (0.0..=1.0).contains(v)));
    }

    #[test]
    fn opponent_space_is_inverted() {
        for rgb in [[0.1, 0.5, 0.9], [1.0, 0.0, 0.3]] {
            let back = rgb_from_opponent(opponent_from_rgb(rgb));
            assert!((0..3).all(|i| (back[i] - rgb[i]).abs() < 1e-4), "{back:?}");
        }
    }
}
