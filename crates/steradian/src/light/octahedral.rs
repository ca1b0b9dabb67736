//! Latitude–longitude pictures of the surroundings as equal-area octahedral squares.

use crate::image::{AxisWrap, Image, ImageError, Layout, Wrap};
use crate::math::warp::{equal_area_square_to_sphere, spherical_angles};
use crate::math::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Sub-texels along each side over which a texel of the square is averaged.
const SUPERSAMPLES: u32 = 4;

/// Resamples a latitude–longitude picture to an equal-area octahedral square of `side` texels, in linear f32 RGB.
///
/// +z is the top row; azimuth grows with the column, starting at +x. Each texel is the mean of 4 × 4 bilinear lookups.
///
/// # Errors
/// When `side` is zero.
pub fn latlong_to_octahedral(latlong: &Image, side: u32) -> Result<Image, ImageError> {
    let wrap = Wrap::Axes { s: AxisWrap::Repeat, t: AxisWrap::Clamp };
    let mut values = Vec::with_capacity(side as usize * side as usize * 3);
    for y in 0..side {
        for x in 0..side {
            let mut sum = Vec3::ZERO;
            for i in 0..SUPERSAMPLES * SUPERSAMPLES {
                let sub = Vec2::new((i % SUPERSAMPLES) as f32 + 0.5, (i / SUPERSAMPLES) as f32 + 0.5);
                let st = (Vec2::new(x as f32, y as f32) + sub / SUPERSAMPLES as f32) / side as f32;
                let (theta, phi) = spherical_angles(equal_area_square_to_sphere(st));
                sum += latlong.bilerp_rgb(Vec2::new(phi / TAU, theta / PI), wrap).0;
            }
            values.extend((sum / (SUPERSAMPLES * SUPERSAMPLES) as f32).to_array());
        }
    }
    Image::from_f32(side, side, Layout::Rgb, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::warp::spherical_direction;

    #[test]
    fn a_smooth_sky_keeps_its_values_by_direction() {
        let sky = |d: Vec3| Vec3::new(1.0 + d.x, 1.0 + 0.5 * d.y, 2.0 - d.z);
        let (width, height) = (256, 128);
        let mut values = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let theta = PI * (y as f32 + 0.5) / height as f32;
                let phi = TAU * (x as f32 + 0.5) / width as f32;
                values.extend(sky(spherical_direction(theta, phi)).to_array());
            }
        }
        let latlong = Image::from_f32(width, height, Layout::Rgb, values).unwrap();
        let side = 64;
        let square = latlong_to_octahedral(&latlong, side).unwrap();
        let mut mean = Vec3::ZERO;
        for y in 0..side {
            for x in 0..side {
                let st = (Vec2::new(x as f32, y as f32) + 0.5) / side as f32;
                let exact = sky(equal_area_square_to_sphere(st));
                // A texel spans about 0.06 rad, over which the mean of a linear function moves by its curvature.
                assert!((square.rgb(x, y).0 - exact).abs().max_element() < 0.01, "{x} {y}");
                mean += square.rgb(x, y).0 / (side * side) as f32;
            }
        }
        assert!((mean - Vec3::new(1.0, 1.0, 2.0)).abs().max_element() < 1e-3, "{mean}");
    }
}
