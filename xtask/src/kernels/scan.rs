//! What reading numbers costs at least: plain scans of bytes, the yardsticks of the parsers.

/// Sum of all numbers in `text`, each word that the standard library accepts as a number: what anyone would write first.
pub(super) fn words_by_std(text: &[u8]) -> f32 {
    let separates = |b: u8| b <= b' ' || matches!(b, b'[' | b']' | b'"');
    let words = text.split(|&b| separates(b));
    words.filter_map(|word| std::str::from_utf8(word).ok()?.parse::<f32>().ok()).sum()
}

/// Sum of all `-12.5` in `text`, digit by digit without a care for rounding, exponents, range, words or malformed numbers:
/// about the fewest instructions that look at one byte after the other.
pub(super) fn digits_by_hand(text: &[u8]) -> f32 {
    const POWERS: [f64; 16] =
        [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
    let digit = |i: usize| text.get(i).map(|b| u64::from(b.wrapping_sub(b'0'))).filter(|d| *d < 10);
    let mut sum = 0.0;
    let mut i = 0;
    while i < text.len() {
        let negative = text[i] == b'-';
        i += usize::from(negative);
        let Some(mut mantissa) = digit(i) else {
            i += usize::from(!negative);
            continue;
        };
        i += 1;
        while let Some(d) = digit(i) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(d);
            i += 1;
        }
        let mut decimals = 0;
        if text.get(i) == Some(&b'.') {
            let point = i + 1;
            i = point;
            while let Some(d) = digit(i) {
                mantissa = mantissa.wrapping_mul(10).wrapping_add(d);
                i += 1;
            }
            decimals = i - point;
        }
        let magnitude = (mantissa as f64 / POWERS[decimals % 16]) as f32;
        sum += if negative { -magnitude } else { magnitude };
    }
    sum
}

/// Sum of the little-endian words of four bytes, as floats.
pub(super) fn words_of_four(bytes: &[u8]) -> f32 {
    bytes.as_chunks::<4>().0.iter().map(|word| f32::from_le_bytes(*word)).sum()
}
