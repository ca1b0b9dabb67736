//! `steradian measure lux`: the luxmeter.

use super::common::{self, Comb, Desk, Outputs, Sampling, parse_comb};
use super::places::{self, Grid, Six, parse_grid, parse_six};
use crate::Failure;
use clap::Args;
use std::path::PathBuf;
use steradian::lab::Session;
use steradian::lab::meters::lux::{self, Layout};
use steradian::lab::meters::{
    Aim, DEFAULT_MAX_DEPTH, LuxReading, LuxSettings, MeterError, MeterPoint, Shown, plots,
};
use steradian::lab::plot::Drawing;
use steradian::render::CancelToken;
use steradian::scene::RenderJob;
use steradian::spectrum::photometry::Response;
use steradian::units::{
    AlphaOpic, EquivalentDaylight, Estimate, Irradiance, LCone, Luminous, MCone, Measured, Melanopic,
    Rhodopic, SCone, Scotopic, Unit,
};

#[derive(Args, Clone, Debug)]
#[command(after_help = NOTES)]
pub(crate) struct Lux {
    /// Scene files in the pbrt-v4 format, read as one; `-` reads standard input
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// A point and the normal of the sensor there; may be repeated
    #[arg(long, value_name = "X,Y,Z,NX,NY,NZ", value_parser = parse_six, allow_hyphen_values = true)]
    point: Vec<Six>,
    /// File with points and normals, six numbers a line; `-` reads standard input; may be repeated
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    points: Vec<PathBuf>,
    /// Cells of a parallelogram: a corner, its two edges, the number of cells along each; may be repeated
    #[arg(long, value_name = "X,Y,Z,UX,UY,UZ,VX,VY,VZ,NU,NV", value_parser = parse_grid, allow_hyphen_values = true)]
    grid: Vec<Grid>,
    /// Measure spectral irradiance at these wavelengths, such as 400:700:10 or 450,550,650, in nm
    #[arg(long, value_name = "NM,...", value_delimiter = ',', value_parser = parse_comb, conflicts_with = "radiant")]
    spectral: Vec<Comb>,
    /// Measure irradiance in W/m² over 360–830 nm instead of illuminance
    #[arg(long)]
    radiant: bool,
    /// Weigh light as by night, or as one of the eye's receptors does (CIE S 026), instead of as by day
    #[arg(long, value_enum, value_name = "NAME", conflicts_with_all = ["spectral", "radiant"])]
    receptor: Option<Receptor>,
    /// Show direct and indirect light as well, each to the precision asked for
    #[arg(long)]
    split: bool,
    /// Most bounces of light; roulette ends most paths earlier
    #[arg(long, value_name = "N", default_value_t = DEFAULT_MAX_DEPTH)]
    max_depth: u32,
    #[command(flatten)]
    outputs: Outputs,
    #[command(flatten)]
    sampling: Sampling,
}

/// Whose response counts instead of that of the eye by day.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Receptor {
    /// Scotopic illuminance, in lx
    Scotopic,
    /// S-cone-opic equivalent daylight illuminance, in lx
    SCone,
    /// M-cone-opic equivalent daylight illuminance, in lx
    MCone,
    /// L-cone-opic equivalent daylight illuminance, in lx
    LCone,
    /// Rhodopic equivalent daylight illuminance, in lx
    Rhodopic,
    /// Melanopic equivalent daylight illuminance (melanopic EDI), in lx
    Melanopic,
}

const NOTES: &str = "\
Positions are in the coordinates and units of the scene's world. A meter has no extent; one that lies on a surface
reads what arrives on the side of its normal. A grid is measured at the centres of its cells, along the first edge
first; its normal is the first edge × the second. A list of points is what `rtrace -I` reads: x y z nx ny nz.
Direct light is what comes from a light past nothing that scatters it; light through glass is indirect.

Examples:
  steradian measure lux --point 450,0,150,0,1,0 --split
      the floor of the built-in Cornell box
  steradian measure lux room.pbrt --grid 0,0,0.8,4,0,0,0,3,0,8,6 -o desk.csv --plot desk.svg
      a working plane of 4 by 3, at a height of 0.8, facing up, in 8 by 6 cells
  steradian measure lux room.pbrt --points - --precision 2% < points.txt
  steradian measure lux room.pbrt --point 2,1.5,0.8,0,0,1 --spectral 400:700:10 -o spectrum.csv
  steradian measure lux room.pbrt --point 2,1.5,1.2,1,0,0 --receptor melanopic";

