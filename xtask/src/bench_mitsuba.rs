//! Samples per second against Mitsuba 3's `scalar_spectral` on its own Cornell box, both programs in turn.

use std::path::Path;
use std::process::Command;

/// Renders `mi.cornell_box()` with a box filter and prints the seconds of each render after a warm-up.
const MITSUBA: &str = r"
import sys, time
import mitsuba as mi
mi.set_variant('scalar_spectral')
d = mi.cornell_box()
d['sensor']['film']['rfilter'] = {'type': 'box'}
d['sensor']['film']['width'], d['sensor']['film']['height'] = 256, 256
d['sensor']['sampler'] = {'type': 'independent', 'sample_count': 64}
d['integrator'] = {'type': 'path', 'max_depth': 8}
scene = mi.load_dict(d)
mi.render(scene, spp=4, seed=9)
print('ready', flush=True)
for line in sys.stdin:
    start = time.perf_counter()
    image = mi.render(scene, spp=64, seed=int(line))
    print(time.perf_counter() - start, flush=True)
";

const ROUNDS: usize = 5;
const SAMPLES: f64 = 256.0 * 256.0 * 64.0;

/// `bench-mitsuba [--python EXE]`.
pub(crate) fn run(root: &Path, arguments: &[String]) -> Result<String, String> {
    use std::io::{BufRead as _, BufReader, Write as _};
    use std::process::Stdio;
    let python = arguments.iter().position(|a| a == "--python").and_then(|i| arguments.get(i + 1));
    let mut peer = Command::new(python.map_or("python3", String::as_str))
        .args(["-c", MITSUBA])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|e| format!("cannot start Python: {e}"))?;
    let mut to_peer = peer.stdin.take().ok_or("no pipe to Python")?;
    let mut from_peer = BufReader::new(peer.stdout.take().ok_or("no pipe from Python")?).lines();
    let mut answer = || -> Result<String, String> {
        from_peer
            .next()
            .ok_or("Mitsuba ended early; is `mitsuba` installed in this Python?")?
            .map_err(|e| e.to_string())
    };
    answer()?;

    let scene = root.join("scenes/mitsuba-cornell-box.pbrt");
    let mut ratios = Vec::new();
    for round in 0..ROUNDS {
        let ours = render(&scene, round as u64)?;
        writeln!(to_peer, "{round}").map_err(|e| e.to_string())?;
        let theirs: f64 = answer()?.trim().parse().map_err(|_| "Mitsuba printed no time".to_owned())?;
        crate::emit(&format!(
            "round {round}: steradian {:.3} Msamples/s, mitsuba scalar_spectral {:.3} Msamples/s, ratio {:.2}",
            SAMPLES / ours * 1e-6,
            SAMPLES / theirs * 1e-6,
            theirs / ours
        ));
        ratios.push(theirs / ours);
    }
    drop(to_peer);
    let _ = peer.wait();
    ratios.sort_by(f64::total_cmp);
    Ok(format!(
        "median ratio {:.2} (min {:.2}, max {:.2}) on {} threads, {} wavelengths per path",
        ratios[ROUNDS / 2],
        ratios[0],
        ratios[ROUNDS - 1],
        std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
        steradian::spectrum::LANES
    ))
}

/// Seconds of one render, without reading the scene.
fn render(scene: &Path, seed: u64) -> Result<f64, String> {
    use steradian::render::{CancelToken, RenderOptions, Silent};
    use steradian::scene::Disk;
    use steradian::scene::import::pbrt::{Input, import};
    let mut imported = import(&[Input::File(scene)], &Disk);
    let job = imported
        .scene
        .take()
        .and_then(|desc| steradian::scene::compile(desc, &Disk, &mut imported.diagnostics));
    let mut job = job.ok_or_else(|| format!("{} does not compile", scene.display()))?;
    job.sampling.seed = seed;
    let rendered = steradian::render::render(&job, &RenderOptions::default(), &Silent, &CancelToken::new())
        .map_err(|e| e.to_string())?;
    Ok(rendered.report.elapsed.as_secs_f64())
}
