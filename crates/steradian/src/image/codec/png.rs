//! PNG: the only format whose encoding the scene may choose.

use super::limits;
use crate::image::encoding::ColorEncoding;
use crate::image::error::ImageError;
use crate::image::picture::{Image, Layout};
use png::{BitDepth, ColorType, Transformations};
use std::io::Cursor;

fn malformed(e: impl std::fmt::Display) -> ImageError {
    ImageError::Malformed { format: "PNG", reason: e.to_string() }
}

/// Reads a PNG file. 8-bit samples keep their codes, 16-bit samples become linear floats.
///
/// Only pictures of the type RGBA keep an alpha channel: that of gray pictures and transparent
/// palette entries are dropped, as in pbrt-v4.
pub(super) fn decode(bytes: &[u8], encoding: ColorEncoding) -> Result<Image, ImageError> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    let info = decoder.read_header_info().map_err(malformed)?;
    let (width, height, stored) = (info.width, info.height, info.color_type);
    // Up to four samples of two bytes each.
    limits::check(width.into(), height.into(), 8, bytes.len())?;
    decoder.set_limits(png::Limits { bytes: (width as usize * height as usize * 8).max(1 << 20) });
    let mut reader = decoder.read_info().map_err(malformed)?;
    let (expanded, depth) = reader.output_color_type();
    let size = reader.output_buffer_size().ok_or_else(|| malformed("the size overflows"))?;
    let mut data = vec![0; size];
    reader.next_frame(&mut data).map_err(malformed)?;

    let (layout, samples) = match (stored, expanded) {
        (ColorType::Rgba, _) => (Layout::Rgba, 4),
        (_, ColorType::Grayscale) => (Layout::Gray, 1),
        (_, ColorType::GrayscaleAlpha) => (Layout::Gray, 2),
        (_, ColorType::Rgba) => (Layout::Rgb, 4),
        (_, ColorType::Rgb | ColorType::Indexed) => (Layout::Rgb, 3),
    };
    let keep = layout.channels();
    if depth == BitDepth::Sixteen {
        let linear = data
            .chunks_exact(samples * 2)
            .flat_map(|pixel| pixel[..keep * 2].chunks_exact(2))
            .map(|b| encoding.to_linear(f32::from(u16::from_be_bytes([b[0], b[1]])) / 65535.0))
            .collect();
        return Image::from_f32(width, height, layout, linear);
    }
    let codes = if keep == samples {
        data
    } else {
        data.chunks_exact(samples).flat_map(|pixel| pixel[..keep].iter().copied()).collect()
    };
    Image::from_u8(width, height, layout, codes, encoding)
}
