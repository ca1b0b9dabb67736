//! The goniophotometer for luminaires: the far-field distribution of everything that shines in a scene.
//!
//! Seen from infinity in direction d, a scene is a figure in the plane perpendicular to d. Its intensity is
//! I(d) = ∫ L(x, d) dA over that plane, A (19), (21); rays are traced backwards through a rectangle around the figure by the
//! integrator that renders the scene. What points emit directly no ray can meet: it is I(d) where nothing stands in between.

use super::plot::{Curve, Drawing, Polar, Scale, series_ink};
use super::precision::{Moments, Precision};
use super::session::{self, Block, Ending, Session};
use super::table::{Cell, Column, Table};
use crate::integrator::{Metering, Tally};
use crate::light::photometric::{Interpolation, Label, Luminaire, Opening, Outline, PhotometricWeb};
use crate::light::{Light, LightTarget};
use crate::math::warp::uniform_sphere;
use crate::math::{Dir, Frame, Ray, Vec2, Vec3, hash};
use crate::render::setup;
use crate::sampler::{Randomization, Sampler, SamplerKind};
use crate::scene::RenderJob;
use crate::shape::ReferencePoint;
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN, LANES, Sampled, Wavelengths, cie};
use crate::units::kind::{Flux, Intensity, Luminous, Radiant, Unit};
use crate::units::{Estimate, LUMENS_PER_WATT, Measured};
use glam::DVec3;

/// Samples of a direction in a block.
const BLOCK: u32 = 32;

/// Samples of the flux in a block.
const FLUX_BLOCK: u32 = 256;

/// A cell is precise enough by the session's relative precision of this share of the largest intensity, if its own is less:
/// dim directions need not be known better than they matter.
pub const DIM: f64 = 0.1;

/// How a luminaire is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LuminaireSettings {
    /// Half planes all around, at equal distance from C = 0 on; 1 for the mean around the axis.
    pub planes: u32,
    /// Intervals of γ from 0 to 180°, at least 1.
    pub gamma_steps: u32,
    /// Direction of γ = 0 in the scene's world, of any length but 0.
    pub nadir: [f64; 3],
    /// A direction in the half plane C = 0, not parallel to the nadir. C counts from it counterclockwise as seen from above,
    /// that is against the nadir.
    pub c0: [f64; 3],
    /// Most bounces of light on its way from a source.
    pub max_depth: u32,
}

impl Default for LuminaireSettings {
    /// 24 planes and 36 intervals of 5°, nadir at −z and C0 at +x.
    fn default() -> Self {
        Self { planes: 24, gamma_steps: 36, nadir: [0.0, 0.0, -1.0], c0: [1.0, 0.0, 0.0], max_depth: 1000 }
    }
}

/// Why a scene is no luminaire that can be measured.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LuminaireError {
    /// The scene is for legacy shading.
    #[error(
        "the scene asks for integrator \"classic\", legacy shading that is no light transport: it cannot be measured"
    )]
    NotTransport,
    /// A light without a place.
    #[error(
        "the scene has a light \"{0}\", which is infinitely far away: a luminaire has all its lights in itself"
    )]
    AtInfinity(&'static str),
    /// The scene is dark.
    #[error("the scene has no light")]
    NoLight,
    /// Nadir or C0.
    #[error("the nadir and C0 must be two directions that are not parallel")]
    Axes,
    /// Number of planes or of intervals.
    #[error("a grid has 1 to 720 planes and 1 to 1800 intervals of γ, not {planes} and {gamma_steps}")]
    Grid {
        /// Planes.
        planes: u32,
        /// Intervals of γ.
        gamma_steps: u32,
    },
}

/// A far-field distribution in domain `D`.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution<D = Luminous>
where
    Intensity: Unit<D>,
    Flux: Unit<D>,
{
    /// C of the half planes [°].
    pub planes: Vec<f64>,
    /// γ [°].
    pub gamma: Vec<f64>,
    /// Intensities, all γ of a plane after each other. The planes share those at γ = 0 and 180°.
    pub cells: Vec<Measured<Intensity, D>>,
    /// The integral of the table, interpolated between its cells; what lies between them was not seen.
    pub table_flux: Measured<Flux, D>,
    /// The flux, from directions all over the sphere: what the table's spacing leaves out counts, too.
    pub flux: Measured<Flux, D>,
    /// Extent of the scene along C0, along C90 and along the nadir [m].
    pub extent: [f64; 3],
    /// Rays traced.
    pub rays: u64,
    /// Samples that were not finite and were left out.
    pub dropped: u64,
    /// Why no more were traced, for the table and for the flux.
    pub endings: [Ending; 2],
}

