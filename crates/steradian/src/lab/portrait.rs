//! Charts of how a material scatters.

use super::plot::{
    Axis, Chart, Curve, Dash, Heading, Ink, Polar, Ray, Scale, Zero, series_ink, wavelength_ink,
};
use super::probe::{AlbedoReading, Angles, Probe, ProbeError};
use super::subject::Subject;
use crate::bsdf::Mode;
use crate::spectrum::{LAMBDA_MAX, LAMBDA_MIN};

/// What is looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Wavelengths in nm, at least one.
    pub wavelengths: Vec<f32>,
    /// Angles of the arriving light to the normal [degrees], in [0, 180], at least one.
    pub thetas: Vec<f64>,
    /// Radius of lobes.
    pub radius: LobeRadius,
    /// Scale of that radius.
    pub scale: Scale,
    /// Random walks behind each value of a material that is estimated.
    pub walks: u32,
}

/// What the radius of a lobe means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LobeRadius {
    /// f·|cosθo| [sr⁻¹]: scattered intensity over arriving power.
    Intensity,
    /// f [sr⁻¹].
    F,
}

/// Step of curves over wavelength [nm].
const SPECTRAL_STEP: f32 = 5.0;

/// Shares of the power that are not worth an arrow.
const LEAST_SHARE: f64 = 1e-4;

/// Curves that differ by less than this share of the largest value are one on paper.
const ALIKE: f64 = 3e-3;

/// The scattered light in the plane of incidence, for light that comes from the left at each of the angles; discrete
/// directions as arrows as long as their share of the power.
///
/// # Errors
/// For materials that have no scattering function of their own.
pub fn lobes(subject: &Subject<'_>, view: &View) -> Result<Polar, ProbeError> {
    let probe = Probe::new(subject, &view.wavelengths)?;
    let families: Vec<_> = view.thetas.iter().map(|&theta| lobe(&probe, theta, view)).collect();
    let grey = families.iter().all(|f| f.alike());
    let angles: Vec<_> = view.thetas.iter().map(|t| format!("{t}°")).collect();
    let mut curves = Vec::new();
    let mut rays = Vec::new();
    let mut shares = Vec::new();
    for (i, family) in families.iter().enumerate() {
        let (theta, dash) = (&angles[i], Dash::ALL[i % Dash::ALL.len()]);
        for (lane, points) in family.curves.iter().enumerate().take(if grey { 1 } else { usize::MAX }) {
            let lambda = view.wavelengths[lane];
            let curve = match (grey, angles.len()) {
                (true, _) => Curve::new(format!("light at {theta}"), series_ink(i), points.clone()),
                (false, 1) => Curve::new(nm(lambda), wavelength_ink(f64::from(lambda)), points.clone()),
                (false, _) => {
                    let label = format!("{}, {theta}", nm(lambda));
                    Curve::new(label, wavelength_ink(f64::from(lambda)), points.clone()).dashed(dash)
                }
            };
            if probe.is_continuous() {
                curves.push(curve);
            }
        }
        let ink = if grey { series_ink(i) } else { Ink::GREY };
        let angle = -view.thetas[i];
        rays.push(Ray { angle, length: 1.0, heading: Heading::In, ink });
        rays.extend(family.rays(&view.wavelengths, ink, grey));
        let named = family.shares().into_iter().map(|share| format!("{theta} → {share}"));
        shares.extend(named.map(|label| Curve::new(label, ink, Vec::new())));
    }
    let has_arrows = !shares.is_empty();
    curves.extend(shares);
    let quantity = match view.radius {
        LobeRadius::Intensity => "f |cos θo| [sr⁻¹]",
        LobeRadius::F => "f [sr⁻¹]",
    };
    let radius = match (probe.is_continuous(), has_arrows) {
        (false, _) => "share of the power in discrete directions [1]".to_owned(),
        (true, true) => format!("{quantity}; arrows: share of the power, 1 at the rim"),
        (true, false) => quantity.to_owned(),
    };
    let scale = if probe.is_continuous() { view.scale } else { Scale::Linear };
    let title =
        format!("{}: scattered light, incident from the left at {}", subject.name(), angles.join(", "));
    Ok(Polar { title, radius, scale, zero: Zero::Top, curves, rays })
}

