//! The film's immutable settings, and how one sample is recorded.

use super::bounds::PixelBounds;
use super::filter::Filter;
use super::sensor::{Sensor, tristimulus};
use super::tile::{Bin, FilmTile, Pixel, SurfaceSums};
use crate::color::{ColorSpace, Xyz};
use crate::math::{Normal, Point, Vec2, Vec3};
use crate::spectrum::{LANES, Sampled, Wavelengths};
use crate::units::{Radiance, Unitless};
use glam::DVec3;

/// What the film records besides RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilmKind {
    /// Nothing.
    Rgb,
    /// Geometry and reflectance of the first visible surface, and the variance of RGB.
    GBuffer,
    /// Radiance by wavelength.
    Spectral(SpectralBins),
}

/// Equal intervals of wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralBins {
    /// Number of intervals.
    pub count: u32,
    /// Start of the first [nm].
    pub min: f32,
    /// End of the last [nm].
    pub max: f32,
}

impl SpectralBins {
    /// The interval that holds `lambda` [nm]; `None` outside the range.
    pub fn bin(&self, lambda: f32) -> Option<usize> {
        if !(self.min..=self.max).contains(&lambda) {
            return None;
        }
        let x = (lambda - self.min) / (self.max - self.min) * self.count as f32;
        Some((x as usize).min(self.count as usize - 1))
    }

    /// Centre of an interval [nm].
    pub fn centre(&self, bin: usize) -> f32 {
        self.min + (bin as f32 + 0.5) * (self.max - self.min) / self.count as f32
    }
}

/// What makes a film impossible.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// Nothing to render.
    #[error("the film's pixel bounds are empty or outside its {0:?} pixels")]
    Bounds([u32; 2]),
    /// No bins, or an empty range.
    #[error("{count} bins over {min} to {max} nm are no spectral film")]
    Bins {
        /// Number of bins.
        count: u32,
        /// Start [nm].
        min: f32,
        /// End [nm].
        max: f32,
    },
}

/// The film: immutable while rendering.
#[derive(Clone, Debug)]
pub struct Film {
    pub(super) resolution: [u32; 2],
    pub(super) bounds: PixelBounds,
    pub(super) filter: Filter,
    pub(super) sensor: Sensor,
    pub(super) kind: FilmKind,
    /// Colour space of the output; its white lights the albedo layer.
    pub(super) space: ColorSpace,
    /// ∫ ȳ of that white [nm].
    white_integral: f32,
}

/// One sample of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct FilmSample<'a> {
    /// Radiance that arrived.
    pub radiance: Sampled<Radiance>,
    /// At these wavelengths, as the path left them.
    pub wavelengths: &'a Wavelengths,
    /// Weight of the filter and of the camera.
    pub weight: f32,
    /// The first visible surface; `None` when the ray left the scene or the film does not record it.
    pub surface: Option<&'a SurfaceLayers>,
}

/// What the geometric layers record of a surface, in the coordinate system chosen for the output.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceLayers {
    /// Position [scene units].
    pub p: Point,
    /// Geometric normal, towards the viewer.
    pub n: Normal,
    /// Shading normal.
    pub ns: Normal,
    /// Surface parameters.
    pub uv: Vec2,
    /// ∂z/∂x and ∂z/∂y per pixel [scene units].
    pub dz: Vec2,
    /// Directional-hemispherical reflectance.
    pub albedo: Sampled<Unitless>,
}

/// What became of a sample.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recorded {
    /// It counts.
    Kept,
    /// It was infinite or NaN and was dropped; to be counted and reported.
    NotFinite,
}

impl Film {
    /// A film of `resolution` pixels of which `bounds` are rendered.
    pub fn new(
        resolution: [u32; 2],
        bounds: PixelBounds,
        filter: Filter,
        sensor: Sensor,
        kind: FilmKind,
        space: ColorSpace,
    ) -> Result<Self, FilmError> {
        let bounds = bounds.intersect(&PixelBounds::full(resolution));
        if bounds.area() == 0 {
            return Err(FilmError::Bounds(resolution));
        }
        if let FilmKind::Spectral(SpectralBins { count, min, max }) = kind
            && (count == 0 || !(min > 0.0 && min < max && max.is_finite()))
        {
            return Err(FilmError::Bins { count, min, max });
        }
        let white_integral = space.illuminant().photometric_integral();
        Ok(Self { resolution, bounds, filter, sensor, kind, space, white_integral })
    }

    /// Size of the whole picture [px].
    pub fn resolution(&self) -> [u32; 2] {
        self.resolution
    }

    /// The pixels to render.
    pub fn bounds(&self) -> PixelBounds {
        self.bounds
    }

    /// The reconstruction filter.
    pub fn filter(&self) -> &Filter {
        &self.filter
    }

