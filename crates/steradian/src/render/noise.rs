//! How many samples which pixel gets so that the picture's noise meets a target at the least cost.
//!
//! The *noise* of a picture is the root mean square over its pixels of their relative standard errors; see
//! [`NoiseTarget`](crate::scene::NoiseTarget). With relative variance c of one sample, a pixel of n samples contributes c/n. With
//! a cost k of one sample, the sum of all nk is least for a given sum of c/n where c/(n²k) = λ: n grows with the standard
//! deviation, not with the variance, of a sample. (Lagrange; the allocation among strata of Neyman 1934.)

/// Share of pixels, those of the largest variance, which the noise leaves out: a few unlucky ones must not decide.
pub(super) const OUTLIERS: f64 = 0.01;

/// Pixels on each side of a pixel over which variances are averaged: one difference of two means says little.
const WINDOW: usize = 5;

/// Share of the whole picture in what a pixel is told: that nothing rare was seen around it does not make it quiet. Of 0.1,
/// 0.3 and 0.6 the middle one took the least time for a given error, as a mean over seven scenes.
const PICTURE: f32 = 0.3;

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
    /// What one sample costs, in any unit.
    pub(super) cost: &'a [f32],
    /// Samples that the pixel has.
    pub(super) taken: &'a [u32],
}

impl Knowledge<'_> {
    /// √(c/(k λ)), rounded to the nearest doubling of what the pixel `at` has, from that to `most`.
    pub(super) fn goal(&self, at: usize, lambda: f64, most: u32) -> u32 {
        let (variance, taken) = (f64::from(self.variance[at] / self.cost[at]), f64::from(self.taken[at]));
        let doublings = (0.5 * (variance / lambda).log2() - taken.log2()).round();
        // No variance at all makes this −∞, which is no doubling.
        ((taken * doublings.clamp(0.0, 31.0).exp2()) as u32).min(most)
    }
}

/// What is to be done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plan {
    /// A pixel whose variance is c and whose samples cost k shall have √(c/(k λ)) of them.
    pub(super) lambda: f64,
    /// Samples that all pixels will have taken together.
    pub(super) samples: u64,
}

