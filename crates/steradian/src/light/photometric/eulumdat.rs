//! EULUMDAT files (`.ldt`), read and written, after Stockmar's format of 1990: one entry a line.
//!
//! Intensities are in cd per 1000 lm of the lamps' flux, times a conversion factor. Length is along C90–C270, the axis of
//! linear lamps, and width along C0–C180: a quarter turn from IES LM-63.

use super::luminaire::{Label, Luminaire, Opening, Outline, decimal, one_line};
use super::text::{Lines, PhotometricError, Word, decode, number, whole};
use super::web::{MAX_ANGLES, MAX_CANDELA, PhotometricWeb, Planes, Symmetry, WebItem};
use thiserror::Error;

/// Most sets of lamps.
const MAX_LAMP_SETS: i64 = 100;

/// Reads a file. Of several sets of lamps the first one counts.
pub fn read(bytes: &[u8]) -> Result<Luminaire, PhotometricError> {
    let text = decode(bytes);
    let lines = Lines::new(&text);
    Entries { lines: &lines, next: 0 }.luminaire()
}

/// Lines, one after the other.
struct Entries<'l, 't> {
    lines: &'l Lines<'t>,
    next: usize,
}

/// The planes whose intensities a file has.
struct Stored {
    planes: Vec<f64>,
    /// Lines of the planes' angles.
    words: Vec<usize>,
}

