//! Transfer functions between linear light and the values that files store.

/// Encodes linear light in [0, 1] for an sRGB display (IEC 61966-2-1); negative values stay linear.
pub fn srgb_encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Decodes an sRGB value in [0, 1] to linear light; the inverse of [`srgb_encode`].
pub fn srgb_decode(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Encodes linear light by a power law: l^(1/γ); negative light counts as none.
pub fn gamma_encode(linear: f32, gamma: f32) -> f32 {
    linear.max(0.0).powf(1.0 / gamma)
}

/// Decodes a value stored by a power law: v^γ; negative values count as zero.
pub fn gamma_decode(encoded: f32, gamma: f32) -> f32 {
    encoded.max(0.0).powf(gamma)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_knows_its_fixed_points() {
        // IEC 61966-2-1: code 188/255 is about half the light, 118/255 the 18 % grey card.
        assert!((srgb_decode(188.0 / 255.0) - 0.5029).abs() < 1e-4);
        assert!((srgb_encode(0.18) - 0.46136).abs() < 1e-5);
        assert!((srgb_encode(1.0) - 1.0).abs() < 1e-6 && srgb_encode(0.0) == 0.0);
    }

    #[test]
    fn decoding_inverts_encoding() {
        for i in 0..=1000 {
            let v = i as f32 / 1000.0;
            assert!((srgb_decode(srgb_encode(v)) - v).abs() < 2e-6, "{v}");
            assert!((gamma_decode(gamma_encode(v, 2.2), 2.2) - v).abs() < 2e-6, "{v}");
        }
    }

    #[test]
    fn both_branches_meet() {
        let step = srgb_encode(0.003_130_801) - srgb_encode(0.003_130_8);
        assert!(step.abs() < 1e-6, "{step}");
    }
}