/// The lobes of one direction of light at all wavelengths.
struct Family {
    /// Angle in the plane of incidence [degrees] and radius, for each wavelength.
    curves: Vec<Vec<[f64; 2]>>,
    /// Angle and share of power of discrete directions, for each wavelength.
    discrete: Vec<Vec<[f64; 2]>>,
}

impl Family {
    fn alike(&self) -> bool {
        let directions = |d: &Vec<[f64; 2]>| {
            d.len() == self.discrete[0].len()
                && d.iter()
                    .zip(&self.discrete[0])
                    .all(|(a, b)| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 5e-3))
        };
        alike(&self.curves) && self.discrete.iter().all(directions)
    }

    /// One arrow for each direction and wavelength, the short ones on top.
    fn rays(&self, wavelengths: &[f32], ink: Ink, grey: bool) -> Vec<Ray> {
        let mut rays: Vec<Ray> = Vec::new();
        let lanes = self.discrete.iter().zip(wavelengths).take(if grey { 1 } else { usize::MAX });
        for (found, &lambda) in lanes {
            for &[angle, share] in found.iter().filter(|d| d[1] > LEAST_SHARE) {
                let ink = if grey { ink } else { wavelength_ink(f64::from(lambda)) };
                rays.push(Ray { angle, length: share.clamp(0.02, 1.0), heading: Heading::Out, ink });
            }
        }
        rays.sort_by(|a, b| b.length.total_cmp(&a.length));
        rays
    }

    /// The discrete directions with their shares of the power, those of all wavelengths together.
    fn shares(&self) -> Vec<String> {
        let mut all: Vec<[f64; 2]> =
            self.discrete.iter().flatten().copied().filter(|d| d[1] > LEAST_SHARE).collect();
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        // Dispersion spreads a direction by a few degrees.
        let groups = all.chunk_by(|a, b| b[0] - a[0] < 4.0);
        let span = |g: &[[f64; 2]], part: usize, decimals: usize| {
            let text = |x: f64| format!("{x:.decimals$}");
            let values = || g.iter().map(|d| d[part].abs());
            let least = text(values().fold(f64::INFINITY, f64::min));
            let most = text(values().fold(0.0, f64::max));
            if least == most { most } else { format!("{least}–{most}") }
        };
        groups.map(|g| format!("{}°: {}", span(g, 0, 0), span(g, 1, 2))).collect()
    }
}

fn lobe(probe: &Probe<'_>, theta: f64, view: &View) -> Family {
    let wi = Angles { theta, phi: 180.0 }.direction();
    let value = |angle: f64| -> Vec<f64> {
        let wo = Angles { theta: angle.abs(), phi: if angle < 0.0 { 180.0 } else { 0.0 } }.direction();
        let cos = match view.radius {
            LobeRadius::Intensity => f64::from(wo.abs_cos_theta()),
            LobeRadius::F => 1.0,
        };
        probe.f(wo, wi, Mode::Radiance, view.walks).iter().map(|f| f.value * cos).collect()
    };
    // Light from below is scattered below first.
    let reach = if probe.transmits() || theta > 90.0 { 180 } else { 90 };
    let mut grid: Vec<f64> = (-reach..=reach).step_by(2).map(f64::from).collect();
    // Lobes may be narrower than the grid, but not elsewhere than here.
    grid.extend([theta, -theta, 180.0 - theta]);
    for (interface, lane) in probe.interfaces().unwrap_or_default() {
        let eta = f64::from(interface.eta[lane]);
        let sin = theta.to_radians().sin() * if theta > 90.0 { eta } else { 1.0 / eta };
        if sin < 1.0 {
            let refracted = sin.asin().to_degrees();
            grid.push(if theta > 90.0 { refracted } else { 180.0 - refracted });
        }
    }
    grid.retain(|a| a.abs() <= f64::from(reach));
    grid.sort_by(f64::total_cmp);
    grid.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let samples: Vec<_> = if probe.is_continuous() {
        let coarse: Vec<_> = grid.iter().map(|&a| (a, value(a))).collect();
        // Noise has no shape to be followed.
        if probe.is_estimated() { coarse } else { refined(coarse, &value, view.scale) }
    } else {
        Vec::new()
    };
    let lanes = view.wavelengths.len();
    let curve = |lane: usize| samples.iter().map(|(a, v)| [*a, v[lane]]).collect();
    let discrete = probe.discrete(wi, Mode::Importance);
    let in_plane = |found: &Vec<super::probe::Discrete>| {
        let angle = |d: &super::probe::Discrete| {
            let a = Angles::of(d.direction);
            if (90.0..270.0).contains(&a.phi) { -a.theta } else { a.theta }
        };
        found.iter().map(|d| [angle(d), d.ratio]).collect()
    };
    Family { curves: (0..lanes).map(curve).collect(), discrete: discrete.iter().map(in_plane).collect() }
}

