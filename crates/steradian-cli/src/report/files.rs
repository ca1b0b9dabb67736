//! The folder that a report goes to.

use crate::output::{OutputFile, reason};
use crate::raster;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use steradian::image::write_radiance;
use steradian::lab::Table;
use steradian::lab::glare::Handedness;
use steradian::lab::plot::{Drawing, svg};
use steradian::lab::report::{
    Backdrop, GridReport, Page, Report, ViewReport, false_color_sheet, grid_table, html, isolux,
    radiance_header, sources_table, summary_table, view_table,
};

/// A folder that can be written to.
#[derive(Debug)]
pub(super) struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Makes the folder where it does not exist, and checks that files can be made in it.
    pub(super) fn new(path: &Path) -> Result<Self, String> {
        std::fs::create_dir_all(path)
            .map_err(|e| format!("cannot make the folder {}: {}", path.display(), reason(&e)))?;
        OutputFile::new(&path.join("index.html"))?;
        Ok(Self { path: path.to_owned() })
    }

    /// Writes everything; the result is the page.
    pub(super) fn write(&self, report: &Report, handedness: Handedness) -> Result<PathBuf, String> {
        let mut page = Page::default();
        let mut tables = Vec::new();
        if !report.grids.is_empty() {
            tables.push(summary_table(report));
            self.file("grids.csv", summary_table(report).to_csv().as_bytes())?;
        }
        for grid in &report.grids {
            page.grid_files.push(self.grid(report, grid)?);
            tables.push(grid_table(report, grid));
        }
        for view in &report.views {
            let (picture, files) = self.view(report, view, handedness)?;
            page.view_pictures.push(picture);
            page.view_files.push(files);
            tables.extend([view_table(report, view), sources_table(report, view)]);
        }
        let tables: Vec<Value> = tables.iter().map(Table::to_json).collect();
        let numbers = json!({ "title": report.title, "remarks": report.remarks, "tables": tables });
        self.file("report.json", format!("{numbers:#}\n").as_bytes())?;
        self.file("index.html", html(report, &page).as_bytes())?;
        Ok(self.path.join("index.html"))
    }

    fn file(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        OutputFile::new(&self.path.join(name))?.write(bytes)
    }

    fn grid(&self, report: &Report, grid: &GridReport) -> Result<Vec<[String; 2]>, String> {
        let stem = format!("grid-{}", grid.grid.name);
        let title = format!("{}: illuminance, isolux lines [lx]", grid.grid.name);
        let drawing = isolux(&grid.grid, &grid.illuminances(), &title, report.meters_per_unit);
        self.file(&format!("{stem}.csv"), grid_table(report, grid).to_csv().as_bytes())?;
        self.file(&format!("{stem}.svg"), svg(&drawing).as_bytes())?;
        self.file(&format!("{stem}.png"), &raster::png(&drawing)?)?;
        Ok(["csv", "svg", "png"].map(|e| [e.to_uppercase(), format!("{stem}.{e}")]).to_vec())
    }

    fn view(
        &self,
        report: &Report,
        view: &ViewReport,
        handedness: Handedness,
    ) -> Result<(String, Vec<[String; 2]>), String> {
        let stem = format!("view-{}", view.name);
        let (drawing, backdrop) = false_color_sheet(view);
        let sheet = svg_over(&drawing, &backdrop)?;
        self.file(&format!("{stem}.svg"), sheet.as_bytes())?;
        self.file(&format!("{stem}.png"), &raster::png_over(&drawing, Some(&backdrop))?)?;
        let mut picture = Vec::new();
        let side = view.photograph.fisheye.side();
        let header = radiance_header(view, handedness, &report.title);
        write_radiance([side, side], &view.photograph.color, &header, &mut picture)
            .map_err(|e| e.to_string())?;
        self.file(&format!("{stem}.hdr"), &picture)?;
        self.file(&format!("{stem}.csv"), view_table(report, view).to_csv().as_bytes())?;
        self.file(&format!("{stem}-sources.csv"), sources_table(report, view).to_csv().as_bytes())?;
        let files = [
            ["Radiance picture", ".hdr"],
            ["SVG", ".svg"],
            ["PNG", ".png"],
            ["readings", ".csv"],
            ["sources", "-sources.csv"],
        ];
        Ok((sheet, files.map(|[what, end]| [what.to_owned(), format!("{stem}{end}")]).to_vec()))
    }
}

/// A drawing on top of a picture, in one file.
fn svg_over(drawing: &Drawing, backdrop: &Backdrop) -> Result<String, String> {
    let text = svg(drawing);
    let Backdrop { at: [x, y], size, .. } = backdrop;
    let data = base64(&raster::backdrop_png(backdrop)?);
    let image = format!(
        "<image x=\"{x}\" y=\"{y}\" width=\"{size}\" height=\"{size}\" href=\"data:image/png;base64,{data}\"/>\n"
    );
    // Above the sheet of paper, which is the first element, and below everything else.
    let paper = text.find("/>\n").map_or(0, |i| i + 3);
    Ok(format!("{}{image}{}", &text[..paper], &text[paper..]))
}

/// RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |i: usize| u32::from(group.get(i).copied().unwrap_or(0));
        let bits = (byte(0) << 16) | (byte(1) << 8) | byte(2);
        for digit in 0..4 {
            let value = ((bits >> (18 - 6 * digit)) & 63) as usize;
            out.push(if digit <= group.len() { char::from(DIGITS[value]) } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_rfc() {
        let pairs = [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")];
        for (plain, coded) in pairs {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }
}