impl<'t> Entries<'_, 't> {
    fn line(&mut self, what: &str) -> Result<Word<'t>, PhotometricError> {
        // A line end after the last entry does not begin another one.
        let line =
            self.lines.line(self.next).filter(|w| !w.text.is_empty() || !self.lines.is_blank_from(self.next));
        self.next += 1;
        line.ok_or_else(|| self.lines.error_at_end(format!("the file ends where {what} should follow")))
    }

    fn words(&mut self, what: &str) -> Result<String, PhotometricError> {
        self.line(what).map(|w| w.text.to_owned())
    }

    fn number(&mut self, what: &str) -> Result<f64, PhotometricError> {
        let word = self.line(what)?;
        number(word.text).ok_or_else(|| {
            let message = format!("expected {what}, a number, found `{}`", word.text);
            self.lines.error(word, message)
        })
    }

    fn at_least_zero(&mut self, what: &str) -> Result<f64, PhotometricError> {
        let x = self.number(what)?;
        if x >= 0.0 { Ok(x) } else { Err(self.last_error(format!("{what} must not be negative, found {x}"))) }
    }

    fn whole(&mut self, what: &str, min: i64, max: i64) -> Result<i64, PhotometricError> {
        let word = self.line(what)?;
        whole(word.text, min..=max).ok_or_else(|| {
            let found = word.text;
            let message = format!("{what} must be a whole number from {min} to {max}, found `{found}`");
            self.lines.error(word, message)
        })
    }

    fn count(&mut self, what: &str, min: i64, max: i64) -> Result<usize, PhotometricError> {
        self.whole(what, min, max).map(|n| usize::try_from(n).unwrap_or(0))
    }

    fn list(&mut self, what: &str, n: usize) -> Result<Vec<f64>, PhotometricError> {
        (0..n).map(|i| self.number(&format!("{what} {} of {n}", i + 1))).collect()
    }

    /// An error about the line read last.
    fn last_error(&self, message: impl Into<String>) -> PhotometricError {
        self.error_in(self.next.saturating_sub(1), message)
    }

    fn error_in(&self, line: usize, message: impl Into<String>) -> PhotometricError {
        self.lines.error(self.lines.line(line).unwrap_or(Word { text: "", line, start: 0 }), message)
    }

    fn luminaire(mut self) -> Result<Luminaire, PhotometricError> {
        let maker = self.words("the company")?;
        self.line("the type indicator")?;
        let symmetry = match self.whole("the symmetry indicator Isym", 0, 4)? {
            0 => Symmetry::None,
            1 => Symmetry::Rotational,
            2 => Symmetry::AboutC0,
            3 => Symmetry::AboutC90,
            _ => Symmetry::Quadrant,
        };
        let most = MAX_ANGLES as i64;
        let n_planes = self.count("the number of C-planes Mc", 1, most)?;
        self.check_divisible(symmetry, n_planes)?;
        self.at_least_zero("the distance between C-planes Dc")?;
        let n_angles = self.count("the number of intensities in a C-plane Ng", 2, most)?;
        self.at_least_zero("the distance between intensities Dg")?;
        let report = self.words("the number of the measurement report")?;
        let name = self.words("the name of the luminaire")?;
        let luminaire_number = self.words("the number of the luminaire")?;
        self.line("the file name")?;
        let date = self.words("date and user")?;
        for what in ["the length of the luminaire", "its width", "its height"] {
            self.at_least_zero(what)?;
        }
        let length = self.at_least_zero("the length of the luminous area")?;
        let width = self.at_least_zero("the width of the luminous area")?;
        let mut height = 0.0_f64;
        for plane in ["C0", "C90", "C180", "C270"] {
            height = height.max(self.number(&format!("the height of the luminous area at {plane}"))?);
        }
        self.number("the downward flux fraction")?;
        self.number("the light output ratio")?;
        let conversion = self.number("the conversion factor for luminous intensities")?;
        if conversion <= 0.0 {
            return Err(self.last_error("the conversion factor for luminous intensities must be positive"));
        }
        self.number("the tilt during measurement")?;
        let lamps = self.lamps()?;
        self.list("direct ratio", 10)?;
        let planes_at = self.next;
        let planes = self.list("C-plane", n_planes)?;
        let gamma_at = self.next;
        let gamma = self.list("angle", n_angles)?;
        let stored = stored(symmetry, &planes, planes_at);
        let values_at = self.next;
        let factor = conversion * lamps.lumens / 1000.0;
        let n = stored.planes.len() * n_angles;
        let values = self.list("intensity", n)?;
        let rest = (self.next..self.lines.len()).filter_map(|i| self.lines.line(i));
        if let Some(extra) = rest.into_iter().find(|w| !w.text.is_empty()) {
            let message =
                format!("the file goes on after its {n} intensities ({} × {n_angles})", stored.planes.len());
            return Err(self.lines.error(extra, message));
        }
        let (sector, values) = mirrored(symmetry, stored.planes, values, n_angles);
        let web = PhotometricWeb::type_c(sector, gamma, values).map_err(|e| {
            let line = match e.item() {
                Some(WebItem::Angle(i)) => gamma_at + i,
                Some(WebItem::Intensity(i)) => values_at + i,
                Some(WebItem::Plane(i)) => stored.words.get(i).copied().unwrap_or(planes_at),
                None => planes_at,
            };
            self.error_in(line, e.to_string())
        })?;
        if !(web.peak() * factor <= MAX_CANDELA) {
            return Err(self.error_in(values_at, format!("intensities exceed {MAX_CANDELA:e} cd")));
        }
        // A round opening states its diameter as length.
        let opening = match width == 0.0 && length > 0.0 {
            true => Opening { along_c0: length, along_c90: length, height, outline: Outline::Ellipse },
            false => Opening { along_c0: width, along_c90: length, height, outline: Outline::Rectangle },
        };
        let metres = |mm: f64| mm / 1000.0;
        Ok(Luminaire {
            label: Label { name, number: luminaire_number, maker, report, date, lamp: lamps.kind },
            lamps: lamps.count,
            lamp_lumens: lamps.are_known.then_some(lamps.lumens),
            input_watts: lamps.watts,
            opening: Opening {
                along_c0: metres(opening.along_c0),
                along_c90: metres(opening.along_c90),
                height: metres(opening.height.max(0.0)),
                ..opening
            },
            tilt: None,
            web: web.scaled(factor),
        })
    }

    fn check_divisible(&self, symmetry: Symmetry, n: usize) -> Result<(), PhotometricError> {
        let by = match symmetry {
            Symmetry::None | Symmetry::Rotational => 1,
            Symmetry::AboutC0 => 2,
            Symmetry::AboutC90 | Symmetry::Quadrant => 4,
        };
        if n.is_multiple_of(by) {
            return Ok(());
        }
        Err(self.last_error(format!(
            "with this symmetry the number of C-planes must be a multiple of {by}, found {n}"
        )))
    }

    fn lamps(&mut self) -> Result<Lamps, PhotometricError> {
        let sets = self.whole("the number of sets of lamps", 1, MAX_LAMP_SETS)?;
        let mut first = None;
        for _ in 0..sets {
            // Negative for absolute photometry, of which the flux is that of the luminaire.
            let count = self.whole("the number of lamps", -1_000_000, 1_000_000)?;
            let kind = self.words("the type of lamps")?;
            let lumens = self.number("the total luminous flux of the lamps")?.abs();
            if lumens == 0.0 && first.is_none() {
                return Err(self
                    .last_error("the luminous flux of the lamps must not be zero: intensities refer to it"));
            }
            self.words("the colour of the lamps")?;
            self.words("the colour rendering of the lamps")?;
            let watts = self.line("the power of the lamps")?;
            // Some makers leave it blank, or write a unit behind it.
            let watts = watts.text.split_whitespace().next().and_then(number).filter(|w| *w >= 0.0);
            first.get_or_insert(Lamps {
                count: u32::try_from(count.abs()).unwrap_or(1).max(1),
                are_known: count > 0,
                kind,
                lumens,
                watts: watts.unwrap_or(0.0),
            });
        }
        first.ok_or_else(|| self.last_error("at least one set of lamps is needed"))
    }
}

