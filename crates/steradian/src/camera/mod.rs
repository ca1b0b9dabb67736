//! Cameras: from film positions to rays in render space.
//!
//! Camera space is left-handed, x right, y up, z forward; film positions are in pixels, y downwards,
//! pixel (0, 0) covering [0, 1)².

mod contract;
mod projection;
mod screen;

use crate::math::{AnimatedTransform, Dir, Frame, Normal, Point, Ray, Transform, Vec2, Vec3};

pub use contract::{CameraError, CameraRay, CameraSample, PointMotion};
pub use projection::{Lens, Orthographic, Perspective, Projection, SphereMap, Spherical};
pub use screen::Screen;

/// A camera in the scene.
#[derive(Clone, Debug)]
pub struct Camera {
    render_from_camera: AnimatedTransform,
    shutter: [f32; 2],
    projection: Projection,
    least: LeastDifferentials,
}

impl Camera {
    /// A camera that is open from `shutter[0]` to `shutter[1]` [s].
    pub fn new(
        projection: Projection,
        render_from_camera: AnimatedTransform,
        shutter: [f32; 2],
    ) -> Result<Self, CameraError> {
        if !(shutter[0] <= shutter[1] && shutter[0].is_finite() && shutter[1].is_finite()) {
            return Err(CameraError::Shutter(shutter));
        }
        let least = LeastDifferentials::find(&projection);
        Ok(Self { render_from_camera, shutter, projection, least })
    }

    /// The ray of a sample; `None` when the sample sees nothing.
    pub fn ray(&self, sample: &CameraSample) -> Option<CameraRay> {
        let local = self.projection.ray(sample.film, sample.lens);
        let time = self.time(sample.time);
        self.render_from_camera.through(time, |to_render| {
            let d = Dir::new(to_render.vector(local.d))?;
            Some(CameraRay { ray: Ray { o: to_render.point(Point(local.o)), d: *d, time }, weight: 1.0 })
        })
    }

    /// Film size [px].
    pub fn resolution(&self) -> [u32; 2] {
        self.projection.resolution()
    }

    /// When the shutter opens and closes [s].
    pub fn shutter(&self) -> [f32; 2] {
        self.shutter
    }

    /// The camera's placement, `render_from_camera`.
    pub fn placement(&self) -> &AnimatedTransform {
        &self.render_from_camera
    }

    /// How film positions become rays.
    pub fn projection(&self) -> &Projection {
        &self.projection
    }

    /// Where the camera is at the given shutter fraction in [0, 1].
    pub fn position(&self, time: f32) -> Point {
        self.render_from_camera.at(self.time(time)).point(Point::ORIGIN)
    }

    fn time(&self, u: f32) -> f32 {
        self.shutter[0] + (self.shutter[1] - self.shutter[0]) * u
    }

    /// Footprint of a pixel on the tangent plane at `p` with normal `n`, for a surface seen at any depth of a path.
    ///
    /// As if `p` were seen directly, along a ray with the least spread of all pixels (pbrt-v4 book, 10.1.1), scaled by
    /// max(1/8, 1/√spp), because many samples share a pixel. `time` in seconds. Zero where the tangent plane is seen edge-on.
    pub fn approximate_footprint(
        &self,
        p: Point,
        n: Normal,
        time: f32,
        samples_per_pixel: u32,
    ) -> PointMotion {
        self.render_from_camera.through(time, |to_render| self.footprint(to_render, p, n, samples_per_pixel))
    }

    fn footprint(&self, to_render: &Transform, p: Point, n: Normal, samples_per_pixel: u32) -> PointMotion {
        const NONE: PointMotion = PointMotion { dpdx: Vec3::ZERO, dpdy: Vec3::ZERO };
        let there = *to_render.point_back(p);
        let (Some(axis), n) = (Dir::new(there), to_render.normal_vector_back(*n)) else { return NONE };
        let distance = axis.dot(there);
        let turned = Turned::new(axis);
        // Of any length: only ratios of its components count.
        let n = Vec3::new(n.dot(turned.x), n.dot(turned.y), n.dot(*axis));
        // Offset rays start near the camera and run near the z axis; both meet the plane n·x = n_z distance.
        let meet = |o: Vec3, d: Vec3| o + d * ((n.z * distance - n.dot(o)) / n.dot(d));
        let here = Vec3::Z * distance;
        let scale = (1.0 / (samples_per_pixel.max(1) as f32).sqrt()).max(0.125);
        let motion = |o: Vec3, d: Vec3| {
            let moved = to_render.vector(turned.back(meet(o, Vec3::Z + d) - here)) * scale;
            if moved.is_finite() { moved } else { Vec3::ZERO }
        };
        let least = &self.least;
        PointMotion { dpdx: motion(least.origin_x, least.dir_x), dpdy: motion(least.origin_y, least.dir_y) }
    }
}

