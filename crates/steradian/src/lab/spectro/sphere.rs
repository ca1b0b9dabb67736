//! The integrating sphere around the sample.

use crate::units::Estimate;

/// How the sphere's readings are compared with those of a standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beams {
    /// The standard is taken out and the sample put in its place (the opening left empty, for transmittance). The sphere is then
    /// another one: a sample that reflects less than the standard also darkens the wall, and reads too low.
    Single,
    /// A second beam falls on the wall while the sample is in its port: both beams see the same sphere, and the error of
    /// substitution is gone.
    Double,
}

/// A sphere with a diffuse wall and one port, which the sample fills when it is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Reflectance of the wall, in [0, 1).
    pub wall: f64,
    /// Share of the sphere's area that the port takes, in (0, 1).
    pub port: f64,
    /// Reflectance of the standard, in (0, 1].
    pub standard: f64,
    /// How readings are made.
    pub beams: Beams,
}

impl Sphere {
    /// The sphere multiplier M = ρ/(1 − ρ(1 − f)) with an empty port: by how much the wall's radiance exceeds what the light
    /// would bring about on the area of a sphere by itself, L = Φ M/(π A).
    ///
    /// Exact for every point of the wall: within a sphere, all see all alike.
    pub fn multiplier(&self) -> f64 {
        self.wall / self.rest(0.0)
    }

    /// 1 minus the mean reflectance of the sphere with a port of that reflectance.
    fn rest(&self, port: f64) -> f64 {
        1.0 - self.wall * (1.0 - self.port) - port * self.port
    }

    /// What is read over what is true for a sample in the port that reflects the share `sample` of diffuse light, where the
    /// same port held a surface of reflectance `before` when the reading was set to its known value.
    fn substitution(&self, before: f64, sample: Estimate) -> Estimate {
        match self.beams {
            Beams::Double => Estimate::exact(1.0),
            Beams::Single => {
                let rest = self.rest(sample.value);
                let ratio = self.rest(before) / rest;
                Estimate { value: ratio, half_width: ratio * self.port * sample.half_width / rest }
            }
        }
    }

    /// What a reflectance reads as, with that factor between; `diffuse` is the sample's reflectance of diffuse light.
    pub fn reflectance(&self, truth: Estimate, diffuse: Estimate) -> SphereReading {
        SphereReading::new(truth, self.substitution(self.standard, diffuse))
    }

    /// What a transmittance reads as, set to one with the port empty; `diffuse` is the reflectance that the sample's inner face
    /// has for diffuse light.
    pub fn transmittance(&self, truth: Estimate, diffuse: Estimate) -> SphereReading {
        SphereReading::new(truth, self.substitution(0.0, diffuse))
    }
}

/// What a sphere reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereReading {
    /// The reading.
    pub reading: Estimate,
    /// Reading over truth.
    pub ratio: Estimate,
}

impl SphereReading {
    fn new(truth: Estimate, ratio: Estimate) -> Self {
        let half_width = (truth.half_width * ratio.value).hypot(truth.value * ratio.half_width);
        Self { reading: Estimate { value: truth.value * ratio.value, half_width }, ratio }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPHERE: Sphere = Sphere { wall: 0.9, port: 0.05, standard: 1.0, beams: Beams::Single };

    #[test]
    fn the_multiplier_is_the_sum_of_the_walls_reflections() {
        assert!((SPHERE.multiplier() - 6.206_896_55).abs() < 5e-9);
        // ρ Σ (ρ(1 − f))^k.
        let series: f64 = (0..2000).map(|k| 0.9 * (0.9_f64 * 0.95).powi(k)).sum();
        assert!((SPHERE.multiplier() - series).abs() < 1e-12);
    }

    #[test]
    fn readings_are_those_of_the_fluxes_in_the_sphere() {
        // Reflection by reflection: light from the port spreads over wall and port, again and again.
        let wall = |sample: f64| {
            let (mut on_wall, mut light) = (0.0, sample);
            for _ in 0..5000 {
                on_wall += light * 0.95;
                light = light * 0.95 * 0.9 + light * 0.05 * sample;
            }
            on_wall
        };
        let (sample, standard) = (0.3, 0.99);
        let sphere = Sphere { standard, ..SPHERE };
        let truth = Estimate::exact(sample);
        let read = sphere.reflectance(truth, truth);
        assert!((read.reading.value - standard * wall(sample) / wall(standard)).abs() < 1e-12);
        assert!(read.ratio.value < 1.0, "{read:?}");
        // A pane in the opening reflects light back that would have left.
        let pane = sphere.transmittance(Estimate::exact(0.8), Estimate::exact(0.15));
        assert!((pane.ratio.value - (1.0 - 0.855) / (1.0 - 0.855 - 0.0075)).abs() < 1e-12);
    }

    #[test]
    fn a_sample_like_the_standard_and_a_second_beam_have_no_error() {
        let (truth, like) = (Estimate { value: 0.99, half_width: 0.01 }, Estimate::exact(1.0));
        assert_eq!(SPHERE.reflectance(truth, like).reading, truth);
        let double = Sphere { beams: Beams::Double, ..SPHERE };
        assert_eq!(double.reflectance(truth, Estimate::exact(0.2)).reading, truth);
    }

    #[test]
    fn what_is_not_known_of_the_sample_widens_the_reading() {
        let truth = Estimate { value: 0.5, half_width: 0.003 };
        let diffuse = Estimate { value: 0.55, half_width: 0.02 };
        let read = SPHERE.reflectance(truth, diffuse).reading;
        // The slope of the ratio by differences.
        let at = |d: f64| SPHERE.reflectance(truth, Estimate::exact(d)).ratio.value;
        let slope = (at(0.55 + 1e-6) - at(0.55 - 1e-6)) / 2e-6;
        let expected = (0.003 * at(0.55)).hypot(0.5 * slope * 0.02);
        assert!((read.half_width / expected - 1.0).abs() < 1e-6);
    }
}
