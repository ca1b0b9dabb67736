//! Daylight through openings without glass, by skies whose luminance depends on elevation only.
//!
//! Sky components are illuminances over the horizontal illuminance of the whole sky (CIE 16:1970).

use super::configuration::parallel_rectangle_at_corner;
use std::f64::consts::PI;

/// A sky without sun or azimuth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sky {
    /// The same luminance everywhere.
    Uniform,
    /// The traditional overcast sky, L(γ) = L_z (1 + 2 sinγ)/3 (Moon & Spencer 1942; CIE S 011).
    Overcast,
}

impl Sky {
    /// Luminance at an elevation whose sine is given, in [0, 1], over that of the zenith.
    pub fn luminance(self, sin_elevation: f64) -> f64 {
        match self {
            Self::Uniform => 1.0,
            Self::Overcast => (1.0 + 2.0 * sin_elevation) / 3.0,
        }
    }

    /// Unobstructed horizontal illuminance over the zenith luminance [lx/(cd·m⁻²) = sr]: π, and 7π/9 for the overcast sky.
    pub fn horizontal(self) -> f64 {
        match self {
            Self::Uniform => PI,
            Self::Overcast => 7.0 * PI / 9.0,
        }
    }

    /// Unobstructed illuminance of a vertical plane over the horizontal one: ½, and (3/7)(½ + 4/(3π)) for the overcast sky.
    pub fn vertical_sky_component(self) -> f64 {
        match self {
            Self::Uniform => 0.5,
            Self::Overcast => 3.0 / 7.0 * (0.5 + 4.0 / (3.0 * PI)),
        }
    }
}

/// A rectangular opening in a vertical wall, seen from a point on a horizontal plane.
///
/// The sky behind long obstructions that run parallel to the wall is also one: their edge projects to a horizontal line on the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Distance of the wall [m], above 0.
    pub distance: f64,
    /// Sides of the opening, along the wall from the foot of the perpendicular [m], the smaller one first.
    pub sides: [f64; 2],
    /// Sill and head above the plane [m], the lower one first; what is below the plane does not count.
    pub heights: [f64; 2],
}

impl Window {
    /// Illuminance of the horizontal plane over the zenith luminance [sr].
    pub fn horizontal(&self, sky: Sky) -> f64 {
        let [sill, head] = self.heights.map(|h| h.max(0.0));
        let part = |side: f64| {
            from_floor(side, head, self.distance, sky) - from_floor(side, sill, self.distance, sky)
        };
        part(self.sides[1]) - part(self.sides[0])
    }

    /// The sky component: that illuminance over the unobstructed one.
    pub fn sky_component(&self, sky: Sky) -> f64 {
        self.horizontal(sky) / sky.horizontal()
    }
}

/// For a window that rises from the plane to height H and reaches W to one side at distance D: with h = H/D, β = atan(W/D),
/// k = h/√(1 + h²), s = sinβ, q = √(1 + h²), from E = ∫ L sinγ dω with dω = cosγ dγ dφ and tanγ ≤ h cosφ
/// (CIE 171:2006, 5.11; also Hopkinson, Petherbridge & Longmore, "Daylighting" (1966)):
///
/// uniform ½[β − atan(tanβ/q)/q]; overcast ⅓{½[β − atan(tanβ/q)/q] + ⅔[asin(ks) − k(1 − k²)s/√(1 − k²s²)]}.
fn from_floor(width: f64, height: f64, distance: f64, sky: Sky) -> f64 {
    let h = height / distance;
    let q = 1.0_f64.hypot(h);
    let beta = (width / distance).atan();
    let first = 0.5 * (beta - (width / distance / q).atan() / q);
    match sky {
        Sky::Uniform => first,
        Sky::Overcast => {
            let (k, s) = (h / q, beta.sin());
            let ks = k * s;
            let second = 2.0 / 3.0 * (ks.asin() - k * (1.0 - k * k) * s / (1.0 - ks * ks).sqrt());
            (first + second) / 3.0
        }
    }
}

/// A rectangular opening in a flat roof, seen from a point on a horizontal plane below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoofLight {
    /// Height above the plane [m], above 0.
    pub height: f64,
    /// Edges along x from the point above the plane's point [m], the smaller one first.
    pub x: [f64; 2],
    /// Edges along y likewise [m].
    pub y: [f64; 2],
}

impl RoofLight {
    /// Illuminance of the horizontal plane over the zenith luminance [sr]: ∫ cosθ dω (uniform), ⅓ ∫ (cosθ + 2 cos²θ) dω
    /// (overcast, where sinγ = cosθ).
    pub fn horizontal(&self, sky: Sky) -> f64 {
        let corner = |x: f64, y: f64| {
            let (a, b) = (x / self.height, y / self.height);
            let first = PI * parallel_rectangle_at_corner(a, b, 1.0);
            match sky {
                Sky::Uniform => first,
                Sky::Overcast => (first + 2.0 * squared_cosine_integral(a, b)) / 3.0,
            }
        };
        let ([x0, x1], [y0, y1]) = (self.x, self.y);
        corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
    }

