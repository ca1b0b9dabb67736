//! Fast reading of decimal numbers, bit for bit equal to the standard library's.

/// A number at the start of some text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::scene) struct Scanned<T> {
    pub(in crate::scene) value: T,
    /// Number of bytes it takes.
    pub(in crate::scene) len: usize,
}

const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// The same as integers, as far as eight digits at a time need them.
const WHOLE_POWERS: [u64; 9] = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];

/// Digits that are sure to fit a `u64`.
const MAX_DIGITS: usize = 19;

/// Digits on the way to a number, and where they end.
#[derive(Clone, Copy)]
struct Digits {
    /// The digits as an integer; wraps around when there are more than [`MAX_DIGITS`].
    value: u64,
    /// Offset behind the last digit.
    end: usize,
}

impl Digits {
    /// Appends the digits at the end one by one: best for the few before a point.
    #[inline]
    fn few(self, text: &[u8]) -> Self {
        let Self { mut value, mut end } = self;
        while let Some(d) = digit(text, end) {
            value = value.wrapping_mul(10).wrapping_add(d);
            end += 1;
        }
        Self { value, end }
    }

    /// Appends the digits at the end eight at a time: best for the many behind a point, and for indices.
    #[inline]
    fn many(self, text: &[u8]) -> Self {
        let Self { mut value, mut end } = self;
        while let Some(word) = text.get(end..).and_then(<[u8]>::first_chunk) {
            let eight = Eight(u64::from_le_bytes(*word));
            let count = eight.digits();
            if count == 0 {
                return Self { value, end };
            }
            value = value.wrapping_mul(WHOLE_POWERS[count]).wrapping_add(eight.value(count));
            end += count;
            if count < 8 {
                return Self { value, end };
            }
        }
        Self { value, end }.few(text)
    }
}

/// Eight characters of text, the first in the lowest byte.
#[derive(Clone, Copy)]
struct Eight(u64);

impl Eight {
    /// How many digits there are before the first character that is none.
    ///
    /// A digit's lower half is its value and its upper half is 3: what remains of it keeps its upper half empty even when 6
    /// is added. Only bytes from 0xfa on carry into the next, and those are no digits themselves.
    #[inline]
    fn digits(self) -> usize {
        let halves = self.0 ^ 0x3030_3030_3030_3030;
        let other = (halves | halves.wrapping_add(0x0606_0606_0606_0606)) & 0xf0f0_f0f0_f0f0_f0f0;
        (other.trailing_zeros() / 8) as usize
    }

    /// The first `count` digits, 1 to 8, as an integer: joined to pairs, and the pairs by two multiplications whose upper
    /// halves collect the sums (Lemire 2021, "Number parsing at a gigabyte per second", section 4).
    #[inline]
    fn value(self, count: usize) -> u64 {
        const PAIR: u64 = 0x0000_00ff_0000_00ff;
        let digits = (self.0 << (64 - 8 * count)) & 0x0f0f_0f0f_0f0f_0f0f;
        let pairs = digits.wrapping_mul(10).wrapping_add(digits >> 8);
        let outer = (pairs & PAIR).wrapping_mul(100 + (1_000_000 << 32));
        let inner = ((pairs >> 16) & PAIR).wrapping_mul(1 + (10_000 << 32));
        outer.wrapping_add(inner) >> 32
    }
}

/// Reads the longest decimal number at the start of `text`: a sign, digits with at most one point, an exponent.
/// `None` when there is no digit. A number beyond the range of `f32` is infinite.
#[inline]
pub(in crate::scene) fn scan_f32(text: &[u8]) -> Option<Scanned<f32>> {
    let negative = text.first() == Some(&b'-');
    let start = usize::from(negative || text.first() == Some(&b'+'));
    let mut read = Digits { value: 0, end: start }.few(text);
    let mut digits = read.end - start;
    let mut exponent = 0_i64;
    if text.get(read.end) == Some(&b'.') {
        let point = read.end + 1;
        read = Digits { end: point, ..read }.many(text);
        digits += read.end - point;
        exponent = -((read.end - point) as i64);
    }
    if digits == 0 {
        return None;
    }
    let mut len = read.end;
    if let Some(b'e' | b'E') = text.get(len)
        && let Some(e) = scan_exponent(&text[len + 1..])
    {
        exponent = exponent.saturating_add(e.value);
        len += 1 + e.len;
    }
    let value = match fast(read.value, digits, exponent) {
        Some(v) if negative => -v,
        Some(v) => v,
        None => slow(&text[..len])?,
    };
    Some(Scanned { value, len })
}

/// What the standard library makes of a number that the fast way cannot decide.
#[cold]
fn slow(number: &[u8]) -> Option<f32> {
    // ASCII by construction, and the standard library accepts what was scanned.
    std::str::from_utf8(number).ok()?.parse().ok()
}

#[inline]
fn digit(text: &[u8], i: usize) -> Option<u64> {
    text.get(i).map(|b| b.wrapping_sub(b'0')).filter(|&d| d < 10).map(u64::from)
}

