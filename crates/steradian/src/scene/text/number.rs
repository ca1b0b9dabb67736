//! Fast reading of decimal numbers, bit for bit equal to the standard library's.

/// A number at the start of some text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scanned<T> {
    pub(super) value: T,
    /// Number of bytes it takes.
    pub(super) len: usize,
}

const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Digits that are sure to fit a `u64`.
const MAX_DIGITS: usize = 19;

/// Reads the longest decimal number at the start of `text`: a sign, digits with at most one point, an exponent.
/// `None` when there is no digit. A number beyond the range of `f32` is infinite.
pub(super) fn scan_f32(text: &[u8]) -> Option<Scanned<f32>> {
    let mut i = 0;
    let negative = match text.first() {
        Some(b'-') => {
            i = 1;
            true
        }
        Some(b'+') => {
            i = 1;
            false
        }
        _ => false,
    };
    let mut mantissa = 0_u64;
    let start = i;
    while let Some(d) = digit(text, i) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(d);
        i += 1;
    }
    let mut digits = i - start;
    let mut exponent = 0_i64;
    if text.get(i) == Some(&b'.') {
        let point = i + 1;
        i = point;
        while let Some(d) = digit(text, i) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(d);
            i += 1;
        }
        digits += i - point;
        exponent = -((i - point) as i64);
    }
    if digits == 0 {
        return None;
    }
    if let Some(b'e' | b'E') = text.get(i)
        && let Some(e) = scan_exponent(&text[i + 1..])
    {
        exponent = exponent.saturating_add(e.value);
        i += 1 + e.len;
    }
    let value = match fast(mantissa, digits, exponent) {
        Some(v) if negative => -v,
        Some(v) => v,
        // ASCII by construction, and the standard library accepts what was scanned.
        None => std::str::from_utf8(&text[..i]).ok()?.parse().ok()?,
    };
    Some(Scanned { value, len: i })
}

fn digit(text: &[u8], i: usize) -> Option<u64> {
    text.get(i).map(|b| b.wrapping_sub(b'0')).filter(|&d| d < 10).map(u64::from)
}

fn scan_exponent(text: &[u8]) -> Option<Scanned<i64>> {
    let sign = usize::from(matches!(text.first(), Some(b'-' | b'+')));
    let mut value = 0_i64;
    let mut i = sign;
    while let Some(d) = digit(text, i) {
        value = (value * 10 + d as i64).min(1_000_000);
        i += 1;
    }
    let value = if text.first() == Some(&b'-') { -value } else { value };
    (i > sign).then_some(Scanned { value, len: i })
}

/// mantissa · 10^exponent where one f64 operation decides the rounding to f32.
///
/// The mantissa and the power are each within half an f64 ulp, so the quotient or product is within 2 ulp of the
/// truth (Clinger 1990 is the exact case). Rounding it to f32 is right unless the truth may lie on the other side of a
/// midpoint between two f32, which are the f64 whose low 29 bits are 2^28; near those the slow path decides.
fn fast(mantissa: u64, digits: usize, exponent: i64) -> Option<f32> {
    if digits > MAX_DIGITS {
        return None;
    }
    let power = *POWERS_OF_TEN.get(usize::try_from(exponent.unsigned_abs()).ok()?)?;
    let m = mantissa as f64;
    let v = if exponent < 0 { m / power } else { m * power };
    let from_midpoint = (v.to_bits() & 0x1fff_ffff).abs_diff(0x1000_0000);
    // Below the normal range f32 has fewer bits and other midpoints; above it the slow path says what overflows.
    let normal = v >= f64::from(f32::MIN_POSITIVE) && v < f64::from(f32::MAX);
    if mantissa == 0 { Some(0.0) } else { (normal && from_midpoint > 4).then_some(v as f32) }
}

/// Why text is not an integer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum IntegerError {
    /// It is something else.
    NotAnInteger,
    /// It does not fit 32 bits.
    OutOfRange,
}

