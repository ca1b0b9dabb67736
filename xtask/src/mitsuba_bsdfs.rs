//! Our scattering functions against those of Mitsuba 3: f and density at pairs of directions, and the power of discrete
//! directions.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use steradian::bsdf::{Bsdf, Mode};
use steradian::lab::Subject;
use steradian::math::hash::Pcg32;
use steradian::math::{LocalDir, Vec3};
use steradian::optics::TrowbridgeReitz;
use steradian::scene::import::pbrt::{Input, import};
use steradian::scene::{Disk, RenderJob};
use steradian::spectrum::{LANES, Wavelengths};
use steradian::units::Density;

/// Reads a plugin dictionary, then a line of pairs of directions ("pairs", wo and wi) or of one direction ("discrete", wo),
/// and prints f at four wavelengths and the density, or the power reflected and transmitted.
const MITSUBA: &str = r"
import sys, json
import mitsuba as mi
mi.set_variant('scalar_spectral')
context = mi.BSDFContext(mi.TransportMode.Radiance)
wavelengths = [float(x) for x in sys.argv[1:5]]
def surface(wo):
    si = mi.SurfaceInteraction3f()
    si.t, si.n = 1.0, mi.Normal3f(0, 0, 1)
    si.sh_frame = mi.Frame3f(mi.Vector3f(1, 0, 0), mi.Vector3f(0, 1, 0), mi.Vector3f(0, 0, 1))
    si.wavelengths, si.wi, si.uv = wavelengths, mi.Vector3f(*wo), mi.Point2f(.5, .5)
    return si
for line in sys.stdin:
    bsdf = mi.load_dict(json.loads(line))
    kind, *numbers = sys.stdin.readline().split()
    n = [float(x) for x in numbers]
    if kind == 'pairs':
        for i in range(0, len(n), 6):
            si, wi = surface(n[i:i + 3]), mi.Vector3f(*n[i + 3:i + 6])
            f = bsdf.eval(context, si, wi)
            print(*[f[k] / abs(wi.z) for k in range(4)], bsdf.pdf(context, si, wi), end=' ')
    else:
        si, count = surface(n), 20000
        power = [0.0, 0.0]
        for i in range(count):
            s, weight = bsdf.sample(context, si, (i + .5) / count, mi.Point2f(.5, .5))
            power[s.wo.z * si.wi.z < 0] += weight[0] * s.eta ** 2 / count
        print(*power, end=' ')
    print(flush=True)
";

const WAVELENGTHS: [f32; LANES] = [450.0, 550.0, 620.0, 700.0];
/// Largest relative difference that is put down to rounding, and to how either program reads its tables.
const AGREES: f64 = 0.005;

/// A material in both languages.
struct Case {
    name: &'static str,
    ours: String,
    theirs: String,
    masking: Masking,
}

/// How the peer's masking differs from ours.
#[derive(Clone, Copy)]
enum Masking {
    /// Not at all.
    Same,
    /// Ours is height-correlated, G = 1/(1 + Λo + Λi); Mitsuba's is separable, G = G1(wo) G1(wi). Values are compared after
    /// that factor is divided out.
    Separable(TrowbridgeReitz),
}

/// `mitsuba-bsdfs [--python EXE] [--bsdf FILE]`.
pub(crate) fn run(arguments: &[String]) -> Result<String, String> {
    let option = |name: &str| arguments.iter().position(|a| a == name).and_then(|i| arguments.get(i + 1));
    let mut peer = Peer::start(option("--python").map_or("python3", String::as_str))?;
    let mut worst_of_all = 0.0_f64;
    crate::emit("material                        worst f    worst pdf   pairs");
    for case in cases(option("--bsdf").map(PathBuf::from).as_deref()) {
        let (f, pdf, n) = compare(&case, &mut peer).map_err(|e| format!("{}: {e}", case.name))?;
        crate::emit(&format!("{:30} {:8.4} %  {:8.4} %  {n:6}", case.name, 100.0 * f, 100.0 * pdf));
        worst_of_all = worst_of_all.max(f).max(pdf);
    }
    crate::emit("smooth dielectric               reflected (ours, theirs)    transmitted (ours, theirs)");
    for degrees in [0.0_f32, 30.0, 60.0, 80.0, 100.0, 150.0, 170.0] {
        let worst = compare_discrete(degrees, &mut peer)?;
        worst_of_all = worst_of_all.max(worst);
    }
    let verdict = format!("worst difference {:.4} %, bound {} %", 100.0 * worst_of_all, 100.0 * AGREES);
    if worst_of_all <= AGREES { Ok(verdict) } else { Err(verdict) }
}

