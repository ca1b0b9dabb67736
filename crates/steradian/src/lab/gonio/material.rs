//! A material as the sample: its scattering function is sampled and evaluated.

use super::super::session::Block;
use super::beam::{Face, Incidence};
use super::cells::CellGrid;
use super::census::{Census, Place};
use crate::bsdf::{Bsdf, Mode, Side};
use crate::math::{LocalDir, Vec2};
use crate::sampler::Sampler;
use crate::units::{Density, PdfSolidAngle};

/// Draws of a block from the scattering function.
const DRAWS: u32 = 512;
/// Draws of a block within each cell: a square number of strata, so that smooth lobes need few blocks.
const CELL_DRAWS: u32 = 16;

/// How cells are filled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Both ways, weighed by the power heuristic (Veach 1997): narrow lobes are found by drawing from the scattering
    /// function, dim cells by integrating over them.
    #[default]
    Combined,
    /// Directions are drawn from the scattering function and counted where they arrive, as photons are.
    Counting,
    /// The scattering function is integrated over each cell. Discrete directions are counted all the same.
    Integration,
}

impl Method {
    /// For people and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Combined => "counting and integration, combined by the power heuristic",
            Self::Counting => "counting",
            Self::Integration => "integration over cells, discrete directions by counting",
        }
    }
}

/// One setting of the instrument.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting<'a> {
    pub(super) grid: &'a CellGrid,
    pub(super) face: Face,
    pub(super) incidence: Incidence,
    pub(super) method: Method,
}

/// One block: light scattered by `bsdf`.
pub(super) fn block(census: &mut Census, block: Block, bsdf: &Bsdf<'_>, setting: &Setting<'_>) {
    let mut sampler = block.sampler(DRAWS);
    let lobes = bsdf.lobes();
    let of_cells = if setting.method == Method::Counting || !lobes.is_continuous() { 0 } else { CELL_DRAWS };
    let grid = setting.grid;
    for i in 0..DRAWS {
        sampler.start([0, 0], i);
        let bsdf = bsdf.with_seed(sampler.hash_seed());
        let from = incident(&mut sampler, setting);
        let Some(s) = bsdf.sample(from, sampler.next_1d(), sampler.next_2d(), Mode::Importance) else {
            continue;
        };
        let cell = grid.index(s.wi);
        let each = 1.0 / f64::from(DRAWS);
        census.witness(s.weight);
        let side = if from.same_hemisphere(s.wi) { Side::Reflection } else { Side::Transmission };
        let Density::SolidAngle(pdf) = s.density else {
            census.add(Place::Discrete(side, cell), s.weight, each);
            continue;
        };
        let drawn = f64::from(DRAWS) * f64::from(pdf.0);
        let share = match setting.method {
            Method::Counting => 1.0,
            Method::Combined => power(drawn, in_cell(grid, cell, s.wi, of_cells)),
            Method::Integration => continue,
        };
        census.add(Place::Cell(side, cell), s.weight, each * share);
    }
    let mut rays = u64::from(DRAWS);
    let sides = [(Side::Reflection, lobes.reflection), (Side::Transmission, lobes.transmission)];
    for (number, (side, _)) in
        sides.into_iter().enumerate().filter(|(_, (_, present))| *present && of_cells > 0)
    {
        for cell in 0..grid.len() {
            let patch = grid.cell(cell);
            for i in 0..of_cells {
                sampler.start([1 + cell as i32, number as i32], i);
                let bsdf = bsdf.with_seed(sampler.hash_seed());
                let from = incident(&mut sampler, setting);
                let towards = patch.direction(sampler.next_2d());
                let to = match side {
                    Side::Reflection => setting.face.turn(towards),
                    Side::Transmission => setting.face.other().turn(towards),
                };
                let drawn = match setting.method {
                    Method::Combined => f64::from(DRAWS) * f64::from(bsdf.pdf(from, to, Mode::Importance).0),
                    Method::Counting | Method::Integration => 0.0,
                };
                let density = in_cell(grid, cell, to, of_cells);
                let f = bsdf.eval(from, to, Mode::Importance);
                let weight = f.weight(to.abs_cos_theta(), PdfSolidAngle(density as f32));
                census.add(Place::Cell(side, cell), weight, power(density, drawn));
            }
        }
        rays += u64::from(of_cells) * grid.len() as u64;
    }
    census.close(u64::from(DRAWS), rays);
}

/// Veach's power heuristic with exponent 2. With the balance heuristic, a dim cell would owe a percent of its value to draws
/// from the scattering function that hardly ever arrive: blocks without any would agree with each other, and be wrong.
fn power(this: f64, other: f64) -> f64 {
    this * this / (this * this + other * other)
}

/// Density of all draws of a block that are made within a cell.
fn in_cell(grid: &CellGrid, cell: usize, w: LocalDir, draws: u32) -> f64 {
    f64::from(draws) * f64::from(w.abs_cos_theta()) / grid.projected_solid_angle(cell)
}

fn incident(sampler: &mut Sampler, setting: &Setting<'_>) -> LocalDir {
    let u = if setting.incidence.is_spread() { sampler.next_2d() } else { Vec2::ZERO };
    setting.incidence.direction(setting.grid, setting.face, u)
}
