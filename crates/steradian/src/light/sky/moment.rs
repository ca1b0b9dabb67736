//! Points in time.

/// A point in time, as days of 86 400 s of universal time since 2000-01-01 12:00 (J2000.0).
///
/// Leap seconds, less than one of which separates UTC from UT1, are not counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    days: f64,
    /// Of the local date.
    day_of_year: u32,
}

/// Why a text is no point in time.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MomentError {
    /// Not of the form that ISO 8601 prescribes.
    #[error("`{0}` is not a time like 2026-06-21T12:00+02:00")]
    Form(String),
    /// The offset from universal time is missing.
    #[error(
        "`{0}` does not say which time it is: end it with the offset from universal time, like +02:00, or Z"
    )]
    Offset(String),
    /// A part is outside its range.
    #[error("{what} {value} does not exist")]
    Range {
        /// The part.
        what: &'static str,
        /// Its number.
        value: u32,
    },
    /// The year is outside 1900–2100.
    #[error("year {0} is outside of 1900–2100, for which the sun's place is computed")]
    Year(u32),
}

impl Moment {
    /// From a date and time of ISO 8601 with the offset from universal time: `2026-06-21T12:00+02:00`, seconds (and their
    /// fractions) optional, `Z` for no offset. Years 1900–2100.
    pub fn parse(text: &str) -> Result<Self, MomentError> {
        let form = || MomentError::Form(text.to_owned());
        let (date, clock) = text.split_once('T').ok_or_else(form)?;
        let [year, month, day] = fields(date, '-').ok_or_else(form)?;
        let cut = clock.find(['Z', '+', '-']).ok_or_else(|| MomentError::Offset(text.to_owned()))?;
        let (clock, offset) = clock.split_at(cut);
        let (clock, seconds) = match clock.match_indices(':').nth(1) {
            Some((at, _)) => (&clock[..at], seconds(&clock[at + 1..]).ok_or_else(form)?),
            None => (clock, 0.0),
        };
        let [hour, minute] = fields(clock, ':').ok_or_else(form)?;
        let east = match offset {
            "Z" => 0.0,
            _ => {
                let [h, m] = fields(&offset[1..], ':').ok_or_else(form)?;
                within("offset hour", h, 0..=14)?;
                within("offset minute", m, 0..=59)?;
                let size = f64::from(h) * 60.0 + f64::from(m);
                if offset.starts_with('-') { -size } else { size }
            }
        };
        if !(1900..=2100).contains(&year) {
            return Err(MomentError::Year(year));
        }
        within("month", month, 1..=12)?;
        within("day", day, 1..=days_of(year, month))?;
        within("hour", hour, 0..=23)?;
        within("minute", minute, 0..=59)?;
        if seconds >= 60.0 {
            return Err(MomentError::Range { what: "second", value: seconds as u32 });
        }
        let day_of_year = (1..month).map(|m| days_of(year, m)).sum::<u32>() + day;
        let minutes = f64::from(hour) * 60.0 + f64::from(minute) - east + seconds / 60.0;
        let midnight = f64::from(days_since_march_0(year, month, day) - days_since_march_0(2000, 1, 1));
        Ok(Self { days: midnight - 0.5 + minutes / 1440.0, day_of_year })
    }

    /// Days since J2000.0.
    pub fn days(&self) -> f64 {
        self.days
    }

    /// Number of the local date within its year, from 1.
    pub fn day_of_year(&self) -> u32 {
        self.day_of_year
    }
}

/// Whole days since the first of March of the year 0 of the Gregorian calendar: years that begin in March end with the leap day.
fn days_since_march_0(year: u32, month: u32, day: u32) -> i32 {
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    // Months of 31, 30, 31, 30, 31 days, twice over: 153 days in five of them.
    let days = 365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day - 1;
    days.cast_signed()
}

fn days_of(year: u32, month: u32) -> u32 {
    match month {
        4 | 6 | 9 | 11 => 30,
        2 if year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400)) => 29,
        2 => 28,
        _ => 31,
    }
}

