//! Luminaires by their measured distribution: photometric webs, their files, and lights that shine by them.

pub mod eulumdat;
pub mod ies;
mod light;
mod luminaire;
mod text;
mod web;

pub use light::{EmittingOpening, PhotometricLight};
pub use luminaire::{Label, Luminaire, Opening, Outline, Tilt, TiltGeometry};
pub use text::PhotometricError;
pub use web::{Interpolation, MAX_ANGLES, PhotometricWeb, Planes, Symmetry, WebError, WebItem};

/// Reads a luminaire in IES LM-63 or EULUMDAT, whichever its content is: the former has a line that begins with `TILT=`.
///
/// `tilt_file` gives the bytes of a file of tilt factors that an IES file names.
pub fn read(
    bytes: &[u8],
    tilt_file: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Luminaire, PhotometricError> {
    let text = text::decode(bytes);
    let is_tilt = |l: &str| l.trim_start().get(..5).is_some_and(|s| s.eq_ignore_ascii_case("TILT="));
    let is_marked = ["IESNA", "IES:"].iter().any(|m| text.trim_start().starts_with(m));
    if is_marked || text.lines().any(is_tilt) || !is_eulumdat(&text) {
        ies::read(bytes, tilt_file)
    } else {
        eulumdat::read(bytes)
    }
}

/// Whether the third line holds a symmetry indicator, and the second a type.
fn is_eulumdat(text: &str) -> bool {
    let mut lines = text.lines().skip(1).map(str::trim);
    let is = |line: Option<&str>, most: i64| line.is_some_and(|l| text::whole(l, 0..=most).is_some());
    is(lines.next(), 9) || is(lines.next(), 9)
}

#[cfg(test)]
mod tests;