/// Adds points between others until straight lines follow the curve to a few thousandths of its largest radius.
fn refined(
    coarse: Vec<(f64, Vec<f64>)>,
    value: &dyn Fn(f64) -> Vec<f64>,
    scale: Scale,
) -> Vec<(f64, Vec<f64>)> {
    let most = coarse.iter().flat_map(|(_, v)| v).copied().fold(f64::MIN_POSITIVE, f64::max);
    let radius = move |x: f64| match scale {
        Scale::Linear => x / most,
        Scale::Logarithmic { decades } => {
            (1.0 + (x / most).max(f64::MIN_POSITIVE).log10() / f64::from(decades)).max(0.0)
        }
    };
    let mut out = Vec::with_capacity(coarse.len() * 2);
    let mut coarse = coarse.into_iter();
    out.extend(coarse.next());
    for (b, vb) in coarse {
        // Intervals that are still to be looked at, the leftmost on top.
        let mut open = vec![(b, vb, 0)];
        while let Some((b, vb, depth)) = open.pop() {
            let Some((a, va)) = out.last() else { break };
            let middle = 0.5 * (a + b);
            let straight = |m: &[f64]| {
                let lanes = m.iter().zip(va).zip(&vb);
                lanes
                    .into_iter()
                    .all(|((m, a), b)| (radius(*m) - 0.5 * (radius(*a) + radius(*b))).abs() < 2e-3)
            };
            // Below a third of a degree the arc between two points is straight on paper as well.
            let m = (depth < 9).then(|| value(middle));
            match m {
                Some(m) if !straight(&m) => {
                    open.push((b, vb, depth + 1));
                    open.push((middle, m, depth + 1));
                }
                _ => out.push((b, vb)),
            }
        }
    }
    out
}

/// ρ and τ over the angle of the arriving light.
///
/// # Errors
/// For materials that have no scattering function of their own.
pub fn albedo_over_angle(subject: &Subject<'_>, view: &View) -> Result<Chart, ProbeError> {
    let probe = Probe::new(subject, &view.wavelengths)?;
    // The last is short of the horizon, where nothing arrives.
    let angles: Vec<f64> = (0..30).map(|i| 3.0 * f64::from(i)).chain([88.5, 89.7]).collect();
    let readings: Vec<Vec<AlbedoReading>> =
        angles.iter().map(|&theta| probe.albedo(Angles { theta, phi: 180.0 }.direction())).collect();
    let of = |lane: usize, part: fn(&AlbedoReading) -> f64| {
        angles.iter().zip(&readings).map(|(a, r)| [*a, part(&r[lane])]).collect()
    };
    let lanes = 0..view.wavelengths.len();
    let rho: Vec<_> = lanes.clone().map(|lane| of(lane, |r| r.reflectance)).collect();
    let tau: Vec<_> = lanes.map(|lane| of(lane, |r| r.transmittance)).collect();
    let names: Vec<_> = view.wavelengths.iter().map(|l| (nm(*l), wavelength_ink(f64::from(*l)))).collect();
    Ok(Chart {
        title: format!("{}: albedo over the angle of incidence", subject.name()),
        x: Axis::angle("angle of incidence θi [°]"),
        y: Axis::new("share of the power [1]").including(&[0.0, 1.0]),
        curves: albedo_curves(rho, tau, &names),
    })
}

