//! A drawing as plain data: what plots are made of, and what a file format writes.
//!
//! Coordinates are in pixels of the nominal size, x to the right and y down.

/// An opaque colour in sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ink {
    /// Red, encoded.
    pub r: u8,
    /// Green, encoded.
    pub g: u8,
    /// Blue, encoded.
    pub b: u8,
}

impl Ink {
    /// Paper.
    pub const WHITE: Self = Self::new(255, 255, 255);
    /// Axes and text.
    pub const BLACK: Self = Self::new(34, 34, 34);
    /// Labels of lesser weight.
    pub const GREY: Self = Self::new(96, 96, 96);
    /// Grid lines.
    pub const PALE: Self = Self::new(222, 222, 222);

    /// A colour from its encoded parts.
    pub const fn new(r: u8, g: u8, b: u8) -> Self {
        Self { r, g, b }
    }
}

/// How a line is interrupted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dash {
    /// Not at all.
    #[default]
    Solid,
    /// Long strokes.
    Dashed,
    /// Dots.
    Dotted,
    /// Strokes and dots in turn.
    DashDotted,
}

impl Dash {
    /// All of them, the plainest first.
    pub const ALL: [Self; 4] = [Self::Solid, Self::Dashed, Self::Dotted, Self::DashDotted];

    /// Lengths of strokes and gaps in turn [px]; empty for a solid line.
    pub fn lengths(self) -> &'static [f32] {
        match self {
            Self::Solid => &[],
            Self::Dashed => &[8.0, 4.0],
            Self::Dotted => &[2.0, 3.0],
            Self::DashDotted => &[8.0, 3.0, 2.0, 3.0],
        }
    }
}

/// The look of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Colour.
    pub ink: Ink,
    /// Width [px], above 0.
    pub width: f64,
    /// Interruptions.
    pub dash: Dash,
}

impl Stroke {
    /// A solid line.
    pub const fn solid(ink: Ink, width: f64) -> Self {
        Self { ink, width, dash: Dash::Solid }
    }
}

/// Which part of a text stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its beginning.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// The way a text runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Run {
    /// From left to right.
    Across,
    /// From the bottom to the top.
    Up,
}

/// One line of text.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// Where the anchor stands on the base line.
    pub at: [f64; 2],
    /// The characters.
    pub text: String,
    /// Height of the em square [px].
    pub size: f64,
    /// What stands there.
    pub anchor: Anchor,
    /// Direction.
    pub run: Run,
    /// Colour.
    pub ink: Ink,
}

/// One element of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A line through points.
    Line {
        /// At least two points.
        points: Vec<[f64; 2]>,
        /// Its look.
        stroke: Stroke,
    },
    /// A filled polygon.
    Area {
        /// At least three corners.
        points: Vec<[f64; 2]>,
        /// Its colour.
        ink: Ink,
        /// Share of the colour, in (0, 1].
        opacity: f64,
    },
    /// Text.
    Text(Text),
}

/// A picture of lines, areas and text on white.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Width [px].
    pub width: f64,
    /// Height [px].
    pub height: f64,
    /// The elements, later ones over earlier ones.
    pub marks: Vec<Mark>,
}

