//! Examples of OpenPBR surfaces for the conformance suite.

use super::slabs::{Slabs, Wall};
use super::surface::OpenPbr;
use crate::bsdf::specimen::Specimen;
use crate::spectrum::Sampled;

impl OpenPbr {
    /// Examples for the conformance suite.
    pub fn specimens() -> impl Iterator<Item = Specimen<Self>> {
        let plain = Slabs::default();
        let colour = Sampled::from_array([0.1, 0.8, 0.4, 1.0]);
        let gold = Slabs {
            base_color: Sampled::from_array([0.35, 0.72, 0.94, 0.97]),
            specular_color: Sampled::from_array([0.7, 0.9, 0.98, 1.0]),
            base_metalness: 1.0,
            ..plain
        };
        let white = Slabs { base_color: Sampled::ONE, ..plain };
        let glass = Slabs { transmission_weight: 1.0, specular_roughness: 0.01, ..plain };
        let film =
            Slabs { thin_film_weight: 1.0, thin_film_thickness_nm: 420.0, thin_film_ior: 1.33, ..plain };
        [
            ("openpbr default plastic", plain),
            ("openpbr white chalk", Slabs { specular_roughness: 1.0, base_diffuse_roughness: 1.0, ..white }),
            (
                "openpbr polished plastic",
                Slabs { base_color: colour, specular_roughness: 0.01, base_diffuse_roughness: 0.5, ..plain },
            ),
            ("openpbr gold", gold),
            ("openpbr polished gold", Slabs { specular_roughness: 0.1, ..gold }),
            ("openpbr lossless metal", Slabs { specular_roughness: 1.0, base_metalness: 1.0, ..white }),
            (
                "openpbr brushed metal",
                Slabs { specular_roughness: 0.6, specular_roughness_anisotropy: 0.7, ..gold },
            ),
            (
                "openpbr car paint",
                Slabs {
                    base_metalness: 0.6,
                    base_color: colour,
                    specular_roughness: 0.5,
                    coat_weight: 1.0,
                    ..plain
                },
            ),
            (
                "openpbr coloured coat",
                Slabs {
                    coat_weight: 0.8,
                    coat_color: colour,
                    coat_roughness: 0.4,
                    coat_roughness_anisotropy: 0.4,
                    coat_darkening: 0.5,
                    ..white
                },
            ),
            (
                "openpbr velvet",
                Slabs {
                    fuzz_weight: 1.0,
                    fuzz_roughness: 0.3,
                    fuzz_color: colour,
                    specular_weight: 0.0,
                    ..plain
                },
            ),
            ("openpbr dusty metal", Slabs { fuzz_weight: 0.7, fuzz_roughness: 1.0, ..gold }),
            ("openpbr clear glass", glass),
            ("openpbr frosted glass", Slabs { specular_roughness: 0.6, ..glass }),
            (
                "openpbr tinted water, coated",
                Slabs {
                    specular_ior: 1.33,
                    specular_roughness: 0.7,
                    transmission_color: colour,
                    transmission_weight: 0.7,
                    coat_weight: 1.0,
                    ..glass
                },
            ),
            (
                "openpbr thin wall",
                Slabs {
                    wall: Wall::Thin,
                    transmission_weight: 0.5,
                    transmission_color: colour,
                    subsurface_weight: 0.5,
                    subsurface_color: colour,
                    subsurface_scatter_anisotropy: 0.3,
                    specular_roughness: 0.45,
                    base_diffuse_roughness: 0.3,
                    ..plain
                },
            ),
            (
                "openpbr soap film",
                Slabs {
                    wall: Wall::Thin,
                    specular_ior: 1.33,
                    transmission_weight: 1.0,
                    specular_roughness: 0.0,
                    ..film
                },
            ),
            ("openpbr plastic with a film", Slabs { thin_film_ior: 2.2, ..film }),
            (
                "openpbr tempered steel",
                Slabs { base_metalness: 1.0, base_color: Sampled::splat(0.6), ..film },
            ),
            (
                "openpbr everything",
                Slabs {
                    base_color: colour,
                    base_diffuse_roughness: 0.6,
                    base_metalness: 0.3,
                    specular_color: Sampled::from_array([1.0, 0.9, 0.8, 0.7]),
                    specular_roughness: 0.5,
                    specular_roughness_anisotropy: 0.5,
                    transmission_weight: 0.4,
                    transmission_color: Sampled::from_array([0.7, 0.8, 0.9, 1.0]),
                    coat_weight: 0.7,
                    coat_color: Sampled::from_array([0.9, 0.8, 0.7, 0.6]),
                    coat_roughness: 0.5,
                    coat_darkening: 0.8,
                    fuzz_weight: 0.3,
                    fuzz_color: Sampled::from_array([0.5, 0.6, 0.7, 0.8]),
                    thin_film_weight: 0.5,
                    ..plain
                },
            ),
        ]
        .into_iter()
        .map(|(name, slabs)| {
            let bsdf = Self::new(&slabs);
            Specimen::new(name, bsdf.claims(), bsdf)
        })
    }
}
