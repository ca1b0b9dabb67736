//! How much the place of a bright source in the field of view counts.

/// Guth's position index p [1] of a direction that is `x` to the right, `y` up and `z` along the line of sight: 1 straight
/// ahead, at most 16; 16 also for what is behind.
///
/// Above the line of sight by Guth (Luckiesh & Guth 1949, as in the IES Lighting Handbook and CIE 117): ln p =
/// (35.2 − 0.31889 α − 1.22 e^(−2α/9)) 10⁻³ β + (21 + 0.26667 α − 0.002963 α²) 10⁻⁵ β², with the angle β [°] to the line of
/// sight and the angle α [°] of their common plane to the vertical. Below it by Iwata and Tokura (1997): p = 1 + 0.8 r for r < 0.6,
/// else 1 + 1.2 r, with r = tan β limited at 3. So does evalglare up to version 2; version 3.06 agrees above the line of sight and has a
/// smooth formula below it, which differs by up to 0.2 within 45°.
pub fn position_index([x, y, z]: [f64; 3]) -> f64 {
    const MOST: f64 = 16.0;
    if !(z > 0.0) {
        return MOST;
    }
    let across = x.hypot(y);
    let p = if y < 0.0 {
        let r = (across / z).min(3.0);
        1.0 + if r < 0.6 { 0.8 } else { 1.2 } * r
    } else {
        let beta = across.atan2(z).to_degrees();
        let alpha = x.abs().atan2(y).to_degrees();
        let linear = 35.2 - 0.31889 * alpha - 1.22 * (-2.0 * alpha / 9.0).exp();
        let square = 21.0 + 0.26667 * alpha - 0.002963 * alpha * alpha;
        (linear * 1e-3 * beta + square * 1e-5 * beta * beta).exp()
    };
    p.min(MOST)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Index of a source that lies H above and T beside the line of sight, R along it, as CIE 117 tabulates.
    fn guth(h_over_r: f64, t_over_r: f64) -> f64 {
        position_index([t_over_r, h_over_r, 1.0])
    }

    #[test]
    fn the_line_of_sight_has_index_one() {
        assert!((guth(0.0, 0.0) - 1.0).abs() < 1e-12);
        assert!((position_index([0.0, -1e-9, 1.0]) - 1.0).abs() < 1e-8);
    }

    #[test]
    fn above_the_line_of_sight_it_is_guths() {
        // Straight above, α = 0: ln p = 0.03398 β + 0.00021 β², β = 26.565° and 45°; beside, α = 90°; between, α = 45°.
        for (h, t, p) in
            [(0.5, 0.0, 2.860_161), (1.0, 0.0, 7.059_329), (0.0, 1.0, 2.049_807), (1.0, 1.0, 7.029_745)]
        {
            let found = guth(h, t);
            assert!((found / p - 1.0).abs() < 1e-6, "{h} {t}: {found}, not {p}");
        }
        assert_eq!(guth(1.9, 0.0), 16.0);
    }

    #[test]
    fn it_is_symmetric_and_grows_away_from_the_line_of_sight() {
        for i in 1..80 {
            let (a, b) = (f64::from(i).to_radians(), f64::from(i + 1).to_radians());
            for turn in [-80.0, -45.0, 0.0, 30.0, 60.0, 90.0_f64] {
                let (s, c) = turn.to_radians().sin_cos();
                let at = |angle: f64, side: f64| {
                    position_index([side * angle.sin() * c, angle.sin() * s, angle.cos()])
                };
                assert!(at(b, 1.0) >= at(a, 1.0), "{i} {turn}");
                assert_eq!(at(a, 1.0), at(a, -1.0));
            }
        }
    }

    #[test]
    fn below_the_line_of_sight_it_is_iwatas() {
        assert!((position_index([0.3, -0.4, 1.0]) - 1.4).abs() < 1e-12);
        assert!((position_index([0.0, -1.0, 1.0]) - 2.2).abs() < 1e-12);
        assert!((position_index([0.0, -9.0, 1.0]) - 4.6).abs() < 1e-12);
        assert_eq!(position_index([0.0, 0.0, -1.0]), 16.0);
    }
}
