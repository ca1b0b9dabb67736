//! Where meters stand: positions and directions from the command line, from files, from standard input, and on grids.

use super::series::Fault;
use crate::output::reason;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// Three coordinates and three components of a direction.
pub(crate) type Six = [f64; 6];

/// Most points of a grid: one reading takes a millisecond at least.
const MAX_CELLS: f64 = 1e7;

/// Cells of a parallelogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    origin: [f64; 3],
    u: [f64; 3],
    v: [f64; 3],
    /// Number of cells along `u` and along `v`.
    pub(crate) cells: [usize; 2],
}

impl Grid {
    /// The centres of the cells with the normal u × v, rows along `u` one after the other.
    pub(crate) fn points(&self) -> impl Iterator<Item = Six> {
        let Self { origin, u, v, cells: [nu, nv] } = *self;
        let n: [f64; 3] = std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            u[j] * v[k] - u[k] * v[j]
        });
        let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        let n = n.map(|x| x / length);
        (0..nu * nv).map(move |i| {
            let s = ((i % nu) as f64 + 0.5) / nu as f64;
            let t = ((i / nu) as f64 + 0.5) / nv as f64;
            let p: [f64; 3] = std::array::from_fn(|i| origin[i] + s * u[i] + t * v[i]);
            [p[0], p[1], p[2], n[0], n[1], n[2]]
        })
    }

    /// Lengths of the edges.
    pub(crate) fn sides(&self) -> [f64; 2] {
        [self.u, self.v].map(|e| e.iter().map(|x| x * x).sum::<f64>().sqrt())
    }
}

pub(crate) fn parse_six(text: &str) -> Result<Six, String> {
    let six =
        numbers::<6>(text).ok_or("expected six numbers: a position and a direction, as in 0,0,0.8,0,0,1")?;
    checked(six).map_err(str::to_owned)
}

/// A direction needs a length.
fn checked(six: Six) -> Result<Six, &'static str> {
    if six[3..].iter().all(|&x| x == 0.0) { Err("the direction has no length") } else { Ok(six) }
}

pub(crate) fn parse_grid(text: &str) -> Result<Grid, String> {
    let all = numbers::<11>(text).ok_or(
        "expected eleven numbers: the position of a corner, two edges from there, and the number of cells along each, \
         as in 0,0,0.8,4,0,0,0,3,0,8,6",
    )?;
    let part = |i: usize| [all[i], all[i + 1], all[i + 2]];
    let cells = [all[9], all[10]];
    if !cells.iter().all(|&n| n >= 1.0 && n.fract() == 0.0) || cells[0] * cells[1] > MAX_CELLS {
        return Err(
            "the numbers of cells must be whole, at least 1, and at most ten million together".to_owned()
        );
    }
    let grid = Grid { origin: part(0), u: part(3), v: part(6), cells: cells.map(|n| n as usize) };
    match grid.points().next() {
        Some(point) if point.iter().all(|x| x.is_finite()) => Ok(grid),
        _ => Err("the edges of the grid span no area".to_owned()),
    }
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let all: Vec<f64> = text.split(',').map(|s| number(s.trim())).collect::<Option<_>>()?;
    all.try_into().ok()
}

fn number(text: &str) -> Option<f64> {
    text.parse().ok().filter(|x: &f64| x.is_finite())
}

/// Reads six numbers from each line of a file, or of standard input for `-`, unless scenes come from there.
pub(crate) fn read(path: &Path, scenes: &[PathBuf]) -> Result<Vec<Six>, String> {
    let stdin = Path::new("-");
    if path != stdin {
        let text = std::fs::read_to_string(path).map_err(|e| match e.kind() {
            std::io::ErrorKind::InvalidData => format!("{} is not a text file", path.display()),
            _ => format!("cannot read {}: {}", path.display(), reason(&e)),
        })?;
        let name = path.display().to_string();
        return parse(&text).map_err(|fault| fault.shown(&name, &text));
    }
    if scenes.iter().any(|s| s == stdin) {
        return Err("standard input holds either the scene or the list of positions, not both".to_owned());
    }
    let mut text = String::new();
    std::io::stdin()
        .read_to_string(&mut text)
        .map_err(|e| format!("cannot read standard input: {}", reason(&e)))?;
    parse(&text).map_err(|fault| fault.shown("(standard input)", &text))
}

