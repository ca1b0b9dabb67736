//! What integrators ask of a surface that a ray met.

use crate::bsdf::Mode;
use crate::material::SurfaceBsdf;
use crate::math::{Dir, SurfacePoint, Vec2};
use crate::shape::ReferencePoint;
use crate::spectrum::Sampled;
use crate::units::Unitless;

/// The surface as lights see it that scatters towards `wo`.
#[inline]
pub(super) fn reference(point: &SurfacePoint, bsdf: &SurfaceBsdf, wo: Dir) -> ReferencePoint {
    let n = bsdf.n();
    let lit_side = (!bsdf.lobes().transmission).then(|| n.facing(*wo));
    ReferencePoint { p: point.p, ng: Some(point.ng), ns: Some(n), lit_side, time: point.time }
}

/// Directional-hemispherical reflectance, B (2.14), from a fixed set of samples (fixed, so that a layer of it has no noise
/// beyond that of its camera rays).
pub(super) fn albedo(bsdf: &SurfaceBsdf, wo: Dir) -> Sampled<Unitless> {
    const N: u32 = 16;
    let mut sum = Sampled::ZERO;
    for i in 0..N {
        // The R2 sequence (Roberts 2018): low-discrepancy without tables.
        let u = Vec2::new(0.754_877_7, 0.569_840_3) * (i as f32 + 0.5);
        let uc = (i as f32 + 0.5) / N as f32;
        if let Some(s) = bsdf.sample(wo, uc, u.fract(), Mode::Radiance) {
            sum += s.weight;
        }
    }
    sum / N as f32
}