/// ρ and τ over wavelength, for light at each of the angles.
///
/// # Errors
/// For materials that have no scattering function of their own.
pub fn albedo_over_wavelength(subject: &Subject<'_>, view: &View) -> Result<Chart, ProbeError> {
    let wavelengths = spectral_grid(subject);
    let probe = Probe::new(subject, &wavelengths)?;
    let mut rho = Vec::new();
    let mut tau = Vec::new();
    for &theta in &view.thetas {
        let readings = probe.albedo(Angles { theta, phi: 180.0 }.direction());
        let of = |part: fn(&AlbedoReading) -> f64| {
            wavelengths.iter().zip(&readings).map(|(l, r)| [f64::from(*l), part(r)]).collect::<Vec<_>>()
        };
        rho.push(of(|r| r.reflectance));
        tau.push(of(|r| r.transmittance));
    }
    let names: Vec<_> =
        view.thetas.iter().enumerate().map(|(i, t)| (format!("{t}°"), series_ink(i))).collect();
    Ok(Chart {
        title: format!("{}: albedo over wavelength", subject.name()),
        x: wavelength_axis(),
        y: Axis::new("share of the power [1]").including(&[0.0, 1.0]),
        curves: albedo_curves(rho, tau, &names),
    })
}

/// Fresnel's reflectances over the angle of incidence; `None` for materials without a single index.
///
/// # Errors
/// For materials that have no scattering function of their own.
pub fn fresnel(subject: &Subject<'_>, view: &View) -> Result<Option<Chart>, ProbeError> {
    let probe = Probe::new(subject, &view.wavelengths)?;
    let Some(interfaces) = probe.interfaces() else { return Ok(None) };
    let angles: Vec<f64> = (0..=360).map(|i| 0.25 * f64::from(i)).collect();
    let curves_of = |part: fn(crate::optics::fresnel::Polarized) -> f32| -> Vec<Vec<[f64; 2]>> {
        let one = |(interface, lane): &(crate::bsdf::Interface, usize)| {
            let at = |a: &f64| {
                let cos = a.to_radians().cos().max(0.0) as f32;
                [*a, f64::from(part(interface.reflectance(*lane, cos)))]
            };
            angles.iter().map(at).collect()
        };
        interfaces.iter().map(one).collect()
    };
    let parts = [
        ("mean", Dash::Solid, curves_of(|p| p.unpolarized())),
        ("s", Dash::Dashed, curves_of(|p| p.s)),
        ("p", Dash::Dotted, curves_of(|p| p.p)),
    ];
    let grey = parts.iter().all(|(_, _, curves)| alike(curves));
    let mut curves = Vec::new();
    for (lane, &lambda) in view.wavelengths.iter().enumerate().take(if grey { 1 } else { usize::MAX }) {
        for (i, (name, dash, points)) in parts.iter().enumerate() {
            let points = points[lane].clone();
            curves.push(match grey {
                true => Curve::new(*name, series_ink(i), points),
                false => {
                    let label = format!("{name}, {}", nm(lambda));
                    Curve::new(label, wavelength_ink(f64::from(lambda)), points).dashed(*dash)
                }
            });
        }
    }
    Ok(Some(Chart {
        title: format!("{}: Fresnel reflectance of the bare interface", subject.name()),
        x: Axis::angle("angle of incidence θi [°]"),
        y: Axis::new("reflectance [1]").including(&[0.0, 1.0]),
        curves,
    }))
}

