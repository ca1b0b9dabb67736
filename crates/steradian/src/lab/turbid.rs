//! Models of turbid slabs side by side: the transport of light as it is, and what two teaching models make of it.

use super::plot::{Axis, Chart, Curve, Dash, Drawing, Scale, series_ink};
use super::table::{Cell, Column, Table};
use crate::optics::Shares;
use crate::optics::adding_doubling::{Below, Slab, SlabError, Transport};
use crate::optics::diffusion::{dipole_reflectance, reduced_albedo};
use crate::optics::two_flux::{Saunderson, TwoFlux};

/// Slabs of one medium and several thicknesses.
#[derive(Clone, Debug, PartialEq)]
pub struct Turbid {
    /// The medium, its boundaries, and what lies below; its own thickness does not matter.
    pub slab: Slab,
    /// Optical thicknesses, at least 0; may be infinite. A plot reaches to the thickest finite one, and to 10 at least.
    pub depths: Vec<f64>,
}

/// One thickness, by three models.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Optical thickness.
    pub depth: f64,
    /// By adding and doubling.
    pub transport: Transport,
    /// By Kubelka and Munk, for diffuse light, with Saunderson's boundaries.
    pub two_flux: Shares,
    /// By the dipole, for a beam along the normal; of half-spaces only.
    pub dipole: Option<f64>,
}

/// Points of a plotted curve.
const POINTS: u32 = 48;
/// Powers of ten that a plot shows.
const DECADES: u32 = 4;

impl Turbid {
    /// Solves all thicknesses.
    ///
    /// # Errors
    /// When a number is out of its range.
    pub fn compare(&self) -> Result<Vec<Comparison>, SlabError> {
        self.depths.iter().map(|&depth| self.at(depth)).collect()
    }

    fn at(&self, depth: f64) -> Result<Comparison, SlabError> {
        let slab = Slab { depth, ..self.slab };
        let transport = slab.solve()?;
        let Slab { albedo, anisotropy, eta, below, .. } = slab;
        let layer = TwoFlux::of_medium(albedo, anisotropy, depth);
        let boundary = Saunderson::of_index(eta);
        let two_flux = match below {
            Below::Surroundings => boundary.between(layer.shares()),
            Below::Lambertian(ground) => {
                Shares { reflectance: boundary.seen(layer.over(ground)), transmittance: 0.0 }
            }
        };
        let dipole = depth.is_infinite().then(|| {
            let first = ((eta - 1.0) / (eta + 1.0)).powi(2);
            first + (1.0 - first) * dipole_reflectance(reduced_albedo(albedo, anisotropy), eta)
        });
        Ok(Comparison { depth, transport, two_flux, dipole })
    }

    /// One row for each thickness.
    pub fn table(&self, comparisons: &[Comparison]) -> Table {
        let columns = [
            "optical thickness",
            "R beam",
            "T beam",
            "R diffuse",
            "T diffuse",
            "R Kubelka-Munk",
            "R error",
            "T Kubelka-Munk",
            "T error",
            "R dipole",
            "dipole error",
        ];
        let mut table =
            Table::new("turbid slab", columns.into_iter().map(|name| Column::new(name, "1")).collect());
        for c in comparisons {
            let Transport { collimated, diffuse } = c.transport;
            // A table writes no infinity; JSON has none.
            let depth = if c.depth.is_finite() { Cell::Number(c.depth) } else { "infinite".into() };
            let optional = |x: Option<f64>| x.map_or(Cell::Missing, Cell::Number);
            table.rows.push(vec![
                depth,
                collimated.reflectance.into(),
                collimated.transmittance.into(),
                diffuse.reflectance.into(),
                diffuse.transmittance.into(),
                c.two_flux.reflectance.into(),
                (c.two_flux.reflectance - diffuse.reflectance).into(),
                c.two_flux.transmittance.into(),
                (c.two_flux.transmittance - diffuse.transmittance).into(),
                optional(c.dipole),
                optional(c.dipole.map(|d| d - collimated.reflectance)),
            ]);
        }
        let Slab { albedo, anisotropy, eta, below, .. } = self.slab;
        table.fact(
            "medium",
            format!("single-scattering albedo {albedo}, mean cosine {anisotropy} (Henyey-Greenstein), relative index {eta}"),
        );
        table.fact(
            "below",
            match below {
                Below::Surroundings => "the same surroundings as above".to_owned(),
                Below::Lambertian(r) => format!("a Lambertian surface of reflectance {r} in optical contact"),
            },
        );
        table.fact(
            "R, T",
            "shares of the incident power by radiative transport (adding-doubling, 32 directions), for a beam along the normal and for diffuse light; \
             the boundary's own reflection and unscattered light are part of them",
        );
        table.fact(
            "Kubelka-Munk",
            "two fluxes, K d = 2 (1 - a) t, S d = (3/4 a (1 - g) - 1/4 (1 - a)) t, with Saunderson's boundaries; its error is against diffuse light",
        );
        table.fact("dipole", "half-spaces only; its error is against the beam");
        table
    }