    /// The sensor.
    pub fn sensor(&self) -> &Sensor {
        &self.sensor
    }

    /// What is recorded.
    pub fn kind(&self) -> FilmKind {
        self.kind
    }

    /// Colour space of the output.
    pub fn color_space(&self) -> &ColorSpace {
        &self.space
    }

    /// Whether samples should carry the first visible surface.
    pub fn wants_surfaces(&self) -> bool {
        self.kind == FilmKind::GBuffer
    }

    /// The wavelengths of a path: by the eye's sensitivity, or uniform over the range of a spectral film.
    pub fn sample_wavelengths(&self, u: f32) -> Wavelengths {
        match self.kind {
            FilmKind::Rgb | FilmKind::GBuffer => Wavelengths::sample_visible(u),
            FilmKind::Spectral(bins) => Wavelengths::sample_uniform(u, bins.min, bins.max),
        }
    }

    /// Empty accumulators for the pixels of `bounds` that the film renders.
    pub fn tile(&self, bounds: PixelBounds) -> FilmTile {
        let bounds = bounds.intersect(&self.bounds);
        let n = bounds.area();
        let (surfaces, bins) = match self.kind {
            FilmKind::Rgb => (0, 0),
            FilmKind::GBuffer => (n, 0),
            FilmKind::Spectral(bins) => (0, n * bins.count as usize),
        };
        FilmTile {
            bounds,
            pixels: vec![Pixel::default(); n],
            surfaces: vec![SurfaceSums::default(); surfaces],
            bins: vec![Bin::default(); bins],
        }
    }

    /// Records a sample of `pixel`, which must lie in the tile.
    pub fn add_sample(&self, tile: &mut FilmTile, pixel: [i32; 2], sample: &FilmSample<'_>) -> Recorded {
        let Some(index) = tile.bounds.index(pixel) else {
            debug_assert!(false, "pixel {pixel:?} outside its tile {:?}", tile.bounds);
            return Recorded::Kept;
        };
        let w = sample.wavelengths;
        let xyz = self.sensor.expose(sample.radiance, w).0;
        // A wavelength that is not finite makes the sum so, whatever the eye makes of it: 0 · ∞ is NaN.
        if !(xyz.is_finite() && sample.weight.is_finite()) {
            return Recorded::NotFinite;
        }
        let weight = f64::from(sample.weight);
        let sums = &mut tile.pixels[index];
        (0..3).for_each(|c| sums.sum[c] += weight * f64::from(xyz[c]));
        sums.weight += weight;
        sums.luminance.add(xyz.y);
        match self.kind {
            FilmKind::Rgb => {}
            FilmKind::GBuffer => {
                let rgb = self.sensor.rgb(xyz.as_dvec3().to_array()).0;
                let sums = &mut tile.surfaces[index];
                (0..3).for_each(|c| sums.rgb[c].add(rgb[c]));
                if let Some(surface) = sample.surface {
                    sums.add(surface, self.albedo(surface, w), weight);
                }
            }
            FilmKind::Spectral(bins) => {
                let first = index * bins.count as usize;
                for lane in 0..LANES {
                    let pdf = w.pdf()[lane];
                    let Some(bin) = bins.bin(w.lambda()[lane]).filter(|_| pdf > 0.0) else { continue };
                    let sums = &mut tile.bins[first + bin];
                    sums.sum += weight * f64::from(sample.radiance[lane]) / f64::from(pdf);
                    sums.weight += weight / f64::from(pdf);
                }
            }
        }
        Recorded::Kept
    }

    /// RGB of a surface under the colour space's white, such that a reflectance of 1 gives (1, 1, 1).
    fn albedo(&self, surface: &SurfaceLayers, w: &Wavelengths) -> Vec3 {
        let lit: Sampled<Radiance> = surface.albedo * self.space.illuminant().sample(w);
        let relative = Xyz(tristimulus(lit, w) / self.white_integral);
        let rgb = self.space.rgb_from_xyz(relative).0;
        if rgb.is_finite() { rgb } else { Vec3::ZERO }
    }
}

impl SurfaceSums {
    fn add(&mut self, surface: &SurfaceLayers, albedo: Vec3, weight: f64) {
        self.weight += weight;
        let add3 = |sum: &mut [f64; 3], v: Vec3| {
            *sum = (DVec3::from_array(*sum) + v.as_dvec3() * weight).to_array();
        };
        add3(&mut self.p, *surface.p);
        add3(&mut self.n, *surface.n);
        add3(&mut self.ns, *surface.ns);
        add3(&mut self.albedo, albedo);
        for axis in 0..2 {
            self.uv[axis] += weight * f64::from(surface.uv[axis]);
            self.dz[axis] += weight * f64::from(surface.dz[axis]);
        }
    }
}
