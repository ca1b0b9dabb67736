use super::finish::Finish;
use super::*;
use crate::bsdf::{PhongLobe, PhongNormalization, PhongSampling};
use crate::math::{BoundedPoint, Normal, Point, Vec2, Vec3};
use crate::spectrum::named::named;
use crate::spectrum::{Sampled, Spectrum};
use crate::texture::SpectrumInput;

fn plane(x: f32) -> SurfacePoint {
    let n = Normal::Z;
    let shading = Shading { n, dpdu: Vec3::X, dpdv: Vec3::Y, dndu: Vec3::ZERO, dndv: Vec3::ZERO };
    SurfacePoint {
        p: BoundedPoint::exact(Point::new(x, 0.3, 0.0)),
        ng: n,
        uv: Vec2::new(x, 0.3),
        dpdu: Vec3::X,
        dpdv: Vec3::Y,
        shading,
        time: 0.0,
        face: 0,
    }
}

fn constant(x: f32) -> SpectrumInput {
    SpectrumInput::Constant(Spectrum::Constant(x))
}

fn shade<'a>(
    materials: &'a Materials,
    id: MaterialId,
    x: f32,
    w: &mut Wavelengths,
) -> Option<SurfaceBsdf<'a>> {
    let wo = Dir::new(Vec3::new(0.3, 0.1, 0.8)).unwrap();
    materials.shade(id, &plane(x), &Footprint::ZERO, wo, &Textures::new(), w, 1)
}

#[test]
fn mix_shows_the_second_material_in_the_given_share() {
    let mut materials = Materials::new();
    let first = materials
        .push(Material::Diffuse(DiffuseMaterial { reflectance: constant(0.2) }), Detail::Flat)
        .unwrap();
    let second = materials.push(Material::Interface(InterfaceMaterial), Detail::Flat).unwrap();
    let mix = |amount| {
        Material::Mix(MixMaterial { materials: [first, second], amount: FloatInput::Constant(amount) })
    };
    let n = 20_000;
    for share in [0.0_f32, 0.3, 1.0] {
        let id = materials.push(mix(share), Detail::Flat).unwrap();
        let seconds = (0..n)
            .filter(|&i| {
                shade(&materials, id, i as f32 * 1e-3, &mut Wavelengths::sample_visible(0.5)).is_none()
            })
            .count();
        // Four standard errors of a binomial share.
        let error = 4.0 * (share * (1.0 - share) / n as f32).sqrt();
        assert!((seconds as f32 / n as f32 - share).abs() <= error, "{share}: {seconds} of {n}");
    }
}

#[test]
fn mix_may_refer_to_earlier_materials_only() {
    let mut materials = Materials::new();
    let own = MaterialId(0);
    let mix = Material::Mix(MixMaterial { materials: [own, own], amount: FloatInput::Constant(0.5) });
    assert_eq!(materials.push(mix, Detail::Flat), Err(MaterialError::UnknownMaterial));
    let flat = materials.push(Material::Interface(InterfaceMaterial), Detail::Normals(NormalMapId(0)));
    assert_eq!(flat, Err(MaterialError::UnknownNormalMap));
}

#[test]
fn only_dispersive_glass_drops_the_companions() {
    let mut materials = Materials::new();
    let mut glass = |eta| {
        let glass = DielectricMaterial { eta, roughness: Roughness::SMOOTH, finish: Finish::default() };
        materials.push(Material::Dielectric(glass), Detail::Flat).unwrap()
    };
    let (plain, flint) = (glass(Spectrum::Constant(1.5)), glass(named("glass-F11").unwrap()));
    let mut w = Wavelengths::sample_visible(0.3);
    assert!(shade(&materials, plain, 0.0, &mut w).is_some());
    assert!(!w.companions_terminated());
    let surface = shade(&materials, flint, 0.0, &mut w).unwrap();
    assert!(w.companions_terminated());
    // The hero's index decides: n of F11 at the hero wavelength.
    let Bsdf::Dielectric(d) = surface.bsdf() else { panic!("not a dielectric") };
    assert_eq!(d.eta, named("glass-F11").unwrap().at(w.lambda()[0]));
}

#[test]
fn reflectance_of_a_metal_is_met_at_normal_incidence() {
    let mut materials = Materials::new();
    let metal = Metal::Reflectance(constant(0.7));
    let material = Material::Conductor(ConductorMaterial {
        metal,
        roughness: Roughness::SMOOTH,
        finish: Finish::default(),
    });
    let id = materials.push(material, Detail::Flat).unwrap();
    let surface = shade(&materials, id, 0.0, &mut Wavelengths::sample_visible(0.3)).unwrap();
    let s = surface.sample(Dir::Z, 0.5, Vec2::splat(0.5), crate::bsdf::Mode::Radiance).unwrap();
    assert!((s.weight[0] - 0.7).abs() < 1e-5, "{:?}", s.weight);
}

#[test]
fn coated_metal_has_its_index_relative_to_the_coat() {
    let mut materials = Materials::new();
    let metal = Metal::Index { eta: constant(0.3), k: constant(3.0) };
    let material = Material::CoatedConductor(CoatedConductorMaterial {
        metal,
        roughness: Roughness::SMOOTH,
        coat: CoatInput { thickness: FloatInput::Constant(0.0), max_depth: 100, ..CoatInput::default() },
    });
    let id = materials.push(material, Detail::Flat).unwrap();
    let mut total = Sampled::ZERO;
    let n = 40_000;
    let mut rng = hash::Pcg32::new(1, 1);
    let surface = shade(&materials, id, 0.0, &mut Wavelengths::sample_visible(0.3)).unwrap();
    for _ in 0..n {
        let (uc, u) = (rng.next_f32(), Vec2::new(rng.next_f32(), rng.next_f32()));
        if let Some(s) = surface.sample(Dir::Z, uc, u, crate::bsdf::Mode::Importance) {
            total += s.weight / n as f32;
        }
    }
    // Incoherent film at normal incidence: r + (1 − r)² R / (1 − r R), R of the metal in the coat.
    let (r, big) = (0.04_f32, crate::optics::fresnel::conductor(1.0, 0.2, 2.0));
    let expected = r + (1.0 - r).powi(2) * big / (1.0 - r * big);
    // The weight's spread is below 0.4: four standard errors are 8e-3.
    assert!((total[0] - expected).abs() < 8e-3, "{total:?} {expected}");
}

#[test]
fn phong_coefficients_that_textures_raise_above_one_are_scaled_in_proportion() {
    let mut materials = Materials::new();
    let phong = ModifiedPhongMaterial {
        diffuse: constant(0.9),
        specular: constant(0.6),
        exponent: 10.0,
        lobe: PhongLobe::Mirror,
        normalization: PhongNormalization::Exact,
        sampling: PhongSampling::Lobe,
    };
    let id = materials.push(Material::ModifiedPhong(phong), Detail::Flat).unwrap();
    let surface = shade(&materials, id, 0.0, &mut Wavelengths::sample_visible(0.3)).unwrap();
    let Bsdf::ModifiedPhong(b) = surface.bsdf() else { panic!("not Phong") };
    assert!((b.diffuse[0] - 0.6).abs() < 1e-6 && (b.specular[0] - 0.4).abs() < 1e-6, "{b:?}");
}