    /// Diffuse reflectance and transmittance over thickness, as they are and after Kubelka and Munk; no curves when a number is
    /// out of its range.
    pub fn drawing(&self) -> Drawing {
        let finite = self.depths.iter().copied().filter(|d| d.is_finite());
        let thickest = finite.fold(10.0, f64::max);
        let exponent = |i: u32| f64::from(DECADES) * (f64::from(i) / f64::from(POINTS) - 1.0);
        let depths = (0..=POINTS).map(|i| thickest * 10.0_f64.powf(exponent(i)));
        let all: Vec<Comparison> = depths.filter_map(|depth| self.at(depth).ok()).collect();
        let curve = |name: &str, index: usize, f: fn(&Comparison) -> f64| {
            Curve::new(name, series_ink(index), all.iter().map(|c| [c.depth, f(c)]).collect())
        };
        let mut curves = vec![
            curve("R", 0, |c| c.transport.diffuse.reflectance),
            curve("R, Kubelka–Munk", 0, |c| c.two_flux.reflectance).dashed(Dash::Dashed),
        ];
        if self.slab.below == Below::Surroundings {
            curves.push(curve("T", 1, |c| c.transport.diffuse.transmittance));
            curves.push(curve("T, Kubelka–Munk", 1, |c| c.two_flux.transmittance).dashed(Dash::Dashed));
        }
        let Slab { albedo, anisotropy, eta, .. } = self.slab;
        let chart = Chart {
            title: format!("diffuse light on a slab: ω = {albedo}, g = {anisotropy}, η = {eta}"),
            x: Axis::new("optical thickness [1]").scaled(Scale::Logarithmic { decades: DECADES }),
            y: Axis::new("share of the incident power [1]").including(&[0.0, 1.0]),
            curves,
        };
        chart.draw()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turbid(eta: f64, below: Below, depths: &[f64]) -> Turbid {
        let slab = Slab { albedo: 0.9, depth: 1.0, anisotropy: 0.0, eta, below };
        Turbid { slab, depths: depths.to_vec() }
    }

    #[test]
    fn models_stand_beside_the_transport_that_they_approximate() {
        let all = turbid(1.0, Below::Surroundings, &[0.1, 1.0, f64::INFINITY]).compare().unwrap();
        // R and T of the diffuse light of lightlab's table; the dipole's half-space is 0.3856 against 0.4149.
        assert!((all[1].transport.diffuse.reflectance - 0.35271).abs() < 1e-5);
        assert!(all[1].dipole.is_none());
        let half_space = all[2];
        assert!((half_space.dipole.unwrap() - 0.3856).abs() < 1e-4);
        assert!(
            (half_space.dipole.unwrap() - half_space.transport.collimated.reflectance + 0.0294).abs() < 1e-3
        );
        // K/S = 0.2/0.65: near the truth for diffuse light, and not equal to it.
        let error = half_space.two_flux.reflectance - half_space.transport.diffuse.reflectance;
        assert!((half_space.two_flux.reflectance - TwoFlux::infinite(0.2 / 0.65)).abs() < 1e-12);
        assert!(error.abs() > 1e-3 && error.abs() < 0.05, "{error}");
    }

    #[test]
    fn tables_and_plots_say_what_they_show() {
        let turbid = turbid(1.33, Below::Lambertian(0.5), &[1.0, f64::INFINITY]);
        let table = turbid.table(&turbid.compare().unwrap());
        assert_eq!(table.rows.len(), 2);
        assert!(table.rows.iter().all(|r| r.len() == table.columns.len()));
        assert!(table.to_csv().contains("\ninfinite,") && table.to_csv().contains("optical thickness [1]"));
        let svg = crate::lab::plot::svg(&turbid.drawing());
        assert!(svg.contains("Kubelka–Munk") && !svg.contains("NaN"));
    }
}
