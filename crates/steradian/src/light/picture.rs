//! Pictures that emit: RGB texels as filters of the colour space's white.

use super::normalise::Yield;
use crate::color::{ColorSpace, Factored, Rgb, UpsamplingTable};
use crate::image::{Image, Wrap};
use crate::math::{Vec2, Vec3};
use crate::spectrum::{LANES, Sampled, Sigmoid, Spectrum, Wavelengths};
use crate::units::Radiance;
use std::sync::Arc;

/// The spectrum of one texel's light, as a filter of the picture's white.
#[derive(Clone, Copy, Debug)]
pub(super) struct TexelLight {
    scale: f32,
    sigmoid: Sigmoid,
}

/// An emitting picture; clones, and lights that show the same file, share its texels. Texel (1, 1, 1) is the white of its colour space, at unit photometric amount before scaling.
#[derive(Clone, Debug)]
pub struct EmissionPicture {
    image: Arc<Image>,
    upsampling: Arc<UpsamplingTable>,
    white: Spectrum,
    white_integral: f32,
    /// Weights of R, G, B in luminance.
    luminance: Vec3,
    /// Factor that makes values absolute.
    factor: f32,
}

impl EmissionPicture {
    /// A picture in `space`, for which `upsampling` was built.
    pub fn new(image: impl Into<Arc<Image>>, upsampling: Arc<UpsamplingTable>, space: &ColorSpace) -> Self {
        let white = space.illuminant().clone();
        let luminance =
            Vec3::from_array([Vec3::X, Vec3::Y, Vec3::Z].map(|primary| space.luminance(Rgb(primary))));
        Self {
            white_integral: white.photometric_integral(),
            white,
            image: image.into(),
            upsampling,
            luminance,
            factor: 1.0,
        }
    }

    /// The texels.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// What a light gives that makes the total of a weighted sum `whole` of texels, and `directional` candela or cd/m²
    /// per 1 cd/m² of white, while the picture is unscaled.
    pub(super) fn yields(&self, whole: Vec3, directional: f32) -> Yield {
        let unit = crate::units::LUMENS_PER_WATT * self.white_integral;
        let total = Self { factor: 1.0, ..self.clone() }.integrals(whole);
        Yield {
            unit,
            luminous: unit * self.luminance(whole),
            radiant: total.watts,
            directional: unit * directional,
        }
    }

    /// The largest relative luminance of a texel.
    pub(super) fn peak(&self) -> f32 {
        let (width, height) = (self.image.width(), self.image.height());
        let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        texels.map(|(x, y)| self.luminance(self.image.rgb(x, y).0.max(Vec3::ZERO))).fold(0.0, f32::max)
    }

    pub(super) fn set_factor(&mut self, factor: f32) {
        self.factor = factor;
    }

    /// The texel that holds `st` in [0, 1]², t downwards; negative components are cut off.
    pub(super) fn nearest(&self, st: Vec2) -> Vec3 {
        let [x, y] = self.nearest_index(st);
        self.image.rgb(x, y).0.max(Vec3::ZERO)
    }

    /// Column and row of the texel that holds `st`.
    #[inline]
    pub(super) fn nearest_index(&self, st: Vec2) -> [u32; 2] {
        let index = |x: f32, n: u32| ((x * n as f32).max(0.0) as u32).min(n - 1);
        [index(st.x, self.image.width()), index(st.y, self.image.height())]
    }

    /// Interpolated texels at `st`, clamped at the edges; negative components are cut off.
    pub(super) fn bilinear(&self, st: Vec2) -> Vec3 {
        self.image.bilerp_rgb(st, Wrap::CLAMP).0.max(Vec3::ZERO)
    }

    /// The light of one triple.
    pub(super) fn light(&self, rgb: Vec3, w: &Wavelengths) -> Sampled<Radiance> {
        if rgb.max_element() <= 0.0 { Sampled::ZERO } else { self.texel_light(&self.emitted(rgb), w) }
    }

    /// What stands for one triple, ready for any wavelength.
    pub(super) fn emitted(&self, rgb: Vec3) -> TexelLight {
        let Factored { scale, shape } = Factored::new(Rgb(rgb));
        TexelLight { scale, sigmoid: self.upsampling.sigmoid(shape) }
    }

    /// The light of a texel.
    #[inline]
    pub(super) fn texel_light(&self, texel: &TexelLight, w: &Wavelengths) -> Sampled<Radiance> {
        if texel.scale == 0.0 {
            return Sampled::ZERO;
        }
        let scale = texel.scale * self.factor;
        let filter: [f32; LANES] = w.lambda().map(|l| texel.sigmoid.at(l));
        let white: Sampled<Radiance> = self.white.sample(w);
        Sampled::from_fn(|i| filter[i] * white[i] * scale)
    }

    /// Relative luminance of a triple.
    pub(super) fn luminance(&self, rgb: Vec3) -> f32 {
        self.luminance.dot(rgb)
    }

    /// Σ over texels of `weight(st)` · RGB, over the number of texels; st is the texel's centre.
    pub(super) fn mean(&self, weight: impl Fn(Vec2) -> f32) -> Vec3 {
        let (width, height) = (self.image.width(), self.image.height());
        let mut sum = glam::DVec3::ZERO;
        for y in 0..height {
            for x in 0..width {
                let st = (Vec2::new(x as f32, y as f32) + 0.5) / Vec2::new(width as f32, height as f32);
                sum += (self.image.rgb(x, y).0.max(Vec3::ZERO) * weight(st)).as_dvec3();
            }
        }
        (sum / (f64::from(width) * f64::from(height))).as_vec3()
    }

    /// ∫ over 360–830 nm, and K_m ∫ ȳ, of the light of a triple.
    pub(super) fn integrals(&self, rgb: Vec3) -> super::contract::LightPower {
        let Factored { scale, shape } = Factored::new(Rgb(rgb));
        let sigmoid = self.upsampling.sigmoid(shape);
        let watts: f64 = (0..crate::spectrum::cie::SAMPLES)
            .map(|i| crate::spectrum::LAMBDA_MIN + i as f32)
            .map(|l| f64::from(sigmoid.at(l) * self.white.at(l)))
            .sum();
        super::contract::LightPower {
            watts: watts as f32 * scale * self.factor,
            lumens: crate::units::LUMENS_PER_WATT * self.white_integral * self.luminance(rgb) * self.factor,
        }
    }
}
