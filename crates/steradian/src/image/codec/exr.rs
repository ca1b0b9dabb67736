//! OpenEXR: channels by name, half, float or integer samples.

use super::limits;
use crate::color::{Chromaticity, ColorSpaceKind};
use crate::image::error::ImageError;
use crate::image::picture::{Image, Layout};
use exr::prelude::{
    AnyChannel, AnyChannels, FlatSamples, Image as ExrImage, ImageAttributes, Layer, ReadChannels,
    ReadLayers, f16, read,
};
use std::io::Cursor;

/// All parts of an OpenEXR file with all their channels.
pub(crate) type ExrParts = ExrImage<exr::prelude::SmallVec<[ExrPart; 2]>>;

/// One part.
pub(crate) type ExrPart = Layer<AnyChannels<FlatSamples>>;

fn malformed(e: impl std::fmt::Display) -> ImageError {
    ImageError::Malformed { format: "OpenEXR", reason: e.to_string() }
}

/// Reads every part, after checking that the header promises no more than the file can hold.
pub(crate) fn read_parts(bytes: &[u8]) -> Result<ExrParts, ImageError> {
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(malformed)?;
    let mut pixel_bytes = 0;
    for header in &meta.headers {
        pixel_bytes += header.channels.bytes_per_pixel as u64;
        limits::check(
            header.layer_size.width() as u64,
            header.layer_size.height() as u64,
            pixel_bytes,
            bytes.len(),
        )?;
    }
    read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(malformed)
}

/// The colour space of the file's chromaticities, sRGB when it has none; `None` for those of no known space.
pub(crate) fn color_space(attributes: &ImageAttributes) -> Option<ColorSpaceKind> {
    let Some(found) = attributes.chromaticities else { return Some(ColorSpaceKind::Srgb) };
    ColorSpaceKind::ALL.into_iter().find(|kind| {
        let close = |a: exr::math::Vec2<f32>, b: Chromaticity| (a.0 - b.x).abs() + (a.1 - b.y).abs() < 2e-3;
        let [r, g, b] = kind.primaries();
        close(found.red, r) && close(found.green, g) && close(found.blue, b)
    })
}

/// Reads the first part: R, G, B and A where present, otherwise the luminance Y, otherwise its only channel.
///
/// The picture is what the data window covers. Half samples stay half. Unknown chromaticities count as sRGB.
pub(super) fn decode(bytes: &[u8]) -> Result<Image, ImageError> {
    let parts = read_parts(bytes)?;
    let part = parts.layer_data.first().ok_or_else(|| malformed("the file has no part"))?;
    let channels = &part.channel_data.list;
    let find = |name: &str| channels.iter().find(|c| c.name == *name);
    let (layout, chosen) = match (find("R"), find("G"), find("B"), find("A")) {
        (Some(r), Some(g), Some(b), Some(a)) => (Layout::Rgba, vec![r, g, b, a]),
        (Some(r), Some(g), Some(b), None) => (Layout::Rgb, vec![r, g, b]),
        _ => match (find("Y"), channels.as_slice()) {
            (Some(y), _) => (Layout::Gray, vec![y]),
            (None, [only]) => (Layout::Gray, vec![only]),
            (None, _) => {
                let names: Vec<String> = channels.iter().map(|c| c.name.to_string()).collect();
                let reason = format!("neither R, G, B nor Y among its channels {}", names.join(", "));
                return Err(ImageError::Unsupported { format: "OpenEXR", reason });
            }
        },
    };
    let (width, height) = (part.size.width(), part.size.height());
    if chosen.iter().any(|c| c.sampling.area() != 1 || c.sample_data.len() != width * height) {
        return Err(ImageError::Unsupported { format: "OpenEXR", reason: "subsampled channels".into() });
    }
    let halves: Option<Vec<&[f16]>> = chosen.iter().map(|c| half_samples(c)).collect();
    // `limits::check` has bounded both sides.
    let (width, height) = (width as u32, height as u32);
    let image = match halves {
        Some(planes) => Image::from_f16(width, height, layout, interleave(&planes)),
        None => {
            let planes: Vec<Vec<f32>> =
                chosen.iter().map(|c| c.sample_data.values_as_f32().collect()).collect();
            let planes: Vec<&[f32]> = planes.iter().map(Vec::as_slice).collect();
            Image::from_f32(width, height, layout, interleave(&planes))
        }
    }?;
    Ok(image.with_color_space(color_space(&parts.attributes).unwrap_or_default()))
}

fn half_samples(channel: &AnyChannel<FlatSamples>) -> Option<&[f16]> {
    match &channel.sample_data {
        FlatSamples::F16(v) => Some(v),
        FlatSamples::F32(_) | FlatSamples::U32(_) => None,
    }
}

fn interleave<T: Copy>(planes: &[&[T]]) -> Vec<T> {
    let n = planes.first().map_or(0, |p| p.len());
    (0..n).flat_map(|i| planes.iter().map(move |p| p[i])).collect()
}
