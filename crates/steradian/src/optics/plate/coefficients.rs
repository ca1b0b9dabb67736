//! The published table of what a leaf's constituents absorb.

use thiserror::Error;

/// What absorbs in a leaf. Amounts are per leaf area.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Absorber {
    /// Chlorophylls a and b [µg/cm²].
    Chlorophyll,
    /// Carotenoids [µg/cm²].
    Carotenoids,
    /// Anthocyanins [µg/cm²].
    Anthocyanins,
    /// Brown pigments [arbitrary units].
    Brown,
    /// Water [g/cm², which is its thickness in cm].
    Water,
    /// All dry matter [g/cm²].
    DryMatter,
    /// Proteins [g/cm²], a part of the dry matter.
    Proteins,
    /// Carbon-based constituents [g/cm²], the rest of the dry matter.
    CarbonBased,
}

impl Absorber {
    /// All of them, in the order of the published table.
    pub const ALL: [Self; 8] = [
        Self::Chlorophyll,
        Self::Carotenoids,
        Self::Anthocyanins,
        Self::Brown,
        Self::Water,
        Self::DryMatter,
        Self::Proteins,
        Self::CarbonBased,
    ];

    /// The name of its column.
    pub fn column(self) -> &'static str {
        match self {
            Self::Chlorophyll => "SAC_CHL",
            Self::Carotenoids => "SAC_CAR",
            Self::Anthocyanins => "SAC_ANT",
            Self::Brown => "SAC_BROWN",
            Self::Water => "SAC_EWT",
            Self::DryMatter => "SAC_LMA",
            Self::Proteins => "SAC_PROT",
            Self::CarbonBased => "SAC_CBC",
        }
    }
}

/// Why a text is no table of coefficients.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum CoefficientsError {
    /// There is a header at most.
    #[error(
        "there are no rows: a table has a line with the names of its columns, and at least two rows of numbers"
    )]
    Empty,
    /// A column that must be there is not.
    #[error("line {line}: there is no column `{column}`")]
    NoColumn {
        /// Line of the header, from 1.
        line: usize,
        /// The column.
        column: &'static str,
    },
    /// A place in the text.
    #[error("line {line}, column {column}: {message}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// Character in the line, from 1.
        column: usize,
        /// What is wrong there.
        message: String,
    },
}

/// Index of refraction and specific absorption of a leaf's constituents over wavelength.
///
/// ```text
/// lambda  nrefrac  SAC_CHL  SAC_CAR  SAC_ANT  SAC_BROWN  SAC_EWT  SAC_LMA  SAC_PROT  SAC_CBC
/// 400     1.5115   0.06488  0.16734  ...
/// ```
///
/// Columns come in any order, separated by blanks, tabs or commas; of the absorbers at least one must be there. The
/// wavelength is in nm, increasing; the index above 1; coefficients are natural ones, in area per amount (see [`Absorber`]),
/// not negative. Empty lines and lines that begin with `#` are passed over.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    lambda: Vec<f64>,
    index: Vec<f64>,
    /// By [`Absorber::ALL`]; empty where the table lacks the column.
    absorption: [Vec<f64>; 8],
}

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Role {
    Lambda,
    Index,
    Absorber(usize),
}

impl Coefficients {
    /// Reads a table.
    ///
    /// # Errors
    /// With the place, when the text is no such table.
    pub fn parse(text: &str) -> Result<Self, CoefficientsError> {
        let mut lines = text
            .lines()
            .enumerate()
            .map(|(i, line)| (i + 1, line))
            .filter(|(_, l)| !l.trim().is_empty() && !l.trim_start().starts_with('#'));
        let (number, header) = lines.next().ok_or(CoefficientsError::Empty)?;
        let roles = roles(number, header)?;
        let mut table =
            Self { lambda: Vec::new(), index: Vec::new(), absorption: std::array::from_fn(|_| Vec::new()) };
        for (line, text) in lines {
            let mut count = 0;
            for cell in cells(line, text) {
                let role = *roles
                    .get(count)
                    .ok_or_else(|| cell.error(format!("the header names {} columns only", roles.len())))?;
                table.take(role, &cell)?;
                count += 1;
            }
            if count < roles.len() {
                let message = format!("{count} values, but the header names {} columns", roles.len());
                let column = text.trim_end().chars().count() + 1;
                return Err(CoefficientsError::Text { line, column, message });
            }
        }
        if table.lambda.len() < 2 { Err(CoefficientsError::Empty) } else { Ok(table) }
    }

