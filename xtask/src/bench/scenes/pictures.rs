//! Pictures by rule: wood, tiles, plaster and a sky.

use std::f32::consts::{PI, TAU};
use steradian::color::ColorSpaceKind;
use steradian::image::{Frame, FrameFormat, SampleDepth, write_frame};
use steradian::math::warp::equal_area_square_to_sphere;
use steradian::math::{Vec2, Vec3, hash};

/// A picture that is not written yet.
pub(super) struct Picture {
    size: [u32; 2],
    format: FrameFormat,
    /// Linear sRGB at (s, t), t downwards.
    at: Box<dyn Fn(f32, f32) -> [f32; 3]>,
    /// Evaluations along each side of a texel.
    sub: u32,
}

impl Picture {
    /// A texture of `side`² texels, in 8-bit sRGB.
    pub(super) fn texture(side: u32, at: fn(f32, f32) -> [f32; 3]) -> Self {
        Self { size: [side, side], format: FrameFormat::Png, at: Box::new(at), sub: 1 }
    }

    /// The sky as an equal-area octahedral square, or by latitude and longitude.
    pub(super) fn sky_square(side: u32, sky: &'static Sky) -> Self {
        let at = |s, t| sky.radiance(equal_area_square_to_sphere(Vec2::new(s, t)));
        Self { size: [side, side], format: FrameFormat::Exr(SampleDepth::Float), at: Box::new(at), sub: 3 }
    }

    /// The sky as Mitsuba reads it: top row at +y, −z in the middle of the first column's left edge, azimuth towards +x.
    pub(super) fn sky_latlong(height: u32, sky: &'static Sky) -> Self {
        let at = |s: f32, t: f32| {
            let ((sin_p, cos_p), (sin_t, cos_t)) = ((TAU * s).sin_cos(), (PI * t).sin_cos());
            sky.radiance(Vec3::new(sin_p * sin_t, cos_t, -cos_p * sin_t))
        };
        let format = FrameFormat::Exr(SampleDepth::Float);
        Self { size: [2 * height, height], format, at: Box::new(at), sub: 3 }
    }

    /// The bytes of its file.
    pub(super) fn encoded(&self) -> Result<Vec<u8>, String> {
        let [width, height] = self.size;
        let n = self.sub;
        let texel = |i: usize| {
            let (x, y) = (i as u32 % width, i as u32 / width);
            let mut sum = [0.0; 3];
            for k in 0..n * n {
                let s = (x as f32 + ((k % n) as f32 + 0.5) / n as f32) / width as f32;
                let t = (y as f32 + ((k / n) as f32 + 0.5) / n as f32) / height as f32;
                let value = (self.at)(s, t);
                sum = std::array::from_fn(|c| sum[c] + value[c] / (n * n) as f32);
            }
            sum
        };
        let texels: Vec<[f32; 3]> = (0..(width * height) as usize).map(texel).collect();
        let frame =
            Frame::from_rgb(self.size, ColorSpaceKind::Srgb, |i| texels[i]).map_err(|e| e.to_string())?;
        let mut bytes = Vec::new();
        write_frame(&frame, &mut bytes, self.format).map_err(|e| e.to_string())?;
        Ok(bytes)
    }
}

/// A sky with a sun and some clouds, over a plain ground; y is up.
pub(super) struct Sky {
    /// Towards the sun; any length.
    sun: [f32; 3],
    /// Cosines of the angles from the sun at which the disc ends and at which it is at its full radiance.
    disc: [f32; 2],
    light: [f32; 3],
    /// Radiance around the sun over that of its disc, and how fast it falls.
    halo: f32,
    halo_power: i32,
    zenith: [f32; 3],
    /// What comes to the zenith's radiance at the horizon.
    horizon: [f32; 3],
    clouds: [f32; 3],
    ground: [f32; 3],
}

/// A broad sun, as through haze.
pub(super) const HAZE: Sky = Sky {
    sun: [0.55, 0.62, 0.56],
    disc: [0.990, 0.994],
    light: [90.0, 80.0, 62.0],
    halo: 0.02,
    halo_power: 24,
    zenith: [0.25, 0.42, 0.85],
    horizon: [0.55, 0.45, 0.05],
    clouds: [1.1, 1.08, 1.05],
    ground: [0.22, 0.20, 0.18],
};

/// An afternoon. The disc has four times the sun's diameter, so that the picture resolves it, and as much less radiance: it
/// gives as much light as the rest of the sky several times over.
pub(super) const AFTERNOON: Sky = Sky {
    sun: [-0.80, 0.52, 0.22],
    disc: [0.99978, 0.99985],
    light: [16_000.0, 14_000.0, 10_500.0],
    halo: 1.5e-4,
    halo_power: 60,
    ..HAZE
};

/// The last of the sun, when lamps are lit already.
pub(super) const EVENING: Sky = Sky {
    sun: [-0.75, 0.13, 0.55],
    disc: [0.99978, 0.99985],
    light: [1500.0, 620.0, 160.0],
    halo: 6e-4,
    halo_power: 10,
    zenith: [0.06, 0.09, 0.22],
    horizon: [0.30, 0.16, 0.10],
    clouds: [0.40, 0.22, 0.20],
    ground: [0.03, 0.03, 0.03],
};