/// The frame that the shortest rotation of the camera's takes its z axis to `z` by.
struct Turned {
    x: Vec3,
    y: Vec3,
    z: Dir,
}

impl Turned {
    fn new(z: Dir) -> Self {
        // Rodrigues' rotation about z × Z, without a root; behind the camera any frame does.
        let k = 1.0 / (1.0 + z.z).max(1e-6);
        let half = *z + Vec3::Z;
        Self { x: Vec3::X - half * (z.x * k), y: Vec3::Y - half * (z.y * k), z }
    }

    fn back(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + *self.z * v.z
    }
}

/// The least change of a ray from one pixel to the next, over the film's diagonal, in camera space.
#[derive(Clone, Copy, Debug)]
struct LeastDifferentials {
    origin_x: Vec3,
    origin_y: Vec3,
    /// Change of the unit direction in a frame whose z axis is that direction.
    dir_x: Vec3,
    dir_y: Vec3,
}

impl LeastDifferentials {
    fn find(projection: &Projection) -> Self {
        const STEPS: u32 = 512;
        let far = Vec3::INFINITY;
        let mut least = Self { origin_x: far, origin_y: far, dir_x: far, dir_y: far };
        let keep = |least: &mut Vec3, v: Vec3| {
            if v.length_squared() < least.length_squared() {
                *least = v;
            }
        };
        let [width, height] = projection.resolution();
        let centre = Vec2::splat(0.5);
        for i in 0..STEPS {
            let film = Vec2::new(width as f32, height as f32) * (i as f32 / (STEPS - 1) as f32);
            let here = projection.ray(film, centre);
            let Some(d) = Dir::new(here.d) else { continue };
            let frame = Frame::from_z(*d);
            let change = |step: Vec2| {
                let there = projection.ray(film + step, centre);
                let turned = Dir::new(there.d).map(|t| *frame.to_local(t) - Vec3::Z);
                (there.o - here.o, turned)
            };
            let (ox, dx) = change(Vec2::X);
            let (oy, dy) = change(Vec2::Y);
            keep(&mut least.origin_x, ox);
            keep(&mut least.origin_y, oy);
            if let Some(dx) = dx {
                keep(&mut least.dir_x, dx);
            }
            if let Some(dy) = dy {
                keep(&mut least.dir_y, dy);
            }
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Transform;

    fn camera(projection: Projection, t: Transform) -> Camera {
        Camera::new(projection, AnimatedTransform::fixed(t), [0.0, 1.0]).unwrap()
    }

    fn perspective(resolution: [u32; 2], fov: f32) -> Projection {
        Projection::perspective(Screen::new(resolution, None, None).unwrap(), fov, Lens::PINHOLE).unwrap()
    }

    fn direction(c: &Camera, film: [f32; 2]) -> Vec3 {
        c.ray(&CameraSample { film: film.into(), lens: Vec2::splat(0.5), time: 0.0 }).unwrap().ray.d
    }

    #[test]
    fn the_field_of_view_spans_the_shorter_side() {
        // 90° across the short side: its edges are seen at slope 1, those of the long side at the aspect ratio.
        let wide = camera(perspective([400, 200], 90.0), Transform::IDENTITY);
        let d = direction(&wide, [200.0, 0.0]);
        assert!((d.y / d.z - 1.0).abs() < 1e-6 && d.x.abs() < 1e-6, "top is up: {d}");
        let d = direction(&wide, [400.0, 100.0]);
        assert!((d.x / d.z - 2.0).abs() < 1e-6 && d.y.abs() < 1e-6, "right is right: {d}");
        let tall = camera(perspective([200, 400], 60.0), Transform::IDENTITY);
        let d = direction(&tall, [0.0, 200.0]);
        assert!((d.x / d.z + 30.0_f32.to_radians().tan()).abs() < 1e-6, "{d}");
        let d = direction(&tall, [100.0, 400.0]);
        assert!((d.y / d.z + 2.0 * 30.0_f32.to_radians().tan()).abs() < 1e-6, "{d}");
    }

    #[test]
    fn screen_window_and_aspect_override_the_resolution() {
        let screen = Screen::new([100, 100], Some(2.0), None).unwrap();
        assert_eq!(screen.at(Vec2::new(100.0, 0.0)), Vec2::new(2.0, 1.0));
        let screen = Screen::new([100, 50], None, Some([0.0, 0.5, -1.0, 0.25])).unwrap();
        assert_eq!(screen.at(Vec2::ZERO), Vec2::new(0.0, 0.25));
        assert_eq!(screen.at(Vec2::new(100.0, 50.0)), Vec2::new(0.5, -1.0));
        assert!(Screen::new([0, 5], None, None).is_err() && Screen::new([5, 5], Some(-1.0), None).is_err());
    }

    #[test]
    fn the_placement_moves_with_the_shutter() {
        let end = Transform::translate(Vec3::new(4.0, 0.0, 0.0));
        let moving = AnimatedTransform::new(Transform::IDENTITY, end, [10.0, 12.0]);
        let c = Camera::new(perspective([10, 10], 40.0), moving, [10.0, 11.0]).unwrap();
        let sample = CameraSample { film: Vec2::splat(5.0), lens: Vec2::ZERO, time: 0.5 };
        let r = c.ray(&sample).unwrap().ray;
        assert_eq!((r.time, *r.o, r.d), (10.5, Vec3::new(1.0, 0.0, 0.0), Vec3::Z));
    }

    #[test]
    fn orthographic_rays_are_parallel_and_start_on_the_screen() {
        let screen = Screen::new([100, 50], None, Some([-3.0, 3.0, -1.5, 1.5])).unwrap();
        let c = camera(Projection::orthographic(screen, Lens::PINHOLE).unwrap(), Transform::IDENTITY);
        let sample = CameraSample { film: Vec2::new(75.0, 0.0), lens: Vec2::ZERO, time: 0.0 };
        let r = c.ray(&sample).unwrap().ray;
        assert_eq!((*r.o, r.d), (Vec3::new(1.5, 1.5, 0.0), Vec3::Z));
    }

    #[test]
    fn spherical_films_see_every_direction_once() {
        for map in [SphereMap::EqualArea, SphereMap::Equirectangular] {
            let c = camera(Projection::spherical([128, 64], map).unwrap(), Transform::IDENTITY);
            // Mean of d dᵀ with the solid angle of each pixel as weight is 1/3 on the diagonal.
            let (mut second, mut total) = (Vec3::ZERO, 0.0);
            for y in 0..64 {
                for x in 0..128 {
                    let d = direction(&c, [x as f32 + 0.5, y as f32 + 0.5]);
                    let weight = match map {
                        SphereMap::EqualArea => 1.0,
                        SphereMap::Equirectangular => (1.0 - d.y * d.y).sqrt(),
                    };
                    second += d * d * weight;
                    total += weight;
                }
            }
            assert!((second / total - Vec3::splat(1.0 / 3.0)).abs().max_element() < 1e-3, "{map:?} {second}");
        }
        let c = camera(
            Projection::spherical([100, 50], SphereMap::Equirectangular).unwrap(),
            Transform::IDENTITY,
        );
        // The first row looks up, the middle of the film along φ = π, that is −x.
        assert!((direction(&c, [30.0, 0.0]) - Vec3::Y).length() < 1e-6);
        assert!((direction(&c, [50.0, 25.0]) + Vec3::X).length() < 1e-6);
    }

    #[test]
    fn the_footprint_of_a_facing_plane_is_a_pixel_of_it() {
        let t = Transform::look_at(Point::new(3.0, 1.0, 2.0), Point::new(3.0, 5.0, 2.0), Vec3::Z)
            .unwrap()
            .inverse();
        let c = camera(perspective([100, 100], 2.0), t);
        // At 4 units a film of 100 px and 2° spans 8 tan 1°; with one sample a pixel is a hundredth of it.
        let n = Normal::new(-Vec3::Y).unwrap();
        let f = c.approximate_footprint(Point::new(3.0, 5.0, 2.0), n, 0.0, 1);
        let pixel = 8.0 * 1.0_f32.to_radians().tan() / 100.0;
        // The least spread is that of the corner, cos²(1.41°) below the centre's.
        assert!((f.dpdx.length() / pixel - 1.0).abs() < 1e-3, "{f:?} {pixel}");
        assert!(
            (f.dpdy.length() / pixel - 1.0).abs() < 1e-3 && f.dpdx.dot(f.dpdy).abs() < 1e-3 * pixel * pixel
        );
        assert!(f.dpdx.y.abs() < 1e-6, "stays in the plane: {f:?}");
        let shared = c.approximate_footprint(Point::new(3.0, 5.0, 2.0), n, 0.0, 16);
        assert!((shared.dpdx.length() * 4.0 / pixel - 1.0).abs() < 1e-3);
        // A plane tilted by 60° is stretched twofold in one direction.
        let tilted = Normal::new(Vec3::new(0.0, -0.5, 0.75_f32.sqrt())).unwrap();
        let f = c.approximate_footprint(Point::new(3.0, 5.0, 2.0), tilted, 0.0, 1);
        let area = f.dpdx.cross(f.dpdy).length() / (pixel * pixel);
        assert!((area - 2.0).abs() < 0.02, "{area}");
    }
}
