//! How film positions become rays in camera space: x right, y up, z forward (left-handed).

use super::contract::CameraError;
use super::screen::Screen;
use crate::math::warp::{concentric_disk, equal_area_square_to_sphere, spherical_direction};
use crate::math::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// A thin lens in front of the film.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    /// Radius of the aperture [scene units]; zero for a pinhole.
    pub radius: f32,
    /// Distance of the plane in focus along the optical axis [scene units].
    pub focal_distance: f32,
}

impl Lens {
    /// A pinhole: everything is in focus.
    pub const PINHOLE: Self = Self { radius: 0.0, focal_distance: 1e6 };

    fn check(&self) -> Result<(), CameraError> {
        if !(self.radius >= 0.0 && self.radius.is_finite()) {
            return Err(CameraError::LensRadius(self.radius));
        }
        if self.focal_distance.is_nan() || self.focal_distance <= 0.0 {
            return Err(CameraError::FocalDistance(self.focal_distance));
        }
        Ok(())
    }

    /// Bends the ray through the lens centre so that it leaves from a point of the lens and still meets the
    /// plane of focus where it did (thin-lens approximation; pbrt-v4 book, 5.2.3).
    fn refract(&self, ray: LocalRay, u: Vec2) -> LocalRay {
        if self.radius == 0.0 {
            return ray;
        }
        let on_lens = (self.radius * concentric_disk(u)).extend(0.0);
        let focus = ray.o + ray.d * (self.focal_distance / ray.d.z);
        let o = ray.o + on_lens;
        LocalRay { o, d: focus - o }
    }
}

/// A ray in camera space; its direction is not normalised.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalRay {
    pub(super) o: Vec3,
    pub(super) d: Vec3,
}

/// Which sphere-to-rectangle map a spherical camera uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SphereMap {
    /// The octahedral square in which every pixel sees the same solid angle (Clarberg 2008).
    EqualArea,
    /// Latitude and longitude.
    Equirectangular,
}

/// How a camera maps directions to the film.
#[derive(Clone, Copy, Debug)]
pub enum Projection {
    /// Central projection through a thin lens.
    Perspective(Perspective),
    /// Parallel projection along the optical axis.
    Orthographic(Orthographic),
    /// All directions around the camera.
    Spherical(Spherical),
}

/// A central projection; build with [`Projection::perspective`].
#[derive(Clone, Copy, Debug)]
pub struct Perspective {
    screen: Screen,
    lens: Lens,
    /// tan(fov / 2): screen units to slopes.
    slope: f32,
}

/// A parallel projection; build with [`Projection::orthographic`].
#[derive(Clone, Copy, Debug)]
pub struct Orthographic {
    screen: Screen,
    lens: Lens,
}

/// A view of the whole sphere; build with [`Projection::spherical`].
#[derive(Clone, Copy, Debug)]
pub struct Spherical {
    resolution: [u32; 2],
    map: SphereMap,
}

impl Projection {
    /// A perspective with `fov` degrees across the screen's [−1, 1], which is its shorter side.
    /// Fails unless 0 < fov < 180.
    pub fn perspective(screen: Screen, fov: f32, lens: Lens) -> Result<Self, CameraError> {
        if !(fov > 0.0 && fov < 180.0) {
            return Err(CameraError::FieldOfView(fov));
        }
        lens.check()?;
        let slope = (f64::from(fov).to_radians() * 0.5).tan() as f32;
        Ok(Self::Perspective(Perspective { screen, lens, slope }))
    }

    /// A parallel projection; the screen is measured in scene units.
    pub fn orthographic(screen: Screen, lens: Lens) -> Result<Self, CameraError> {
        lens.check()?;
        Ok(Self::Orthographic(Orthographic { screen, lens }))
    }

    /// A view of the whole sphere on a film of `resolution` pixels.
    pub fn spherical(resolution: [u32; 2], map: SphereMap) -> Result<Self, CameraError> {
        if resolution.contains(&0) {
            return Err(CameraError::EmptyFilm);
        }
        Ok(Self::Spherical(Spherical { resolution, map }))
    }