/// Index and extinction over wavelength; `None` for materials without a single index.
///
/// # Errors
/// For materials that have no scattering function of their own.
pub fn index_over_wavelength(subject: &Subject<'_>) -> Result<Option<Chart>, ProbeError> {
    let wavelengths = spectral_grid(subject);
    let probe = Probe::new(subject, &wavelengths)?;
    let Some(interfaces) = probe.interfaces() else { return Ok(None) };
    let curve = |part: &dyn Fn(&crate::bsdf::Interface, usize) -> f32| -> Vec<[f64; 2]> {
        let points = wavelengths.iter().zip(&interfaces);
        points.map(|(l, (i, lane))| [f64::from(*l), f64::from(part(i, *lane))]).collect()
    };
    let k = curve(&|i, lane| i.k[lane]);
    let mut curves = vec![Curve::new("η", series_ink(0), curve(&|i, lane| i.eta[lane]))];
    let absorbs = k.iter().any(|p| p[1] > 0.0);
    if absorbs {
        curves.push(Curve::new("k", series_ink(1), k).dashed(Dash::Dashed));
    }
    let (what, y) = match absorbs {
        true => ("complex index η + jk", Axis::new("relative index [1]").including(&[0.0])),
        false => ("index of refraction", Axis::new("relative index [1]")),
    };
    Ok(Some(Chart { title: format!("{}: {what}", subject.name()), x: wavelength_axis(), y, curves }))
}

/// ρ solid and τ dashed, in the colours and under the names of what they are for; alike ones only once.
fn albedo_curves(rho: Vec<Vec<[f64; 2]>>, tau: Vec<Vec<[f64; 2]>>, names: &[(String, Ink)]) -> Vec<Curve> {
    let transmits = tau.iter().flatten().any(|p| p[1] > 1e-6);
    if alike(&rho) && alike(&tau) {
        let mut curves: Vec<_> = rho.into_iter().take(1).map(|p| Curve::new("ρ", series_ink(0), p)).collect();
        if transmits {
            let dashed = |p| Curve::new("τ", series_ink(1), p).dashed(Dash::Dashed);
            curves.extend(tau.into_iter().take(1).map(dashed));
        }
        return curves;
    }
    let mut curves = Vec::new();
    for ((rho, tau), (name, ink)) in rho.into_iter().zip(tau).zip(names) {
        curves.push(Curve::new(format!("ρ, {name}"), *ink, rho));
        if transmits {
            curves.push(Curve::new(format!("τ, {name}"), *ink, tau).dashed(Dash::Dashed));
        }
    }
    curves
}

/// Whether curves over the same abscissae cannot be told apart.
fn alike(curves: &[Vec<[f64; 2]>]) -> bool {
    let Some((first, rest)) = curves.split_first() else { return true };
    let most = curves.iter().flatten().map(|p| p[1].abs()).fold(0.0, f64::max);
    rest.iter().all(|c| {
        c.len() == first.len() && c.iter().zip(first).all(|(a, b)| (a[1] - b[1]).abs() <= ALIKE * most)
    })
}

/// Wavelengths of the film's range for which the material has data.
fn spectral_grid(subject: &Subject<'_>) -> Vec<f32> {
    let (lo, hi) = subject.range();
    let n = ((LAMBDA_MAX - LAMBDA_MIN) / SPECTRAL_STEP).round() as usize;
    let all = (0..=n).map(|i| LAMBDA_MIN + i as f32 * SPECTRAL_STEP);
    all.filter(|l| (lo..=hi).contains(l)).collect()
}

fn wavelength_axis() -> Axis {
    Axis::new("wavelength λ [nm]").stepped(50.0)
}

