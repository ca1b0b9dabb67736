//! IES LM-63 files, read and written: the editions of 1986, 1991, 1995, 2002 and 2019.
//!
//! A file has a line with its edition (none in 1986), lines of keywords, the line `TILT=…`, and numbers that spaces, commas
//! or line ends part: lamps, lumens per lamp (−1 for absolute photometry), multiplier, numbers of vertical and horizontal
//! angles, photometric type, unit, width, length and height of the opening, ballast factor, ballast–lamp photometric factor,
//! input watts, the angles, and the intensities of each horizontal angle.

use super::luminaire::{Label, Luminaire, Opening, Outline, Tilt, TiltGeometry, decimal, one_line};
use super::text::{Lines, PhotometricError, Word, decode, number, whole};
use super::web::{MAX_ANGLES, MAX_CANDELA, PhotometricWeb, Planes, Symmetry, WebError, WebItem};
use std::fmt::Write as _;

/// An edition of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Edition {
    /// LM-63-1986.
    Of1986,
    /// LM-63-1991.
    Of1991,
    /// LM-63-1995.
    Of1995,
    /// LM-63-2002.
    Of2002,
    /// LM-63-2019.
    Of2019,
}

impl Edition {
    const ALL: [Self; 5] = [Self::Of1986, Self::Of1991, Self::Of1995, Self::Of2002, Self::Of2019];

    /// The first line of a file; none in 1986.
    fn mark(self) -> &'static str {
        match self {
            Self::Of1986 => "",
            Self::Of1991 => "IESNA91",
            Self::Of1995 => "IESNA:LM-63-1995",
            Self::Of2002 => "IESNA:LM-63-2002",
            Self::Of2019 => "IES:LM-63-2019",
        }
    }
}

const METRES_PER_FOOT: f64 = 0.3048;

/// Most pairs of tilt angles and factors.
const MAX_TILTS: i64 = 1000;

