//! How many samples which pixel gets so that the picture's noise meets a target with the fewest samples in all.
//!
//! The *noise* of a picture is the root mean square over its pixels of their relative standard errors; see
//! [`NoiseTarget`](crate::scene::NoiseTarget). With relative variance c of one sample, a pixel of n samples contributes c/n. The
//! sum of all n is least for a given sum of c/n where their derivatives are equal, c/n² = λ: n grows with the standard
//! deviation, not with the variance, of a sample. (Lagrange; the allocation among strata of Neyman 1934.)

/// Share of pixels, those of the largest variance, which the noise leaves out: a few unlucky ones must not decide.
pub(super) const OUTLIERS: f64 = 0.01;

/// Pixels on each side of a pixel over which variances are averaged: one difference of two means says little.
const WINDOW: usize = 5;

/// Share of the whole picture in what a pixel is told: that nothing rare was seen around it does not make it quiet.
const PICTURE: f32 = 0.1;

/// Whom a pixel believes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Teller {
    /// The pixels of the other colour of a checkerboard in the window around it.
    Others,
    /// All pixels in the window.
    All,
    /// Itself alone. Biased.
    #[cfg_attr(not(test), expect(dead_code, reason = "shows that the test of bias can fail"))]
    Itself,
}

/// What is known about the pixels of a picture.
pub(super) struct Knowledge<'a> {
    /// Relative variance of one sample, as it is told.
    pub(super) variance: &'a [f32],
    /// Samples that the pixel has.
    pub(super) taken: &'a [u32],
    /// Whether the pixel still takes samples.
    pub(super) open: &'a [bool],
}

/// What is to be done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plan {
    /// A pixel whose variance is c shall have √(c/λ) samples.
    pub(super) lambda: f64,
    /// Samples that all pixels will have taken together.
    pub(super) samples: u64,
}

/// The least samples for a noise of `target`, where open pixels hold `now` samples each and may come to `most`.
pub(super) fn plan(known: &Knowledge<'_>, target: f64, now: u32, most: u32) -> Plan {
    let limit = outlier_limit(known.variance);
    let count = known.variance.iter().filter(|&&c| c <= limit).count().max(1);
    let evaluate = |lambda: f64| {
        let (mut noise, mut samples) = (0.0, 0);
        for ((&c, &taken), &open) in known.variance.iter().zip(known.taken).zip(known.open) {
            let n = if open { doubled(f64::from(c), lambda, now, most) } else { taken };
            samples += u64::from(n);
            if c <= limit {
                noise += f64::from(c) / f64::from(n.max(1));
            }
        }
        (noise / count as f64, samples)
    };
    // Where λ is so large that no pixel continues, and so small that every one does.
    let (mut enough, mut too_large) = (-100.0_f64, 100.0_f64);
    for _ in 0..48 {
        let middle = 0.5 * (enough + too_large);
        if evaluate(middle.exp2()).0 <= target * target { enough = middle } else { too_large = middle }
    }
    let lambda = enough.exp2();
    Plan { lambda, samples: evaluate(lambda).1 }
}

/// √(c/λ), rounded to the nearest doubling of `now`, from `now` to `most`.
pub(super) fn doubled(variance: f64, lambda: f64, now: u32, most: u32) -> u32 {
    let doublings = (0.5 * (variance / lambda).log2() - f64::from(now).log2()).round();
    // No variance at all makes this −∞, which is no doubling.
    let factor = doublings.clamp(0.0, 31.0).exp2();
    ((f64::from(now) * factor) as u32).min(most)
}