/// How wavelengths count.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Response {
    Luminous,
    Radiant,
}

impl Response {
    fn wavelengths(self, u: f32) -> Wavelengths {
        match self {
            Self::Luminous => Wavelengths::sample_visible(u),
            Self::Radiant => Wavelengths::sample_uniform(u, LAMBDA_MIN, LAMBDA_MAX),
        }
    }

    /// One sample of the integral over wavelengths.
    fn integral<Q>(self, found: &Sampled<Q>, w: &Wavelengths) -> f64 {
        let weight = |lambda: f32| match self {
            Self::Luminous => LUMENS_PER_WATT * cie::y_bar(lambda),
            Self::Radiant => 1.0,
        };
        let lanes = (0..LANES).filter(|&i| w.pdf()[i] > 0.0);
        lanes.map(|i| f64::from(found[i] * weight(w.lambda()[i])) / f64::from(w.pdf()[i])).sum::<f64>()
            / LANES as f64
    }
}

/// Luminous intensity [cd] in all directions of the grid, and the luminous flux [lm], each as precise as the session asks.
///
/// # Errors
/// When the scene is for legacy shading, has no light or one at infinity, or the settings make no grid.
pub fn measure(
    job: &RenderJob,
    settings: &LuminaireSettings,
    session: &Session<'_>,
) -> Result<Distribution, LuminaireError> {
    measure_as(job, settings, session, Response::Luminous)
}

/// Radiant intensity [W·sr⁻¹] and flux [W] over 360–830 nm; as [`measure`] otherwise.
///
/// # Errors
/// As [`measure`].
pub fn measure_radiant(
    job: &RenderJob,
    settings: &LuminaireSettings,
    session: &Session<'_>,
) -> Result<Distribution<Radiant>, LuminaireError> {
    measure_as(job, settings, session, Response::Radiant)
}

fn measure_as<D>(
    job: &RenderJob,
    settings: &LuminaireSettings,
    session: &Session<'_>,
    response: Response,
) -> Result<Distribution<D>, LuminaireError>
where
    Intensity: Unit<D>,
    Flux: Unit<D>,
{
    let bench = Bench::new(job, settings, response)?;
    let grid = Grid::new(settings)?;
    let precision = &session.precision;
    let outcome = session.run(
        0,
        || Cells::new(grid.cells()),
        |cells, block| bench.take_table(&grid, cells, block),
        |cells| cells.demand(precision),
    );
    let flux = session.run(
        1,
        || Cells::new(1),
        |sum, block| bench.take_flux(sum, block),
        |sum| precision.demand(sum.estimates(precision)[0]),
    );
    let estimates = outcome.tally.estimates(precision);
    let cells = grid.indices().map(|cell| Measured::new(estimates[cell])).collect();
    Ok(Distribution {
        cells,
        table_flux: Measured::new(Estimate {
            value: grid.flux(&estimates.iter().map(|e| e.value).collect::<Vec<_>>(), Interpolation::Smooth),
            ..outcome.tally.table_flux.estimate(precision)
        }),
        flux: Measured::new(flux.tally.estimates(precision)[0]),
        extent: bench.extent(),
        rays: outcome.tally.tally.rays() + flux.tally.tally.rays(),
        dropped: outcome.tally.dropped + flux.tally.dropped,
        endings: [outcome.ending, flux.ending],
        planes: grid.planes,
        gamma: grid.gamma,
    })
}

/// Directions of a table.
struct Grid {
    /// C [°].
    planes: Vec<f64>,
    /// γ [°].
    gamma: Vec<f64>,
}

impl Grid {
    fn new(settings: &LuminaireSettings) -> Result<Self, LuminaireError> {
        let &LuminaireSettings { planes, gamma_steps, .. } = settings;
        if !(1..=720).contains(&planes) || !(1..=1800).contains(&gamma_steps) {
            return Err(LuminaireError::Grid { planes, gamma_steps });
        }
        Ok(Self {
            planes: (0..planes).map(|i| f64::from(i) * 360.0 / f64::from(planes)).collect(),
            gamma: (0..=gamma_steps).map(|i| f64::from(i) * 180.0 / f64::from(gamma_steps)).collect(),
        })
    }

