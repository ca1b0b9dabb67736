//! A far-field distribution: as a table, as polar curves, and for a photometric file.

use super::cells::DIM;
use super::contract::LuminaireSettings;
use crate::lab::plot::{Curve, Drawing, Polar, Scale, Zero, series_ink};
use crate::lab::session::{Ending, Session};
use crate::lab::table::{Cell, Column, Table};
use crate::light::photometric::{Label, Luminaire, Opening, Outline, PhotometricWeb};
use crate::units::Measured;
use crate::units::kind::{Flux, Intensity, Luminous, Unit};

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
            title: format!("flux {}; γ from the nadir", self.flux),
            radius: format!("{} [{}]", <Intensity as Unit<D>>::NAME, <Intensity as Unit<D>>::UNIT),
            scale: Scale::Linear,
            zero: Zero::Bottom,
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
