//! Mean illuminance over surfaces: a luxmeter that lies at random points of them.

use super::super::precision::{Moments, Precision};
use super::super::session::{Ending, Session, Tally};
use super::contract::Part;
use crate::integrator::{self, Metering, SensorPoint};
use crate::math::{BoundedPoint, Normal, Point, Vec3};
use crate::radiometry::opening::Rectangle;
use crate::scene::RenderJob;
use crate::spectrum::{LANES, Wavelengths, cie};
use crate::units::{Estimate, LUMENS_PER_WATT};

/// Points of a block.
const BLOCK: u32 = 256;

/// A point on a surface is lifted off it by this share of its largest coordinate, as luxmeters are.
const LIFT: f64 = 1.0 / 1_048_576.0;

#[derive(Clone, Debug, Default)]
struct Sums {
    moments: Moments,
    rays: integrator::Tally,
}

impl Tally for Sums {
    fn merge(&mut self, later: &Self) {
        self.moments.merge(&later.moments);
        self.rays = self.rays.merge(later.rays);
    }

    fn rays(&self) -> u64 {
        self.rays.rays()
    }
}

/// What the measurement came to.
pub(super) struct Mean {
    pub(super) lux: Estimate,
    pub(super) rays: u64,
    pub(super) ending: Ending,
}

/// The mean illuminance [lx] of the faces together, on the sides of their normals.
pub(super) fn illuminance(
    job: &RenderJob,
    integrator: &dyn Metering,
    faces: &[Rectangle],
    part: Part,
    session: &Session<'_>,
) -> Mean {
    let area: f64 = faces.iter().map(Rectangle::area).sum();
    let inverse = job.world_from_render.inverse();
    let place = |mut u: f64, v: [f32; 2]| {
        // The face by its share of the area, and the place on it.
        let mut chosen = faces.first()?;
        u *= area;
        for face in faces {
            chosen = face;
            if u < face.area() {
                break;
            }
            u -= face.area();
        }
        let [s, t] = v.map(f64::from);
        let world = chosen.corner + s * chosen.edges[0] + t * chosen.edges[1];
        let p = inverse.matrix().as_dmat4().transform_point3(world);
        let bound = world.abs().max_element().max(p.abs().max_element()) * LIFT;
        let n = inverse.normal(Normal::new(chosen.normal().as_vec3())?)?;
        let p = BoundedPoint { p: Point(p.as_vec3()), error: Vec3::splat(bound as f32) };
        Some(SensorPoint { p, n, time: job.scene.camera().shutter()[0] })
    };
    let precision: &Precision = &session.precision;
    let outcome = session.run(
        0,
        Sums::default,
        |sums, block| {
            let mut sampler = block.sampler(BLOCK);
            let mut sum = 0.0;
            for index in 0..BLOCK {
                sampler.start([0, 0], index);
                let mut w = Wavelengths::sample_visible(sampler.next_1d());
                let (u, v) = (f64::from(sampler.next_1d()), sampler.next_2d());
                let Some(sensor) = place(u, v.to_array()) else { continue };
                let arriving =
                    integrator.irradiance(&job.scene, &sensor, &mut w, &mut sampler, &mut sums.rays);
                let found = match part {
                    Part::Total => arriving.direct + arriving.indirect,
                    Part::Reflected => arriving.indirect,
                };
                for lane in 0..LANES {
                    let (lambda, pdf) = (w.lambda()[lane], w.pdf()[lane]);
                    if pdf > 0.0 && found[lane].is_finite() {
                        let weight = f64::from(LUMENS_PER_WATT * cie::y_bar(lambda) / pdf) / LANES as f64;
                        sum += weight * f64::from(found[lane]);
                    }
                }
            }
            sums.moments.add(sum / f64::from(BLOCK));
        },
        |sums| precision.demand(sums.moments.estimate(precision)),
    );
    Mean {
        lux: outcome.tally.moments.estimate(precision),
        rays: outcome.tally.rays(),
        ending: outcome.ending,
    }
}
