//! Drawings as SVG 1.1.

use super::drawing::{Anchor, Drawing, Ink, Mark, Run, Stroke, Text};
use std::fmt::Write as _;

/// The faces that texts ask for, the one that [`text_width`](super::drawing::text_width) measures first.
const FACES: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";

/// The drawing as an `<svg>` element, which stands alone as a file and inside of HTML.
pub fn svg(drawing: &Drawing) -> String {
    let (w, h) = (number(drawing.width), number(drawing.height));
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
         font-family=\"{FACES}\">\n<rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n"
    );
    for mark in &drawing.marks {
        match mark {
            Mark::Line { points, stroke } => line(&mut out, points, stroke),
            Mark::Area { points, ink, opacity } => area(&mut out, points, *ink, *opacity),
            Mark::Text(t) => text(&mut out, t),
        }
    }
    out.push_str("</svg>\n");
    out
}

fn line(out: &mut String, points: &[[f64; 2]], stroke: &Stroke) {
    let Stroke { ink, width, dash } = stroke;
    // Writing to a String does not fail.
    let _ = write!(
        out,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"",
        coordinates(points),
        hex(*ink),
        number(*width)
    );
    let lengths: Vec<_> = dash.lengths().iter().map(|l| number(f64::from(*l))).collect();
    if !lengths.is_empty() {
        let _ = write!(out, " stroke-dasharray=\"{}\"", lengths.join(" "));
    }
    out.push_str("/>\n");
}

fn area(out: &mut String, points: &[[f64; 2]], ink: Ink, opacity: f64) {
    let _ = writeln!(
        out,
        "<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"{}\"/>",
        coordinates(points),
        hex(ink),
        number(opacity)
    );
}

fn text(out: &mut String, t: &Text) {
    let (x, y) = (number(t.at[0]), number(t.at[1]));
    let anchor = match t.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let turn = match t.run {
        Run::Across => String::new(),
        Run::Up => format!(" transform=\"rotate(-90 {x} {y})\""),
    };
    let _ = writeln!(
        out,
        "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" fill=\"{}\" text-anchor=\"{anchor}\"{turn}>{}</text>",
        number(t.size),
        hex(t.ink),
        escaped(&t.text)
    );
}

fn coordinates(points: &[[f64; 2]]) -> String {
    let pairs: Vec<_> = points.iter().map(|[x, y]| format!("{},{}", number(*x), number(*y))).collect();
    pairs.join(" ")
}

/// Hundredths of pixels, without the zeros that say nothing.
fn number(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn hex(ink: Ink) -> String {
    format!("#{:02x}{:02x}{:02x}", ink.r, ink.g, ink.b)
}

/// The characters as XML allows them: markup escaped, control characters left out.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {}
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_never_minus_zero() {
        let written: Vec<_> = [1.0, -0.001, 2.5, 1e-9, -12.345].iter().map(|x| number(*x)).collect();
        assert_eq!(written, ["1", "0", "2.5", "0", "-12.35"]);
    }

    #[test]
    fn text_cannot_break_out_of_its_element() {
        let mut drawing = Drawing::new(10.0, 10.0);
        drawing.text([1.0, 2.0], "</text><script a=\"b\">&\u{1}", 9.0, Anchor::Middle, Ink::BLACK);
        let out = svg(&drawing);
        assert!(out.contains(">&lt;/text&gt;&lt;script a=&quot;b&quot;&gt;&amp;</text>"), "{out}");
    }
}
