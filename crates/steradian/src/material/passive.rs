//! The check that reflectances return no more light than arrives.

use super::schema::Fault;
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN};
use crate::texture::SpectrumInput;

/// What rounding of two decimal fractions and of RGB triples may add to one.
const ROUNDING: f32 = 1e-5;

/// Checks that reflectances that do not vary over the surface add up to one at most at every nanometre of 360–830 nm, B (2.19);
/// what textures add to them is limited where they are looked up.
///
/// # Errors
/// A fault of the parameter `at`, with the wavelength where the sum is largest.
pub(super) fn require_passive(
    at: &'static str,
    parts: &[(&'static str, &SpectrumInput)],
) -> Result<(), Fault> {
    let constant: Vec<_> =
        parts.iter().filter_map(|(name, input)| Some((*name, input.constant()?))).collect();
    let mut worst = (LAMBDA_MIN, 0.0_f32);
    for step in 0..=(LAMBDA_MAX - LAMBDA_MIN) as u32 {
        let lambda = LAMBDA_MIN + step as f32;
        let sum: f32 = constant.iter().map(|(_, s)| s.at(lambda)).sum();
        if sum > worst.1 {
            worst = (lambda, sum);
        }
    }
    let (lambda, sum) = worst;
    if sum <= 1.0 + ROUNDING {
        return Ok(());
    }
    let names: Vec<String> = constant.iter().map(|(name, _)| format!("\"{name}\"")).collect();
    let what = match names.as_slice() {
        [name] => format!("{name} is"),
        names => format!("{} add up to", names.join(" and ")),
    };
    Err(Fault::new(at, format!("{what} {sum:.4} at {lambda} nm: more light would leave than arrives")))
}