/// The noise of a picture whose pixels have these smoothed relative variances of their means.
pub(super) fn noise(variance_of_mean: &[f32]) -> f64 {
    let limit = outlier_limit(variance_of_mean);
    let kept = variance_of_mean.iter().filter(|&&v| v <= limit);
    let (sum, count) = kept.fold((0.0, 0_u32), |(sum, n), &v| (sum + f64::from(v), n + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

/// The variance above which pixels count as outliers.
fn outlier_limit(variance: &[f32]) -> f32 {
    let rank = ((variance.len() as f64) * (1.0 - OUTLIERS)) as usize;
    match variance.get(rank) {
        None => f32::INFINITY,
        Some(_) => *variance.to_vec().select_nth_unstable_by(rank, f32::total_cmp).1,
    }
}

/// What each pixel of a picture `width` pixels wide is told about `values`: the mean over the pixels that it believes,
/// with a share of the mean over the picture.
pub(super) fn told(values: &[f32], width: usize, teller: Teller) -> Vec<f32> {
    let local = match teller {
        Teller::Itself => return values.to_vec(),
        Teller::All => smoothed(values, width),
        Teller::Others => {
            let color = |i: usize| (i % width + i / width) & 1;
            let sums = |of: usize, value: &dyn Fn(usize) -> f32| {
                let masked: Vec<f32> =
                    (0..values.len()).map(|i| if color(i) == of { value(i) } else { 0.0 }).collect();
                smoothed(&masked, width)
            };
            let by = [0, 1].map(|of| (sums(of, &|i| values[i]), sums(of, &|_| 1.0)));
            let mean = |i: usize| {
                let (sum, count) = &by[1 - color(i)];
                // A picture of one pixel has no others.
                if count[i] > 0.0 { sum[i] / count[i] } else { values[i] }
            };
            (0..values.len()).map(mean).collect()
        }
    };
    let limit = outlier_limit(&local);
    let kept = local.iter().filter(|&&v| v <= limit);
    let (sum, count) = kept.fold((0.0, 0_u32), |(sum, n), &v| (sum + f64::from(v), n + 1));
    let share = PICTURE * (sum / f64::from(count.max(1))) as f32;
    local.into_iter().map(|v| (1.0 - PICTURE) * v + share).collect()
}

/// Mean over the window around each pixel, as far as it lies inside.
fn smoothed(values: &[f32], width: usize) -> Vec<f32> {
    if width == 0 {
        return Vec::new();
    }
    let rows: Vec<f32> = values.chunks(width).flat_map(|row| means(row.len(), |i| row[i])).collect();
    let height = values.len() / width;
    let mut out = vec![0.0; values.len()];
    for x in 0..width {
        for (y, mean) in means(height, |y| rows[y * width + x]).enumerate() {
            out[y * width + x] = mean;
        }
    }
    out
}

fn means(n: usize, value: impl Fn(usize) -> f32 + Copy) -> impl Iterator<Item = f32> {
    (0..n).map(move |i| {
        let window = i.saturating_sub(WINDOW)..(i + WINDOW + 1).min(n);
        let count = window.len() as f32;
        window.map(value).sum::<f32>() / count
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TARGET: f64 = 0.01;

    fn known<'a>(variance: &'a [f32], taken: &'a [u32], open: &'a [bool]) -> Knowledge<'a> {
        Knowledge { variance, taken, open }
    }

    #[test]
    fn the_plan_meets_the_target_with_fewer_samples_than_equal_counts_would() {
        // Standard deviations over two decades: equal counts need E[σ²]/E[σ]² = 2.32 times the samples.
        let variance: Vec<f32> = (0..1000).map(|i| 10_f32.powf(4.0 * i as f32 / 1000.0 - 4.0)).collect();
        let (taken, open) = (vec![8; 1000], vec![true; 1000]);
        let plan = plan(&known(&variance, &taken, &open), TARGET, 8, 1 << 20);
        let counts: Vec<u32> = variance.iter().map(|&c| doubled(c.into(), plan.lambda, 8, 1 << 20)).collect();
        assert_eq!(counts.iter().map(|&n| u64::from(n)).sum::<u64>(), plan.samples);
        let reached: Vec<f32> = variance.iter().zip(&counts).map(|(c, &n)| c / n as f32).collect();
        let noise = noise(&reached);
        assert!(noise <= TARGET * 1.001 && noise > TARGET * 0.95, "{noise}");
        let mean: f64 = variance[..990].iter().map(|&c| f64::from(c)).sum::<f64>() / 990.0;
        let equal = 1000.0 * mean / TARGET.powi(2);
        // Rounding to doublings costs 4 %, the outliers' own samples a few more.
        let gain = equal / plan.samples as f64;
        assert!((1.9..2.32).contains(&gain), "{gain}");
    }

    #[test]
    fn pixels_stay_within_their_bounds() {
        let variance = [0.0, 1e-9, 1.0, 1e9];
        let (taken, open) = ([8, 8, 8, 2], [true, true, true, false]);
        let hopeless = plan(&known(&variance, &taken, &open), TARGET, 8, 64);
        let n = |c| doubled(c, hopeless.lambda, 8, 64);
        assert_eq!((n(0.0), n(1.0)), (8, 64));
        assert_eq!(hopeless.samples, 8 + u64::from(n(1e-9)) + 64 + 2);
        // What is quiet already takes no more.
        let quiet = plan(&known(&[1e-9; 4], &taken, &open), TARGET, 8, 64);
        assert_eq!(quiet.samples, 26);
    }

    #[test]
    fn a_pixel_is_told_by_its_neighbours_of_the_other_colour_alone() {
        let (width, height) = (20, 16);
        for teller in [Teller::Others, Teller::All, Teller::Itself] {
            assert!(told(&[2.0; 320], width, teller).iter().all(|v| (v - 2.0).abs() < 1e-5), "{teller:?}");
        }
        let mut one = vec![0.0; width * height];
        let (x, y) = (10, 7);
        one[y * width + x] = 1000.0;
        let heard = told(&one, width, Teller::Others);
        let background = heard[0];
        for (i, v) in heard.iter().enumerate() {
            let (dx, dy) = ((i % width).abs_diff(x), (i / width).abs_diff(y));
            let tells = dx <= 5 && dy <= 5 && (dx + dy) % 2 == 1;
            // 121 pixels of the window, of which 60 or 61 tell, and fewer at the border.
            assert_eq!(*v > background + 10.0, tells, "{i}: {v}");
            assert!(tells || (v - background).abs() < 1e-6, "{i}: {v}");
        }
        assert!((told(&[3.0], 1, Teller::Others)[0] - 3.0).abs() < 1e-6);
        assert!(told(&[], 0, Teller::Others).is_empty());
    }
}
