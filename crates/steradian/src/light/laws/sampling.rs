//! Densities of samples and probabilities of choices.

use super::*;

#[test]
fn environment_maps_are_sampled_by_their_density() {
    let turn = Transform::rotate(77.0, Vec3::new(0.3, 1.0, 0.2)).unwrap();
    let map = ImageInfiniteLight::new(turn, picture([16, 16], sky), &Stated::default()).unwrap();
    let light = Light::ImageInfinite(Box::new(map));
    let w = Wavelengths::sample_visible(0.4);
    let from = facing(Vec3::ZERO, Vec3::Z);
    // χ² over octants of the sphere: counts of random samples against the density's integral.
    let octant = |d: Vec3| usize::from(d.x > 0.0) + 2 * usize::from(d.y > 0.0) + 4 * usize::from(d.z > 0.0);
    let mut expected = [0.0_f64; 8];
    let fine = 512;
    for st in grid(fine) {
        let d = equal_area_square_to_sphere(st);
        let p = light.escape_density(Dir::new(d).unwrap()).0;
        expected[octant(d)] += f64::from(p) * f64::from(4.0 * PI) / f64::from(fine * fine);
    }
    // The edges of the brightest texel fall between the nodes: 512² of them resolve it to half a percent.
    let mass: f64 = expected.iter().sum();
    assert!((mass - 1.0).abs() < 5e-3, "{mass}");
    let mut counts = [0_u32; 8];
    let samples = 20_000;
    let mut rng = crate::math::hash::Pcg32::new(7, 1);
    for _ in 0..samples {
        let u = Vec2::new(rng.next_f32(), rng.next_f32());
        let s = light.sample(&from, &[], 0, u, &w).unwrap();
        counts[octant(*s.wi)] += 1;
        let Density::SolidAngle(density) = s.density else { panic!("a map is no delta light") };
        assert!((density.0 / light.escape_density(s.wi).0 - 1.0).abs() < 1e-3, "{s:?}");
        assert!((s.radiance - light.escaped(s.wi, &w)).to_array().iter().all(|d| d.abs() < 1e-9), "{s:?}");
    }
    let chi2: f64 = (0..8)
        .map(|i| {
            (f64::from(counts[i]) - expected[i] * f64::from(samples)).powi(2)
                / (expected[i] * f64::from(samples))
        })
        .sum();
    // 7 degrees of freedom, α = 10⁻⁴: 29.9.
    assert!(chi2 < 29.9, "{chi2}: {counts:?} {expected:?}");
    assert!(
        (Light::UniformInfinite(UniformInfiniteLight::new(one(), &ABSOLUTE).unwrap())
            .escape_density(Dir::Z)
            .0
            - UNIFORM_SPHERE_PDF)
            .abs()
            < 1e-9
    );
}

#[test]
fn a_hit_on_an_emitter_reports_the_density_and_radiance_of_its_sample() {
    let w = Wavelengths::sample_visible(0.2);
    let from = facing(Vec3::new(0.1, -0.2, 0.0), Vec3::Z);
    for shape in [disk(), sphere_at(2.5), square()] {
        let shapes = std::slice::from_ref(&shape);
        let light = area_light(&shape, one(), Sides::Front, &ABSOLUTE);
        for prim in 0..shape.prim_count() {
            for u in grid(5) {
                let Some(s) = light.sample(&from, shapes, prim, u, &w) else { continue };
                let Density::SolidAngle(density) = s.density else { panic!("a shape is no delta light") };
                let ray = Ray { o: from.p.p, d: *s.wi, time: 0.0 };
                let hit = shape.primitive(prim).intersect(&ray, f32::INFINITY).unwrap();
                let point = shape.surface(prim, &ray, &hit);
                let found = light.hit_density(&from, shapes, prim, s.wi, &point);
                assert!((found.0 / density.0 - 1.0).abs() < 1e-2, "{shape:?} {u}: {found:?} {density:?}");
                assert_eq!(light.emitted(&point, -s.wi, &w), s.radiance);
            }
        }
    }
}

#[test]
fn selection_by_power_follows_area_and_luminance() {
    let shapes = [square(), disk()];
    let area = |id: u32, scale| {
        let shape = &shapes[id as usize];
        let stated = Stated { scale, ..Stated::default() };
        let radiance = AreaRadiance::Uniform(named("stdillum-D65").unwrap());
        Light::DiffuseArea(
            DiffuseAreaLight::new(ShapeId(id), shape, radiance, Sides::Front, &stated).unwrap(),
        )
    };
    let lights = [area(0, 4.0 * PI), area(1, 1.0)];
    let sampler = LightSampler::by_power(&lights, &shapes, 10.0);
    // Fluxes 4π·π·1 and π·π: four fifths for the square, half of that for each triangle.
    for (light, prim, p) in [(0, 0, 0.4), (0, 1, 0.4), (1, 0, 0.2)] {
        let found = sampler.probability(Emitter { light: LightId(light), prim });
        assert!((found - p).abs() < 1e-4, "{light} {prim}: {found}");
    }
}

