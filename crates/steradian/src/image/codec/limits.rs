//! How much a header may promise before anything is allocated.

use crate::image::error::ImageError;

/// Longest side of a picture [px].
const MAX_SIDE: u64 = 1 << 16;

/// DEFLATE cannot expand more than 1032-fold; the run-length codes of the other formats stay below that.
const MAX_EXPANSION: u64 = 1032;

/// What any file may expand to [B], so that a few bytes of JPEG may be a large flat picture.
const FREE_BYTES: u64 = 64 << 20;

/// Decides whether `width` × `height` pixels of `bytes_per_pixel` can be meant by a file of `len` bytes.
pub(super) fn check(width: u64, height: u64, bytes_per_pixel: u64, len: usize) -> Result<(), ImageError> {
    let too_large = ImageError::TooLarge { width, height, bytes: len };
    if width == 0 || height == 0 {
        return Err(ImageError::Empty);
    }
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(too_large);
    }
    let needed = width * height * bytes_per_pixel;
    let plausible = (len as u64).saturating_mul(MAX_EXPANSION).max(FREE_BYTES);
    if needed > plausible { Err(too_large) } else { Ok(()) }
}
