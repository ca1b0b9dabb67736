//! Numbers as colours.

use super::encoding::ColorEncoding;
use super::error::ImageError;
use super::frame::Frame;
use crate::color::ColorSpaceKind;

/// sRGB-encoded anchors at equal steps, from black over violet and orange to nearly white.
const ANCHORS: [[f32; 3]; 6] = [
    [0.0, 0.0, 0.02],
    [0.20, 0.07, 0.45],
    [0.55, 0.13, 0.50],
    [0.89, 0.32, 0.30],
    [0.99, 0.68, 0.25],
    [1.0, 0.99, 0.85],
];

/// Linear sRGB for a number in [0, 1]; luminance rises with the number, so that the map reads in gray as well.
/// Numbers outside are limited, and what is not a number is cyan, which no number gives.
pub fn heat_color(v: f32) -> [f32; 3] {
    if v.is_nan() {
        return [0.0, 1.0, 1.0];
    }
    let x = v.clamp(0.0, 1.0) * (ANCHORS.len() - 1) as f32;
    let i = (x as usize).min(ANCHORS.len() - 2);
    let t = x - i as f32;
    std::array::from_fn(|c| ColorEncoding::Srgb.to_linear(ANCHORS[i][c] * (1.0 - t) + ANCHORS[i + 1][c] * t))
}

/// A picture of numbers in [0, 1], rows from the top.
///
/// # Errors
/// When the number of values does not fit the size.
pub fn heat_map([width, height]: [u32; 2], values: &[f32]) -> Result<Frame, ImageError> {
    if width as usize * height as usize != values.len() {
        return Err(ImageError::WrongSize { width, height, channels: 1, found: values.len() });
    }
    Frame::from_rgb([width, height], ColorSpaceKind::Srgb, |i| heat_color(values[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luminance_rises_with_the_number() {
        let luminance = |v: f32| {
            let [r, g, b] = heat_color(v);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        for i in 0..200 {
            assert!(luminance((i + 1) as f32 / 200.0) > luminance(i as f32 / 200.0), "{i}");
        }
    }

    #[test]
    fn outside_numbers_are_limited_and_nan_stands_out() {
        assert_eq!(heat_color(-1.0), heat_color(0.0));
        assert_eq!(heat_color(7.0), heat_color(1.0));
        let frame = heat_map([2, 1], &[0.0, f32::NAN]).unwrap();
        assert_eq!(frame.rgb().unwrap().pixel(1), [0.0, 1.0, 1.0]);
        assert!(heat_map([2, 2], &[0.0]).is_err());
    }
}
