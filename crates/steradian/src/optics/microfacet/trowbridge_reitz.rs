//! The Trowbridge–Reitz (GGX) distribution of microfacet normals.

use super::distribution::{Distribution, Widths};
use crate::math::{LocalDir, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Microfacets whose slopes follow Trowbridge & Reitz 1975, with Smith's height-correlated shadowing
/// (Walter et al. 2007; Heitz 2014; pbrt-v4 book, 9.6).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrowbridgeReitz {
    alpha_x: f32,
    alpha_y: f32,
}

impl TrowbridgeReitz {
    /// No microfacets: a smooth interface.
    pub const SMOOTH: Self = Self::of(Widths::SMOOTH);

    /// A distribution with slope widths `alpha_x`, `alpha_y` ≥ 0 along the axes of the shading frame.
    pub fn new(alpha_x: f32, alpha_y: f32) -> Self {
        Self::of(Widths::new(alpha_x, alpha_y))
    }

    const fn of(widths: Widths) -> Self {
        Self { alpha_x: widths.x, alpha_y: widths.y }
    }

    const fn widths(&self) -> Widths {
        Widths { x: self.alpha_x, y: self.alpha_y }
    }

    /// Width α of the perceptual roughness in scene files: its square root.
    pub fn alpha_from_roughness(roughness: f32) -> f32 {
        roughness.max(0.0).sqrt()
    }

    /// The widths along x and y.
    pub fn alpha(&self) -> [f32; 2] {
        [self.alpha_x, self.alpha_y]
    }

    /// Whether both widths are too small to be told from a smooth interface: such a surface scatters
    /// into discrete directions, and D is not to be evaluated.
    pub fn is_smooth(&self) -> bool {
        self.widths().is_smooth()
    }

    /// Whether the distribution does not change under rotation about the normal.
    pub fn is_isotropic(&self) -> bool {
        self.alpha_x == self.alpha_y
    }

    /// Widens a narrow distribution: a named bias against fireflies (pbrt-v4 book, 14.2).
    #[must_use]
    pub fn regularized(self) -> Self {
        Self::of(self.widths().regularized())
    }

    /// Differential area of facets with normal `wm` per area and solid angle [sr⁻¹]; ∫ D cosθm dωm = 1.
    pub fn d(&self, wm: LocalDir) -> f32 {
        let (x, y) = (wm.x / self.alpha_x, wm.y / self.alpha_y);
        let s = x * x + y * y + wm.z * wm.z;
        1.0 / (PI * self.alpha_x * self.alpha_y * s * s)
    }

    /// Smith's Λ: ratio of the hidden to the visible projected area, Heitz 2014, eq. 72. Infinite at grazing.
    pub fn lambda(&self, w: LocalDir) -> f32 {
        0.5 * (self.stretched_length(w) / w.abs_cos_theta() - 1.0)
    }

    /// Share of the facets that `w` sees, 1 / (1 + Λ), Heitz 2014, eq. 43. Zero at grazing.
    pub fn g1(&self, w: LocalDir) -> f32 {
        self.g1_over_cos(w) * w.abs_cos_theta()
    }

    /// Share of the facets visible from both directions, height-correlated, 1 / (1 + Λo + Λi), Heitz 2014,
    /// eq. 99. Zero when either grazes.
    pub fn g(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        self.g_over_cosines(wo, wi) * (wo.z * wi.z).abs()
    }

    /// G1 / |cosθ|, finite at grazing.
    pub fn g1_over_cos(&self, w: LocalDir) -> f32 {
        2.0 / (w.abs_cos_theta() + self.stretched_length(w))
    }

    /// G / |cosθo cosθi|, finite unless both directions graze.
    pub fn g_over_cosines(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        2.0 / (wi.abs_cos_theta() * self.stretched_length(wo)
            + wo.abs_cos_theta() * self.stretched_length(wi))
    }

    /// G / G1(wo): what is left of a direction drawn from the visible normals of `wo`. `wi` must not graze.
    pub fn g_over_g1(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        let (o, i) = (wo.abs_cos_theta(), wi.abs_cos_theta());
        let length = self.stretched_length(wo);
        i * (o + length) / (i * length + o * self.stretched_length(wi))
    }

    /// Density [sr⁻¹] of the facet normals that `w` sees: G1(w) |w·wm| D(wm) / |cosθ|, Heitz 2014, eq. 16.
    pub fn visible_pdf(&self, w: LocalDir, wm: LocalDir) -> f32 {
        self.g1_over_cos(w) * self.d(wm) * w.dot(*wm).abs()
    }

    /// |cosθ| √(1 + α² tan²θ), in a form that does not divide.
    fn stretched_length(&self, w: LocalDir) -> f32 {
        let (x, y) = (w.x * self.alpha_x, w.y * self.alpha_y);
        (x * x + y * y + w.z * w.z).sqrt()
    }

    /// A facet normal, in the upper hemisphere, with density [`TrowbridgeReitz::visible_pdf`] in u ∈ [0, 1)²;
    /// `w` may lie on either side and is seen from above (Dupuy & Benyoub 2023, listing 1).
    pub fn sample_visible(&self, w: LocalDir, u: Vec2) -> LocalDir {
        let w = if w.z < 0.0 { -*w } else { *w };
        let stretched = Vec3::new(w.x * self.alpha_x, w.y * self.alpha_y, w.z);
        let stretched = stretched * stretched.length_recip();
        let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
        let r = (1.0 - z * z).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (TAU * u.x).sin_cos();
        let h = Vec3::new(r * cos_phi, r * sin_phi, z) + stretched;
        // z ≥ 0 but for rounding; the floor keeps a normal at the rim of the hemisphere usable.
        let wm = Vec3::new(h.x * self.alpha_x, h.y * self.alpha_y, h.z.max(1e-6));
        LocalDir::new_unchecked(wm * wm.length_recip())
    }
}

/// The closed forms above, which need one root a direction.
impl Distribution for TrowbridgeReitz {
    fn alpha(&self) -> [f32; 2] {
        Self::alpha(self)
    }

    fn is_smooth(&self) -> bool {
        Self::is_smooth(self)
    }

    fn regularized(self) -> Self {
        Self::regularized(self)
    }

    fn d(&self, wm: LocalDir) -> f32 {
        Self::d(self, wm)
    }

    fn facing_area(&self, w: LocalDir) -> f32 {
        0.5 * (w.abs_cos_theta() + self.stretched_length(w))
    }

    fn sample_visible(&self, w: LocalDir, u: Vec2) -> LocalDir {
        Self::sample_visible(self, w, u)
    }

    fn g1_over_cos(&self, w: LocalDir) -> f32 {
        Self::g1_over_cos(self, w)
    }

    fn g_over_cosines(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        Self::g_over_cosines(self, wo, wi)
    }

    fn g_over_g1(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        Self::g_over_g1(self, wo, wi)
    }
}
