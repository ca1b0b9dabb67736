//! From accumulators to layers of numbers.

use super::bounds::PixelBounds;
use super::recording::{Film, FilmKind};
use super::tile::FilmTile;
use crate::color::Rgb;
use crate::units::{Quantity, Radiance};

/// A developed film: named planes over the rendered pixels.
#[derive(Clone, Debug)]
pub struct Developed {
    /// Size of the whole picture [px].
    pub resolution: [u32; 2],
    /// The rendered part, which the planes cover.
    pub bounds: PixelBounds,
    /// The planes, in the order of the file.
    pub layers: Vec<Layer>,
    /// Text attributes that name units and layouts.
    pub attributes: Vec<(&'static str, String)>,
}

/// One plane of numbers.
#[derive(Clone, Debug)]
pub struct Layer {
    /// Channel name.
    pub name: String,
    /// One value per pixel of the bounds, row by row.
    pub values: Vec<f32>,
}

impl Developed {
    /// The plane of that name.
    pub fn layer(&self, name: &str) -> Option<&[f32]> {
        self.layers.iter().find(|l| l.name == name).map(|l| &l.values[..])
    }
}

impl Film {
    /// Divides the sums of all tiles by their weights. Pixels without a sample are black; tiles may overlap the
    /// bounds only where no other tile does.
    ///
    /// A bin of a spectral film is Σ w L/p ÷ Σ w/p, a ratio of estimates: exact for radiance that is constant in the
    /// bin, consistent otherwise, with a bias of order 1/n.
    pub fn develop<'a>(&self, tiles: impl IntoIterator<Item = &'a FilmTile>) -> Developed {
        let mut planes = Planes::new(self.layer_names(), self.bounds.area());
        for tile in tiles {
            for (index, pixel) in tile.bounds.pixels().enumerate() {
                if let Some(at) = self.bounds.index(pixel) {
                    self.develop_pixel(tile, index, &mut planes.pixel(at));
                }
            }
        }
        Developed {
            resolution: self.resolution,
            bounds: self.bounds,
            layers: planes.layers,
            attributes: self.attributes(),
        }
    }

    /// RGB of one pixel as it would be shown now; `None` without a sample or outside the tile.
    pub fn rgb(&self, tile: &FilmTile, pixel: [i32; 2]) -> Option<Rgb> {
        let sums = &tile.pixels[tile.bounds.index(pixel)?];
        (sums.weight != 0.0).then(|| self.sensor.rgb(sums.sum.map(|s| s / sums.weight)))
    }

    /// Channel names, in the order in which [`Film::develop_pixel`] writes values.
    fn layer_names(&self) -> Vec<String> {
        let mut names: Vec<String> = ["R", "G", "B"].map(String::from).to_vec();
        match self.kind {
            FilmKind::Rgb => {}
            FilmKind::GBuffer => {
                const NAMES: [&str; 22] = [
                    "Albedo.R",
                    "Albedo.G",
                    "Albedo.B",
                    "P.X",
                    "P.Y",
                    "P.Z",
                    "u",
                    "v",
                    "dzdx",
                    "dzdy",
                    "N.X",
                    "N.Y",
                    "N.Z",
                    "Ns.X",
                    "Ns.Y",
                    "Ns.Z",
                    "Variance.R",
                    "Variance.G",
                    "Variance.B",
                    "RelativeVariance.R",
                    "RelativeVariance.G",
                    "RelativeVariance.B",
                ];
                names.extend(NAMES.map(String::from));
            }
            FilmKind::Spectral(bins) => {
                // Fichet et al. 2021: unpolarised emission, centre of the bin with a decimal comma.
                names.extend(
                    (0..bins.count as usize)
                        .map(|bin| format!("S0.{}nm", format!("{:.3}", bins.centre(bin)).replace('.', ","))),
                );
            }
        }
        names
    }

    fn develop_pixel(&self, tile: &FilmTile, index: usize, out: &mut PixelOut<'_>) {
        let sums = &tile.pixels[index];
        let rgb = if sums.weight == 0.0 {
            [0.0; 3]
        } else {
            self.sensor.rgb(sums.sum.map(|s| s / sums.weight)).0.to_array()
        };
        out.extend(rgb);
        match self.kind {
            FilmKind::Rgb => {}
            FilmKind::GBuffer => {
                let surface = &tile.surfaces[index];
                let per =
                    |weight: f64| move |sum: f64| if weight == 0.0 { 0.0 } else { (sum / weight) as f32 };
                let visible = per(surface.weight);
                // Pixels partly covered show the covered share of the albedo, like RGB; geometry is that of the surfaces.
                out.extend(surface.albedo.map(per(sums.weight)));
                out.extend(surface.p.map(&visible));
                out.extend(surface.uv.map(&visible));
                out.extend(surface.dz.map(&visible));
                out.extend(surface.n.map(&visible));
                out.extend(surface.ns.map(&visible));
                out.extend(surface.rgb.map(|s| s.variance()));
                out.extend(surface.rgb.map(|s| s.relative_variance()));
            }
            FilmKind::Spectral(bins) => {
                let count = bins.count as usize;
                let own = &tile.bins[index * count..][..count];
                out.extend(own.iter().map(|b| if b.weight == 0.0 { 0.0 } else { (b.sum / b.weight) as f32 }));
            }
        }
    }

    fn attributes(&self) -> Vec<(&'static str, String)> {
        let mut list = vec![("colorSpace", self.space.kind().name().to_owned())];
        if let Some(limit) = self.sensor.settings().max_component {
            list.push(("bias.maxComponentValue", limit.to_string()));
        }
        if let FilmKind::Spectral(_) = self.kind {
            list.push(("spectralLayoutVersion", "1.0".to_owned()));
            list.push(("emissiveUnits", exr_unit(Radiance::UNIT)));
        }
        list
    }
}

/// A unit in the spelling of the spectral layout: `W.m^-2.sr^-1.nm^-1`.
fn exr_unit(unit: &str) -> String {
    let ascii = |c: char| match c {
        '·' => '.',
        '⁻' => '-',
        '¹' => '1',
        '²' => '2',
        other => other,
    };
    unit.replace('⁻', "^⁻").chars().map(ascii).collect()
}

/// Planes that are filled pixel by pixel.
struct Planes {
    layers: Vec<Layer>,
}

struct PixelOut<'a> {
    layers: &'a mut [Layer],
    at: usize,
    next: usize,
}

impl Planes {
    fn new(names: Vec<String>, area: usize) -> Self {
        Self { layers: names.into_iter().map(|name| Layer { name, values: vec![0.0; area] }).collect() }
    }

    fn pixel(&mut self, at: usize) -> PixelOut<'_> {
        PixelOut { layers: &mut self.layers, at, next: 0 }
    }
}

impl PixelOut<'_> {
    fn extend(&mut self, values: impl IntoIterator<Item = f32>) {
        for v in values {
            self.layers[self.next].values[self.at] = v;
            self.next += 1;
        }
    }
}