struct Lamps {
    count: u32,
    /// Whether the flux is that of bare lamps.
    are_known: bool,
    kind: String,
    lumens: f64,
    watts: f64,
}

/// The planes of which the intensities are listed, from all planes, whose angles begin at line `at`.
fn stored(symmetry: Symmetry, planes: &[f64], at: usize) -> Stored {
    let n = planes.len();
    let indices: Vec<usize> = match symmetry {
        Symmetry::None => (0..n).collect(),
        Symmetry::Rotational => vec![0],
        Symmetry::AboutC0 => (0..=n / 2).collect(),
        Symmetry::Quadrant => (0..=n / 4).collect(),
        // From C270 over C0 to C90.
        Symmetry::AboutC90 => (3 * n / 4..=3 * n / 4 + n / 2).map(|i| i % n).collect(),
    };
    Stored {
        planes: indices.iter().map(|&i| planes[i]).collect(),
        words: indices.into_iter().map(|i| at + i).collect(),
    }
}

/// A sector as [`PhotometricWeb::type_c`] takes it: that from C270 over C0 to C90 becomes its image from 90 to 270.
fn mirrored(symmetry: Symmetry, planes: Vec<f64>, values: Vec<f64>, n_angles: usize) -> (Vec<f64>, Vec<f64>) {
    match symmetry {
        Symmetry::AboutC90 => {
            let image =
                planes.iter().rev().map(|c| 180.0 - if *c >= 180.0 { c - 360.0 } else { *c }).collect();
            let rows = values.chunks(n_angles).rev().flatten().copied().collect();
            (image, rows)
        }
        Symmetry::None | Symmetry::Rotational | Symmetry::AboutC0 | Symmetry::Quadrant => (planes, values),
    }
}

/// Why a luminaire cannot be written.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum WriteError {
    /// It has planes of another type.
    #[error("EULUMDAT has planes of type C only, and this luminaire has planes of type {0:?}")]
    Planes(Planes),
    /// A sector without the planes that halve it.
    #[error("EULUMDAT counts planes in equal numbers on either side of a mirror")]
    Uneven,
}

