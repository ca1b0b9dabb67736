//! Portable float map: `PF` or `Pf`, size, scale whose sign is the byte order, rows from the bottom.

use super::limits;
use crate::image::error::ImageError;
use crate::image::picture::{Image, Layout};
use std::io::Write;

fn malformed(reason: impl Into<String>) -> ImageError {
    ImageError::Malformed { format: "PFM", reason: reason.into() }
}

/// Reads a PFM file of either byte order. A scale of other than ±1 multiplies the values, as in pbrt-v4.
pub(super) fn decode(bytes: &[u8]) -> Result<Image, ImageError> {
    let mut rest = bytes;
    let layout = match word(&mut rest)? {
        b"PF" => Layout::Rgb,
        b"Pf" => Layout::Gray,
        _ => return Err(malformed("the file does not begin with PF or Pf")),
    };
    let width: u32 = number(&mut rest, "width")?;
    let height: u32 = number(&mut rest, "height")?;
    let scale: f32 = number(&mut rest, "scale")?;
    if !scale.is_finite() || scale == 0.0 {
        return Err(malformed(format!("the scale is {scale}")));
    }
    let row = layout.channels() * width as usize;
    limits::check(width.into(), height.into(), layout.channels() as u64 * 4, bytes.len())?;
    let data = rest.get(..row * height as usize * 4).ok_or_else(|| malformed("the data end early"))?;
    let read = if scale < 0.0 { f32::from_le_bytes } else { f32::from_be_bytes };
    let factor = scale.abs();
    let mut values = Vec::with_capacity(row * height as usize);
    for line in data.chunks_exact(row * 4).rev() {
        values.extend(line.chunks_exact(4).map(|b| read([b[0], b[1], b[2], b[3]]) * factor));
    }
    Image::from_f32(width, height, layout, values)
}

/// Takes one word and the single white space that ends it.
fn word<'a>(rest: &mut &'a [u8]) -> Result<&'a [u8], ImageError> {
    let end = rest
        .iter()
        .take(64)
        .position(u8::is_ascii_whitespace)
        .ok_or_else(|| malformed("the header ends early"))?;
    let (word, tail) = rest.split_at(end);
    *rest = &tail[1..];
    Ok(word)
}

fn number<T: std::str::FromStr>(rest: &mut &[u8], what: &str) -> Result<T, ImageError> {
    let word = word(rest)?;
    std::str::from_utf8(word)
        .ok()
        .and_then(|text| text.parse().ok())
        .ok_or_else(|| malformed(format!("\"{}\" is no {what}", String::from_utf8_lossy(word))))
}

/// Writes interleaved RGB rows, top row first in `rgb`, as little-endian PFM.
pub(crate) fn encode(out: &mut impl Write, width: u32, rgb: &[f32]) -> std::io::Result<()> {
    let row = width as usize * 3;
    write!(out, "PF\n{width} {}\n-1\n", rgb.len() / row.max(1))?;
    for line in rgb.chunks_exact(row).rev() {
        for value in line {
            out.write_all(&value.to_le_bytes())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_byte_orders_and_the_bottom_up_rows_are_read() {
        let values = [1.0_f32, -2.5, 3e-20, f32::MAX, 0.0, 7.0];
        let mut little = b"Pf\n2 3\n-1.0\n".to_vec();
        let mut big = b"Pf\n2 3\n1.0\n".to_vec();
        for v in values {
            little.extend(v.to_le_bytes());
            big.extend(v.to_be_bytes());
        }
        for bytes in [little, big] {
            let image = decode(&bytes).unwrap();
            assert_eq!((image.width(), image.height(), image.layout()), (2, 3, Layout::Gray));
            assert_eq!(image.texel(0, 2, 0), 1.0, "the first row of the file is the bottom");
            assert_eq!(image.texel(1, 1, 0), f32::MAX);
            assert_eq!(image.texel(1, 0, 0), 7.0);
        }
    }

    #[test]
    fn a_written_picture_reads_back_bit_for_bit() {
        let rgb: Vec<f32> = (0..2 * 3 * 3).map(|i| (i as f32).exp2() * 1e-3).collect();
        let mut bytes = Vec::new();
        encode(&mut bytes, 2, &rgb).unwrap();
        assert_eq!(decode(&bytes).unwrap().to_linear(), rgb);
    }

    #[test]
    fn headers_that_lie_are_refused_before_anything_is_allocated() {
        for text in [
            "PF\n99999 99999\n-1\n",
            "PF\n4000000000 2\n-1\n",
            "PF\n4 4\n-1\n",
            "PF\n0 4\n-1\n",
            "PF\n-2 4\n-1\n",
            "PF\n2 2\nnan\n",
            "P6\n1 1\n255\n",
            "PF",
        ] {
            assert!(decode(text.as_bytes()).is_err(), "{text:?}");
        }
    }
}
