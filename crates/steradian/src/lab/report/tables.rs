//! The numbers of a report as tables.

use super::daylight::DAYLIGHT_LEVELS;
use super::room::{GridReport, Report};
use super::view::ViewReport;
use crate::lab::glare::index::{dgp_class, ugr_class};
use crate::lab::{Cell, Column, Table};
use crate::units::Estimate;

/// All grids: mean, extremes, uniformity, daylight.
pub fn summary_table(report: &Report) -> Table {
    let mut columns = vec![Column::words("grid"), Column::new("points", "1")];
    columns.extend(["mean illuminance", "minimum", "maximum"].map(|name| Column::new(name, "lx")));
    columns.extend(["U0 of the readings", "U0 at least", "U0 at most"].map(|name| Column::new(name, "1")));
    columns.push(Column::new("points that may be the minimum", "1"));
    columns.push(Column::new("widest interval of a point", "%"));
    let daylight = report.grids.iter().any(|g| g.daylight.is_some());
    if daylight {
        columns.push(Column::new("illuminance outdoors", "lx"));
        columns.extend(
            ["mean", "median", "95 % reach"].map(|n| Column::new(format!("daylight factor, {n}"), "%")),
        );
    }
    columns.push(Column::new("rays", "1"));
    let mut table = Table::new(format!("illuminance on grids: {}", report.title), columns);
    for g in &report.grids {
        let u = &g.uniformity;
        let mut row = vec![Cell::from(g.grid.name.as_str()), Cell::Number(g.readings.len() as f64)];
        row.extend([u.mean, u.min, u.max].map(Cell::Estimate));
        row.extend([u.u0, u.u0_interval.low, u.u0_interval.high].map(Cell::Number));
        row.push(Cell::Number(u.candidates as f64));
        row.push(Cell::Number(100.0 * u.worst_relative));
        if daylight {
            match (&g.daylight, g.outdoors) {
                (Some(d), Some(out)) => {
                    row.extend([out.estimate(), d.mean.scaled(100.0)].map(Cell::Estimate));
                    row.extend([d.median, d.nearly_all].map(|x| Cell::Number(100.0 * x)));
                }
                _ => row.extend([Cell::Missing, Cell::Missing, Cell::Missing, Cell::Missing]),
            }
        }
        row.push(Cell::Number(g.rays() as f64));
        table.rows.push(row);
    }
    level(&mut table, report);
    table.fact("U0", "Emin/Ē (EN 12464-1); a minimum of noisy points comes out low: the bounds hold for the true U0 at the level of the intervals (those of all points widened by Bonferroni's rule)");
    if daylight {
        table.fact(
            "daylight factor",
            "E/E outdoors, the latter of the same plane with nothing around it; EN 17037, method 1",
        );
        for g in &report.grids {
            let Some(d) = &g.daylight else { continue };
            for level in &DAYLIGHT_LEVELS {
                let needed = d.outdoors_for(level);
                let text = if needed.is_finite() {
                    format!("met where the median diffuse illuminance outdoors is at least {needed:.0} lx")
                } else {
                    "not met anywhere: points without daylight".to_owned()
                };
                let asked = format!(
                    "{}: {} ({} lx on half, {} lx on 95 % of the points)",
                    g.grid.name, level.name, level.target, level.least
                );
                table.fact(format!("EN 17037, {asked}"), text);
            }
        }
    }
    table
}

/// One grid, a row for each point.
pub fn grid_table(report: &Report, grid: &GridReport) -> Table {
    let mut columns = vec![Column::new("column", "1"), Column::new("row", "1")];
    columns.extend(["x", "y", "z"].map(|name| Column::new(name, "scene units")));
    columns
        .extend(["illuminance", "direct illuminance", "indirect illuminance"].map(|n| Column::new(n, "lx")));
    if grid.daylight.is_some() {
        columns.push(Column::new("daylight factor", "%"));
    }
    columns.push(Column::new("rays", "1"));
    let notes = grid.readings.iter().any(|r| r.effort.note().is_some());
    if notes {
        columns.push(Column::words("note"));
    }
    let mut table = Table::new(format!("illuminance on {}: {}", grid.grid.name, report.title), columns);
    for (i, (point, reading)) in grid.points.iter().zip(&grid.readings).enumerate() {
        let (column, row) = (i % grid.grid.columns + 1, i / grid.grid.columns + 1);
        let mut cells = vec![Cell::Number(column as f64), Cell::Number(row as f64)];
        cells.extend(point.position.map(Cell::Number));
        cells.extend([reading.total, reading.direct, reading.indirect].map(|e| Cell::Estimate(e.estimate())));
        cells.extend(grid.daylight.as_ref().map(|d| Cell::Estimate(d.factors[i].scaled(100.0))));
        cells.push(Cell::Number(reading.effort.rays as f64));
        if notes {
            cells.push(reading.effort.note().map_or(Cell::Missing, Cell::Text));
        }
        table.rows.push(cells);
    }
    let [nx, ny, nz] = grid.grid.normal().unwrap_or_default();
    table.fact(
        "instrument",
        format!("meters in the middle of the cells, facing {nx} {ny} {nz}, ideal cosine response"),
    );
    level(&mut table, report);
    table
}