impl Drawing {
    /// An empty sheet.
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height, marks: Vec::new() }
    }

    /// Adds a line; fewer than two points are none.
    pub fn line(&mut self, points: Vec<[f64; 2]>, stroke: Stroke) {
        if points.len() >= 2 {
            self.marks.push(Mark::Line { points, stroke });
        }
    }

    /// Adds a filled polygon; fewer than three corners are none.
    pub fn area(&mut self, points: Vec<[f64; 2]>, ink: Ink, opacity: f64) {
        if points.len() >= 3 {
            self.marks.push(Mark::Area { points, ink, opacity });
        }
    }

    /// Adds text that runs across.
    pub fn text(&mut self, at: [f64; 2], text: impl Into<String>, size: f64, anchor: Anchor, ink: Ink) {
        let run = Run::Across;
        self.marks.push(Mark::Text(Text { at, text: text.into(), size, anchor, run, ink }));
    }

    /// Adds text that runs from the bottom to the top.
    pub fn text_up(&mut self, at: [f64; 2], text: impl Into<String>, size: f64, anchor: Anchor, ink: Ink) {
        self.marks.push(Mark::Text(Text { at, text: text.into(), size, anchor, run: Run::Up, ink }));
    }

    /// Adds another drawing with its upper left corner at a place.
    pub fn place(&mut self, other: Self, at: [f64; 2]) {
        let moved = |p: &mut [f64; 2]| {
            p[0] += at[0];
            p[1] += at[1];
        };
        for mut mark in other.marks {
            match &mut mark {
                Mark::Line { points, .. } | Mark::Area { points, .. } => points.iter_mut().for_each(moved),
                Mark::Text(text) => moved(&mut text.at),
            }
            self.marks.push(mark);
        }
    }

    /// Drawings side by side, `columns` to a row, each cell as large as the largest of them.
    pub fn grid(drawings: Vec<Self>, columns: usize) -> Self {
        let columns = columns.clamp(1, drawings.len().max(1));
        let rows = drawings.len().div_ceil(columns);
        let width = drawings.iter().map(|d| d.width).fold(0.0, f64::max);
        let height = drawings.iter().map(|d| d.height).fold(0.0, f64::max);
        let mut sheet = Self::new(width * columns as f64, height * rows as f64);
        for (i, drawing) in drawings.into_iter().enumerate() {
            sheet.place(drawing, [(i % columns) as f64 * width, (i / columns) as f64 * height]);
        }
        sheet
    }
}

/// Width of a text [px], by the advances of DejaVu Sans; other sans-serif faces are hardly wider.
pub fn text_width(text: &str, size: f64) -> f64 {
    let advance = |c: char| match c {
        ' '..='~' => ADVANCES[c as usize - 32],
        '²' | '³' | '¹' | '⁰' | '⁴'..='⁹' => 821,
        '·' => 651,
        '°' | '–' => 1024,
        '−' | '±' | '×' | '…' => 1716,
        _ => 1300,
    };
    text.chars().map(|c| f64::from(advance(c))).sum::<f64>() * size / 2048.0
}

/// Advance widths of the printable ASCII characters in 2048ths of the size.
const ADVANCES: [u16; 95] = [
    651, 821, 942, 1716, 1303, 1946, 1597, 563, 799, 799, 1024, 1716, 651, 739, 651, 690, 1303, 1303, 1303,
    1303, 1303, 1303, 1303, 1303, 1303, 1303, 690, 690, 1716, 1716, 1716, 1087, 2048, 1401, 1405, 1430, 1577,
    1294, 1178, 1587, 1540, 604, 604, 1343, 1141, 1767, 1532, 1612, 1235, 1612, 1423, 1300, 1251, 1499, 1401,
    2025, 1403, 1251, 1403, 799, 690, 799, 1716, 1024, 1024, 1255, 1300, 1126, 1300, 1260, 721, 1300, 1298,
    569, 569, 1186, 569, 1995, 1298, 1253, 1300, 1300, 842, 1067, 803, 1298, 1212, 1675, 1212, 1212, 1075,
    1303, 690, 1303, 1716,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_moves_every_mark_into_its_own_cell() {
        let mut cell = Drawing::new(10.0, 20.0);
        cell.line(vec![[1.0, 2.0], [3.0, 4.0]], Stroke::solid(Ink::BLACK, 1.0));
        cell.text([5.0, 6.0], "t", 10.0, Anchor::Start, Ink::BLACK);
        let sheet = Drawing::grid(vec![cell.clone(), cell.clone(), cell], 2);
        assert_eq!((sheet.width, sheet.height, sheet.marks.len()), (20.0, 40.0, 6));
        let Mark::Line { points, .. } = &sheet.marks[2] else { panic!("{:?}", sheet.marks[2]) };
        assert_eq!(points[0], [11.0, 2.0]);
        let Mark::Text(text) = &sheet.marks[5] else { panic!("{:?}", sheet.marks[5]) };
        assert_eq!(text.at, [5.0, 26.0]);
    }

    #[test]
    fn widths_of_text_grow_with_its_size_and_length() {
        assert!((text_width("00", 2048.0) - 2606.0).abs() < 1e-9);
        assert!((text_width("00", 12.0) * 2.0 - text_width("0000", 12.0)).abs() < 1e-9);
    }
}
