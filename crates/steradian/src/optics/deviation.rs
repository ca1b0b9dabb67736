//! How far prisms and drops turn light: closed forms for angles that instruments and rainbows show.

use std::f64::consts::PI;

/// The least angle [rad] by which a prism of apex angle `apex` [rad] in (0, π) and relative index `eta` turns light:
/// sin((A + D)/2) = η sin(A/2), reached by the symmetric path. `None` if no light passes symmetrically.
///
/// Negative for an index below one: such a prism turns light towards its apex.
pub fn prism_minimum(apex: f64, eta: f64) -> Option<f64> {
    let sin = eta * (0.5 * apex).sin();
    (sin <= 1.0).then(|| 2.0 * sin.asin() - apex)
}

/// The relative index of a prism of apex angle `apex` [rad] whose minimum deviation is `deviation` [rad]: how a
/// spectrometer measures an index.
pub fn prism_index(apex: f64, deviation: f64) -> f64 {
    (0.5 * (apex + deviation)).sin() / (0.5 * apex).sin()
}

/// The ray of stationary deviation through a sphere, which concentrates light: a rainbow (Descartes 1637).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rainbow {
    /// Angle of incidence at the drop [rad].
    pub incidence: f64,
    /// Total angle by which the ray is turned [rad]; above π for orders that go around.
    pub deviation: f64,
}

impl Rainbow {
    /// The rainbow of `order` (1 primary, 2 secondary, …), that is the number of internal reflections, of drops of
    /// relative index `eta`: D = kπ + 2θi − 2(k + 1)θt is stationary where cosθi = √((η² − 1)/(k(k + 2))).
    ///
    /// `None` for order 0, for an index not above 1, and for one above k + 1, where no ray is stationary.
    pub fn of_order(order: u32, eta: f64) -> Option<Self> {
        let k = f64::from(order);
        let cos = ((eta * eta - 1.0) / (k * (k + 2.0))).sqrt();
        if order == 0 || !(eta > 1.0) || !(cos <= 1.0) {
            return None;
        }
        let incidence = cos.acos();
        let refracted = (incidence.sin() / eta).asin();
        Some(Self { incidence, deviation: k * PI + 2.0 * incidence - 2.0 * (k + 1.0) * refracted })
    }

    /// Angle [rad] in [0, π] at which it is seen from the point opposite to the sun.
    pub fn radius(&self) -> f64 {
        let turned = self.deviation.rem_euclid(2.0 * PI);
        (turned - PI).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_minimum_deviation_is_the_smallest_of_all_paths_through_a_prism() {
        let (apex, eta) = (60.0_f64.to_radians(), 1.5168_f64);
        let minimum = prism_minimum(apex, eta).unwrap();
        let smallest = (4000..9000)
            .filter_map(|i| {
                let incidence = (f64::from(i) * 0.01).to_radians();
                let first = (incidence.sin() / eta).asin();
                let leaving = eta * (apex - first).sin();
                (leaving <= 1.0).then(|| incidence + leaving.asin() - apex)
            })
            .fold(f64::INFINITY, f64::min);
        assert!((minimum - smallest).abs() < 1e-7, "{minimum} {smallest}");
        assert!((prism_index(apex, minimum) - eta).abs() < 1e-14);
        assert_eq!(prism_minimum(apex, 2.1), None);
    }

    #[test]
    fn rainbows_of_water_stand_at_42_and_51_degrees() {
        let primary = Rainbow::of_order(1, 1.333).unwrap();
        assert!((primary.radius().to_degrees() - 42.1).abs() < 0.05, "{}", primary.radius().to_degrees());
        assert!((primary.incidence.to_degrees() - 59.4).abs() < 0.05);
        let secondary = Rainbow::of_order(2, 1.333).unwrap();
        assert!((secondary.radius().to_degrees() - 50.9).abs() < 0.1, "{}", secondary.radius().to_degrees());
        assert_eq!(
            [Rainbow::of_order(0, 1.333), Rainbow::of_order(1, 1.0), Rainbow::of_order(1, 2.1)],
            [None; 3]
        );
    }

    #[test]
    fn the_deviation_of_a_rainbow_is_stationary() {
        for (order, eta) in [(1, 1.333_f64), (2, 1.333), (3, 1.5)] {
            let bow = Rainbow::of_order(order, eta).unwrap();
            let deviation = |incidence: f64| {
                let k = f64::from(order);
                k * PI + 2.0 * incidence - 2.0 * (k + 1.0) * (incidence.sin() / eta).asin()
            };
            let slope = (deviation(bow.incidence + 1e-4) - deviation(bow.incidence - 1e-4)) / 2e-4;
            assert!(slope.abs() < 1e-7, "{order}: {slope}");
        }
    }
}