/// Reads a file. `tilt_file` gives the bytes of the file that a line `TILT=<name>` names, and why it cannot otherwise.
pub fn read(
    bytes: &[u8],
    tilt_file: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Luminaire, PhotometricError> {
    let text = decode(bytes);
    let lines = Lines::new(&text);
    let header = Header::read(&lines)?;
    let mut data = Data { lines: &lines, next: header.tilt.line + 1, words: Vec::new() };
    let name = header.tilt.text.split_once('=').map_or("", |(_, n)| n.trim());
    let tilt = match name.to_ascii_uppercase().as_str() {
        "" => return Err(lines.error(header.tilt, "TILT= needs NONE, INCLUDE or the name of a file")),
        "NONE" => None,
        "INCLUDE" => Some(data.tilt()?),
        _ => Some(tilt_of_file(&lines, header.tilt, name, tilt_file)?),
    };
    data.luminaire(header, tilt)
}

fn tilt_of_file(
    lines: &Lines<'_>,
    place: Word<'_>,
    name: &str,
    tilt_file: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Tilt, PhotometricError> {
    let bytes = tilt_file(name)
        .map_err(|why| lines.error(place, format!("cannot read the file of tilt factors: {why}")))?;
    let text = decode(&bytes);
    let tilt_lines = Lines::new(&text);
    let mut data = Data { lines: &tilt_lines, next: 0, words: Vec::new() };
    data.tilt().map_err(|e| PhotometricError { file: Some(name.to_owned()), ..e })
}

/// What stands above the numbers.
struct Header<'t> {
    edition: Edition,
    label: Label,
    /// The line `TILT=…`.
    tilt: Word<'t>,
}

impl<'t> Header<'t> {
    fn read(lines: &Lines<'t>) -> Result<Self, PhotometricError> {
        let first = lines.line(0).map_or("", |w| w.text);
        let edition = Edition::ALL
            .into_iter()
            .rev()
            .find(|e| first.get(..e.mark().len()).is_some_and(|start| start.eq_ignore_ascii_case(e.mark())));
        let mut header = Self {
            edition: edition.unwrap_or(Edition::Of1986),
            label: Label::default(),
            tilt: Word { text: "", line: 0, start: 0 },
        };
        for word in (0..lines.len()).filter_map(|i| lines.line(i)) {
            if word.text.get(..5).is_some_and(|s| s.eq_ignore_ascii_case("TILT=")) {
                header.tilt = word;
                return Ok(header);
            }
            header.keyword(word.text);
        }
        Err(lines.error_at_end("no line begins with TILT=, as one of every IES LM-63 file does"))
    }

    fn keyword(&mut self, line: &str) {
        let Some((key, value)) = line.strip_prefix('[').and_then(|l| l.split_once(']')) else { return };
        let slot = match key.trim().to_ascii_uppercase().as_str() {
            "LUMINAIRE" => &mut self.label.name,
            "LUMCAT" => &mut self.label.number,
            "MANUFAC" => &mut self.label.maker,
            "TEST" => &mut self.label.report,
            "ISSUEDATE" | "DATE" => &mut self.label.date,
            "LAMP" => &mut self.label.lamp,
            _ => return,
        };
        if slot.is_empty() {
            value.trim().clone_into(slot);
        }
    }
}

/// The numbers, in the order of the file.
struct Data<'l, 't> {
    lines: &'l Lines<'t>,
    /// The line after those of `words`.
    next: usize,
    /// Words of the current line, reversed.
    words: Vec<Word<'t>>,
}

impl<'t> Data<'_, 't> {
    fn word(&mut self) -> Option<Word<'t>> {
        while self.words.is_empty() {
            if self.next >= self.lines.len() {
                return None;
            }
            self.words.extend(self.lines.words(self.next));
            self.words.reverse();
            self.next += 1;
        }
        self.words.pop()
    }

    fn number(&mut self, what: &str) -> Result<(f64, Word<'t>), PhotometricError> {
        let Some(word) = self.word() else {
            return Err(self.lines.error_at_end(format!("the file ends where {what} should follow")));
        };
        match number(word.text) {
            Some(x) => Ok((x, word)),
            None => {
                let message = format!("expected {what}, a number, found `{}`", word.text);
                Err(self.lines.error(word, message))
            }
        }
    }

    fn positive(&mut self, what: &str) -> Result<(f64, Word<'t>), PhotometricError> {
        let (x, word) = self.number(what)?;
        if x > 0.0 {
            Ok((x, word))
        } else {
            Err(self.lines.error(word, format!("{what} must be positive, found {x}")))
        }
    }

    fn count(&mut self, what: &str, min: i64, max: i64) -> Result<usize, PhotometricError> {
        let (_, word) = self.number(what)?;
        whole(word.text, min..=max).and_then(|n| usize::try_from(n).ok()).ok_or_else(|| {
            let message = format!("{what} must be a whole number from {min} to {max}, found {}", word.text);
            self.lines.error(word, message)
        })
    }

    /// `n` numbers with their places.
    fn list(&mut self, what: &str, n: usize) -> Result<Listed<'t>, PhotometricError> {
        let mut listed = Listed { values: Vec::new(), words: Vec::new() };
        for i in 0..n {
            let (x, word) = self.number(&format!("{what} {} of {n}", i + 1))?;
            listed.values.push(x);
            listed.words.push(word);
        }
        Ok(listed)
    }

    fn tilt(&mut self) -> Result<Tilt, PhotometricError> {
        let geometry = match self.count("the lamp-to-luminaire geometry", 1, 3)? {
            1 => TiltGeometry::Vertical,
            2 => TiltGeometry::HorizontalAlong0,
            _ => TiltGeometry::HorizontalAlong90,
        };
        let n = self.count("the number of tilt angles", 1, MAX_TILTS)?;
        let angles = self.list("tilt angle", n)?;
        if let Some(i) = angles.values.windows(2).position(|w| w[0] >= w[1]) {
            return Err(self.lines.error(angles.words[i + 1], "tilt angles must increase"));
        }
        let factors = self.list("tilt factor", n)?;
        if let Some(i) = factors.values.iter().position(|f| *f < 0.0) {
            return Err(self.lines.error(factors.words[i], "a tilt factor must not be negative"));
        }
        Ok(Tilt { geometry, angles: angles.values, factors: factors.values })
    }

    fn luminaire(mut self, header: Header<'t>, tilt: Option<Tilt>) -> Result<Luminaire, PhotometricError> {
        let lamps = self.count("the number of lamps", 0, 1_000_000)?;
        let (lumens, place) = self.number("the lumens per lamp")?;
        if lumens < 0.0 && lumens != -1.0 {
            let message = "the lumens per lamp must be positive, or -1 for absolute photometry";
            return Err(self.lines.error(place, message));
        }
        let (multiplier, multiplier_at) = self.positive("the candela multiplier")?;
        let most = MAX_ANGLES as i64;
        let n_vertical = self.count("the number of vertical angles", 2, most)?;
        let n_horizontal = self.count("the number of horizontal angles", 1, most)?;
        let system = match self.count("the photometric type", 1, 3)? {
            1 => Planes::C,
            2 => Planes::B,
            _ => Planes::A,
        };
        let metres = match self.count("the unit of the opening (1 feet, 2 metres)", 1, 2)? {
            1 => METRES_PER_FOOT,
            _ => 1.0,
        };
        let opening = self.list("size of the opening", 3)?;
        let (ballast, _) = self.positive("the ballast factor")?;
        let (photometric, _) = self.positive("the ballast-lamp photometric factor")?;
        // Since 2019 this number codes how the file was made.
        let photometric = if header.edition >= Edition::Of2019 { 1.0 } else { photometric };
        let (input_watts, place) = self.number("the input watts")?;
        if input_watts < 0.0 {
            return Err(self.lines.error(place, "the input watts must not be negative"));
        }
        let vertical = self.list("vertical angle", n_vertical)?;
        let horizontal = self.list("horizontal angle", n_horizontal)?;
        let candela = self.candela(n_horizontal, n_vertical)?;
        let factor = multiplier * ballast * photometric;
        let make = match system {
            Planes::A => PhotometricWeb::type_a,
            Planes::B => PhotometricWeb::type_b,
            Planes::C => PhotometricWeb::type_c,
        };
        let web = make(horizontal.values.clone(), vertical.values.clone(), candela.values.clone())
            .map_err(|e| self.fault(&e, &horizontal, &vertical, &candela))?;
        if !(web.peak() * factor <= MAX_CANDELA) {
            return Err(self.lines.error(multiplier_at, format!("intensities exceed {MAX_CANDELA:e} cd")));
        }
        if let Some(extra) = self.word() {
            let n = n_horizontal * n_vertical;
            let message =
                format!("the file goes on after its {n} intensities ({n_horizontal} × {n_vertical})");
            return Err(self.lines.error(extra, message));
        }
        let lamps = u32::try_from(lamps).unwrap_or(1).max(1);
        Ok(Luminaire {
            label: header.label,
            lamps,
            lamp_lumens: (lumens > 0.0).then_some(lumens * f64::from(lamps)),
            input_watts,
            opening: read_opening(
                [opening.values[0], opening.values[1], opening.values[2]],
                metres,
                header.edition,
            ),
            tilt,
            web: web.scaled(factor),
        })
    }

    fn candela(&mut self, n_horizontal: usize, n_vertical: usize) -> Result<Listed<'t>, PhotometricError> {
        let n = n_horizontal * n_vertical;
        let mut listed = Listed { values: Vec::new(), words: Vec::new() };
        for i in 0..n {
            let (x, word) = self.number("an intensity").map_err(|e| PhotometricError {
                message: format!(
                    "{} (intensity {} of horizontal angle {} of {n_horizontal})",
                    e.message,
                    i % n_vertical + 1,
                    i / n_vertical + 1
                ),
                ..e
            })?;
            listed.values.push(x);
            listed.words.push(word);
        }
        Ok(listed)
    }

    fn fault(
        &self,
        error: &WebError,
        horizontal: &Listed<'t>,
        vertical: &Listed<'t>,
        candela: &Listed<'t>,
    ) -> PhotometricError {
        let place = match error.item() {
            Some(WebItem::Plane(i)) => horizontal.words.get(i),
            Some(WebItem::Angle(i)) => vertical.words.get(i),
            Some(WebItem::Intensity(i)) => candela.words.get(i),
            None => horizontal.words.first(),
        };
        match place {
            Some(&word) => self.lines.error(word, error.to_string()),
            None => self.lines.error_at_end(error.to_string()),
        }
    }
}