/// The text of a file. Intensities are those of the luminaire, per 1000 lm of its lamps, or per its own 1000 lm where the
/// lamps' flux is not known.
pub fn write(luminaire: &Luminaire) -> Result<String, WriteError> {
    let web = &luminaire.web;
    if web.system() != Planes::C {
        return Err(WriteError::Planes(web.system()));
    }
    let flux = web.flux();
    let symmetry = web.symmetry();
    let planes = web.planes();
    let n = planes.len();
    let at = |c: f64| planes.iter().position(|p| *p == c).ok_or(WriteError::Uneven);
    let (isym, listed): (u8, Vec<usize>) = match symmetry {
        Symmetry::None => (0, (0..n).collect()),
        Symmetry::Rotational => (1, vec![0]),
        Symmetry::AboutC0 => (2, (0..=at(180.0)?).collect()),
        Symmetry::AboutC90 => (3, (at(270.0)?..n).chain(0..=at(90.0)?).collect()),
        Symmetry::Quadrant => (4, (0..=at(90.0)?).collect()),
    };
    // Programs expect planes all around even of one that stands for all.
    let all_planes =
        if symmetry == Symmetry::Rotational { vec![0.0, 90.0, 180.0, 270.0] } else { planes.to_vec() };
    let expected = match symmetry {
        Symmetry::None | Symmetry::Rotational => listed.len(),
        Symmetry::AboutC0 | Symmetry::AboutC90 => n / 2 + 1,
        Symmetry::Quadrant => n / 4 + 1,
    };
    if listed.len() != expected {
        return Err(WriteError::Uneven);
    }
    let lumens = luminaire.lamp_lumens.unwrap_or(if flux > 0.0 { flux } else { 1000.0 });
    let label = &luminaire.label;
    let mut lines: Vec<String> = Vec::new();
    let mm = |metres: f64| decimal(metres * 1000.0);
    let opening = &luminaire.opening;
    let [width, length] = match opening.outline {
        Outline::Ellipse if opening.along_c0 == opening.along_c90 => ["0".to_owned(), mm(opening.along_c90)],
        _ => [mm(opening.along_c0), mm(opening.along_c90)],
    };
    let height = mm(opening.height);
    // Point sources, with or without symmetry, and linear luminaires.
    let kind = match symmetry {
        Symmetry::Rotational => "1",
        _ if opening.along_c90 > 2.0 * opening.along_c0 => "2",
        _ => "3",
    };
    let entry = |text: &str| one_line(text).chars().take(78).collect::<String>();
    lines.extend([entry(&label.maker), kind.to_owned(), isym.to_string()]);
    lines.extend([all_planes.len().to_string(), decimal(spacing(&all_planes, true))]);
    lines.extend([web.angles().len().to_string(), decimal(spacing(web.angles(), false))]);
    lines.extend([
        entry(&label.report),
        entry(&label.name),
        entry(&label.number),
        String::new(),
        entry(&label.date),
    ]);
    lines.extend([length.clone(), width.clone(), height.clone(), length, width]);
    lines.extend(std::iter::repeat_n(height, 4));
    let percent = |share: f64| decimal((1e4 * share).round() / 100.0);
    let downward = if flux > 0.0 { web.flux_within([0.0, 90.0]) / flux } else { 0.0 };
    lines.extend([percent(downward), percent(flux / lumens), "1".to_owned(), "0".to_owned()]);
    let count = i64::from(luminaire.lamps.max(1));
    let count = if luminaire.lamp_lumens.is_some() { count } else { -count };
    lines.extend(["1".to_owned(), count.to_string(), entry(&label.lamp), decimal(lumens)]);
    lines.extend([String::new(), String::new(), decimal(luminaire.input_watts)]);
    // Direct ratios for room indices: not stated.
    lines.extend(std::iter::repeat_n("0".to_owned(), 10));
    lines.extend(all_planes.iter().map(|c| decimal(*c)));
    lines.extend(web.angles().iter().map(|g| decimal(*g)));
    for plane in listed {
        lines.extend(web.plane(plane).iter().map(|i| decimal(i * 1000.0 / lumens)));
    }
    Ok(lines.join("\r\n") + "\r\n")
}

/// The distance of equidistant angles [°], 0 of others.
fn spacing(list: &[f64], around: bool) -> f64 {
    let [first, second, ..] = list else { return 0.0 };
    let step = second - first;
    let even = list.windows(2).all(|w| (w[1] - w[0] - step).abs() < 1e-9);
    let closes = !around || (list.len() as f64 * step - 360.0).abs() < 1e-9;
    if even && closes { step } else { 0.0 }
}
