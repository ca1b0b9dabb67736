//! The 8-bit formats that are always sRGB, and Radiance HDR.

use super::limits;
use crate::image::encoding::ColorEncoding;
use crate::image::error::ImageError;
use crate::image::picture::{Image, Layout};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};
use std::io::Cursor;

/// A format that the `image` crate decodes for us.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Raster {
    Bmp,
    Hdr,
    Jpeg,
    Tga,
}

impl Raster {
    fn name(self) -> &'static str {
        match self {
            Self::Bmp => "BMP",
            Self::Hdr => "Radiance HDR",
            Self::Jpeg => "JPEG",
            Self::Tga => "TGA",
        }
    }

    fn format(self) -> ImageFormat {
        match self {
            Self::Bmp => ImageFormat::Bmp,
            Self::Hdr => ImageFormat::Hdr,
            Self::Jpeg => ImageFormat::Jpeg,
            Self::Tga => ImageFormat::Tga,
        }
    }
}

/// Reads a picture of the given format. The alpha of gray pictures is dropped.
pub(super) fn decode(bytes: &[u8], raster: Raster) -> Result<Image, ImageError> {
    let malformed =
        |e: image::ImageError| ImageError::Malformed { format: raster.name(), reason: e.to_string() };
    let decoder =
        ImageReader::with_format(Cursor::new(bytes), raster.format()).into_decoder().map_err(malformed)?;
    let (width, height) = decoder.dimensions();
    limits::check(width.into(), height.into(), decoder.color_type().bytes_per_pixel().into(), bytes.len())?;
    let srgb = |layout, codes| Image::from_u8(width, height, layout, codes, ColorEncoding::Srgb);
    match DynamicImage::from_decoder(decoder).map_err(malformed)? {
        DynamicImage::ImageLuma8(v) => srgb(Layout::Gray, v.into_raw()),
        DynamicImage::ImageLumaA8(v) => srgb(Layout::Gray, v.into_raw().into_iter().step_by(2).collect()),
        DynamicImage::ImageRgb8(v) => srgb(Layout::Rgb, v.into_raw()),
        DynamicImage::ImageRgba8(v) => srgb(Layout::Rgba, v.into_raw()),
        DynamicImage::ImageRgb32F(v) => Image::from_f32(width, height, Layout::Rgb, v.into_raw()),
        other => Err(ImageError::Unsupported {
            format: raster.name(),
            reason: format!("the pixel type {:?}", other.color()),
        }),
    }
}