/// Glare of one view.
pub fn view_table(report: &Report, view: &ViewReport) -> Table {
    let columns = vec![
        Column::words("quantity"),
        Column::words("unit"),
        Column::words("value"),
        Column::words("meaning"),
    ];
    let mut table = Table::new(format!("glare, view {}: {}", view.name, report.title), columns);
    let r = &view.reading;
    let mut add = |name: &str, unit: &str, value: Option<Estimate>, meaning: &str| {
        let value = value.map_or(Cell::Missing, Cell::Estimate);
        table.rows.push(vec![name.into(), unit.into(), value, meaning.into()]);
    };
    add("vertical illuminance at the eye", "lx", Some(r.vertical_illuminance.estimate()), "");
    add("mean luminance", "cd·m⁻²", Some(r.mean.estimate()), "over the half space");
    add("background luminance", "cd·m⁻²", Some(r.background.estimate()), "without the sources");
    let class = r.ugr.map_or("no source", |u| ugr_class(u.value));
    add("UGR", "1", r.ugr, class);
    add("DGP", "1", r.dgp, r.dgp.map_or("", |d| dgp_class(d.value)));
    add("DGP with low-light correction", "1", r.dgp_low_light, "as evalglare below 1000 lx");
    add("threshold", "cd·m⁻²", Some(Estimate::exact(r.threshold)), "");
    add("sources", "1", Some(Estimate::exact(r.sources.len() as f64)), "");
    let eye = view.photograph.eye;
    let words = |v: [f64; 3]| {
        v.map(|x| format!("{x:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()).join(" ")
    };
    table.fact("eye [scene units]", words(eye.point));
    table.fact("line of sight", words(eye.ahead));
    table.fact(
        "picture",
        format!(
            "angular fisheye 180°, {side} × {side} px, {spp} samples per pixel, {rays} rays",
            side = view.photograph.fisheye.side(),
            spp = view.photograph.samples,
            rays = view.photograph.rays
        ),
    );
    if view.photograph.dropped > 0 {
        table.fact(
            "dropped",
            format!("{} samples that were not finite are left out", view.photograph.dropped),
        );
    }
    table.fact("glare sources", view.rule.describe());
    table.fact("position index", "Guth above the line of sight, Iwata and Tokura below, at most 16");
    table.fact("UGR", "CIE 117-1995; made for luminaires of 0.0003 to 0.1 sr");
    table.fact("DGP", "Wienold & Christoffersen 2006; for daylight, 0.2 to 0.8, from 380 lx at the eye");
    if let Some(d) = r.dgp
        && !((0.2..=0.8).contains(&d.value) && r.vertical_illuminance.value() >= 380.0)
    {
        table.fact("DGP here", "outside of the range for which it was made");
    }
    table.fact(
        "intervals",
        format!(
            "{} % confidence, statistical only, jackknife over {} exposures",
            percent(report.confidence),
            view.photograph.exposures.len()
        ),
    );
    table.fact("seed", report.seed.to_string());
    table
}

/// The sources of one view, a row for each.
pub fn sources_table(report: &Report, view: &ViewReport) -> Table {
    let mut columns = vec![Column::new("source", "1")];
    columns.extend(["mean luminance", "peak luminance"].map(|n| Column::new(n, "cd·m⁻²")));
    columns.push(Column::new("solid angle", "sr"));
    columns.push(Column::new("illuminance at the eye", "lx"));
    columns.extend(["to the right", "upwards"].map(|n| Column::new(n, "°")));
    columns.extend(["x", "y", "z"].map(|n| Column::new(n, "1")));
    columns.push(Column::new("position index", "1"));
    columns.push(Column::new("pixels", "1"));
    let mut table = Table::new(format!("glare sources, view {}: {}", view.name, report.title), columns);
    for (i, s) in view.reading.sources.iter().enumerate() {
        let [x, y, z] = s.direction;
        let numbers = [
            (i + 1) as f64,
            s.luminance,
            s.peak,
            s.solid_angle,
            s.illuminance,
            x.atan2(z).to_degrees(),
            y.clamp(-1.0, 1.0).asin().to_degrees(),
        ];
        let [wx, wy, wz] = view.photograph.eye.to_world(s.direction);
        let all = numbers.into_iter().chain([wx, wy, wz, s.position_index, s.pixels as f64]);
        table.rows.push(all.map(Cell::Number).collect());
    }
    table.fact(
        "glare sources",
        format!("{}; here {:.0} cd·m⁻²", view.rule.describe(), view.reading.threshold),
    );
    table.fact("direction", "x, y, z in the scene's world; to the right and upwards from the line of sight");
    table
}

fn level(table: &mut Table, report: &Report) {
    table.fact("light", format!("paths of at most {} bounces with Russian roulette", report.max_depth));
    table.fact(
        "intervals",
        format!("{} % confidence for each number, statistical only", percent(report.confidence)),
    );
    let imprecise: usize = report.grids.iter().map(GridReport::imprecise).sum();
    if imprecise > 0 {
        table.fact("precision", format!("not met at {imprecise} points: the ray limit came first"));
    }
    table.fact("seed", report.seed.to_string());
}

fn percent(share: f64) -> f64 {
    (share * 1e8).round() / 1e6
}