    /// Film size [px].
    pub fn resolution(&self) -> [u32; 2] {
        match self {
            Self::Perspective(p) => p.screen.resolution(),
            Self::Orthographic(p) => p.screen.resolution(),
            Self::Spherical(p) => p.resolution,
        }
    }

    /// The ray through a film position [px] and a point `lens` ∈ [0, 1)² of the aperture.
    pub(super) fn ray(&self, film: Vec2, lens: Vec2) -> LocalRay {
        match self {
            Self::Perspective(p) => {
                let d = (p.screen.at(film) * p.slope).extend(1.0);
                p.lens.refract(LocalRay { o: Vec3::ZERO, d }, lens)
            }
            Self::Orthographic(p) => {
                p.lens.refract(LocalRay { o: p.screen.at(film).extend(0.0), d: Vec3::Z }, lens)
            }
            Self::Spherical(p) => LocalRay { o: Vec3::ZERO, d: p.direction(film) },
        }
    }
}

impl Perspective {
    /// The lens.
    pub fn lens(&self) -> &Lens {
        &self.lens
    }
}

impl Spherical {
    /// The maps are defined around +z; the camera's up axis is y (pbrt-v4 book, 5.3).
    fn direction(&self, film: Vec2) -> Vec3 {
        let uv = film / Vec2::new(self.resolution[0] as f32, self.resolution[1] as f32);
        let d = match self.map {
            SphereMap::EqualArea => equal_area_square_to_sphere(wrap_octahedral(uv)),
            SphereMap::Equirectangular => spherical_direction(PI * uv.y, TAU * uv.x),
        };
        Vec3::new(d.x, d.z, d.y)
    }
}

/// Continues the octahedral square across its edges: each edge is folded onto itself, mirrored at its middle.
fn wrap_octahedral(mut uv: Vec2) -> Vec2 {
    if uv.x < 0.0 || uv.x > 1.0 {
        uv = Vec2::new(if uv.x < 0.0 { -uv.x } else { 2.0 - uv.x }, 1.0 - uv.y);
    }
    if uv.y < 0.0 || uv.y > 1.0 {
        uv = Vec2::new(1.0 - uv.x, if uv.y < 0.0 { -uv.y } else { 2.0 - uv.y });
    }
    uv
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_octahedral_square_continues_across_its_edges() {
        for (inside, outside) in [([0.001, 0.3], [-0.001, 0.3]), ([0.6, 0.999], [0.6, 1.001])] {
            let a = equal_area_square_to_sphere(Vec2::from(inside));
            let b = equal_area_square_to_sphere(wrap_octahedral(Vec2::from(outside)));
            assert!((a - b).length() < 0.01, "{inside:?}: {a} {b}");
        }
    }

    #[test]
    fn rays_through_the_lens_meet_on_the_plane_of_focus() {
        let screen = Screen::new([200, 100], None, None).unwrap();
        let lens = Lens { radius: 0.3, focal_distance: 4.0 };
        for p in [
            Projection::perspective(screen, 50.0, lens).unwrap(),
            Projection::orthographic(screen, lens).unwrap(),
        ] {
            let film = Vec2::new(150.0, 20.0);
            let centre = p.ray(film, Vec2::splat(0.5));
            let expected = centre.o + centre.d * (4.0 / centre.d.z);
            let mut reach = 0.0_f32;
            for i in 0..64 {
                let r = p.ray(film, Vec2::new((i % 8) as f32 + 0.5, (i / 8) as f32 + 0.5) / 8.0);
                let hit = r.o + r.d * (4.0 / r.d.z);
                assert!((hit - expected).length() < 1e-5, "{hit} {expected}");
                reach = reach.max((r.o - centre.o).length());
            }
            // The outermost of 8 × 8 concentric cells lies at 7/8 of the radius.
            assert!((reach - 0.3 * 7.0 / 8.0).abs() < 1e-4, "{reach}");
        }
    }
}
