//! Drawings as PNG pictures.

use steradian::color::transfer::srgb_encode;
use steradian::lab::plot::{Anchor, Drawing, Ink, Mark, Run, Text};
use steradian::lab::report::Backdrop;
use tiny_skia::{
    Color, FillRule, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint, Stroke, StrokeDash, Transform,
};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// DejaVu Sans, reduced; its licence lies beside it.
const FONT: &[u8] = include_bytes!("../assets/DejaVuSans-subset.ttf");

/// Pixels of the picture for one nominal pixel of the drawing: sharp on dense displays and in print.
const SCALE: f32 = 2.0;

/// The drawing as the bytes of a PNG file.
pub(crate) fn png(drawing: &Drawing) -> Result<Vec<u8>, String> {
    png_over(drawing, None)
}

/// The drawing on top of a picture.
pub(crate) fn png_over(drawing: &Drawing, backdrop: Option<&Backdrop>) -> Result<Vec<u8>, String> {
    let size = |x: f64| (x as f32 * SCALE).ceil() as u32;
    let mut map = Pixmap::new(size(drawing.width), size(drawing.height))
        .ok_or_else(|| "the drawing is too large for a picture".to_owned())?;
    map.fill(Color::WHITE);
    if let Some(backdrop) = backdrop {
        let mut picture = Pixmap::new(backdrop.side, backdrop.side)
            .ok_or_else(|| "the picture is too large to be drawn".to_owned())?;
        for (out, rgb) in picture.data_mut().chunks_exact_mut(4).zip(&backdrop.pixels) {
            let [r, g, b] = quantized(*rgb);
            out.copy_from_slice(&[r, g, b, 255]);
        }
        let grown = backdrop.size as f32 / backdrop.side as f32;
        let place =
            scale().pre_translate(backdrop.at[0] as f32, backdrop.at[1] as f32).pre_scale(grown, grown);
        map.draw_pixmap(0, 0, picture.as_ref(), &PixmapPaint::default(), place, None);
    }
    let face = Face::parse(FONT, 0).map_err(|e| format!("the built-in font is broken: {e}"))?;
    for mark in &drawing.marks {
        match mark {
            Mark::Line { points, stroke } => {
                let Some(path) = polyline(points) else { continue };
                let dash = StrokeDash::new(stroke.dash.lengths().to_vec(), 0.0);
                let width = stroke.width as f32;
                let look = Stroke { width, line_join: LineJoin::Round, dash, ..Stroke::default() };
                map.stroke_path(&path, &paint(stroke.ink, 1.0), &look, scale(), None);
            }
            Mark::Area { points, ink, opacity } => {
                let Some(path) = polyline(points) else { continue };
                map.fill_path(&path, &paint(*ink, *opacity), FillRule::Winding, scale(), None);
            }
            Mark::Text(text) => {
                if let Some((path, transform)) = outlines(&face, text) {
                    map.fill_path(&path, &paint(text.ink, 1.0), FillRule::Winding, transform, None);
                }
            }
        }
    }
    encode(&map).map_err(|e| format!("cannot write the picture: {e}"))
}

fn scale() -> Transform {
    Transform::from_scale(SCALE, SCALE)
}

fn paint(ink: Ink, opacity: f64) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(ink.r, ink.g, ink.b, (opacity.clamp(0.0, 1.0) * 255.0).round() as u8);
    paint
}

fn polyline(points: &[[f64; 2]]) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (i, [x, y]) in points.iter().enumerate() {
        if i == 0 { path.move_to(*x as f32, *y as f32) } else { path.line_to(*x as f32, *y as f32) }
    }
    path.finish()
}