/// Exactly `N` groups of digits.
fn fields<const N: usize>(text: &str, separator: char) -> Option<[u32; N]> {
    let digits = |part: &str| {
        let plain = (1..=4).contains(&part.len()) && part.bytes().all(|b| b.is_ascii_digit());
        plain.then(|| part.parse().ok()).flatten()
    };
    let parts: Option<Vec<u32>> = text.split(separator).map(digits).collect();
    parts?.try_into().ok()
}

fn seconds(text: &str) -> Option<f64> {
    let plain = text.bytes().all(|b| b.is_ascii_digit() || b == b'.') && !text.starts_with('.');
    plain.then(|| text.parse().ok()).flatten()
}

fn within(what: &'static str, value: u32, range: std::ops::RangeInclusive<u32>) -> Result<(), MomentError> {
    if range.contains(&value) { Ok(()) } else { Err(MomentError::Range { what, value }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn julian_day(text: &str) -> f64 {
        Moment::parse(text).unwrap().days() + 2_451_545.0
    }

    #[test]
    fn dates_become_julian_days() {
        // Meeus (1998), chapter 7; the standard's own date J2000.0; NREL's example (Reda and Andreas 2004).
        for (text, expected) in [
            ("2000-01-01T12:00Z", 2_451_545.0),
            ("1999-01-01T00:00:00Z", 2_451_179.5),
            ("1987-01-27T00:00+00:00", 2_446_822.5),
            ("1988-06-19T12:00Z", 2_447_332.0),
            ("1900-01-01T00:00Z", 2_415_020.5),
            ("2003-10-17T12:30:30-07:00", 2_452_930.312_847),
            ("2003-10-17T21:30:30.0+02:00", 2_452_930.312_847),
            ("2026-02-28T23:30-01:00", 2_461_100.520_833),
        ] {
            let found = julian_day(text);
            assert!((found - expected).abs() < 1e-6, "{text}: {found}");
        }
        // The day after a leap day, and the day number of the local date.
        assert!((julian_day("2024-03-01T00:00Z") - julian_day("2024-02-28T00:00Z") - 2.0).abs() < 1e-9);
        assert_eq!(Moment::parse("2023-12-31T23:59-05:00").unwrap().day_of_year(), 365);
        assert_eq!(Moment::parse("2024-12-31T23:59-05:00").unwrap().day_of_year(), 366);
    }

    #[test]
    fn what_is_no_time_is_refused_with_its_reason() {
        for (text, reason) in [
            ("noon", "`noon` is not a time like 2026-06-21T12:00+02:00"),
            ("2026-06-21 12:00Z", "`2026-06-21 12:00Z` is not a time like 2026-06-21T12:00+02:00"),
            ("2026-06-21T12Z", "`2026-06-21T12Z` is not a time like 2026-06-21T12:00+02:00"),
            ("2026-6-+1T12:00Z", "`2026-6-+1T12:00Z` is not a time like 2026-06-21T12:00+02:00"),
            ("2026-06-21T12:00:1e1Z", "`2026-06-21T12:00:1e1Z` is not a time like 2026-06-21T12:00+02:00"),
            (
                "2026-06-21T12:00",
                "`2026-06-21T12:00` does not say which time it is: end it with the offset from universal time, like +02:00, or Z",
            ),
            ("2026-02-29T12:00Z", "day 29 does not exist"),
            ("2026-13-01T12:00Z", "month 13 does not exist"),
            ("2026-06-21T24:00Z", "hour 24 does not exist"),
            ("2026-06-21T12:00:60Z", "second 60 does not exist"),
            ("2026-06-21T12:00+15:00", "offset hour 15 does not exist"),
            ("1492-10-12T12:00Z", "year 1492 is outside of 1900–2100, for which the sun's place is computed"),
        ] {
            assert_eq!(Moment::parse(text).unwrap_err().to_string(), reason);
        }
    }

    proptest::proptest! {
        #[test]
        fn any_text_gives_a_time_or_an_error(text in "[0-9TZ:+.-]{0,30}|.{0,20}") {
            if let Ok(moment) = Moment::parse(&text) {
                proptest::prop_assert!(moment.days().abs() < 40_000.0);
            }
        }
    }
}