    /// Cells that differ: both poles are one direction each.
    fn cells(&self) -> usize {
        2 + self.planes.len() * (self.gamma.len() - 2)
    }

    /// C and γ [°] of a cell, the first two being the poles; `u` chooses C where one plane stands for all.
    fn direction(&self, cell: usize, u: f32) -> [f64; 2] {
        let inner = self.gamma.len() - 2;
        match cell {
            0 => [0.0, 0.0],
            1 => [0.0, 180.0],
            _ if self.planes.len() == 1 => [360.0 * f64::from(u), self.gamma[1 + (cell - 2) % inner]],
            _ => [self.planes[(cell - 2) / inner], self.gamma[1 + (cell - 2) % inner]],
        }
    }

    /// The cell of each place of the table, all γ of a plane after each other.
    fn indices(&self) -> impl Iterator<Item = usize> + '_ {
        let (n, inner) = (self.gamma.len(), self.gamma.len() - 2);
        (0..self.planes.len() * n).map(move |i| match i % n {
            0 => 0,
            g if g == n - 1 => 1,
            g => 2 + (i / n) * inner + g - 1,
        })
    }

    /// The integral of a table of cells.
    fn flux(&self, values: &[f64], interpolation: Interpolation) -> f64 {
        let table = self.indices().map(|cell| values[cell]).collect();
        let web = PhotometricWeb::type_c(self.planes.clone(), self.gamma.clone(), table);
        web.map_or(0.0, |web| web.interpolated(interpolation).flux())
    }
}

/// Sums over blocks.
struct Cells {
    cells: Vec<CellSum>,
    /// The integral of each block's table, interpolated by straight lines.
    table_flux: Moments,
    /// The largest sample of all.
    largest: f64,
    tally: Tally,
    dropped: u64,
    /// Means of the block in work.
    block: Vec<f64>,
}

#[derive(Clone, Copy, Default)]
struct CellSum {
    moments: Moments,
    samples: u64,
    /// Whether any of them found light.
    is_lit: bool,
}

impl session::Tally for Cells {
    fn merge(&mut self, later: &Self) {
        for (sum, more) in self.cells.iter_mut().zip(&later.cells) {
            sum.moments.merge(&more.moments);
            sum.samples += more.samples;
            sum.is_lit |= more.is_lit;
        }
        self.table_flux.merge(&later.table_flux);
        self.largest = self.largest.max(later.largest);
        self.tally = self.tally.merge(later.tally);
        self.dropped += later.dropped;
    }

    fn rays(&self) -> u64 {
        // Directions without geometry cost samples, but no rays.
        self.tally.rays().max(self.cells.iter().map(|c| c.samples).sum())
    }
}

impl Cells {
    fn new(n: usize) -> Self {
        Self {
            cells: vec![CellSum::default(); n],
            table_flux: Moments::default(),
            largest: 0.0,
            tally: Tally::default(),
            dropped: 0,
            block: vec![0.0; n],
        }
    }

    fn add(&mut self, cell: usize, sample: f64) {
        self.cells[cell].samples += 1;
        if !sample.is_finite() {
            self.dropped += 1;
            return;
        }
        self.block[cell] += sample;
        self.cells[cell].is_lit |= sample > 0.0;
        self.largest = self.largest.max(sample);
    }

    fn close_block(&mut self, samples: u32) {
        for (cell, sum) in self.cells.iter_mut().zip(&mut self.block) {
            *sum /= f64::from(samples);
            cell.moments.add(*sum);
        }
    }

    /// Cells that found no light among n samples: with the session's confidence, light is less frequent than −ln(1 − c)/n, and
    /// none is assumed to be brighter than the brightest sample of the whole measurement.
    fn estimates(&self, precision: &Precision) -> Vec<Estimate> {
        let dark = |c: &CellSum| -(1.0 - precision.confidence).ln() / c.samples.max(1) as f64 * self.largest;
        let estimate = |c: &CellSum| match c.is_lit {
            true => c.moments.estimate(precision),
            false => Estimate { value: 0.0, half_width: dark(c) },
        };
        self.cells.iter().map(estimate).collect()
    }