fn cases(measured: Option<&Path>) -> Vec<Case> {
    let case = |name, ours: &str, theirs: &str, masking| Case {
        name,
        ours: ours.to_owned(),
        theirs: theirs.to_owned(),
        masking,
    };
    let ggx = |ax, ay| Masking::Separable(TrowbridgeReitz::new(ax, ay));
    let mut all = vec![
        case(
            "diffuse",
            r#""diffuse" "spectrum reflectance" [ 300 .5 900 .5 ]"#,
            r#"{"type": "diffuse", "reflectance": {"type": "uniform", "value": 0.5}}"#,
            Masking::Same,
        ),
        case(
            "rough conductor 0.3",
            r#""conductor" "spectrum eta" [ 300 .2 900 .2 ] "spectrum k" [ 300 3.9 900 3.9 ]
               "float roughness" .3 "bool remaproughness" false"#,
            r#"{"type": "roughconductor", "eta": 0.2, "k": 3.9, "alpha": 0.3, "distribution": "ggx"}"#,
            ggx(0.3, 0.3),
        ),
        case(
            "rough conductor 0.1 x 0.5",
            r#""conductor" "spectrum eta" [ 300 1.4 900 1.4 ] "spectrum k" [ 300 7.5 900 7.5 ]
               "float uroughness" .1 "float vroughness" .5 "bool remaproughness" false"#,
            r#"{"type": "roughconductor", "eta": 1.4, "k": 7.5, "alpha_u": 0.1, "alpha_v": 0.5, "distribution": "ggx"}"#,
            ggx(0.1, 0.5),
        ),
    ];
    for alpha in [0.1_f32, 0.4] {
        all.push(Case {
            name: if alpha < 0.2 { "rough dielectric 0.1" } else { "rough dielectric 0.4" },
            ours: format!(
                r#""dielectric" "float eta" 1.5 "float roughness" {alpha} "bool remaproughness" false"#
            ),
            theirs: format!(
                r#"{{"type": "roughdielectric", "int_ior": 1.5, "ext_ior": 1.0, "alpha": {alpha}, "distribution": "ggx"}}"#
            ),
            masking: ggx(alpha, alpha),
        });
    }
    if let Some(path) = measured {
        let path = path.display();
        all.push(Case {
            name: "measured",
            ours: format!(r#""measured" "string filename" "{path}""#),
            theirs: format!(r#"{{"type": "measured", "filename": "{path}"}}"#),
            masking: Masking::Same,
        });
    }
    all
}

/// Worst relative differences of f and of the density, and the number of pairs.
fn compare(case: &Case, peer: &mut Peer) -> Result<(f64, f64, usize), String> {
    let job = compile(&case.ours)?;
    let bsdf = scatterer(&job)?;
    let pairs = pairs(&bsdf);
    let mut question = "pairs".to_owned();
    for &(wo, wi) in &pairs {
        question += &format!(" {} {} {} {} {} {}", wo.x, wo.y, wo.z, wi.x, wi.y, wi.z);
    }
    let answer = peer.ask(&case.theirs, &question)?;
    let (mut worst_f, mut worst_pdf) = (0.0_f64, 0.0_f64);
    for (&(wo, wi), theirs) in pairs.iter().zip(answer.chunks_exact(LANES + 1)) {
        let f = bsdf.eval(wo, wi, Mode::Radiance);
        let pdf = bsdf.pdf(wo, wi, Mode::Radiance).0;
        let factor = match case.masking {
            Masking::Same => 1.0,
            Masking::Separable(d) => f64::from(d.g(wo, wi) / (d.g1(wo) * d.g1(wi))),
        };
        let relative = |ours: f32, theirs: f64| (f64::from(ours) - theirs).abs() / theirs.max(1e-6);
        for lane in 0..LANES {
            worst_f = worst_f.max(relative(f[lane], theirs[lane] * factor));
        }
        worst_pdf = worst_pdf.max(relative(pdf, theirs[LANES]));
    }
    Ok((worst_f, worst_pdf, pairs.len()))
}

/// Worst relative difference of the powers of a smooth interface, radiance scaling taken out.
fn compare_discrete(degrees: f32, peer: &mut Peer) -> Result<f64, String> {
    let job = compile(r#""dielectric" "float eta" 1.5"#)?;
    let bsdf = scatterer(&job)?;
    let (sin, cos) = degrees.to_radians().sin_cos();
    let wo = LocalDir::new(Vec3::new(sin, 0.0, cos)).ok_or("no direction")?;
    let theirs = peer.ask(
        r#"{"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}"#,
        &format!("discrete {} {} {}", wo.x, wo.y, wo.z),
    )?;
    let albedo = bsdf.albedo(wo);
    let ours = [albedo.reflectance[0], albedo.transmittance[0]].map(f64::from);
    crate::emit(&format!(
        "{degrees:5} degrees                   {:.5} {:.5}             {:.5} {:.5}",
        ours[0], theirs[0], ours[1], theirs[1]
    ));
    // The peer's power is counted in steps of 1/20000.
    let beyond_counting = |a: f64, b: f64| ((a - b).abs() - 1e-4).max(0.0) / b.max(1e-3);
    Ok(beyond_counting(ours[0], theirs[0]).max(beyond_counting(ours[1], theirs[1])))
}

/// Pairs of directions where the function has something to say: drawn by itself.
fn pairs(bsdf: &Bsdf<'_>) -> Vec<(LocalDir, LocalDir)> {
    let mut rng = Pcg32::new(4, 4);
    let mut all = Vec::new();
    while all.len() < 400 {
        let mut draw = || steradian::math::Vec2::new(rng.next_f32(), rng.next_f32());
        let up = steradian::math::warp::uniform_sphere(draw());
        let (uc, u) = (draw().x, draw());
        let Some(wo) = LocalDir::new(up) else { continue };
        let Some(s) = bsdf.sample(wo, uc, u, Mode::Radiance) else { continue };
        let continuous = matches!(s.density, Density::SolidAngle(_));
        if continuous && wo.abs_cos_theta() > 0.02 && s.wi.abs_cos_theta() > 0.02 && is_single_sided(wo, bsdf)
        {
            all.push((wo, s.wi));
        }
    }
    all
}

/// Mitsuba's opaque plugins scatter above the surface only; ours on both sides.
fn is_single_sided(wo: LocalDir, bsdf: &Bsdf<'_>) -> bool {
    wo.z > 0.0 || bsdf.lobes().transmission
}

fn compile(material: &str) -> Result<RenderJob, String> {
    let text = format!("WorldBegin Material {material}");
    let input = Input::Text { name: "material", bytes: text.as_bytes(), base: Path::new("") };
    let mut imported = import(&[input], &Disk);
    let job = imported
        .scene
        .take()
        .and_then(|desc| steradian::scene::compile(desc, &Disk, &mut imported.diagnostics));
    job.ok_or_else(|| imported.diagnostics.display(&imported.sources).to_string())
}

fn scatterer(job: &RenderJob) -> Result<Bsdf<'_>, String> {
    let subjects = Subject::all(job);
    let subject = subjects.last().ok_or("no material")?;
    subject.scatterer(&mut Wavelengths::exactly(WAVELENGTHS), 0).ok_or_else(|| "not a surface".to_owned())
}

/// A running Mitsuba.
struct Peer {
    to: std::process::ChildStdin,
    from: std::io::Lines<BufReader<std::process::ChildStdout>>,
}

impl Peer {
    fn start(python: &str) -> Result<Self, String> {
        let mut child = Command::new(python)
            .args(["-c", MITSUBA])
            .args(WAVELENGTHS.map(|l| l.to_string()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|e| format!("cannot start Python: {e}"))?;
        let to = child.stdin.take().ok_or("no pipe to Python")?;
        let from = BufReader::new(child.stdout.take().ok_or("no pipe from Python")?).lines();
        Ok(Self { to, from })
    }

    fn ask(&mut self, plugin: &str, question: &str) -> Result<Vec<f64>, String> {
        writeln!(self.to, "{}\n{question}", plugin.replace('\n', " ")).map_err(|e| e.to_string())?;
        let line = self
            .from
            .next()
            .ok_or("Mitsuba ended early; is `mitsuba` installed in this Python?")?
            .map_err(|e| e.to_string())?;
        line.split_whitespace().map(|n| n.parse().map_err(|_| format!("Mitsuba said {n}"))).collect()
    }
}
