//! Picture files into [`Image`]s. The content decides the format, the extension only where there is no signature.

pub(super) mod exr;
mod limits;
pub(super) mod pfm;
mod png;
mod raster;

use super::encoding::ColorEncoding;
use super::error::ImageError;
use super::picture::Image;
use raster::Raster;

/// Decodes a picture file.
///
/// `encoding` matters for PNG only, as in pbrt-v4: TGA, JPEG and BMP are always sRGB, OpenEXR, PFM and
/// Radiance HDR always linear. `extension` (without the dot) decides only for TGA, which has no signature.
///
/// # Errors
/// When the format is unknown, the bytes do not follow it, or the header promises more pixels than
/// the file can hold.
pub fn decode(bytes: &[u8], extension: &str, encoding: ColorEncoding) -> Result<Image, ImageError> {
    let starts = |signature: &[u8]| bytes.starts_with(signature);
    if starts(b"\x89PNG") {
        png::decode(bytes, encoding)
    } else if starts(&[0x76, 0x2f, 0x31, 0x01]) {
        exr::decode(bytes)
    } else if starts(b"PF") || starts(b"Pf") {
        pfm::decode(bytes)
    } else if starts(b"#?") {
        raster::decode(bytes, Raster::Hdr)
    } else if starts(&[0xff, 0xd8, 0xff]) {
        raster::decode(bytes, Raster::Jpeg)
    } else if starts(b"BM") {
        raster::decode(bytes, Raster::Bmp)
    } else if extension.eq_ignore_ascii_case("tga") {
        raster::decode(bytes, Raster::Tga)
    } else {
        let format = match extension.to_ascii_lowercase().as_str() {
            "png" => "PNG",
            "exr" => "OpenEXR",
            "pfm" => "PFM",
            "hdr" => "Radiance HDR",
            "jpg" | "jpeg" => "JPEG",
            "bmp" => "BMP",
            _ => return Err(ImageError::UnknownFormat { extension: extension.to_owned() }),
        };
        Err(ImageError::Malformed { format, reason: "the signature of the format is missing".into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::picture::Layout;
    use ::exr::prelude::{
        AnyChannel, AnyChannels, Encoding, FlatSamples, Image as ExrImage, Layer, LayerAttributes,
        WritableImage, f16,
    };
    use image::{DynamicImage, ImageFormat, RgbImage, RgbaImage};
    use proptest::prelude::*;
    use std::io::Cursor;

    fn pattern(w: u32, h: u32) -> RgbImage {
        RgbImage::from_fn(w, h, |x, y| {
            image::Rgb([(x * 37 + y) as u8, (y * 53) as u8, (x * y * 11 + 5) as u8])
        })
    }

    fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    fn png_bytes(color: ::png::ColorType, depth: ::png::BitDepth, w: u32, h: u32, data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, w, h);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == ::png::ColorType::Indexed {
            encoder.set_palette(vec![0, 0, 0, 255, 128, 64]);
            encoder.set_trns(vec![0, 255]);
        }
        encoder.write_header().unwrap().write_image_data(data).unwrap();
        bytes
    }

    fn exr_bytes(w: usize, h: usize, channels: Vec<(&str, FlatSamples)>) -> Vec<u8> {
        let list = channels.into_iter().map(|(name, data)| AnyChannel::new(name, data)).collect();
        let layer =
            Layer::new((w, h), LayerAttributes::default(), Encoding::SMALL_LOSSLESS, AnyChannels::sort(list));
        let mut bytes = Cursor::new(Vec::new());
        ExrImage::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).unwrap();
        bytes.into_inner()
    }

    /// One valid file of every kind, all 5 × 4 pixels.
    fn specimens() -> Vec<(&'static str, Vec<u8>)> {
        let rgb = DynamicImage::ImageRgb8(pattern(5, 4));
        let float = DynamicImage::ImageRgb32F(rgb.to_rgb32f());
        let mut pfm = Vec::new();
        pfm::encode(&mut pfm, 5, float.as_flat_samples_f32().unwrap().samples).unwrap();
        let half = || FlatSamples::F16((0..20).map(|i| f16::from_f32(i as f32 * 0.25)).collect());
        vec![
            ("png", encoded(&rgb, ImageFormat::Png)),
            ("png", png_bytes(::png::ColorType::Indexed, ::png::BitDepth::One, 5, 4, &[0b1010_1000; 4])),
            ("tga", encoded(&rgb, ImageFormat::Tga)),
            ("bmp", encoded(&rgb, ImageFormat::Bmp)),
            ("jpg", encoded(&rgb, ImageFormat::Jpeg)),
            ("hdr", encoded(&float, ImageFormat::Hdr)),
            ("pfm", pfm),
            ("exr", exr_bytes(5, 4, vec![("R", half()), ("G", half()), ("B", half())])),
        ]
    }

    #[test]
    fn lossless_8_bit_formats_keep_every_code() {
        let source = pattern(5, 4);
        let rgb = DynamicImage::ImageRgb8(source.clone());
        for format in [ImageFormat::Png, ImageFormat::Tga, ImageFormat::Bmp] {
            let image =
                decode(&encoded(&rgb, format), format.extensions_str()[0], ColorEncoding::Srgb).unwrap();
            assert_eq!((image.width(), image.height(), image.layout()), (5, 4, Layout::Rgb), "{format:?}");
            for (x, y, pixel) in source.enumerate_pixels() {
                for c in 0..3 {
                    assert_eq!(
                        ColorEncoding::Srgb.quantize(image.texel(x, y, c)),
                        pixel[c],
                        "{format:?} {x} {y}"
                    );
                }
            }
        }
    }

    #[test]
    fn encoding_applies_to_png_and_to_nothing_else() {
        let gray = DynamicImage::ImageLuma8(image::GrayImage::from_pixel(2, 2, image::Luma([128])));
        for (format, expected) in [
            (ImageFormat::Png, 128.0 / 255.0),
            (ImageFormat::Tga, 0.215_861),
            (ImageFormat::Bmp, 0.215_861),
            (ImageFormat::Jpeg, 0.215_861),
        ] {
            let bytes = encoded(&gray, format);
            let image = decode(&bytes, format.extensions_str()[0], ColorEncoding::Linear).unwrap();
            assert!((image.scalar(1, 1) - expected).abs() < 1e-5, "{format:?}: {}", image.scalar(1, 1));
        }
    }

    #[test]
    fn sixteen_bit_png_keeps_sixteen_bits() {
        let data: Vec<u8> = [0_u16, 1, 32768, 65535].iter().flat_map(|v| v.to_be_bytes()).collect();
        let bytes = png_bytes(::png::ColorType::Grayscale, ::png::BitDepth::Sixteen, 4, 1, &data);
        let image = decode(&bytes, "png", ColorEncoding::Linear).unwrap();
        for (x, code) in [0_u16, 1, 32768, 65535].into_iter().enumerate() {
            assert_eq!(image.texel(x as u32, 0, 0), f32::from(code) / 65535.0);
        }
    }

    #[test]
    fn only_rgba_png_has_alpha() {
        use ::png::{BitDepth, ColorType};
        let rgba = DynamicImage::ImageRgba8(RgbaImage::from_pixel(1, 1, image::Rgba([255, 0, 0, 0])));
        let image = decode(&encoded(&rgba, ImageFormat::Png), "png", ColorEncoding::Srgb).unwrap();
        assert_eq!(image.layout(), Layout::Rgba);
        assert!(!image.is_opaque());
        let gray_alpha = png_bytes(ColorType::GrayscaleAlpha, BitDepth::Eight, 1, 1, &[255, 0]);
        assert_eq!(decode(&gray_alpha, "png", ColorEncoding::Srgb).unwrap().layout(), Layout::Gray);
        let indexed = png_bytes(ColorType::Indexed, BitDepth::One, 2, 1, &[0b0100_0000]);
        let image = decode(&indexed, "png", ColorEncoding::Linear).unwrap();
        assert_eq!(image.layout(), Layout::Rgb);
        assert_eq!(image.texel(1, 0, 1), 128.0 / 255.0);
    }

    #[test]
    fn jpeg_is_within_its_quantisation() {
        let smooth =
            RgbImage::from_fn(16, 16, |x, y| image::Rgb([(x * 8) as u8 + 60, (y * 8) as u8 + 60, 120]));
        let bytes = encoded(&DynamicImage::ImageRgb8(smooth.clone()), ImageFormat::Jpeg);
        let image = decode(&bytes, "jpeg", ColorEncoding::Srgb).unwrap();
        for (x, y, pixel) in smooth.enumerate_pixels() {
            for c in 0..3 {
                let code = ColorEncoding::Srgb.quantize(image.texel(x, y, c));
                // Quality 75 with subsampled chroma: a smooth ramp stays within 5 % of full scale.
                assert!(code.abs_diff(pixel[c]) <= 13, "{x} {y} {c}: {code} for {}", pixel[c]);
            }
        }
    }

    #[test]
    fn radiance_is_within_its_shared_exponent() {
        let source = image::Rgb32FImage::from_fn(9, 3, |x, y| {
            image::Rgb([0.001 * (x + 1) as f32, 2.0, 100.0 * y as f32])
        });
        let bytes = encoded(&DynamicImage::ImageRgb32F(source.clone()), ImageFormat::Hdr);
        let image = decode(&bytes, "hdr", ColorEncoding::Srgb).unwrap();
        for (x, y, pixel) in source.enumerate_pixels() {
            // Eight bits of mantissa relative to the largest channel.
            let bound = pixel.0.iter().fold(0.0_f32, |a, &b| a.max(b)) / 128.0;
            for c in 0..3 {
                assert!((image.texel(x, y, c) - pixel[c]).abs() <= bound, "{x} {y} {c}");
            }
        }
    }

    #[test]
    fn exr_reads_half_float_and_integer_samples_by_channel_name() {
        let ramp = |k: f32| (0..6).map(|i| i as f32 * k).collect::<Vec<f32>>();
        let half = |k: f32| FlatSamples::F16(ramp(k).into_iter().map(f16::from_f32).collect());
        let image = decode(
            &exr_bytes(3, 2, vec![("R", half(1.0)), ("G", half(2.0)), ("B", half(4.0)), ("A", half(0.125))]),
            "exr",
            ColorEncoding::Srgb,
        )
        .unwrap();
        assert_eq!((image.layout(), image.bytes()), (Layout::Rgba, 6 * 4 * 2));
        assert_eq!([0, 1, 2, 3].map(|c| image.texel(2, 1, c)), [5.0, 10.0, 20.0, 0.625]);

        let mixed = exr_bytes(
            3,
            2,
            vec![("R", FlatSamples::F32(ramp(0.1))), ("G", half(1.0)), ("B", FlatSamples::U32(vec![7; 6]))],
        );
        let image = decode(&mixed, "exr", ColorEncoding::Srgb).unwrap();
        assert_eq!([0, 1, 2].map(|c| image.texel(1, 1, c)), [ramp(0.1)[4], 4.0, 7.0]);

        let depth = exr_bytes(3, 2, vec![("Z", FlatSamples::F32(ramp(3.0)))]);
        assert_eq!(decode(&depth, "exr", ColorEncoding::Srgb).unwrap().texel(2, 0, 0), 6.0);
        let nameless = exr_bytes(3, 2, vec![("U", half(1.0)), ("V", half(1.0))]);
        assert!(matches!(decode(&nameless, "exr", ColorEncoding::Srgb), Err(ImageError::Unsupported { .. })));
    }

    #[test]
    fn every_specimen_decodes_and_no_truncation_of_it_does() {
        for (extension, bytes) in specimens() {
            let image = decode(&bytes, extension, ColorEncoding::Srgb).unwrap();
            assert_eq!((image.width(), image.height()), (5, 4), "{extension}");
            for len in [0, 1, 3, 8, bytes.len() / 3, bytes.len() / 2] {
                assert!(
                    decode(&bytes[..len], extension, ColorEncoding::Srgb).is_err(),
                    "{extension} cut to {len}"
                );
            }
        }
    }

    #[test]
    fn an_unknown_format_is_named_in_the_error() {
        let error = decode(b"hello", "gif", ColorEncoding::Srgb).unwrap_err();
        assert!(error.to_string().contains("\"gif\""), "{error}");
        assert!(matches!(decode(b"hello", "png", ColorEncoding::Srgb), Err(ImageError::Malformed { .. })));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]

        /// A decoder may accept a damaged file, but what it returns is whole, and it does not panic.
        #[test]
        fn damaged_files_are_refused_or_decoded_whole(
            which in 0_usize..8,
            damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        ) {
            let (extension, mut bytes) = specimens().swap_remove(which);
            for (at, value) in damage {
                let at = at.index(bytes.len());
                bytes[at] = value;
            }
            if let Ok(image) = decode(&bytes, extension, ColorEncoding::Srgb) {
                let texels = image.width() as usize * image.height() as usize;
                prop_assert_eq!(image.to_linear().len(), texels * image.layout().channels());
            }
        }
    }
}