/// The least cost for a noise of `target`, where pixels may come to `most` samples.
pub(super) fn plan(known: &Knowledge<'_>, target: f64, most: u32) -> Plan {
    let limit = outlier_limit(known.variance);
    let count = known.variance.iter().filter(|&&c| c <= limit).count().max(1);
    let evaluate = |lambda: f64| {
        let (mut noise, mut samples) = (0.0, 0);
        for (at, &c) in known.variance.iter().enumerate() {
            let n = known.goal(at, lambda, most);
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

/// What each pixel of a picture `width` pixels wide is told about `values`: the mean, weighted by `weights`, over the pixels
/// that it believes, with a share of the mean over the picture.
pub(super) fn told(values: &[f32], weights: &[f32], width: usize, teller: Teller) -> Vec<f32> {
    let ratio = |among: &dyn Fn(usize) -> bool| -> Vec<Option<f32>> {
        let weight = |i: usize| if among(i) { weights[i] } else { 0.0 };
        let sums = smoothed(&(0..values.len()).map(|i| weight(i) * values[i]).collect::<Vec<_>>(), width);
        let of = smoothed(&(0..values.len()).map(weight).collect::<Vec<_>>(), width);
        sums.iter().zip(of).map(|(sum, of)| (of > 0.0).then(|| sum / of)).collect()
    };
    // A picture of one pixel has no others.
    let or_own = |(i, told): (usize, Option<f32>)| told.unwrap_or(values[i]);
    let local: Vec<f32> = match teller {
        Teller::Itself => return values.to_vec(),
        Teller::All => ratio(&|_| true).into_iter().enumerate().map(or_own).collect(),
        Teller::Others => {
            let color = |i: usize| (i % width + i / width) & 1;
            let by = [0, 1].map(|of| ratio(&|i| color(i) == of));
            (0..values.len()).map(|i| or_own((i, by[1 - color(i)][i]))).collect()
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

    const MOST: u32 = 1 << 20;

    fn known<'a>(variance: &'a [f32], cost: &'a [f32], taken: &'a [u32]) -> Knowledge<'a> {
        Knowledge { variance, cost, taken }
    }

    /// Standard deviations over two decades: equal counts need E[σ²]/E[σ]² = 2.32 times the samples.
    fn two_decades() -> Vec<f32> {
        (0..1000).map(|i| 10_f32.powf(4.0 * i as f32 / 1000.0 - 4.0)).collect()
    }

    #[test]
    fn the_plan_meets_the_target_with_fewer_samples_than_equal_counts_would() {
        let (variance, cost, taken) = (two_decades(), vec![3.0; 1000], vec![8; 1000]);
        let known = known(&variance, &cost, &taken);
        let plan = plan(&known, TARGET, MOST);
        let counts: Vec<u32> = (0..1000).map(|i| known.goal(i, plan.lambda, MOST)).collect();
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
    fn dear_samples_are_taken_where_they_tell_more() {
        // Every other sample costs nine times as much: √9 times fewer of them are taken, and the same noise is cheaper than
        // with a plan that does not know the cost.
        let (variance, taken) = (two_decades(), vec![8; 1000]);
        let cost: Vec<f32> = (0..1000).map(|i| if i % 2 == 0 { 1.0 } else { 9.0 }).collect();
        let total = |known: &Knowledge<'_>, lambda| -> f64 {
            (0..1000).map(|i| f64::from(known.goal(i, lambda, MOST)) * f64::from(cost[i])).sum()
        };
        let ones = vec![1.0; 1000];
        let (wise, blind) = (known(&variance, &cost, &taken), known(&variance, &ones, &taken));
        let (a, b) = (plan(&wise, TARGET, MOST).lambda, plan(&blind, TARGET, MOST).lambda);
        // (Σ σ√k)² against Σ σ · Σ σk: 16 against 20.
        let gain = total(&blind, b) / total(&wise, a);
        assert!((1.05..1.4).contains(&gain), "{gain}");
    }

    #[test]
    fn pixels_stay_within_their_bounds() {
        let (variance, cost, taken) = ([0.0, 1e-9, 1.0, 1e9], [1.0; 4], [8, 8, 8, 2]);
        let anxious = known(&variance, &cost, &taken);
        let hopeless = plan(&anxious, TARGET, 64);
        let n = |at| anxious.goal(at, hopeless.lambda, 64);
        assert_eq!((n(0), n(2), n(3)), (8, 64, 64));
        assert_eq!(hopeless.samples, 8 + u64::from(n(1)) + 64 + 64);
        // What is quiet already takes no more.
        let quiet = plan(&known(&[1e-9; 4], &cost, &taken), TARGET, 64);
        assert_eq!(quiet.samples, 26);
    }

    #[test]
    fn a_pixel_is_told_by_its_neighbours_of_the_other_colour_alone() {
        let (width, height) = (20, 16);
        let equal = vec![1.0; width * height];
        for teller in [Teller::Others, Teller::All, Teller::Itself] {
            assert!(
                told(&[2.0; 320], &equal, width, teller).iter().all(|v| (v - 2.0).abs() < 1e-5),
                "{teller:?}"
            );
        }
        let mut one = vec![0.0; width * height];
        let (x, y) = (10, 7);
        one[y * width + x] = 1000.0;
        let heard = told(&one, &equal, width, Teller::Others);
        let background = heard[0];
        for (i, v) in heard.iter().enumerate() {
            let (dx, dy) = ((i % width).abs_diff(x), (i / width).abs_diff(y));
            let tells = dx <= 5 && dy <= 5 && (dx + dy) % 2 == 1;
            // 121 pixels of the window, of which 60 or 61 tell, and fewer at the border.
            assert_eq!(*v > background + 10.0, tells, "{i}: {v}");
            assert!(tells || (v - background).abs() < 1e-6, "{i}: {v}");
        }
        assert!((told(&[3.0], &[1.0], 1, Teller::Others)[0] - 3.0).abs() < 1e-6);
        assert!(told(&[], &[], 0, Teller::Others).is_empty());
    }

    #[test]
    fn who_has_more_samples_is_believed_more() {
        // A row of which every other pair says 1 with three samples, and the rest 5 with one: (3·1 + 5)/4 = 2.
        let pair = |i: usize| i / 2 % 2;
        let values: Vec<f32> = (0..400).map(|i| [1.0, 5.0][pair(i)]).collect();
        let weights: Vec<f32> = (0..400).map(|i| [3.0, 1.0][pair(i)]).collect();
        for teller in [Teller::Others, Teller::All] {
            let heard = told(&values, &weights, 400, teller);
            let mean = heard.iter().sum::<f32>() / 400.0;
            assert!((mean - 2.0).abs() < 0.05, "{teller:?}: {mean}");
        }
    }
}