/// Numbers and where they stand.
struct Listed<'t> {
    values: Vec<f64>,
    words: Vec<Word<'t>>,
}

/// The opening from width (across the zero plane), length (along it) and height, of which signs tell shapes.
///
/// A negative width stands for something round. Until 1995 a round opening states its width alone and an ellipse also a
/// positive length; since 2002 all negative extents belong to something round, and one positive extent beside a negative one
/// to a cylinder that lies, whose plan is a rectangle.
fn read_opening([width, length, height]: [f64; 3], metres: f64, edition: Edition) -> Opening {
    let round = match edition {
        Edition::Of1986 | Edition::Of1991 | Edition::Of1995 => {
            width < 0.0 && (height >= 0.0 || length == 0.0)
        }
        Edition::Of2002 | Edition::Of2019 => width < 0.0 && length <= 0.0,
    };
    let across = width.abs() * metres;
    let along = if round && length == 0.0 { across } else { length.abs() * metres };
    let outline = if round { Outline::Ellipse } else { Outline::Rectangle };
    Opening { along_c0: along, along_c90: across, height: height.abs() * metres, outline }
}

/// The text of a file of an edition. Intensities are written as they are, with all factors at 1; what a web's symmetry repeats
/// is left out. The tilt factors are included.
pub fn write(luminaire: &Luminaire, edition: Edition) -> String {
    let mut text = String::new();
    let label = &luminaire.label;
    let line = |text: &mut String, line: &str| {
        text.push_str(line);
        text.push_str("\r\n");
    };
    if edition > Edition::Of1986 {
        line(&mut text, edition.mark());
        let or_unknown = |s: &str| if s.trim().is_empty() { "unknown".to_owned() } else { one_line(s) };
        // The keywords that the standard demands, then those that are known.
        line(&mut text, &format!("[TEST] {}", or_unknown(&label.report)));
        line(&mut text, &format!("[MANUFAC] {}", or_unknown(&label.maker)));
        if edition >= Edition::Of2002 {
            line(&mut text, "[TESTLAB] unknown");
            line(&mut text, &format!("[ISSUEDATE] {}", or_unknown(&label.date)));
        }
        for (key, value) in [("LUMCAT", &label.number), ("LUMINAIRE", &label.name), ("LAMP", &label.lamp)] {
            if !value.trim().is_empty() {
                line(&mut text, &format!("[{key}] {}", one_line(value)));
            }
        }
    } else if !label.name.trim().is_empty() {
        line(&mut text, &one_line(&label.name));
    }
    match &luminaire.tilt {
        None => line(&mut text, "TILT=NONE"),
        Some(tilt) => {
            line(&mut text, "TILT=INCLUDE");
            let geometry = match tilt.geometry {
                TiltGeometry::Vertical => 1,
                TiltGeometry::HorizontalAlong0 => 2,
                TiltGeometry::HorizontalAlong90 => 3,
            };
            line(&mut text, &geometry.to_string());
            line(&mut text, &tilt.angles.len().to_string());
            numbers(&mut text, &tilt.angles);
            numbers(&mut text, &tilt.factors);
        }
    }
    let rows = Rows::of(&luminaire.web);
    let kind = match luminaire.web.system() {
        Planes::C => 1,
        Planes::B => 2,
        Planes::A => 3,
    };
    let per_lamp = luminaire.lamp_lumens.map_or(-1.0, |lm| lm / f64::from(luminaire.lamps.max(1)));
    let [width, length, height] = written_opening(&luminaire.opening, edition).map(decimal);
    let (lamps, per_lamp) = (luminaire.lamps.max(1), decimal(per_lamp));
    let (n_vertical, n_horizontal) = (rows.vertical.len(), rows.horizontal.len());
    line(
        &mut text,
        &format!("{lamps} {per_lamp} 1 {n_vertical} {n_horizontal} {kind} 2 {width} {length} {height}"),
    );
    // In 2019 the second number says how the file was made: here unknown to us.
    let factors = if edition >= Edition::Of2019 { "1 1.00001" } else { "1 1" };
    line(&mut text, &format!("{factors} {}", decimal(luminaire.input_watts)));
    numbers(&mut text, &rows.vertical);
    numbers(&mut text, &rows.horizontal);
    for row in &rows.candela {
        numbers(&mut text, row);
    }
    text
}