pub(crate) fn run(lux: &Lux, cancel: &CancelToken) -> Result<(), Failure> {
    let desk = Desk::new(&lux.outputs)?;
    let mut sixes = lux.point.clone();
    for file in &lux.points {
        sixes.extend(places::read(file, &lux.scenes)?);
    }
    sixes.extend(lux.grid.iter().flat_map(Grid::points));
    if sixes.is_empty() {
        return Err("say where to measure, by --point, --points or --grid".to_owned().into());
    }
    let points: Vec<MeterPoint> = sixes
        .iter()
        .map(|&[x, y, z, nx, ny, nz]| MeterPoint { position: [x, y, z], normal: [nx, ny, nz] })
        .collect();
    let wavelengths: Vec<f32> = lux.spectral.iter().flat_map(|c| c.0.iter().copied()).collect();
    let aim = if lux.split { Aim::Parts } else { Aim::Total };
    let settings = LuxSettings { max_depth: lux.max_depth, aim };
    let job = common::scene(&lux.scenes, &lux.outputs)?;
    let session = lux.sampling.session(cancel);
    let paper = Paper { job: &job, lux, points: &points, wavelengths: &wavelengths, settings: &settings };
    if !wavelengths.is_empty() {
        let readings = lux::measure_spectral(&job, &points, &wavelengths, &settings, &session);
        return paper.hand_out(desk, &readings.map_err(said)?, &session);
    }
    if lux.radiant {
        let readings = lux::measure_radiant(&job, &points, &settings, &session);
        return paper.hand_out(desk, &readings.map_err(said)?, &session);
    }
    match lux.receptor {
        None => paper.hand_out(desk, &paper.read::<Luminous>(&session)?, &session),
        Some(Receptor::Scotopic) => paper.hand_out(desk, &paper.read::<Scotopic>(&session)?, &session),
        Some(Receptor::SCone) => paper.hand_out(desk, &paper.daylight::<SCone>(&session)?, &session),
        Some(Receptor::MCone) => paper.hand_out(desk, &paper.daylight::<MCone>(&session)?, &session),
        Some(Receptor::LCone) => paper.hand_out(desk, &paper.daylight::<LCone>(&session)?, &session),
        Some(Receptor::Rhodopic) => paper.hand_out(desk, &paper.daylight::<Rhodopic>(&session)?, &session),
        Some(Receptor::Melanopic) => paper.hand_out(desk, &paper.daylight::<Melanopic>(&session)?, &session),
    }
}

fn said(e: MeterError) -> Failure {
    Failure::Message(e.to_string())
}

type Readings<D> = Vec<LuxReading<Measured<Irradiance, D>>>;

/// What was asked for.
struct Paper<'a> {
    job: &'a RenderJob,
    lux: &'a Lux,
    points: &'a [MeterPoint],
    wavelengths: &'a [f32],
    settings: &'a LuxSettings,
}

impl Paper<'_> {
    fn read<D: Response>(&self, session: &Session<'_>) -> Result<Readings<D>, Failure>
    where
        Irradiance: Unit<D>,
    {
        lux::measure_weighted(self.job, self.points, self.settings, session).map_err(said)
    }

    /// As so much daylight as would excite the receptor alike.
    fn daylight<A: Response + AlphaOpic>(
        &self,
        session: &Session<'_>,
    ) -> Result<Readings<EquivalentDaylight<A>>, Failure>
    where
        Irradiance: Unit<A> + Unit<EquivalentDaylight<A>>,
    {
        let readings = self.read::<A>(session)?;
        let equal = readings.into_iter().map(|r| LuxReading {
            total: r.total.equivalent_daylight(),
            direct: r.direct.equivalent_daylight(),
            indirect: r.indirect.equivalent_daylight(),
            effort: r.effort,
        });
        Ok(equal.collect())
    }

    fn hand_out<Q: Shown>(
        &self,
        desk: Desk,
        readings: &[LuxReading<Q>],
        session: &Session<'_>,
    ) -> Result<(), Failure> {
        let layout = if self.lux.split { Layout::Split } else { Layout::Total };
        let table = lux::table(self.points, readings, self.wavelengths, layout, self.settings, session);
        desk.hand_out(&table, || self.draw(readings), session.cancel)
    }

    /// A map where one grid is all that was measured.
    fn draw<Q: Shown>(&self, readings: &[LuxReading<Q>]) -> Drawing {
        let quantity = format!("{} [{}]", Q::NAME, Q::UNIT);
        let all: Vec<Vec<Estimate>> = readings.iter().map(|r| r.total.estimates()).collect();
        if !self.wavelengths.is_empty() {
            return plots::spectra(&quantity, "point", self.wavelengths, &all);
        }
        let flat = all.concat();
        match self.lux.grid.as_slice() {
            [grid] if self.lux.point.is_empty() && self.lux.points.is_empty() => {
                plots::map(&quantity, grid.cells, grid.sides(), &flat)
            }
            _ => plots::along(&quantity, "point", &flat),
        }
    }
}