    fn demand(&self, precision: &Precision) -> f64 {
        let estimates = self.estimates(precision);
        let peak = estimates.iter().map(|e| e.value).fold(0.0, f64::max);
        let floor = precision.absolute.max(precision.relative * DIM * peak);
        let precision = Precision { absolute: floor, ..*precision };
        estimates.iter().map(|e| precision.demand(*e)).fold(0.0, f64::max)
    }
}

/// A luminaire before a detector far away.
struct Bench<'j> {
    job: &'j RenderJob,
    integrator: Box<dyn Metering + 'j>,
    response: Response,
    /// Directions of the nadir, of C0 and of C90 in the scene's world.
    axes: [DVec3; 3],
    /// Lights that rays cannot meet.
    points: Vec<&'j Light>,
    /// Square metres of a square scene unit.
    area: f64,
    time: f32,
}

impl<'j> Bench<'j> {
    fn new(
        job: &'j RenderJob,
        settings: &LuminaireSettings,
        response: Response,
    ) -> Result<Self, LuminaireError> {
        let lights = job.scene.lights();
        if let Some(light) = lights.iter().find(|l| l.is_infinite()) {
            return Err(LuminaireError::AtInfinity(light.kind()));
        }
        if lights.is_empty() {
            return Err(LuminaireError::NoLight);
        }
        let integrator = setup::metering(job, settings.max_depth).ok_or(LuminaireError::NotTransport)?;
        let unit = |v: DVec3| v.try_normalize().ok_or(LuminaireError::Axes);
        let nadir = unit(DVec3::from_array(settings.nadir))?;
        let towards = unit(DVec3::from_array(settings.c0))?;
        let across = towards - nadir * towards.dot(nadir);
        if across.length() < 1e-6 {
            return Err(LuminaireError::Axes);
        }
        let c0 = unit(across)?;
        Ok(Self {
            job,
            integrator,
            response,
            axes: [nadir, c0, (-nadir).cross(c0)],
            points: lights.iter().filter(|l| l.place(Vec2::ZERO).is_some()).collect(),
            area: f64::from(job.meters_per_unit) * f64::from(job.meters_per_unit),
            time: job.scene.camera().shutter()[0],
        })
    }

    /// Extent of the geometry along C0, C90 and the nadir [m].
    fn extent(&self) -> [f64; 3] {
        let bounds = self.job.scene.accel().bounds();
        if bounds.is_empty() {
            return [0.0; 3];
        }
        let [nadir, c0, c90] = self.axes;
        let corners = bounds.corners().map(|p| self.job.world_from_render.point(p).as_dvec3());
        [c0, c90, nadir].map(|axis| {
            let along = corners.map(|p| p.dot(axis));
            let (lo, hi) =
                (along.into_iter().fold(f64::MAX, f64::min), along.into_iter().fold(f64::MIN, f64::max));
            (hi - lo) * f64::from(self.job.meters_per_unit)
        })
    }

    /// A direction of the grid [°] in render space.
    fn direction(&self, [c, gamma]: [f64; 2]) -> Option<Dir> {
        let [nadir, c0, c90] = self.axes;
        let ((sin_c, cos_c), (sin_g, cos_g)) = (c.to_radians().sin_cos(), gamma.to_radians().sin_cos());
        let d = nadir * cos_g + (c0 * cos_c + c90 * sin_c) * sin_g;
        Dir::new(self.job.world_from_render.inverse().vector(d.as_vec3()))
    }

    fn take_table(&self, grid: &Grid, cells: &mut Cells, block: Block) {
        for cell in 0..grid.cells() {
            let mut sampler = new_sampler(BLOCK, hash::combine(block.seed, cell as u64));
            for index in 0..BLOCK {
                sampler.start([0, 0], index);
                let around = sampler.next_1d();
                let sample = match self.direction(grid.direction(cell, around)) {
                    Some(d) => self.intensity(d, &mut sampler, &mut cells.tally),
                    None => 0.0,
                };
                cells.add(cell, sample);
            }
        }
        cells.close_block(BLOCK);
        // Cubics through noise would not be right in the mean; their spread is that of straight lines.
        cells.table_flux.add(grid.flux(&cells.block, Interpolation::Linear));
        cells.block.fill(0.0);
    }

