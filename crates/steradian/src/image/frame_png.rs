//! Frames for looking at, and as plain float maps.

use super::codec::pfm;
use super::encoding::ColorEncoding;
use super::error::ImageError;
use super::frame::Frame;
use super::frame_exr::{SampleDepth, write_exr};
use crate::color::{ColorSpace, ColorSpaceKind, Rgb};
use std::io::Write;

/// A file format for output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameFormat {
    /// OpenEXR, all channels and attributes.
    Exr(SampleDepth),
    /// R, G and B in 8 bits.
    Png,
    /// R, G and B in 32-bit floats.
    Pfm,
}

impl FrameFormat {
    /// The format of files with this extension (without the dot); OpenEXR in 32 bits.
    ///
    /// # Errors
    /// When no such format is written.
    pub fn from_extension(extension: &str) -> Result<Self, ImageError> {
        match extension.to_ascii_lowercase().as_str() {
            "exr" => Ok(Self::Exr(SampleDepth::Float)),
            "png" => Ok(Self::Png),
            "pfm" => Ok(Self::Pfm),
            _ => Err(ImageError::UnwritableFormat { extension: extension.to_owned() }),
        }
    }
}

/// Writes a frame in the given format.
///
/// # Errors
/// When writing fails or the format needs a channel that is missing.
pub fn write_frame(frame: &Frame, out: &mut impl Write, format: FrameFormat) -> Result<(), ImageError> {
    match format {
        FrameFormat::Exr(depth) => write_exr(frame, out, depth),
        FrameFormat::Png => write_png(frame, out),
        FrameFormat::Pfm => write_pfm(frame, out),
    }
}

/// Writes R, G and B of the window as 8-bit sRGB, with the attributes as text chunks. Linear 1 is white; what is
/// brighter saturates, what is not a number is black. Other primaries are converted.
///
/// # Errors
/// When writing fails, a colour channel is missing, or an attribute's name is no PNG keyword.
pub fn write_png(frame: &Frame, out: &mut impl Write) -> Result<(), ImageError> {
    let failed = |e: png::EncodingError| ImageError::Write(e.to_string());
    let rgb = frame.rgb()?;
    let to_srgb = match frame.color_space() {
        None | Some(ColorSpaceKind::Srgb) => None,
        Some(other) => Some((ColorSpace::new(other), ColorSpace::new(ColorSpaceKind::Srgb))),
    };
    let mut codes = Vec::with_capacity(rgb.len() * 3);
    for i in 0..rgb.len() {
        let [r, g, b] = rgb.pixel(i);
        let mut color = Rgb::new(r, g, b);
        if let Some((from, to)) = &to_srgb {
            color = to.rgb_from_xyz(from.xyz_from_rgb(color));
        }
        codes.extend(color.0.to_array().map(|v| ColorEncoding::Srgb.quantize(v)));
    }
    let mut encoder = png::Encoder::new(out, frame.window().width, frame.window().height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    for (name, value) in frame.attributes() {
        encoder.add_itxt_chunk(name.to_owned(), value.to_owned()).map_err(failed)?;
    }
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&codes).map_err(failed)?;
    writer.finish().map_err(failed)
}

/// Writes R, G and B of the window as a little-endian portable float map.
///
/// # Errors
/// When writing fails or a colour channel is missing.
pub fn write_pfm(frame: &Frame, out: &mut impl Write) -> Result<(), ImageError> {
    let rgb = frame.rgb()?;
    let interleaved: Vec<f32> = (0..rgb.len()).flat_map(|i| rgb.pixel(i)).collect();
    pfm::encode(out, frame.window().width, &interleaved).map_err(|e| ImageError::Write(e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::codec::decode;

    fn gradient(space: ColorSpaceKind) -> Frame {
        Frame::from_rgb([4, 2], space, |i| [i as f32 / 7.0, 0.18, 1.0]).unwrap()
    }

    #[test]
    fn png_shows_the_srgb_code_of_linear_light() {
        let mut frame = gradient(ColorSpaceKind::Srgb);
        frame.set_attribute("unit", "cd/m² over π");
        let mut bytes = Vec::new();
        write_frame(&frame, &mut bytes, FrameFormat::Png).unwrap();
        let image = decode(&bytes, "png", ColorEncoding::Srgb).unwrap();
        for i in 0..8_u32 {
            let (x, y) = (i % 4, i / 4);
            // Half a code is 0.5/255 of the encoded range; the curve's slope is at most 2.28 near white.
            assert!((image.texel(x, y, 0) - i as f32 / 7.0).abs() < 2.28 * 0.5 / 255.0 + 1e-6);
            assert_eq!(ColorEncoding::Srgb.quantize(image.texel(x, y, 1)), 118, "18 % gray");
        }
        let reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        assert!(reader.info().srgb.is_some());
        assert_eq!(reader.info().utf8_text[0].get_text().unwrap(), "cd/m² over π");
    }

    #[test]
    fn white_of_any_colour_space_of_the_same_white_is_white() {
        for space in [ColorSpaceKind::Rec2020, ColorSpaceKind::DciP3] {
            let frame = Frame::from_rgb([1, 1], space, |_| [1.0; 3]).unwrap();
            let mut bytes = Vec::new();
            write_png(&frame, &mut bytes).unwrap();
            let image = decode(&bytes, "png", ColorEncoding::Linear).unwrap();
            assert_eq!([0, 1, 2].map(|c| image.texel(0, 0, c)), [1.0; 3], "{space:?}");
        }
        // A saturated Rec. 2020 green lies outside sRGB: red clips at zero, green at one.
        let frame = Frame::from_rgb([1, 1], ColorSpaceKind::Rec2020, |_| [0.0, 1.0, 0.0]).unwrap();
        let mut bytes = Vec::new();
        write_png(&frame, &mut bytes).unwrap();
        let image = decode(&bytes, "png", ColorEncoding::Linear).unwrap();
        assert_eq!((image.texel(0, 0, 0), image.texel(0, 0, 1)), (0.0, 1.0));
    }

    #[test]
    fn pfm_keeps_every_bit() {
        let frame = gradient(ColorSpaceKind::Srgb);
        let mut bytes = Vec::new();
        write_frame(&frame, &mut bytes, FrameFormat::from_extension("PFM").unwrap()).unwrap();
        let image = decode(&bytes, "pfm", ColorEncoding::Srgb).unwrap();
        let rgb = frame.rgb().unwrap();
        for i in 0..8_u32 {
            assert_eq!([0, 1, 2].map(|c| image.texel(i % 4, i / 4, c)), rgb.pixel(i as usize));
        }
    }

    #[test]
    fn unknown_formats_are_refused_with_the_known_ones() {
        let error = FrameFormat::from_extension("gif").unwrap_err();
        assert!(error.to_string().contains("exr, png, pfm"), "{error}");
    }
}
