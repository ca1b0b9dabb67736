//! Samples per second and cold start against Mitsuba 3, on the same scenes with the same path lengths.

use super::job;
use super::options::Options;
use super::row::{Row, Target};
use super::scenes::{self, Kind};
use std::io::{BufRead as _, BufReader, Lines, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

const SECTION: &str = "Samples: whole renders against Mitsuba 3";

/// The peer's variant: spectral, compiled for this processor's vectors, all threads.
const VARIANT: &str = "llvm_ad_spectral";

/// Asked for by the project: samples per second with the peer's compile time excluded, and a preview from a cold start.
const THROUGHPUT: Target = Target::RatioAtLeast(2.0);
const COLD_START: Target = Target::RatioAtLeast(5.0);

/// Samples per pixel of a preview.
const PREVIEW: u32 = 16;

/// A scene in both formats.
struct Subject {
    name: &'static str,
    pbrt: PathBuf,
    /// The peer's scene: an XML file, or its built-in Cornell box.
    peer: PathBuf,
    size: [u32; 2],
    /// Scattering events at most; the peer counts the camera's segment too.
    bounces: u32,
    spp: u32,
}

/// Loads a scene, renders it twice to have everything compiled, and then prints the seconds of one render per line read.
const PEER: &str = r"
import sys, time
import mitsuba as mi
variant, path, width, height, depth, spp = sys.argv[1], sys.argv[2], *map(int, sys.argv[3:7])
mi.set_variant(variant)
mi.set_log_level(mi.LogLevel.Error)
jit = not variant.startswith('scalar')
if jit:
    import drjit as dr
if path == 'cornell_box':
    d = mi.cornell_box()
    d['sensor']['film'] = {'type': 'hdrfilm', 'width': width, 'height': height, 'rfilter': {'type': 'box'}}
    scene = mi.load_dict(d)
else:
    scene = mi.load_file(path)
integrator = mi.load_dict({'type': 'path', 'max_depth': depth})
def render(seed):
    image = mi.render(scene, integrator=integrator, spp=spp, seed=seed)
    if jit:
        dr.eval(image)
        dr.sync_thread()
if len(sys.argv) > 7:
    render(0)
    sys.exit(0)
render(1000)
render(1001)
print('ready', flush=True)
for line in sys.stdin:
    start = time.perf_counter()
    render(int(line))
    print(time.perf_counter() - start, flush=True)
";

/// The peer with a scene loaded and compiled.
struct Peer {
    process: Child,
    input: ChildStdin,
    output: Lines<BufReader<ChildStdout>>,
}

impl Peer {
    fn start(python: &Path, variant: &str, scene: &Subject) -> Result<Self, String> {
        let mut process = command(python, variant, scene, scene.spp)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|e| format!("cannot start {}: {e}", python.display()))?;
        let input = process.stdin.take().ok_or("no pipe to Python")?;
        let output = BufReader::new(process.stdout.take().ok_or("no pipe from Python")?).lines();
        let mut peer = Self { process, input, output };
        peer.answer()?;
        Ok(peer)
    }

    fn answer(&mut self) -> Result<String, String> {
        let line = self.output.next().ok_or(
            "Mitsuba ended early: is `mitsuba` installed in this Python, and DRJIT_LIBLLVM_PATH a libLLVM newer than 16?",
        )?;
        line.map_err(|e| e.to_string())
    }

    /// Seconds of one render.
    fn render(&mut self, seed: usize) -> Result<f64, String> {
        writeln!(self.input, "{seed}").map_err(|e| e.to_string())?;
        self.answer()?.trim().parse().map_err(|_| "Mitsuba printed no time".to_owned())
    }

    fn stop(self) {
        let Self { mut process, input, .. } = self;
        drop(input);
        let _ = process.wait();
    }
}

fn command(python: &Path, variant: &str, scene: &Subject, spp: u32) -> Command {
    let [width, height] = scene.size;
    let mut command = Command::new(python);
    command.args(["-c", PEER, variant]).arg(&scene.peer);
    command.args([width, height, scene.bounces + 1, spp].map(|n| n.to_string()));
    command
}

