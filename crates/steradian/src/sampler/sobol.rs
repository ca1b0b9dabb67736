//! The first two dimensions of Sobol's sequence: a (0, 2)-sequence in base 2.

/// Digits of dimension 0, the van der Corput sequence.
pub(super) const fn dimension_0(index: u64) -> u32 {
    (index as u32).reverse_bits()
}

/// Digits of dimension 1, primitive polynomial x + 1.
///
/// Its generator matrix is Pascal's triangle modulo 2, the six-fold Kronecker power of [[1, 1], [0, 1]],
/// so six masked shifts multiply by it (Ahmed 2024). Index bits above 32 matter: the matrix is upper triangular.
pub(super) const fn dimension_1(index: u64) -> u32 {
    let mut x = index;
    x ^= (x & 0xaaaa_aaaa_aaaa_aaaa) >> 1;
    x ^= (x & 0xcccc_cccc_cccc_cccc) >> 2;
    x ^= (x & 0xf0f0_f0f0_f0f0_f0f0) >> 4;
    x ^= (x & 0xff00_ff00_ff00_ff00) >> 8;
    x ^= (x & 0xffff_0000_ffff_0000) >> 16;
    x ^= x >> 32;
    (x as u32).reverse_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dimension_1_follows_the_recurrence_of_its_direction_numbers() {
        // Bratley & Fox 1988 for x + 1: m_1 = 1, m_k = 2 m_(k-1) ⊕ m_(k-1); v_k = m_k 2^(32-k).
        let mut m = 1_u64;
        for k in 0..32 {
            assert_eq!(dimension_1(1 << k), (m << (31 - k)) as u32, "direction number {}", k + 1);
            m = (2 * m) ^ m;
        }
        // Columns beyond the 32nd by the same recurrence, of which the leading 32 digits count.
        let mut wide = 1_u128;
        for k in 0..60_u32 {
            let digits = if k < 32 { wide << (31 - k) } else { wide >> (k - 31) };
            assert_eq!(dimension_1(1 << k), digits as u32, "column {k}");
            wide = (2 * wide) ^ wide;
        }
    }
}
