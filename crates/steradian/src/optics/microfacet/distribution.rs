//! What every distribution of microfacet normals promises.

use crate::math::{LocalDir, Vec2};

/// Below this width along both axes a surface is treated as perfectly smooth.
const SMOOTH_ALPHA: f32 = 1e-3;

/// Narrowest lobe along one axis of an anisotropic distribution: D stays finite in f32.
const MIN_ALPHA: f32 = 1e-4;

/// Steepest facets: a hundred times beyond the roughest surfaces, and far from where D underflows.
const MAX_ALPHA: f32 = 100.0;

/// Slope widths along the axes of the shading frame; zero along both for a smooth surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Widths {
    pub(super) x: f32,
    pub(super) y: f32,
}

impl Widths {
    /// No microfacets.
    pub(super) const SMOOTH: Self = Self { x: 0.0, y: 0.0 };

    /// `x`, `y` ≥ 0, limited to what f32 can tell from a smooth surface.
    pub(super) fn new(x: f32, y: f32) -> Self {
        debug_assert!(x >= 0.0 && y >= 0.0, "{x} {y}");
        let mut widths = Self { x, y };
        if !widths.is_smooth() {
            widths.x = x.clamp(MIN_ALPHA, MAX_ALPHA);
            widths.y = y.clamp(MIN_ALPHA, MAX_ALPHA);
        }
        widths
    }

    pub(super) fn is_smooth(self) -> bool {
        self.x.max(self.y) < SMOOTH_ALPHA
    }

    pub(super) fn regularized(self) -> Self {
        let widen = |a: f32| if a < 0.3 { (2.0 * a).clamp(0.1, 0.3) } else { a };
        Self { x: widen(self.x), y: widen(self.y) }
    }
}

/// Microfacets by the slopes of their normals, with Smith's height-correlated shadowing.
///
/// Directions may lie on either side and are seen from above; normals `wm` lie in the upper hemisphere. But for
/// [`Distribution::alpha`] and [`Distribution::is_smooth`], nothing is to be asked of a smooth surface.
pub trait Distribution: Copy {
    /// The widths along x and y.
    fn alpha(&self) -> [f32; 2];

    /// Whether both widths are too small to be told from a smooth interface: such a surface scatters
    /// into discrete directions, and D is not to be evaluated.
    fn is_smooth(&self) -> bool;

    /// Widens a narrow distribution: a named bias against fireflies (pbrt-v4 book, 14.2).
    #[must_use]
    fn regularized(self) -> Self;

    /// Differential area of facets with normal `wm` per area and solid angle [sr⁻¹]; ∫ D cosθm dωm = 1.
    fn d(&self, wm: LocalDir) -> f32;

    /// |cosθ| (1 + Λ): area of the facets that face `w`, projected along it, per area; finite and positive
    /// everywhere (Heitz 2014, eq. 22 and 43).
    fn facing_area(&self, w: LocalDir) -> f32;

    /// A facet normal with density [`Distribution::visible_pdf`] in u ∈ [0, 1)².
    fn sample_visible(&self, w: LocalDir, u: Vec2) -> LocalDir;

    /// G1 / |cosθ|, finite at grazing.
    fn g1_over_cos(&self, w: LocalDir) -> f32 {
        1.0 / self.facing_area(w)
    }

    /// G / |cosθo cosθi| with G = 1 / (1 + Λo + Λi), Heitz 2014, eq. 99; finite unless both directions graze.
    fn g_over_cosines(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        let (o, i) = (wo.abs_cos_theta(), wi.abs_cos_theta());
        1.0 / (i * self.facing_area(wo) + o * self.facing_area(wi) - o * i)
    }

    /// G / G1(wo): what is left of a direction drawn from the visible normals of `wo`. `wi` must not graze.
    fn g_over_g1(&self, wo: LocalDir, wi: LocalDir) -> f32 {
        let (o, i) = (wo.abs_cos_theta(), wi.abs_cos_theta());
        let facing = i * self.facing_area(wo);
        facing / (facing + o * self.facing_area(wi) - o * i)
    }

    /// Density [sr⁻¹] of the facet normals that `w` sees: G1(w) |w·wm| D(wm) / |cosθ|, Heitz 2014, eq. 16.
    fn visible_pdf(&self, w: LocalDir, wm: LocalDir) -> f32 {
        self.g1_over_cos(w) * self.d(wm) * w.dot(*wm).abs()
    }
}
