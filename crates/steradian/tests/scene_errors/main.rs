//! Wrong scenes, whole: the full text of every message, from import to compilation.

#[path = "../support/errors.rs"]
mod errors;

mod files;
mod geometry;
mod language;
mod names;
mod numbers;
mod view_and_lights;

/// A picture of one brightness.
pub(crate) fn pfm(width: usize, height: usize) -> Vec<u8> {
    let mut bytes = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    bytes.extend([0.5_f32; 3].repeat(width * height).iter().flat_map(|v| v.to_le_bytes()));
    bytes
}