/// Numbers in lines of at most 100 characters: earlier editions end lines at 132.
fn numbers(text: &mut String, values: &[f64]) {
    let mut line = String::new();
    for value in values {
        let word = decimal(*value);
        if !line.is_empty() && line.len() + word.len() > 100 {
            text.push_str(&line);
            text.push_str("\r\n");
            line.clear();
        }
        // Writing to a String cannot fail.
        let _ = write!(line, "{}{word}", if line.is_empty() { "" } else { " " });
    }
    text.push_str(&line);
    text.push_str("\r\n");
}

fn written_opening(opening: &Opening, edition: Edition) -> [f64; 3] {
    let [w, l, h] = [opening.along_c90, opening.along_c0, opening.height];
    match opening.outline {
        Outline::Rectangle => [w, l, h],
        Outline::Ellipse if edition >= Edition::Of2002 => [-w, -l, h],
        Outline::Ellipse if w == l => [-w, 0.0, h],
        Outline::Ellipse => [-w, l, h],
    }
}

/// A web in the order of the file.
struct Rows {
    horizontal: Vec<f64>,
    vertical: Vec<f64>,
    /// The intensities of each horizontal angle.
    candela: Vec<Vec<f64>>,
}

impl Rows {
    fn of(web: &PhotometricWeb) -> Self {
        let less_90 = |list: &[f64]| list.iter().map(|a| a - 90.0).collect::<Vec<_>>();
        let rows = |kept: &[usize]| kept.iter().map(|&i| web.plane(i).to_vec()).collect();
        match web.system() {
            Planes::A => Self {
                horizontal: web.planes().to_vec(),
                vertical: less_90(web.angles()),
                candela: rows(&(0..web.planes().len()).collect::<Vec<_>>()),
            },
            Planes::B => Self {
                horizontal: less_90(web.angles()),
                vertical: web.planes().to_vec(),
                candela: (0..web.angles().len())
                    .map(|h| (0..web.planes().len()).map(|v| web.plane(v)[h]).collect())
                    .collect(),
            },
            Planes::C => {
                let [from, to] = match web.symmetry() {
                    Symmetry::Rotational => [0.0, 0.0],
                    Symmetry::Quadrant => [0.0, 90.0],
                    Symmetry::AboutC0 => [0.0, 180.0],
                    Symmetry::AboutC90 => [90.0, 270.0],
                    Symmetry::None => [0.0, 360.0],
                };
                let planes = web.planes();
                let mut kept: Vec<usize> =
                    (0..planes.len()).filter(|&i| (from..=to).contains(&planes[i])).collect();
                let mut horizontal: Vec<f64> = kept.iter().map(|&i| planes[i]).collect();
                if web.symmetry() == Symmetry::None {
                    kept.push(0);
                    horizontal.push(360.0);
                }
                Self { horizontal, vertical: web.angles().to_vec(), candela: rows(&kept) }
            }
        }
    }
}
