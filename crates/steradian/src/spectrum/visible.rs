//! The density with which the wavelengths of a path are drawn for a picture in colour.

/// First wavelength of [`SHAPE`] and distance between its entries [nm].
const FIRST: f32 = 360.0;
const STEP: f32 = 10.0;
const KNOTS: usize = 48;

/// The density at 360, 370, … 830 nm up to a factor, linear in between.
///
/// Chosen by `xtask/tables/make_visible.py` such that four wavelengths a quarter of the distribution apart give the colours of
/// many reflectances under several lights with the least variance, relative in red, green, blue and luminance. A density
/// like the eye's sensitivity (Radziszewski et al. 2009) is as good for luminance, but leaves a third of its square as
/// variance to the blue of a white surface, and more than the square itself to that of wood.
const SHAPE: [f32; KNOTS] = [
    0.003, 0.008, 0.021, 0.056, 0.136, 0.315, 0.697, 1.0, 0.899, 0.835, 0.824, 0.855, 0.773, 0.615, 0.612,
    0.71, 0.787, 0.785, 0.738, 0.695, 0.721, 0.761, 0.781, 0.761, 0.712, 0.736, 0.775, 0.687, 0.585, 0.481,
    0.39, 0.299, 0.187, 0.058, 0.025, 0.017, 0.018, 0.02, 0.019, 0.015, 0.011, 0.009, 0.007, 0.006, 0.005,
    0.005, 0.005, 0.005,
];

/// Equal parts of the distribution, within each of which the density is constant: it takes no search and no root to draw.
const PARTS: usize = 256;

/// Where the parts begin and end [nm].
static EDGES: [f32; PARTS + 1] = {
    let mut edges = [FIRST; PARTS + 1];
    let total = integral(KNOTS - 1, 0.0);
    let (mut part, mut knot) = (1, 0);
    while part <= PARTS {
        let mass = total * part as f64 / PARTS as f64;
        while knot + 2 < KNOTS && integral(knot + 1, 0.0) <= mass {
            knot += 1;
        }
        let (mut low, mut high) = (0.0, STEP as f64);
        let mut halvings = 0;
        while halvings < 40 {
            let middle = 0.5 * (low + high);
            if integral(knot, middle) <= mass {
                low = middle;
            } else {
                high = middle;
            }
            halvings += 1;
        }
        edges[part] = (FIRST as f64 + STEP as f64 * knot as f64 + high) as f32;
        part += 1;
    }
    edges
};

/// ∫ of [`SHAPE`] up to a distance [nm] behind an entry.
const fn integral(knot: usize, beyond: f64) -> f64 {
    let mut sum = 0.0;
    let mut i = 0;
    while i < knot {
        sum += 0.5 * STEP as f64 * (SHAPE[i] as f64 + SHAPE[i + 1] as f64);
        i += 1;
    }
    if knot + 1 < KNOTS {
        let slope = (SHAPE[knot + 1] as f64 - SHAPE[knot] as f64) / STEP as f64;
        sum += (SHAPE[knot] as f64 + 0.5 * slope * beyond) * beyond;
    }
    sum
}

/// The density within each part [nm⁻¹].
static DENSITIES: [f32; PARTS] = {
    let mut densities = [0.0; PARTS];
    let mut i = 0;
    while i < PARTS {
        densities[i] = 1.0 / (PARTS as f32 * (EDGES[i + 1] - EDGES[i]));
        i += 1;
    }
    densities
};

/// A wavelength [nm] and its density [nm⁻¹].
#[derive(Clone, Copy, Debug)]
pub(super) struct Drawn {
    pub(super) lambda: f32,
    pub(super) pdf: f32,
}

/// The wavelength below which the share `u` ∈ [0, 1) of the distribution lies.
#[inline]
pub(super) fn draw(u: f32) -> Drawn {
    let x = u * PARTS as f32;
    let i = (x as usize).min(PARTS - 1);
    let lambda = EDGES[i] + (EDGES[i + 1] - EDGES[i]) * (x - i as f32);
    Drawn { lambda, pdf: DENSITIES[i] }
}

/// Density of [`draw`] [nm⁻¹] at a wavelength within the table.
pub(super) fn density(lambda: f32) -> f32 {
    let behind = EDGES.partition_point(|&edge| edge <= lambda);
    DENSITIES[behind.clamp(1, PARTS) - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_fill_the_range_and_follow_the_shape() {
        assert_eq!((EDGES[0], EDGES[PARTS]), (360.0, 830.0));
        let total = integral(KNOTS - 1, 0.0);
        for (i, edge) in EDGES.windows(2).enumerate() {
            // The mean of the shape over the part.
            let at = |lambda: f32| {
                let x = (lambda - FIRST) / STEP;
                let knot = (x as usize).min(KNOTS - 2);
                integral(knot, f64::from((x - knot as f32) * STEP))
            };
            let mean = (at(edge[1]) - at(edge[0])) / f64::from(edge[1] - edge[0]) / total;
            assert!((f64::from(DENSITIES[i]) / mean - 1.0).abs() < 1e-3, "{edge:?}: {} {mean}", DENSITIES[i]);
        }
    }

    #[test]
    fn shares_of_the_distribution_lie_below_what_is_drawn() {
        for i in 0..10_000 {
            let u = (i as f32 + 0.5) / 10_000.0;
            let Drawn { lambda, pdf } = draw(u);
            assert_eq!(pdf, density(lambda), "{u}: {lambda}");
            let below: f64 = EDGES
                .windows(2)
                .map(|e| f64::from((lambda.min(e[1]) - e[0]).max(0.0) * density(0.5 * (e[0] + e[1]))))
                .sum();
            assert!((below - f64::from(u)).abs() < 1e-5, "{u}: {below}");
        }
    }
}