/// Seconds of one render of ours, without reading the scene.
fn render(scene: &Subject, seed: usize) -> Result<f64, String> {
    let mut job = job::compile_file(&scene.pbrt)?;
    job.sampling.seed = seed as u64;
    job.sampling.spp = scene.spp;
    Ok(job::render(&job, None)?.elapsed.as_secs_f64())
}

/// Measures all scenes.
pub(super) fn measure(root: &Path, options: &Options) -> Result<Vec<Row>, String> {
    let python = options.python();
    let program = super::program(root)?;
    let mut rows = Vec::new();
    for scene in &subjects(root)? {
        rows.push(throughput(&python, VARIANT, scene, options, THROUGHPUT)?);
        rows.push(cold_start(&python, &program, scene, root)?);
    }
    for variant in ["llvm_ad_rgb", "scalar_spectral"] {
        rows.push(throughput(&python, variant, &cornell_box(root), options, Target::None)?);
    }
    Ok(rows)
}

fn throughput(
    python: &Path,
    variant: &str,
    scene: &Subject,
    options: &Options,
    target: Target,
) -> Result<Row, String> {
    let mut peer = Peer::start(python, variant, scene)?;
    render(scene, 99)?;
    let samples = f64::from(scene.size[0]) * f64::from(scene.size[1]) * f64::from(scene.spp) * 1e-6;
    let mut pairs = Vec::new();
    for round in 0..options.repetitions.unwrap_or(5) {
        pairs.push([samples / render(scene, round)?, samples / peer.render(round)?]);
    }
    peer.stop();
    let name = format!("{}, {} spp, {} bounces, {variant}", scene.name, scene.spp, scene.bounces);
    Ok(Row::compared(SECTION, name, "Msamples/s", &pairs, target)
        .noted("all threads; reading, compiling and warming up excluded"))
}

/// Whole processes: from the command line to a written or at least finished picture of [`PREVIEW`] samples per pixel.
fn cold_start(python: &Path, program: &Path, scene: &Subject, root: &Path) -> Result<Row, String> {
    let folder = root.join("target/bench");
    std::fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    let mut pairs = Vec::new();
    for round in 0..3 {
        let start = Instant::now();
        let status = Command::new(program)
            .args(["render", "--quiet", "--spp", &PREVIEW.to_string()])
            .arg(&scene.pbrt)
            .arg("-o")
            .arg(folder.join("preview.exr"))
            .status()
            .map_err(|e| e.to_string())?;
        let ours = start.elapsed().as_secs_f64();
        // The peer keeps compiled kernels below the home directory.
        let home = folder.join(format!("home-{round}"));
        let _ = std::fs::remove_dir_all(&home);
        std::fs::create_dir_all(&home).map_err(|e| e.to_string())?;
        let start = Instant::now();
        let peer = command(python, VARIANT, scene, PREVIEW)
            .arg("once")
            .env("HOME", &home)
            .status()
            .map_err(|e| e.to_string())?;
        if !(status.success() && peer.success()) {
            return Err(format!("{}: a preview failed", scene.name));
        }
        pairs.push([1.0 / ours, 1.0 / start.elapsed().as_secs_f64()]);
    }
    let name = format!("{}, preview of {PREVIEW} spp from a cold start", scene.name);
    Ok(Row::compared(SECTION, name, "1/s", &pairs, COLD_START)
        .noted("whole processes; the peer with an empty kernel cache"))
}

fn cornell_box(root: &Path) -> Subject {
    Subject {
        name: "Mitsuba's Cornell box",
        pbrt: root.join("scenes/mitsuba-cornell-box.pbrt"),
        peer: "cornell_box".into(),
        size: [256, 256],
        bounces: 7,
        spp: 64,
    }
}

fn subjects(root: &Path) -> Result<Vec<Subject>, String> {
    let folder = root.join("target/bench/scenes");
    let own = |kind: Kind, name| -> Result<Subject, String> {
        let written = scenes::write(kind, &folder)?;
        let size = [written.width, written.height];
        let bounces = written.max_depth - 1;
        Ok(Subject { name, pbrt: written.pbrt, peer: written.mitsuba, size, bounces, spp: 64 })
    };
    Ok(vec![
        cornell_box(root),
        own(Kind::Interior, "furnished room")?,
        own(Kind::Glass, "glass and metal under a sky")?,
    ])
}