fn nm(lambda: f32) -> String {
    format!("{lambda} nm")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::import::pbrt::{Input, import};
    use crate::scene::{Diagnostics, MemoryFiles, RenderJob, compile};
    use std::f64::consts::{FRAC_1_PI, PI};
    use std::path::Path;

    fn job() -> RenderJob {
        let text = b"WorldBegin
            MakeNamedMaterial \"paint\" \"string type\" \"diffuse\" \"spectrum reflectance\" [400 0.5 700 0.5]
            MakeNamedMaterial \"glass\" \"string type\" \"dielectric\"
            MakeNamedMaterial \"polished\" \"string type\" \"conductor\" \"bool remaproughness\" false
              \"float roughness\" 0.01";
        let input = Input::Text { name: "test", bytes: text, base: Path::new("") };
        let scene = import(&[input], &MemoryFiles::default()).scene.unwrap();
        compile(scene, &MemoryFiles::default(), &mut Diagnostics::default()).unwrap()
    }

    fn view(wavelengths: &[f32], thetas: &[f64]) -> View {
        View {
            wavelengths: wavelengths.to_vec(),
            thetas: thetas.to_vec(),
            radius: LobeRadius::Intensity,
            scale: Scale::Linear,
            walks: 2,
        }
    }

    #[test]
    fn wavelengths_that_scatter_alike_share_a_lobe_and_paint_scatters_by_lamberts_law() {
        let job = job();
        let paint = Subject::find(&job, "paint").unwrap();
        let polar = lobes(&paint, &view(&[450.0, 650.0], &[0.0, 60.0])).unwrap();
        let labels: Vec<_> = polar.curves.iter().map(|c| c.label.as_str()).collect();
        assert_eq!(labels, ["light at 0°", "light at 60°"]);
        for [angle, radius] in &polar.curves[1].points {
            assert!((radius - 0.5 * FRAC_1_PI * (angle * PI / 180.0).cos()).abs() < 1e-6, "{angle}");
        }
    }

    /// A lobe of half a degree on a grid of two: its peak and its flanks must be on paper.
    #[test]
    fn narrow_lobes_are_followed_to_their_peak() {
        let job = job();
        let metal = Subject::find(&job, "polished").unwrap();
        let polar = lobes(&metal, &view(&[550.0], &[37.3])).unwrap();
        let points = &polar.curves[0].points;
        let peak = points.iter().map(|p| p[1]).fold(0.0, f64::max);
        let probe = Probe::new(&metal, &[550.0]).unwrap();
        let wi = Angles { theta: 37.3, phi: 180.0 }.direction();
        let dense = (0..4000).map(|i| {
            let theta = 35.0 + f64::from(i) * 0.00125;
            let wo = Angles { theta, phi: 0.0 }.direction();
            let r = probe.f(wo, wi, Mode::Radiance, 2)[0].value * f64::from(wo.abs_cos_theta());
            let next = points.iter().position(|p| p[0] >= theta).unwrap();
            let ([a, ra], [b, rb]) = (points[next - 1], points[next]);
            let drawn = ra + (rb - ra) * (theta - a) / (b - a);
            (r, (r - drawn).abs())
        });
        let (most, worst) = dense.fold((0.0, 0.0), |(m, w): (f64, f64), (r, e)| (m.max(r), w.max(e)));
        assert!((peak / most - 1.0).abs() < 1e-3 && worst < 0.02 * most, "{peak} {most} {worst}");
    }

    /// R(0) = 0.04, and no light polarised in the plane is reflected at Brewster's angle arctan 1.5.
    #[test]
    fn fresnel_curves_begin_at_four_percent_and_vanish_at_brewsters_angle() {
        let job = job();
        let glass = Subject::find(&job, "glass").unwrap();
        let chart = fresnel(&glass, &view(&[450.0, 650.0], &[0.0])).unwrap().unwrap();
        let curve = |label: &str| &chart.curves.iter().find(|c| c.label == label).unwrap().points;
        for label in ["mean", "s", "p"] {
            assert!((curve(label)[0][1] - 0.04).abs() < 1e-6 && (curve(label)[360][1] - 1.0).abs() < 1e-6);
        }
        let least = curve("p").iter().copied().reduce(|a, b| if b[1] < a[1] { b } else { a }).unwrap();
        assert!((least[0] - 1.5_f64.atan().to_degrees()).abs() <= 0.125 && least[1] < 1e-5, "{least:?}");
        let paint = Subject::find(&job, "paint").unwrap();
        assert!(fresnel(&paint, &view(&[550.0], &[0.0])).unwrap().is_none());
    }

    #[test]
    fn curves_over_wavelength_end_where_the_data_end() {
        let job = job();
        let paint = Subject::find(&job, "paint").unwrap();
        let chart = albedo_over_wavelength(&paint, &view(&[550.0], &[0.0])).unwrap();
        let points = &chart.curves[0].points;
        assert_eq!((points[0][0], points[points.len() - 1][0]), (400.0, 700.0));
        assert!(points.iter().all(|p| (p[1] - 0.5).abs() < 1e-6));
    }
}
