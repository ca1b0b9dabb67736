//! The report as a page for people.

use super::isolux::isolux;
use super::room::Report;
use super::tables::{sources_table, summary_table, view_table};
use crate::lab::plot::svg;
use crate::lab::{Cell, Table};
use crate::units::Estimate;
use std::fmt::Write as _;

const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:72em;padding:0 1em;color:#222;background:#fff}\
h1{font-size:1.5em}h2{font-size:1.15em;margin:2em 0 .4em;border-top:1px solid #ddd;padding-top:1em}\
.t{overflow-x:auto}table{border-collapse:collapse;margin:.6em 0}td,th{padding:.2em .9em .2em 0;text-align:left;vertical-align:top}\
th{border-bottom:1px solid #999;font-weight:600}.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}\
dl{display:grid;grid-template-columns:max-content 1fr;gap:.1em 1em;color:#555;font-size:.9em}dt{font-weight:600}dd{margin:0}\
svg{max-width:100%;height:auto}";

/// What belongs to a page besides the numbers.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// For each grid, links to its files: what they are and where.
    pub grid_files: Vec<Vec<[String; 2]>>,
    /// For each view, its false-colour sheet as an `<svg>` element.
    pub view_pictures: Vec<String>,
    /// For each view, links to its files.
    pub view_files: Vec<Vec<[String; 2]>>,
}

/// The report as one HTML page without scripts, with its plots inside.
pub fn html(report: &Report, page: &Page) -> String {
    let title = escaped(&report.title);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Lighting report: {title}</title>\
         <style>{STYLE}</style></head><body>\n<h1>Lighting report: {title}</h1>\n"
    );
    for remark in &report.remarks {
        // Writing to a String does not fail.
        let _ = writeln!(out, "<p><b>Note:</b> {}</p>", escaped(remark));
    }
    if !report.grids.is_empty() {
        out.push_str("<h2>Illuminance</h2>\n");
        transposed(&mut out, &summary_table(report));
    }
    for (i, g) in report.grids.iter().enumerate() {
        let _ = writeln!(out, "<h2>Grid {}</h2>", escaped(&g.grid.name));
        let title = format!("{}: illuminance, isolux lines [lx]", g.grid.name);
        out.push_str(&svg(&isolux(&g.grid, &g.illuminances(), &title, report.meters_per_unit)));
        out.push_str("<p>▽ least reading, △ greatest reading.");
        links(&mut out, page.grid_files.get(i));
        out.push_str("</p>\n");
    }
    for (i, v) in report.views.iter().enumerate() {
        let _ = writeln!(out, "<h2>View {}</h2>", escaped(&v.name));
        if let Some(picture) = page.view_pictures.get(i) {
            out.push_str(picture);
        }
        out.push_str("<p>Rings: sources of glare, the most disturbing first.");
        links(&mut out, page.view_files.get(i));
        out.push_str("</p>\n");
        table(&mut out, &view_table(report, v));
        if !v.reading.sources.is_empty() {
            let mut sources = sources_table(report, v);
            let rest = sources.rows.len().saturating_sub(SHOWN);
            sources.rows.truncate(SHOWN);
            if rest > 0 {
                sources.fact("not shown", format!("{rest} more, in the files"));
            }
            table(&mut out, &sources);
        }
    }
    out.push_str("</body></html>\n");
    out
}

/// Sources on the page.
const SHOWN: usize = 12;

fn links(out: &mut String, files: Option<&Vec<[String; 2]>>) {
    for [what, file] in files.into_iter().flatten() {
        let _ = write!(out, " <a href=\"{}\">{}</a>", escaped(file), escaped(what));
    }
}

fn shown(cell: &Cell) -> String {
    match cell {
        Cell::Text(s) => escaped(s),
        Cell::Number(x) => rounded(*x),
        Cell::Estimate(e) => escaped(&e.to_string()),
        Cell::Missing => "–".to_owned(),
    }
}

/// Five digits: the files have them all.
fn rounded(x: f64) -> String {
    let short: f64 = format!("{x:.4e}").parse().unwrap_or(x);
    Estimate::exact(short).to_string()
}

fn heading(table: &Table, column: usize) -> String {
    let column = &table.columns[column];
    let unit = column.unit.as_deref().filter(|u| *u != "1").map_or(String::new(), |u| format!(" [{u}]"));
    escaped(&format!("{}{unit}", column.name))
}

fn table(out: &mut String, table: &Table) {
    out.push_str("<div class=t><table><tr>");
    for i in 0..table.columns.len() {
        let _ = write!(out, "<th>{}</th>", heading(table, i));
    }
    out.push_str("</tr>\n");
    for row in &table.rows {
        out.push_str("<tr>");
        for cell in row {
            let class = if matches!(cell, Cell::Text(_) | Cell::Missing) { "" } else { " class=n" };
            let _ = write!(out, "<td{class}>{}</td>", shown(cell));
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</table></div>\n");
    facts(out, table);
}

/// A table of few rows with many columns, turned.
fn transposed(out: &mut String, table: &Table) {
    out.push_str("<div class=t><table>");
    for i in 0..table.columns.len() {
        let _ = write!(out, "<tr><th>{}</th>", heading(table, i));
        for row in &table.rows {
            let _ = write!(out, "<td class=n>{}</td>", row.get(i).map_or(String::new(), shown));
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</table></div>\n");
    facts(out, table);
}

fn facts(out: &mut String, table: &Table) {
    out.push_str("<dl>");
    for fact in &table.facts {
        let _ = write!(out, "<dt>{}</dt><dd>{}</dd>", escaped(&fact.name), escaped(&fact.value));
    }
    out.push_str("</dl>\n");
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
