//! Frames as OpenEXR files.

use super::codec::exr::{ExrPart, color_space, read_parts};
use super::error::ImageError;
use super::frame::{Frame, Window};
use crate::color::{ColorSpace, ColorSpaceKind};
use exr::math::Vec2 as ExrVec2;
use exr::meta::attribute::{AttributeValue, Chromaticities, IntegerBounds};
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image as ExrImage, ImageAttributes,
    Layer, LayerAttributes, LineOrder, Text, WritableImage, f16,
};
use std::io::{Cursor, Write};

/// Precision of the samples in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SampleDepth {
    /// 16 bits: relative precision 2⁻¹¹, at most 65504.
    Half,
    /// 32 bits.
    #[default]
    Float,
}

/// Writes all channels losslessly compressed; attributes become string attributes of the header, and the
/// colour space its chromaticities. The bytes depend on nothing but the frame.
///
/// # Errors
/// When writing fails, or an attribute has a name that OpenEXR reserves.
pub fn write_exr(frame: &Frame, out: &mut impl Write, depth: SampleDepth) -> Result<(), ImageError> {
    let failed = |e: exr::error::Error| ImageError::Write(e.to_string());
    let window = frame.window();
    let mut layer_attributes = LayerAttributes {
        layer_position: ExrVec2(window.x, window.y),
        software_name: frame.attribute(SOFTWARE).map(text).transpose()?,
        comments: frame.attribute(COMMENTS).map(text).transpose()?,
        owner: frame.attribute(OWNER).map(text).transpose()?,
        ..LayerAttributes::default()
    };
    for (key, value) in frame.attributes().filter(|(key, _)| ![SOFTWARE, COMMENTS, OWNER].contains(key)) {
        layer_attributes.other.insert(name(key)?, AttributeValue::Text(text(value)?));
    }
    let channels = frame.channels().iter().map(|c| {
        let samples = match depth {
            SampleDepth::Half => FlatSamples::F16(c.values.iter().map(|&v| f16::from_f32(v)).collect()),
            SampleDepth::Float => FlatSamples::F32(c.values.clone()),
        };
        Ok(AnyChannel::new(name(&c.name)?, samples))
    });
    let channels = AnyChannels::sort(channels.collect::<Result<_, ImageError>>()?);
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = (window.width as usize, window.height as usize);
    let [width, height] = frame.resolution();
    let mut attributes =
        ImageAttributes::new(IntegerBounds::from_dimensions((width as usize, height as usize)));
    attributes.chromaticities = frame.color_space().map(chromaticities);
    let image =
        ExrImage::empty(attributes).with_layer(Layer::new(size, layer_attributes, encoding, channels));

    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(failed)?;
    let mut bytes = bytes.into_inner();
    sort_header(&mut bytes);
    out.write_all(&bytes).map_err(|e| ImageError::Write(e.to_string()))
}

/// Standard attributes that the `exr` crate keeps apart from the free ones.
const SOFTWARE: &str = "software";
const COMMENTS: &str = "comments";
const OWNER: &str = "owner";

/// UTF-8, as the OpenEXR specification recommends; the `exr` crate itself would write Latin-1.
fn text(s: &str) -> Result<Text, ImageError> {
    if s.contains('\0') {
        return Err(ImageError::Write("a name or an attribute contains a zero byte".into()));
    }
    Ok(Text::from_slice_unchecked(s.as_bytes()))
}

fn name(s: &str) -> Result<Text, ImageError> {
    if s.is_empty() {
        return Err(ImageError::Write("a channel or an attribute has no name".into()));
    }
    text(s)
}

fn string(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}

fn chromaticities(kind: ColorSpaceKind) -> Chromaticities {
    let [red, green, blue] = kind.primaries().map(|c| ExrVec2(c.x, c.y));
    let white = ColorSpace::new(kind).white();
    Chromaticities { red, green, blue, white: ExrVec2(white.x, white.y) }
}

/// Puts the attributes of the header into the order of their names: the `exr` crate writes the free ones in the
/// order of a randomly seeded hash map. The header's length, and with it every offset, stays the same.
fn sort_header(bytes: &mut [u8]) {
    const START: usize = 8;
    let mut attributes: Vec<&[u8]> = Vec::new();
    let mut at = START;
    // An attribute is name, zero, type, zero, length, value; an empty name ends the header.
    while bytes.get(at).is_some_and(|&b| b != 0) {
        let zero = |from: usize| bytes[from..].iter().position(|&b| b == 0).map(|n| from + n + 1);
        let Some(length_at) = zero(at).and_then(zero) else { return };
        let Some(length) = bytes.get(length_at..length_at + 4) else { return };
        let length = u32::from_le_bytes([length[0], length[1], length[2], length[3]]) as usize;
        let end = length_at + 4 + length;
        let Some(attribute) = bytes.get(at..end) else { return };
        attributes.push(attribute);
        at = end;
    }
    attributes.sort_unstable();
    let sorted = attributes.concat();
    bytes[START..START + sorted.len()].copy_from_slice(&sorted);
}