    /// The sky component: that illuminance over the unobstructed one.
    pub fn sky_component(&self, sky: Sky) -> f64 {
        self.horizontal(sky) / sky.horizontal()
    }
}

/// ∫ cos²θ dω over [0, a] × [0, b] at height 1: ⅓[atan(ab/q) + (ab/q)(1/(1 + a²) + 1/(1 + b²))], q = √(1 + a² + b²): the second
/// axial moment of Arvo (1995), [`super::polygon::axial_moment`].
fn squared_cosine_integral(a: f64, b: f64) -> f64 {
    let (a2, b2) = (a * a, b * b);
    let ratio = a * b / (1.0 + a2 + b2).sqrt();
    (ratio.atan() + ratio * (1.0 / (1.0 + a2) + 1.0 / (1.0 + b2))) / 3.0
}

#[cfg(test)]
mod tests {
    use super::super::polygon::{axial_moment, projected_solid_angle};
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    #[test]
    fn a_window_has_the_checked_sky_components() {
        let window = Window { distance: 3.0, sides: [0.0, 2.0], heights: [0.0, 1.5] };
        assert!((window.sky_component(Sky::Overcast) - 0.011_471_98).abs() < 6e-9);
        assert!((window.sky_component(Sky::Uniform) - 0.017_042_96).abs() < 6e-9);
    }

    #[test]
    fn a_roof_light_has_the_checked_sky_components() {
        let roof = RoofLight { height: 3.0, x: [-0.5, 0.5], y: [-0.5, 0.5] };
        assert!((roof.sky_component(Sky::Overcast) - 0.043_589_8).abs() < 6e-8);
        assert!((roof.sky_component(Sky::Uniform) - 0.034_106_8).abs() < 6e-8);
    }

    #[test]
    fn openings_without_end_show_the_whole_sky() {
        assert!((Sky::Overcast.vertical_sky_component() - 0.396_177).abs() < 5e-7);
        for sky in [Sky::Uniform, Sky::Overcast] {
            let roof = RoofLight { height: 1.0, x: [-1e7, 1e7], y: [-1e7, 1e7] };
            assert!((roof.sky_component(sky) - 1.0).abs() < 1e-6);
            // One side of the sky, and each half of that by its own window.
            let wall = |sides| Window { distance: 1e-3, sides, heights: [0.0, 1e4] }.sky_component(sky);
            assert!((wall([-1e4, 1e4]) - 0.5).abs() < 1e-6, "{sky:?}");
            assert!((wall([-1e4, 0.0]) - 0.25).abs() < 1e-6, "{sky:?}");
        }
    }

    #[test]
    fn skies_light_the_horizontal_plane_as_the_integral_of_their_luminance() {
        let n = 20_000;
        for sky in [Sky::Uniform, Sky::Overcast] {
            // ∫ L sinγ dω = 2π ∫ L s ds over the sine s of elevation; vertical: ∫ L cosγ cosφ dω = 2 ∫ L √(1 − s²) ds.
            let (mut horizontal, mut vertical) = (0.0, 0.0);
            for i in 0..n {
                let s = (f64::from(i) + 0.5) / f64::from(n);
                horizontal += 2.0 * PI * sky.luminance(s) * s / f64::from(n);
                vertical += 2.0 * sky.luminance(s) * (1.0 - s * s).sqrt() / f64::from(n);
            }
            assert!((horizontal / sky.horizontal() - 1.0).abs() < 1e-6);
            assert!(
                (vertical / sky.horizontal() / sky.vertical_sky_component() - 1.0).abs() < 1e-5,
                "{sky:?}"
            );
        }
    }

    proptest! {
        #[test]
        fn openings_agree_with_axial_moments(
            d in 0.3..5.0_f64, x in -3.0..3.0_f64, w in 0.2..3.0_f64, z in 0.0..3.0_f64, h in 0.2..3.0_f64
        ) {
            // E/L_z = ⅓(τ₁ + 2τ₂) about the zenith.
            let sum = |v: &[DVec3]| {
                let e = projected_solid_angle(DVec3::ZERO, DVec3::Z, v).0;
                (e, (e + 2.0 * axial_moment(DVec3::ZERO, DVec3::Z, v, 2)) / 3.0)
            };
            let wall = [[x, z], [x + w, z], [x + w, z + h], [x, z + h]].map(|[y, z]| DVec3::new(d, y, z));
            let window = Window { distance: d, sides: [x, x + w], heights: [z, z + h] };
            let (uniform, overcast) = sum(&wall);
            prop_assert!((window.horizontal(Sky::Uniform) - uniform).abs() < 1e-12);
            prop_assert!((window.horizontal(Sky::Overcast) - overcast).abs() < 1e-12);
            let ceiling = [[x, z], [x + w, z], [x + w, z + h], [x, z + h]].map(|[x, y]| DVec3::new(x, y, d));
            let roof = RoofLight { height: d, x: [x, x + w], y: [z, z + h] };
            let (uniform, overcast) = sum(&ceiling);
            prop_assert!((roof.horizontal(Sky::Uniform) - uniform).abs() < 1e-12);
            prop_assert!((roof.horizontal(Sky::Overcast) - overcast).abs() < 1e-12);
        }
    }
}
