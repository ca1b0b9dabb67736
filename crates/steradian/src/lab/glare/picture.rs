//! Luminance over half of all directions.

use std::f64::consts::{FRAC_PI_2, PI};

/// The geometry of an angular (equidistant) fisheye picture of 180°: the distance from the middle is proportional to the angle
/// to the line of sight, 90° at the rim of the inscribed circle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fisheye {
    side: u32,
}

impl Fisheye {
    /// A square picture; at least one pixel along a side.
    pub fn new(side: u32) -> Self {
        Self { side: side.max(1) }
    }

    /// Pixels along a side.
    pub fn side(self) -> u32 {
        self.side
    }

    /// The direction (right, up, ahead) at a place of the picture [px], rows downwards; `None` outside of the circle.
    pub fn direction(self, [x, y]: [f64; 2]) -> Option<[f64; 3]> {
        let half = 0.5 * f64::from(self.side);
        let (u, v) = (x / half - 1.0, 1.0 - y / half);
        let r = u.hypot(v);
        if r > 1.0 {
            return None;
        }
        let (sin, cos) = (r * FRAC_PI_2).sin_cos();
        let s = if r > 0.0 { sin / r } else { FRAC_PI_2 };
        Some([u * s, v * s, cos])
    }

    /// The direction through the middle of a pixel, counted row by row; `None` outside of the circle.
    pub fn middle(self, pixel: usize) -> Option<[f64; 3]> {
        let side = self.side as usize;
        self.direction([(pixel % side) as f64 + 0.5, (pixel / side) as f64 + 0.5])
    }

    /// Solid angle of a pixel whose middle lies `cos` from the line of sight [sr]: dω = sinθ/θ (π/2)² dA of the unit disk.
    pub fn solid_angle(self, cos: f64) -> f64 {
        let theta = cos.clamp(-1.0, 1.0).acos();
        let sinc = if theta > 1e-9 { theta.sin() / theta } else { 1.0 };
        sinc * (PI / f64::from(self.side)).powi(2)
    }
}

/// Luminances [cd/m²] in such a picture, row by row from the top; what lies outside of the circle does not count.
#[derive(Clone, Debug, PartialEq)]
pub struct LuminancePicture {
    /// Geometry.
    pub fisheye: Fisheye,
    /// One luminance for each pixel.
    pub luminance: Vec<f32>,
}

/// A pixel within the circle.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Its number, row by row.
    pub index: usize,
    /// Direction of its middle: right, up, ahead.
    pub direction: [f64; 3],
    /// Solid angle [sr].
    pub solid_angle: f64,
    /// Luminance [cd/m²].
    pub luminance: f64,
}

impl LuminancePicture {
    /// The pixels within the circle.
    pub fn pixels(&self) -> impl Iterator<Item = Pixel> + '_ {
        self.luminance.iter().enumerate().filter_map(|(index, &l)| {
            let direction = self.fisheye.middle(index)?;
            let solid_angle = self.fisheye.solid_angle(direction[2]);
            Some(Pixel { index, direction, solid_angle, luminance: l.into() })
        })
    }

    /// Illuminance of the plane of the picture, the vertical illuminance at an eye that looks ahead [lx]: Σ L ω cosθ.
    ///
    /// The sums of ω and of ω cosθ over the pixels are set right to 2π and π: pixels on the rim count whole or not at all.
    pub fn vertical_illuminance(&self) -> f64 {
        let (mut sum, mut norm) = (0.0, 0.0);
        for p in self.pixels() {
            let weight = p.solid_angle * p.direction[2];
            sum += p.luminance * weight;
            norm += weight;
        }
        if norm > 0.0 { sum * PI / norm } else { 0.0 }
    }

    /// Mean luminance over the half space [cd/m²].
    pub fn mean(&self) -> f64 {
        let (mut sum, mut norm) = (0.0, 0.0);
        for p in self.pixels() {
            sum += p.luminance * p.solid_angle;
            norm += p.solid_angle;
        }
        if norm > 0.0 { sum / norm } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(side: u32, l: impl Fn([f64; 3]) -> f64) -> LuminancePicture {
        let fisheye = Fisheye::new(side);
        let luminance =
            (0..(side * side) as usize).map(|i| fisheye.middle(i).map_or(9e9, |d| l(d) as f32)).collect();
        LuminancePicture { fisheye, luminance }
    }

    #[test]
    fn the_circle_holds_half_of_all_directions() {
        let p = picture(200, |_| 1.0);
        let omega: f64 = p.pixels().map(|p| p.solid_angle).sum();
        assert!((omega / (2.0 * PI) - 1.0).abs() < 3e-3, "{omega}");
        assert!((p.vertical_illuminance() - PI).abs() < 1e-12 && (p.mean() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_angle_grows_with_the_distance() {
        let f = Fisheye::new(100);
        for (place, expected) in [
            ([50.0, 50.0], [0.0, 0.0, 1.0]),
            ([100.0, 50.0], [1.0, 0.0, 0.0]),
            ([50.0, 0.0], [0.0, 1.0, 0.0]),
            ([75.0, 50.0], [0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt()]),
        ] {
            let d = f.direction(place).unwrap();
            assert!(d.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{place:?}: {d:?}");
        }
        assert_eq!(f.direction([99.0, 1.0]), None);
    }

    #[test]
    fn a_lambertian_sky_above_lights_the_wall_by_half_of_pi() {
        let p = picture(256, |d| if d[1] > 0.0 { 100.0 } else { 0.0 });
        assert!((p.vertical_illuminance() / (50.0 * PI) - 1.0).abs() < 1e-3);
        // L = cosθ ahead: ∫ cos²θ dω = 2π/3.
        let p = picture(256, |d| d[2]);
        assert!((p.vertical_illuminance() / (2.0 * PI / 3.0) - 1.0).abs() < 1e-3);
    }
}