/// Reads all channels of all parts with the text and number attributes. The channels of a named part among
/// several are prefixed with its name and a dot.
///
/// # Errors
/// When the file is malformed, or its parts cover different windows.
pub fn read_frame_exr(bytes: &[u8]) -> Result<Frame, ImageError> {
    let parts = read_parts(bytes)?;
    let unsupported = |reason: &str| ImageError::Unsupported { format: "OpenEXR", reason: reason.to_owned() };
    let first = parts.layer_data.first().ok_or_else(|| unsupported("a file without parts"))?;
    let window = window(first);
    let display = parts.attributes.display_window.size;
    let resolution = [display.width() as u32, display.height() as u32];
    let mut frame = Frame::new(resolution, window, color_space(&parts.attributes))?;
    for part in &parts.layer_data {
        if self::window(part) != window {
            return Err(unsupported("parts that cover different windows"));
        }
        let prefix = match &part.attributes.layer_name {
            Some(name) if parts.layer_data.len() > 1 => string(name) + ".",
            _ => String::new(),
        };
        for channel in &part.channel_data.list {
            if channel.sampling.area() != 1 {
                return Err(unsupported("subsampled channels"));
            }
            frame.push_channel(
                prefix.clone() + &string(&channel.name),
                channel.sample_data.values_as_f32().collect(),
            )?;
        }
        let own = &part.attributes;
        for (name, value) in [(SOFTWARE, &own.software_name), (COMMENTS, &own.comments), (OWNER, &own.owner)]
        {
            if let Some(value) = value {
                frame.set_attribute(name, string(value));
            }
        }
        // Attributes are kept sorted by name, so the order of the hash map does not show.
        for (name, value) in own.other.iter().chain(&parts.attributes.other) {
            let value = match value {
                AttributeValue::Text(t) => string(t),
                AttributeValue::F32(v) => v.to_string(),
                AttributeValue::F64(v) => v.to_string(),
                AttributeValue::I32(v) => v.to_string(),
                _ => continue,
            };
            frame.set_attribute(string(name), value);
        }
    }
    Ok(frame)
}

fn window(part: &ExrPart) -> Window {
    let ExrVec2(x, y) = part.attributes.layer_position;
    Window { x, y, width: part.size.width() as u32, height: part.size.height() as u32 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn specimen() -> Frame {
        let window = Window { x: 3, y: 1, width: 5, height: 4 };
        let mut frame = Frame::new([16, 9], window, Some(ColorSpaceKind::Rec2020)).unwrap();
        for (k, name) in ["R", "G", "B", "Albedo.R", "N.X", "S0.550,000nm"].into_iter().enumerate() {
            let values = (0..20).map(|i| (i as f32 - 3.7) * (k as f32 + 0.1)).collect();
            frame.push_channel(name, values).unwrap();
        }
        for i in 0..20 {
            frame.set_attribute(format!("setting {i}"), format!("value {}", i * i));
        }
        frame.set_attribute("unit", "W·m⁻²·sr⁻¹·nm⁻¹");
        frame.set_attribute("software", "steradian");
        frame
    }

    fn written(frame: &Frame, depth: SampleDepth) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_exr(frame, &mut bytes, depth).unwrap();
        bytes
    }

    #[test]
    fn a_frame_survives_the_file_bit_for_bit() {
        let frame = specimen();
        let back = read_frame_exr(&written(&frame, SampleDepth::Float)).unwrap();
        assert_eq!((back.resolution(), back.window()), (frame.resolution(), frame.window()));
        assert_eq!(back.color_space(), Some(ColorSpaceKind::Rec2020));
        assert_eq!(back.channels().len(), frame.channels().len());
        for channel in frame.channels() {
            assert_eq!(back.channel(&channel.name), Some(&channel.values[..]), "{}", channel.name);
        }
        assert!(back.attributes().eq(frame.attributes()));
    }

    #[test]
    fn half_precision_errs_by_half_a_unit_in_the_eleventh_bit() {
        let frame = specimen();
        let back = read_frame_exr(&written(&frame, SampleDepth::Half)).unwrap();
        for channel in frame.channels() {
            for (a, b) in channel.values.iter().zip(back.channel(&channel.name).unwrap()) {
                assert!((a - b).abs() <= a.abs() * 0.5_f32.powi(11), "{a} {b}");
            }
        }
    }

    #[test]
    fn the_same_frame_gives_the_same_bytes() {
        // Many blocks, which threads compress in any order, and many attributes, which a hash map shuffles.
        let tall = || {
            let mut frame =
                Frame::from_rgb([7, 200], ColorSpaceKind::Srgb, |i| [(i as f32).sin(); 3]).unwrap();
            specimen().attributes().for_each(|(name, value)| frame.set_attribute(name, value));
            frame
        };
        let first = written(&tall(), SampleDepth::Float);
        for _ in 0..5 {
            assert!(written(&tall(), SampleDepth::Float) == first);
        }
    }

    #[test]
    fn no_value_is_altered_not_even_one_that_is_not_a_number() {
        let values = vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.0, f32::MIN_POSITIVE / 2.0];
        let mut frame = Frame::new([5, 1], Window::full([5, 1]), None).unwrap();
        frame.push_channel("Y", values.clone()).unwrap();
        let back = read_frame_exr(&written(&frame, SampleDepth::Float)).unwrap();
        let bits = |v: &[f32]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(back.channel("Y").unwrap()), bits(&values));
    }

    #[test]
    fn reserved_names_and_garbage_are_errors() {
        let mut frame = specimen();
        frame.set_attribute("channels", "mine");
        assert!(write_exr(&frame, &mut Vec::new(), SampleDepth::Float).is_err());
        assert!(read_frame_exr(b"\x76\x2f\x31\x01 and then nothing").is_err());
        let bytes = written(&specimen(), SampleDepth::Float);
        assert!(read_frame_exr(&bytes[..bytes.len() / 2]).is_err());
    }
}