    fn take(&mut self, role: Role, cell: &Cell<'_>) -> Result<(), CoefficientsError> {
        let value = cell.number()?;
        match role {
            Role::Lambda if !(value > 0.0) => {
                return Err(cell.error(format!("{value} nm is no wavelength")));
            }
            Role::Lambda => {
                if let Some(&previous) = self.lambda.last()
                    && value <= previous
                {
                    let message = format!("{value} nm follows {previous} nm: wavelengths must increase");
                    return Err(cell.error(message));
                }
                self.lambda.push(value);
            }
            Role::Index if !(1.0..=10.0).contains(&value) => {
                return Err(cell.error(format!("an index of refraction of {value} is not from 1 to 10")));
            }
            Role::Index => self.index.push(value),
            Role::Absorber(_) if value < 0.0 => {
                return Err(
                    cell.error(format!("a coefficient of {value}: nothing absorbs less than nothing"))
                );
            }
            Role::Absorber(i) => self.absorption[i].push(value),
        }
        Ok(())
    }

    /// First and last wavelength [nm]; nothing is known beyond.
    pub fn range(&self) -> (f64, f64) {
        (self.lambda.first().copied().unwrap_or(0.0), self.lambda.last().copied().unwrap_or(0.0))
    }

    /// The wavelengths [nm] of its rows, increasing.
    pub fn wavelengths(&self) -> &[f64] {
        &self.lambda
    }

    /// Whether there is a column for the absorber.
    pub fn has(&self, absorber: Absorber) -> bool {
        !self.absorption[absorber as usize].is_empty()
    }

    /// Index of refraction and natural absorbance of the given amounts, by [`Absorber::ALL`], at a wavelength [nm]: linear
    /// between rows. `None` outside [`Coefficients::range`]. Absorbers without a column count as zero.
    pub(super) fn at(&self, lambda: f64, amounts: &[f64; 8]) -> Option<Optics> {
        let (first, last) = self.range();
        if !(first..=last).contains(&lambda) {
            return None;
        }
        let right = self.lambda.partition_point(|l| *l <= lambda).clamp(1, self.lambda.len() - 1);
        let (l0, l1) = (self.lambda[right - 1], self.lambda[right]);
        let t = (lambda - l0) / (l1 - l0);
        let of = |column: &[f64]| {
            column.get(right - 1).zip(column.get(right)).map_or(0.0, |(a, b)| a * (1.0 - t) + b * t)
        };
        let depth = amounts.iter().zip(&self.absorption).map(|(amount, k)| amount * of(k)).sum();
        Some(Optics { index: of(&self.index), depth })
    }
}

/// A leaf's substance at one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Optics {
    /// Index of refraction.
    pub(super) index: f64,
    /// Natural absorbance of all absorbers along the normal.
    pub(super) depth: f64,
}

fn roles(line: usize, header: &str) -> Result<Vec<Role>, CoefficientsError> {
    let mut roles = Vec::new();
    for cell in cells(line, header) {
        let is = |name: &str| cell.text.eq_ignore_ascii_case(name);
        let role = if is("lambda") {
            Role::Lambda
        } else if is("nrefrac") {
            Role::Index
        } else if let Some(i) = Absorber::ALL.iter().position(|a| is(a.column())) {
            Role::Absorber(i)
        } else {
            let known = Absorber::ALL.map(Absorber::column).join(", ");
            let message = format!("unknown column `{}`; known are lambda, nrefrac, {known}", cell.text);
            return Err(cell.error(message));
        };
        if roles.contains(&role) {
            return Err(cell.error(format!("a second column `{}`", cell.text)));
        }
        roles.push(role);
    }
    for (role, column) in [(Role::Lambda, "lambda"), (Role::Index, "nrefrac")] {
        if !roles.contains(&role) {
            return Err(CoefficientsError::NoColumn { line, column });
        }
    }
    if roles.len() < 3 {
        return Err(CoefficientsError::NoColumn { line, column: "SAC_CHL" });
    }
    Ok(roles)
}

/// A piece of a line.
struct Cell<'a> {
    text: &'a str,
    line: usize,
    /// Character where it begins, from 1.
    column: usize,
}