    /// Φ = ∫ I dω over the sphere.
    fn take_flux(&self, sum: &mut Cells, block: Block) {
        let mut sampler = new_sampler(FLUX_BLOCK, block.seed);
        for index in 0..FLUX_BLOCK {
            sampler.start([0, 0], index);
            let d = Dir::new_unchecked(uniform_sphere(sampler.next_2d()));
            let sample = self.intensity(d, &mut sampler, &mut sum.tally) * 4.0 * std::f64::consts::PI;
            sum.add(0, sample);
        }
        sum.close_block(FLUX_BLOCK);
        sum.block.fill(0.0);
    }

    /// One sample of the intensity in a direction of render space.
    fn intensity(&self, d: Dir, sampler: &mut Sampler, tally: &mut Tally) -> f64 {
        let mut w = self.response.wavelengths(sampler.next_1d());
        let mut sum = 0.0;
        for light in &self.points {
            sum += self.response.integral(&self.point_intensity(light, d, sampler.next_2d(), &w, tally), &w);
        }
        let u = sampler.next_2d();
        if let Some(Window { ray, area }) = self.window(d, u) {
            let radiance = self.integrator.radiance(&self.job.scene, ray, &mut w, sampler, tally, None);
            sum += self.response.integral(&radiance, &w) * area;
        }
        sum * self.area
    }

    /// Intensity of a light without extent, or of a point of its opening; zero where something stands in the way.
    fn point_intensity(
        &self,
        light: &Light,
        d: Dir,
        u: Vec2,
        w: &Wavelengths,
        tally: &mut Tally,
    ) -> Sampled<crate::units::Radiance> {
        let scene = &self.job.scene;
        let Some(place) = light.place(u) else { return Sampled::ZERO };
        // Any distance would do but for rounding: E r².
        let r = place.abs().max_element().max(1.0);
        let from = ReferencePoint::free(place + *d * r, self.time);
        let Some(sample) = light.sample(&from, scene.shapes(), 0, u, w) else { return Sampled::ZERO };
        tally.shadow_rays += 1;
        let leaving = ReferencePoint::free(place, self.time);
        match scene.is_occluded(&leaving, &LightTarget::Infinite, d) {
            true => Sampled::ZERO,
            false => sample.radiance * (r * r),
        }
    }

    /// A ray against `d` through the rectangle that holds the scene as seen from there; `None` where it shows no area.
    fn window(&self, d: Dir, u: Vec2) -> Option<Window> {
        let bounds = self.job.scene.accel().bounds();
        if bounds.is_empty() {
            return None;
        }
        let frame = Frame::from_z(d);
        let (centre, radius) = bounds.bounding_sphere();
        let corners = bounds.corners().map(|p| p - centre);
        let half = |axis: Vec3| corners.iter().map(|c| c.dot(axis).abs()).fold(0.0, f32::max);
        let (half_s, half_t) = (half(frame.s), half(frame.t));
        let area = 4.0 * f64::from(half_s) * f64::from(half_t);
        let at = 2.0 * u - Vec2::ONE;
        let o = centre + frame.s * (at.x * half_s) + frame.t * (at.y * half_t) + *d * (1.01 * radius);
        (area > 0.0).then_some(Window { ray: Ray { o, d: -*d, time: self.time }, area })
    }
}

/// A ray through a figure, and the area that its start was chosen from [square scene units].
struct Window {
    ray: Ray,
    area: f64,
}

fn new_sampler(n: u32, seed: u64) -> Sampler {
    Sampler::new(SamplerKind::PaddedSobol(Randomization::FastOwen), n, [1, 1], seed)
}