impl Sky {
    fn radiance(&self, d: Vec3) -> [f32; 3] {
        if d.y < 0.0 {
            return self.ground.map(|c| c * (1.0 + 0.3 * d.y));
        }
        let sun = Vec3::from(self.sun).normalize().dot(d);
        let [rim, full] = self.disc;
        let disc = smooth((sun - rim) / (full - rim));
        let halo = sun.max(0.0).powi(self.halo_power);
        let low = (1.0 - d.y).powi(3);
        let clouds = smooth((fractal(d.x * 3.0, d.z * 3.0, 5) - 0.5) * 3.0) * smooth(d.y * 3.0);
        std::array::from_fn(|c| {
            let clear = self.zenith[c] + self.horizon[c] * low;
            clear * (1.0 - clouds) + self.clouds[c] * clouds + self.light[c] * (disc + self.halo * halo)
        })
    }
}

/// Boards of brown wood, with grain along s; repeats at the unit square.
pub(super) fn wood(s: f32, t: f32) -> [f32; 3] {
    let boards = 4.0;
    let board = (t * boards).floor();
    let wave = (TAU * s).sin() * 0.35 + (TAU * (2.0 * s + 0.3 * board)).cos() * 0.15;
    let rings = ((t * boards).fract() * 9.0 + wave + 5.0 * noise(board * 3.7, 1.5)).fract();
    let grain = 0.5 + 0.5 * (TAU * rings).sin();
    let fine = tiled(s * 8.0, t * 128.0, 8.0, 128.0);
    let joint = if ((t * boards).fract() - 0.5).abs() > 0.492 { 0.25 } else { 1.0 };
    let shade = (0.55 + 0.3 * grain + 0.15 * fine) * (0.8 + 0.2 * noise(board + 0.5, 7.5)) * joint;
    [0.46 * shade, 0.25 * shade, 0.11 * shade]
}

/// Tiles of two greys with joints; repeats at the unit square.
pub(super) fn tiles(s: f32, t: f32) -> [f32; 3] {
    let (x, y) = (s * 8.0, t * 8.0);
    let odd = (x.floor() + y.floor()).rem_euclid(2.0);
    let joint = (x.fract() - 0.5).abs().max((y.fract() - 0.5).abs()) > 0.48;
    let spots = 0.85 + 0.15 * tiled(s * 64.0, t * 64.0, 64.0, 64.0);
    let v = if joint { 0.12 } else { spots * if odd > 0.5 { 0.55 } else { 0.18 } };
    [v, v * 0.97, v * 0.9]
}

/// Pale plaster; repeats at the unit square.
pub(super) fn plaster(s: f32, t: f32) -> [f32; 3] {
    let n = 0.6 * tiled(s * 16.0, t * 16.0, 16.0, 16.0) + 0.4 * tiled(s * 64.0, t * 64.0, 64.0, 64.0);
    [0.62 + 0.14 * n, 0.58 + 0.14 * n, 0.5 + 0.14 * n]
}

/// A woven pattern of three colours; repeats at the unit square.
pub(super) fn carpet(s: f32, t: f32) -> [f32; 3] {
    let (x, y) = (s * 6.0, t * 6.0);
    let ring = ((x.fract() - 0.5).abs() + (y.fract() - 0.5).abs()) * 4.0;
    let yarn = 0.8 + 0.2 * (TAU * 128.0 * s).sin() * (TAU * 128.0 * t).sin();
    let color = match ring as u32 {
        0 => [0.55, 0.42, 0.2],
        1 => [0.35, 0.06, 0.05],
        _ => [0.08, 0.1, 0.2],
    };
    color.map(|c| c * yarn)
}

fn smooth(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// Value noise in [0, 1].
pub(super) fn noise(x: f32, y: f32) -> f32 {
    tiled(x, y, 4096.0, 4096.0)
}

/// Value noise with the periods `px`, `py`.
fn tiled(x: f32, y: f32, px: f32, py: f32) -> f32 {
    let at = |i: f32, j: f32| {
        let (i, j) = ((x.floor() + i).rem_euclid(px), (y.floor() + j).rem_euclid(py));
        hash::to_unit(hash::hash_floats(&[i, j]))
    };
    let (fx, fy) = (smooth(x - x.floor()), smooth(y - y.floor()));
    let row = |j| at(0.0, j) * (1.0 - fx) + at(1.0, j) * fx;
    row(0.0) * (1.0 - fy) + row(1.0) * fy
}

/// Octaves of noise in [0, 1].
pub(super) fn fractal(x: f32, y: f32, octaves: i32) -> f32 {
    let sum = |f: &dyn Fn(f32) -> f32| (0..octaves).map(|o| f(0.5_f32.powi(o))).sum::<f32>();
    sum(&|a| a * noise(x / a, y / a)) / sum(&|a| a)
}