/// Reads the integer at the start of `text`: a sign and digits.
pub(super) fn scan_i32(text: &[u8]) -> Result<Scanned<i32>, IntegerError> {
    let sign = usize::from(matches!(text.first(), Some(b'-' | b'+')));
    let mut magnitude = 0_u64;
    let mut i = sign;
    while let Some(d) = digit(text, i) {
        magnitude = magnitude.wrapping_mul(10).wrapping_add(d);
        i += 1;
    }
    if i == sign {
        return Err(IntegerError::NotAnInteger);
    }
    if i - sign > MAX_DIGITS {
        // The sum may have wrapped around: sum again with saturation.
        magnitude =
            text[sign..i].iter().fold(0_u64, |m, b| m.saturating_mul(10).saturating_add(u64::from(b - b'0')));
    }
    let value = i64::try_from(magnitude).map_err(|_| IntegerError::OutOfRange)?;
    let value = if text.first() == Some(&b'-') { -value } else { value };
    let value = i32::try_from(value).map_err(|_| IntegerError::OutOfRange)?;
    Ok(Scanned { value, len: i })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn agrees(text: &str) {
        let std: f32 = text.parse().unwrap();
        let ours = scan_f32(text.as_bytes()).unwrap();
        assert_eq!(ours.len, text.len(), "{text}");
        assert_eq!(ours.value.to_bits(), std.to_bits(), "{text}: {} against {std}", ours.value);
    }

    #[test]
    fn hard_numbers_round_as_in_the_standard_library() {
        for text in [
            "0",
            "-0",
            "+1",
            "1.",
            ".5",
            "-.5e-3",
            "1e5",
            "1E+05",
            "16777217",
            "16777217.0000001",
            "16777219",
            "0.1",
            "3.4028235e38",
            "3.4028236e38",
            "3.5e38",
            "1e400",
            "1e-400",
            "1e-45",
            "7e-46",
            "1.1754943e-38",
            "1.17549435e-38",
            "9007199254740993",
            "9999999999999999999",
            "99999999999999999999999999",
            "0.000000000000000000000000000000000000000000001",
            "8388608.5",
            "8388609.5",
            "1.00000005960464477539",
            "1.00000005960464477540",
            "123456789012345678e-10",
            "0e99999999999999999999",
            "1.5e-0000000000000001",
        ] {
            agrees(text);
        }
    }

    #[test]
    fn numbers_end_where_the_grammar_ends() {
        let scan = |t: &str| scan_f32(t.as_bytes()).map(|s| (s.value, s.len));
        assert_eq!(scan("1.5]"), Some((1.5, 3)));
        assert_eq!(scan("1e"), Some((1.0, 1)));
        assert_eq!(scan("1e+ 2"), Some((1.0, 1)));
        assert_eq!(scan("1.2.3"), Some((1.2, 3)));
        for none in ["", "-", ".", "+.", "e5", "nan", "inf", "-inf", "x1", "--1"] {
            assert_eq!(scan(none), None, "{none}");
        }
    }

    #[test]
    fn integers_are_checked_for_range() {
        let scan = |t: &str| scan_i32(t.as_bytes()).map(|s| s.value);
        assert_eq!(scan("2147483647"), Ok(i32::MAX));
        assert_eq!(scan("-2147483648"), Ok(i32::MIN));
        assert_eq!(scan("+7"), Ok(7));
        assert_eq!(scan("-0000000000000000000000042"), Ok(-42));
        for big in ["2147483648", "-2147483649", "99999999999999999999999999", "18446744073709551617"] {
            assert_eq!(scan(big), Err(IntegerError::OutOfRange), "{big}");
        }
        assert_eq!(scan("-"), Err(IntegerError::NotAnInteger));
        assert_eq!(scan("x"), Err(IntegerError::NotAnInteger));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn any_decimal_agrees_with_the_standard_library(
            sign in "[-+]?", whole in "[0-9]{1,12}", fraction in "(\\.[0-9]{0,12})?", exponent in "([eE][-+]?[0-9]{1,2})?",
        ) {
            agrees(&format!("{sign}{whole}{fraction}{exponent}"));
        }

        #[test]
        fn every_float_survives_printing(bits in any::<u32>()) {
            let v = f32::from_bits(bits);
            prop_assume!(v.is_finite());
            agrees(&format!("{v}"));
            agrees(&format!("{v:e}"));
            agrees(&format!("{:.9}", v.clamp(-1e9, 1e9)));
        }

        /// Midpoints between neighbouring floats, and decimals just beside them, are the hard cases.
        #[test]
        fn midpoints_round_as_in_the_standard_library(bits in 0x3000_0000_u32..0x4f00_0000, digits in 8_usize..24) {
            let (a, b) = (f64::from(f32::from_bits(bits)), f64::from(f32::from_bits(bits + 1)));
            let middle = (a + b) / 2.0;
            agrees(&format!("{middle:.digits$}"));
            agrees(&format!("{middle:.digits$e}"));
        }
    }
}