/// The outlines of a text in units of the font, y upwards, and where they go; `None` for nothing but blanks.
fn outlines(face: &Face<'_>, text: &Text) -> Option<(Path, Transform)> {
    let mut pen = Pen { path: PathBuilder::new(), x: 0.0 };
    for c in text.text.chars() {
        // Glyph 0 is the box that stands for characters that a font lacks.
        let glyph = face.glyph_index(c).unwrap_or(GlyphId(0));
        // A blank has no outline, and that is all right.
        let _ = face.outline_glyph(glyph, &mut pen);
        pen.x += f32::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    }
    let shift = match text.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * pen.x,
        Anchor::End => -pen.x,
    };
    let size = text.size as f32 / f32::from(face.units_per_em().max(1));
    let turn = match text.run {
        Run::Across => 0.0,
        Run::Up => -90.0,
    };
    let transform = scale()
        .pre_translate(text.at[0] as f32, text.at[1] as f32)
        .pre_rotate(turn)
        .pre_scale(size, -size)
        .pre_translate(shift, 0.0);
    Some((pen.path.finish()?, transform))
}

/// Collects outlines one after the other along a line.
struct Pen {
    path: PathBuilder,
    x: f32,
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.x + x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.x + x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.quad_to(self.x + x1, y1, self.x + x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.path.cubic_to(self.x + x1, y1, self.x + x2, y2, self.x + x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

/// A picture without a drawing as the bytes of a PNG file, for an `<image>` element.
pub(crate) fn backdrop_png(backdrop: &Backdrop) -> Result<Vec<u8>, String> {
    let rgb: Vec<u8> = backdrop.pixels.iter().flat_map(|p| quantized(*p)).collect();
    encode_rgb(&rgb, [backdrop.side, backdrop.side]).map_err(|e| format!("cannot write the picture: {e}"))
}

fn quantized(rgb: [f32; 3]) -> [u8; 3] {
    rgb.map(|c| (srgb_encode(c.clamp(0.0, 1.0)) * 255.0).round() as u8)
}

/// On white paper every pixel is opaque, so that the alpha channel has nothing to say.
fn encode(map: &Pixmap) -> Result<Vec<u8>, png::EncodingError> {
    let rgb: Vec<u8> = map.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    encode_rgb(&rgb, [map.width(), map.height()])
}

fn encode_rgb(rgb: &[u8], [width, height]: [u32; 2]) -> Result<Vec<u8>, png::EncodingError> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgb)?;
    writer.finish()?;
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use steradian::lab::plot::text_width;

    #[test]
    fn the_font_has_the_glyphs_of_units_and_the_widths_that_layout_assumes() {
        let face = Face::parse(FONT, 0).unwrap();
        for c in "θφλρτηαω°·×±−–…⁰¹²³⁴⁵⁶⁷⁸⁹⁻".chars() {
            assert!(face.glyph_index(c).is_some(), "{c}");
        }
        for c in ' '..='~' {
            let glyph = face.glyph_index(c).unwrap();
            let advance = f64::from(face.glyph_hor_advance(glyph).unwrap());
            assert_eq!(text_width(&c.to_string(), 2048.0), advance, "{c}");
        }
    }

    #[test]
    fn text_up_rises_from_its_place() {
        let mut drawing = Drawing::new(20.0, 40.0);
        drawing.text_up([10.0, 35.0], "MMM", 10.0, Anchor::Start, Ink::BLACK);
        let bytes = png(&drawing).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (40, 80));
        let dark: Vec<(usize, usize)> =
            (0..40 * 80).filter(|i| pixels[3 * i] < 128).map(|i| (i % 40, i / 40)).collect();
        let (x0, x1) = (dark.iter().map(|p| p.0).min().unwrap(), dark.iter().map(|p| p.0).max().unwrap());
        let (y0, y1) = (dark.iter().map(|p| p.1).min().unwrap(), dark.iter().map(|p| p.1).max().unwrap());
        // Three capitals of 8.6 px, 7.3 px high, at twice the size, left of the base line.
        assert!(x0 >= 4 && x1 <= 21 && y1 <= 70 && y0 >= 15 && y1 - y0 > 40, "{x0} {x1} {y0} {y1}");
    }
}