/// Numbers apart by blanks or commas; lines that are blank, and what follows a `#`, say nothing.
fn parse(text: &str) -> Result<Vec<Six>, Fault> {
    let mut all = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let content = line.split('#').next().unwrap_or("");
        let mut six = Vec::new();
        let mut at = start;
        for piece in content.split_inclusive(|c: char| c.is_whitespace() || c == ',') {
            let word = piece.trim_end_matches(|c: char| c.is_whitespace() || c == ',');
            let span = at..at + word.len();
            at += piece.len();
            if word.is_empty() {
                continue;
            }
            let Some(x) = number(word) else {
                return Err(Fault::new(format!("expected a number, found \"{word}\""), span));
            };
            if six.len() == 6 {
                return Err(Fault::new("a line holds six numbers: a position and a direction", span));
            }
            six.push(x);
        }
        let end = start + content.trim_end().len();
        if !six.is_empty() {
            let found = six.len();
            let six: Six = six.try_into().map_err(|_| {
                let message = format!("expected six numbers, a position and a direction, found {found}");
                Fault::new(message, end..end)
            })?;
            let begin = start + (content.len() - content.trim_start().len());
            all.push(checked(six).map_err(|message| Fault::new(message, begin..end))?);
        }
        start += line.len();
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_have_cell_centres_and_the_normal_of_their_edges() {
        let grid = parse_grid("1,2,0.8,4,0,0,0,3,0,2,3").unwrap();
        let points: Vec<Six> = grid.points().collect();
        assert_eq!(points.len(), 6);
        assert_eq!(points[0], [2.0, 2.5, 0.8, 0.0, 0.0, 1.0]);
        assert_eq!(points[1], [4.0, 2.5, 0.8, 0.0, 0.0, 1.0]);
        assert_eq!(points[5], [4.0, 4.5, 0.8, 0.0, 0.0, 1.0]);
        assert_eq!(grid.sides(), [4.0, 3.0]);
        for bad in ["1,2,3", "0,0,0,1,0,0,2,0,0,2,2", "0,0,0,1,0,0,0,1,0,2.5,2", "0,0,0,1,0,0,0,1,0,0,2"] {
            assert!(parse_grid(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn lists_may_have_commas_comments_and_blank_lines() {
        let text = "# desk\n0 0 0.8  0 0 1\n\n  1,2,0.8, 0,0,-1 # upside down\r\n3\t4 5 1e-3 0 0";
        let expected = [
            [0.0, 0.0, 0.8, 0.0, 0.0, 1.0],
            [1.0, 2.0, 0.8, 0.0, 0.0, -1.0],
            [3.0, 4.0, 5.0, 1e-3, 0.0, 0.0],
        ];
        assert_eq!(parse(text).unwrap(), expected);
        assert_eq!(parse("").unwrap(), Vec::<Six>::new());
    }

    #[test]
    fn faults_point_at_the_text() {
        for (text, message, column) in [
            ("0 0 0 0 0 1\n0 0 x 0 0 1\n", "expected a number, found \"x\"", "2:5"),
            ("0 0 0 0 0\n", "expected six numbers, a position and a direction, found 5", "1:10"),
            ("0 0 0 0 0 1 7\n", "a line holds six numbers: a position and a direction", "1:13"),
            ("\n 1 2 3 0 0 0", "the direction has no length", "2:2"),
            ("1 2 3 0 0 inf", "expected a number, found \"inf\"", "1:11"),
        ] {
            let shown = parse(text).unwrap_err().shown("list", text);
            assert!(shown.starts_with(message) && shown.contains(&format!("list:{column}\n")), "{shown}");
        }
    }
}