#[test]
fn selection_by_position_finds_every_light_with_its_probability_and_favours_the_near() {
    let mut rng = crate::math::hash::Pcg32::new(5, 1);
    let mut random = |lo: f32, hi: f32| lo + (hi - lo) * rng.next_f32();
    let mut shapes = Vec::new();
    for _ in 0..12 {
        let turn =
            Transform::rotate(random(0.0, 360.0), Vec3::new(random(-1.0, 1.0), 1.0, random(-1.0, 1.0)))
                .unwrap();
        let to = Vec3::new(random(-5.0, 5.0), random(-5.0, 5.0), random(-5.0, 5.0));
        let t = Transform::translate(to) * turn;
        let corners = [(-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5), (0.5, -0.5)];
        let data = MeshData {
            indices: vec![[0, 1, 2], [0, 2, 3]],
            positions: corners.map(|(x, y)| Point::new(x, y, 1.0)).to_vec(),
            ..MeshData::default()
        };
        shapes.push(Shape::Mesh(TriangleMesh::new(data, &t, Orientation::AsDefined).unwrap()));
    }
    let mut lights: Vec<Light> = (0..)
        .zip(&shapes)
        .map(|(id, shape)| {
            let sides = if id % 3 == 0 { Sides::Both } else { Sides::Front };
            let radiance = AreaRadiance::Uniform(one());
            Light::DiffuseArea(DiffuseAreaLight::new(ShapeId(id), shape, radiance, sides, &ABSOLUTE).unwrap())
        })
        .collect();
    let spot = |to: Vec3| {
        SpotLight::new(Transform::IDENTITY, Point::ORIGIN, Point(to), 30.0, 0.0, one(), &ABSOLUTE)
            .map(Light::Spot)
    };
    lights.push(spot(Vec3::X).unwrap());
    lights.push(spot(-Vec3::Z).unwrap());
    lights.push(Light::Point(
        PointLight::new(Transform::IDENTITY, Point::new(2.0, 1.0, 0.0), one(), &ABSOLUTE).unwrap(),
    ));
    lights.push(lambertian(EmittingOpening { half_x: 0.5, half_y: 0.2, ..EmittingOpening::default() }));
    lights.push(Light::UniformInfinite(UniformInfiniteLight::new(one(), &ABSOLUTE).unwrap()));
    let sampler = LightSampler::for_scene(&lights, &shapes, 10.0, Selection::Position);
    let by_power = LightSampler::by_power(&lights, &shapes, 10.0);
    let w = Wavelengths::sample_visible(0.5);
    let mut variances = [0.0_f64; 2];
    for i in 0..40 {
        let n = Vec3::new(random(-1.0, 1.0), random(-1.0, 1.0), random(-1.0, 1.0));
        let from = facing(Vec3::new(random(-4.0, 4.0), random(-4.0, 4.0), random(-4.0, 4.0)), n);
        // The irradiance of every emitter by itself, by quadrature.
        let own = |e: Emitter| {
            let light = &lights[e.light.0 as usize];
            let mut sum = 0.0;
            for u in grid(8) {
                let Some(s) = light.sample(&from, &shapes, e.prim, u, &w) else { continue };
                let cos = f64::from(s.wi.dot(*from.ns.unwrap()).max(0.0));
                let density = match s.density {
                    Density::Delta => 1.0,
                    Density::SolidAngle(p) => f64::from(p.0),
                };
                sum += f64::from(s.radiance[0]) * cos / density / 64.0;
            }
            sum
        };
        let emitters: Vec<Emitter> = (0..lights.len() as u32)
            .flat_map(|light| {
                let prims = shapes.get(light as usize).map_or(1, Shape::prim_count);
                (0..prims).map(move |prim| Emitter { light: LightId(light), prim })
            })
            .collect();
        let contributions: Vec<f64> = emitters.iter().map(|&e| own(e)).collect();
        let is_local = |e: Emitter| !lights[e.light.0 as usize].is_infinite();
        let mut mass = 0.0;
        for (&e, &c) in emitters.iter().zip(&contributions) {
            let p = sampler.probability_at(&from, e);
            mass += p;
            assert!(c == 0.0 || p > 0.0, "{i}: {e:?} contributes {c} and is never chosen");
            if c > 0.0 && is_local(e) {
                variances[0] += c * c / f64::from(p);
                variances[1] += c * c / f64::from(by_power.probability(e));
            }
        }
        assert!(mass < 1.0 + 1e-4, "{mass}");
        let draws = 2000;
        let mut counts = vec![0_u32; emitters.len()];
        for k in 0..draws {
            let Some(c) = sampler.sample_at(&from, (k as f32 + 0.5) / draws as f32) else { continue };
            let found = sampler.probability_at(&from, c.emitter);
            assert!((found / c.probability - 1.0).abs() < 1e-4, "{found} {c:?}");
            counts[emitters.iter().position(|&e| e == c.emitter).unwrap()] += 1;
        }
        for (&e, &count) in emitters.iter().zip(&counts) {
            let p = sampler.probability_at(&from, e);
            // A grid of u resolves each interval to one draw at each end.
            assert!((count as f32 - p * draws as f32).abs() < 2.0, "{e:?}: {count} {p}");
        }
    }
    // Second moment of the estimate of local light, summed over places.
    assert!(variances[0] < 0.75 * variances[1], "{variances:?}");
}