impl<D> Distribution<D>
where
    Intensity: Unit<D>,
    Flux: Unit<D>,
    D: Copy,
{
    /// The largest intensity.
    pub fn peak(&self) -> f64 {
        self.cells.iter().map(|c| c.value()).fold(0.0, f64::max)
    }

    /// The distribution as a table: a row for each direction.
    pub fn table(&self, settings: &LuminaireSettings, session: &Session<'_>) -> Table {
        let name = <Intensity as Unit<D>>::NAME;
        let columns = vec![
            Column::new("C", "°"),
            Column::new("γ", "°"),
            Column::new(name, <Intensity as Unit<D>>::UNIT),
        ];
        let mut table = Table::new(format!("far-field {name} of a luminaire"), columns);
        let n = self.gamma.len();
        for (i, cell) in self.cells.iter().enumerate() {
            table.rows.push(vec![
                self.planes[i / n].into(),
                self.gamma[i % n].into(),
                Cell::from(cell.estimate()),
            ]);
        }
        let axis = |v: [f64; 3]| format!("({}, {}, {})", v[0], v[1], v[2]);
        let around = if self.planes.len() == 1 { "; mean over all C" } else { "" };
        table.fact("flux", format!("{}, from directions all over the sphere", self.flux));
        table.fact("flux of the table", format!("{}, interpolated between its cells", self.table_flux));
        table.fact("γ", format!("0 towards the nadir {} of the scene's world", axis(settings.nadir)));
        table.fact("C", format!("0 towards {}, counterclockwise from above{around}", axis(settings.c0)));
        table.fact(
            "extent along C0, C90, nadir",
            format!("{:.6}, {:.6}, {:.6} m", self.extent[0], self.extent[1], self.extent[2]),
        );
        let percent = 100.0 * session.precision.confidence;
        table.fact("confidence", format!("{percent} % of each number for itself, statistical only"));
        let share = 100.0 * session.precision.relative;
        table.fact(
            "precision asked for",
            format!("{share} % of each number, and of {:.0} % of the largest where it is less", 100.0 * DIM),
        );
        table.fact("rays", self.rays.to_string());
        table.fact("ending", format!("{}; flux: {}", self.endings[0].name(), self.endings[1].name()));
        if self.dropped > 0 {
            table.fact("left out", format!("{} samples that were not finite", self.dropped));
        }
        table.fact("seed", session.seed.to_string());
        table
    }

    /// Polar curves of the planes C0–C180 and C90–C270, or of those next to them.
    pub fn drawing(&self) -> Drawing {
        let n = self.gamma.len();
        let nearest = |c: f64| {
            let apart = |p: f64| ((p - c).rem_euclid(360.0)).min((c - p).rem_euclid(360.0));
            (0..self.planes.len())
                .min_by(|&a, &b| apart(self.planes[a]).total_cmp(&apart(self.planes[b])))
                .unwrap_or(0)
        };
        let curve = |index: usize, c: f64| {
            let (right, left) = (nearest(c), nearest(c + 180.0));
            let value = |plane: usize, g: usize| self.cells[plane * n + g].value();
            let points = (1..n).rev().map(|g| [-self.gamma[g], value(left, g)]);
            let points = points.chain((0..n).map(|g| [self.gamma[g], value(right, g)]));
            let label = format!("C{:.0} – C{:.0}", self.planes[right], self.planes[left]);
            Curve::new(label, series_ink(index), points.collect())
        };
        let curves = match self.planes.len() {
            1 => vec![Curve { label: "mean over C".to_owned(), ..curve(0, 0.0) }],
            _ => vec![curve(0, 0.0), curve(1, 90.0)],
        };
        Polar {
            title: format!("flux {}; γ from the nadir, which is at the top", self.flux),
            radius: format!("{} [{}]", <Intensity as Unit<D>>::NAME, <Intensity as Unit<D>>::UNIT),
            scale: Scale::Linear,
            curves,
            rays: Vec::new(),
        }
        .draw()
    }
}

impl Distribution {
    /// The luminaire for a photometric file, `name` being its description. Its opening is the extent of the scene.
    pub fn luminaire(&self, name: &str) -> Luminaire {
        let candela = self.cells.iter().map(|c| c.value().max(0.0)).collect();
        let web = PhotometricWeb::type_c(self.planes.clone(), self.gamma.clone(), candela);
        // The grid is one that a web takes.
        debug_assert!(web.is_ok());
        let label =
            Label { name: name.to_owned(), report: "computed by Steradian".to_owned(), ..Label::default() };
        let [along_c0, along_c90, height] = self.extent;
        let opening = Opening { along_c0, along_c90, height, outline: Outline::Rectangle };
        Luminaire { label, opening, ..Luminaire::of(web.unwrap_or_else(|_| PhotometricWeb::dark())) }
    }
}