impl Cell<'_> {
    fn error(&self, message: String) -> CoefficientsError {
        CoefficientsError::Text { line: self.line, column: self.column, message }
    }

    fn number(&self) -> Result<f64, CoefficientsError> {
        let number = self.text.parse().ok().filter(|x: &f64| x.is_finite());
        number.ok_or_else(|| self.error(format!("`{}` is not a number", self.text)))
    }
}

fn cells(line: usize, text: &str) -> impl Iterator<Item = Cell<'_>> {
    let pieces = text.split(|c: char| c.is_whitespace() || c == ',').filter(|piece| !piece.is_empty());
    pieces.map(move |piece| {
        let before = piece.as_ptr() as usize - text.as_ptr() as usize;
        Cell { text: piece, line, column: text[..before].chars().count() + 1 }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "# two constituents\nlambda\tnrefrac\tSAC_CHL\tSAC_EWT\n400\t1.5\t0.05\t0\n\n\
         500\t1.4\t1.5E-01\t2e-3\n600 1.3 0 1\n";

    fn at(table: &Coefficients, lambda: f64) -> Option<Optics> {
        table.at(lambda, &[40.0, 0.0, 0.0, 0.0, 0.5, 0.0, 7.0, 0.0])
    }

    #[test]
    fn rows_are_met_and_joined_by_lines() {
        let table = Coefficients::parse(TABLE).unwrap();
        assert_eq!(table.range(), (400.0, 600.0));
        assert!(table.has(Absorber::Water) && !table.has(Absorber::Proteins));
        assert_eq!(at(&table, 400.0), Some(Optics { index: 1.5, depth: 2.0 }));
        let middle = at(&table, 450.0).unwrap();
        assert!((middle.index - 1.45).abs() < 1e-15 && (middle.depth - 4.0005).abs() < 1e-12);
        assert_eq!(at(&table, 600.0), Some(Optics { index: 1.3, depth: 0.5 }));
    }

    #[test]
    fn nothing_is_extrapolated() {
        let table = Coefficients::parse(TABLE).unwrap();
        assert_eq!([at(&table, 399.999), at(&table, 600.001), at(&table, f64::NAN)], [None; 3]);
    }

    #[test]
    fn columns_come_in_any_order_and_with_any_separator() {
        let text = "SAC_EWT, lambda ,SAC_CHL, nrefrac\n0,400,0.05,1.5\n0.002,500,0.15,1.4\n1,600,0,1.3\n";
        assert_eq!(Coefficients::parse(text), Coefficients::parse(TABLE));
    }

    #[test]
    fn faults_are_located() {
        let said = |text: &str| Coefficients::parse(text).unwrap_err().to_string();
        for (from, to, message) in [
            ("1.5E-01", "much", "line 5, column 9: `much` is not a number"),
            ("1.5E-01", "inf", "line 5, column 9: `inf` is not a number"),
            ("600 1.3 0 1", "600 1.3 0", "line 6, column 10: 3 values, but the header names 4 columns"),
            ("600 1.3 0 1", "600 1.3 0 1 2", "line 6, column 13: the header names 4 columns only"),
            ("600 1.3", "500 1.3", "line 6, column 1: 500 nm follows 500 nm: wavelengths must increase"),
            ("1.3", "0.3", "line 6, column 5: an index of refraction of 0.3 is not from 1 to 10"),
            (
                "2e-3",
                "-2e-3",
                "line 5, column 17: a coefficient of -0.002: nothing absorbs less than nothing",
            ),
            (
                "SAC_EWT",
                "SAC_XYZ",
                "line 2, column 24: unknown column `SAC_XYZ`; known are lambda, nrefrac, SAC_CHL, SAC_CAR, SAC_ANT, \
                 SAC_BROWN, SAC_EWT, SAC_LMA, SAC_PROT, SAC_CBC",
            ),
            ("SAC_EWT", "sac_chl", "line 2, column 24: a second column `sac_chl`"),
            ("nrefrac", "SAC_ANT", "line 2: there is no column `nrefrac`"),
        ] {
            assert_eq!(said(&TABLE.replacen(from, to, 1)), message, "{to}");
        }
        assert!(said("").starts_with("there are no rows"));
        assert!(said("lambda nrefrac SAC_CHL\n400 1.5 0\n").starts_with("there are no rows"));
        assert_eq!(said("lambda nrefrac\n400 1.5\n500 1.5\n"), "line 1: there is no column `SAC_CHL`");
    }
}
