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

/// ∫ of [`SHAPE`] up to each entry [nm].
const INTEGRAL: [f32; KNOTS] = {
    let mut sum = [0.0; KNOTS];
    let mut i = 1;
    while i < KNOTS {
        sum[i] = sum[i - 1] + 0.5 * STEP * (SHAPE[i - 1] + SHAPE[i]);
        i += 1;
    }
    sum
};

const TOTAL: f32 = INTEGRAL[KNOTS - 1];

/// Equal parts of the distribution.
const PARTS: usize = 128;

/// The interval of [`SHAPE`] in which each part begins: a part touches few of them.
static BEGINS: [u8; PARTS] = {
    let mut begins = [0; PARTS];
    let (mut part, mut i) = (0, 0);
    while part < PARTS {
        while i + 2 < KNOTS && INTEGRAL[i + 1] * PARTS as f32 <= part as f32 * TOTAL {
            i += 1;
        }
        begins[part] = i as u8;
        part += 1;
    }
    begins
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
    let mut i = usize::from(BEGINS[((u * PARTS as f32) as usize).min(PARTS - 1)]);
    let mass = u * TOTAL;
    while i + 2 < KNOTS && mass >= INTEGRAL[i + 1] {
        i += 1;
    }
    // Within the interval the density p obeys p² = p₀² + 2 p′ m with the mass m since its beginning.
    let (p0, slope) = (SHAPE[i], (SHAPE[i + 1] - SHAPE[i]) / STEP);
    let m = (mass - INTEGRAL[i]).max(0.0);
    let p = (p0 * p0 + 2.0 * slope * m).max(SHAPE[0] * SHAPE[0]).sqrt();
    let beyond = (2.0 * m / (p0 + p)).min(STEP);
    Drawn { lambda: FIRST + STEP * i as f32 + beyond, pdf: p / TOTAL }
}

/// Density of [`draw`] [nm⁻¹] at a wavelength within the table.
pub(super) fn density(lambda: f32) -> f32 {
    let x = (lambda - FIRST) / STEP;
    let i = (x as usize).min(KNOTS - 2);
    (SHAPE[i] + (SHAPE[i + 1] - SHAPE[i]) * (x - i as f32)) / TOTAL
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_the_distribution_lie_below_what_is_drawn() {
        for i in 0..10_000 {
            let u = i as f32 / 10_000.0;
            let Drawn { lambda, pdf } = draw(u);
            assert!((pdf / density(lambda) - 1.0).abs() < 1e-4, "{u}: {lambda}");
            let n = 1000;
            let step = (f64::from(lambda) - 360.0) / f64::from(n);
            let below: f64 =
                (0..n).map(|k| f64::from(density((360.0 + (f64::from(k) + 0.5) * step) as f32)) * step).sum();
            assert!((below - f64::from(u)).abs() < 1e-5, "{u}: {below}");
        }
    }
}