#[cold]
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
#[inline]
fn fast(mantissa: u64, digits: usize, exponent: i64) -> Option<f32> {
    // Below the normal range f32 has fewer bits and other midpoints; above it the slow path says what overflows.
    const LEAST: u64 = (f32::MIN_POSITIVE as f64).to_bits();
    const BEYOND: u64 = (f32::MAX as f64).to_bits();
    if digits > MAX_DIGITS {
        return None;
    }
    let power = *POWERS_OF_TEN.get(usize::try_from(exponent.unsigned_abs()).ok()?)?;
    let m = mantissa as f64;
    let v = if exponent <= 0 { m / power } else { m * power };
    let bits = v.to_bits();
    let normal = bits.wrapping_sub(LEAST) < BEYOND - LEAST;
    let beside_midpoint = (bits & 0x1fff_ffff).wrapping_sub(0x1000_0000 - 4) <= 8;
    if normal && !beside_midpoint {
        return Some(v as f32);
    }
    (mantissa == 0).then_some(0.0)
}

/// Why text is not an integer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::scene) enum IntegerError {
    /// It is something else.
    NotAnInteger,
    /// It does not fit 32 bits.
    OutOfRange,
}

/// Reads the integer at the start of `text`: a sign and digits.
#[inline]
pub(in crate::scene) fn scan_i32(text: &[u8]) -> Result<Scanned<i32>, IntegerError> {
    let negative = text.first() == Some(&b'-');
    let sign = usize::from(negative || text.first() == Some(&b'+'));
    let Digits { value: mut magnitude, end } = Digits { value: 0, end: sign }.many(text);
    if end == sign {
        return Err(IntegerError::NotAnInteger);
    }
    if end - sign > MAX_DIGITS {
        // The sum may have wrapped around: sum again with saturation.
        magnitude = text[sign..end]
            .iter()
            .fold(0_u64, |m, b| m.saturating_mul(10).saturating_add(u64::from(b - b'0')));
    }
    let value = i64::try_from(magnitude).map_err(|_| IntegerError::OutOfRange)?;
    let value = if negative { -value } else { value };
    let value = i32::try_from(value).map_err(|_| IntegerError::OutOfRange)?;
    Ok(Scanned { value, len: end })
}

/// Reads the digits at the start of `text`. `None` when there are none, or too many for 32 bits.
#[inline]
pub(in crate::scene) fn scan_u32(text: &[u8]) -> Option<Scanned<u32>> {
    let Digits { value, end } = Digits { value: 0, end: 0 }.many(text);
    if end == 0 || end > MAX_DIGITS {
        return None;
    }
    Some(Scanned { value: u32::try_from(value).ok()?, len: end })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash::Pcg32;
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

    struct Dice(Pcg32);

    impl Dice {
        fn below(&mut self, n: usize) -> usize {
            (self.0.next_u32() as usize * n) >> 32
        }
    }

    /// A decimal of any make: many digits or few, nines and zeros in runs, a point anywhere, an exponent now and then.
    fn decimal(dice: &mut Dice) -> String {
        let most = if dice.below(4) == 0 { 24 } else { 11 };
        let digits = 1 + dice.below(most);
        let point = dice.below(2 * digits + 1);
        let make = dice.below(3);
        let mut text = String::from(["", "-", "+"][dice.below(3)]);
        for i in 0..digits {
            if i == point {
                text.push('.');
            }
            let digit = match make {
                0 => dice.below(10),
                1 => [0, 0, 0, 9, 9, 9, 5, 1][dice.below(8)],
                _ => [dice.below(10), 0][usize::from(i > digits / 2)],
            };
            text.push(char::from(b'0' + digit as u8));
        }
        if dice.below(4) == 0 {
            text += &format!("{}{}", ["e", "E", "e+", "e-", "E-"][dice.below(5)], dice.below(52));
        }
        text
    }

    /// A decimal that says the midpoint between two neighbouring floats, or a hair more or less than it.
    fn near_midpoint(dice: &mut Dice) -> String {
        let bits = 0x0080_0000 + dice.below(0x7e00_0000) as u32;
        let middle = f64::midpoint(f64::from(f32::from_bits(bits)), f64::from(f32::from_bits(bits + 1)));
        let middle = f64::from_bits(middle.to_bits() + dice.below(9) as u64 - 4);
        format!("{middle:.*e}", 6 + dice.below(14))
    }

    #[test]
    fn two_million_decimals_agree_with_the_standard_library_wherever_the_text_ends() {
        let mut dice = Dice(Pcg32::new(7, 1));
        for i in 0..2_000_000 {
            let number = if i % 4 == 0 { near_midpoint(&mut dice) } else { decimal(&mut dice) };
            // What follows must not change the number, even when it is read along with it.
            let followed =
                number.clone() + ["", " ", "] 99999999", "\n12345678", "x0000000", "#"][dice.below(6)];
            let expected: f32 = number.parse().unwrap();
            let ours = scan_f32(followed.as_bytes()).unwrap();
            assert_eq!((ours.len, ours.value.to_bits()), (number.len(), expected.to_bits()), "{followed}");
        }
    }

    #[test]
    fn a_million_integers_agree_with_the_standard_library() {
        let mut dice = Dice(Pcg32::new(8, 1));
        for _ in 0..1_000_000 {
            let digits: String =
                (0..1 + dice.below(13)).map(|_| char::from(b'0' + dice.below(10) as u8)).collect();
            let signed = format!("{}{digits}", ["", "-", "+"][dice.below(3)]);
            let followed = ["", " 7", "\n", ".5", "] 12345678"][dice.below(5)];
            let ours = scan_i32((signed.clone() + followed).as_bytes());
            assert_eq!(ours.map(|s| s.value).ok(), signed.parse().ok(), "{signed}");
            let ours = scan_u32((digits.clone() + followed).as_bytes());
            assert_eq!(ours.map(|s| s.value), digits.parse().ok(), "{digits}");
        }
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
