//! How the cost of a picture grows with threads and with lights.

use super::job;
use super::options::Options;
use super::row::{Row, Target, median};
use std::fmt::Write as _;
use std::path::Path;
use steradian::lab::plot::{Axis, Chart, Curve, Scale, series_ink, svg};
use steradian::scene::RenderJob;
use steradian::scene::import::pbrt::Input;

const SECTION: &str = "Scaling";

/// A sublinear cost: at most proportional to this power of the number of lights. Cost that grows with the logarithm grows
/// fivefold from ten lights to a hundred thousand, which is the power 0.17.
const EXPONENT: Target = Target::AtMost(0.2);

/// Numbers of lights.
const LIGHTS: [usize; 5] = [10, 100, 1_000, 10_000, 100_000];

/// Measures all.
pub(super) fn measure(root: &Path, options: &Options) -> Result<Vec<Row>, String> {
    let mut rows = threads(root, options)?;
    rows.extend(lights(root, options)?);
    Ok(rows)
}

/// Rays per second of processor time, with several threads against one.
fn threads(root: &Path, options: &Options) -> Result<Vec<Row>, String> {
    let offered = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let mut job = job::compile_file(&root.join("scenes/mitsuba-cornell-box.pbrt"))?;
    job.sampling.spp = 64;
    let mut rows = Vec::new();
    for threads in [2, 4, 8, 16].into_iter().filter(|t| *t <= offered) {
        let rate = |threads| -> Result<f64, String> {
            let before = processor_seconds()?;
            let report = job::render(&job, Some(threads))?;
            Ok(report.tally.rays() as f64 / (processor_seconds()? - before) * 1e-6)
        };
        let mut pairs = Vec::new();
        for _ in 0..options.repetitions.unwrap_or(5) {
            pairs.push([rate(threads)?, rate(1)?]);
        }
        rows.push(
            Row::compared(
                SECTION,
                format!("Cornell box, {threads} threads against one"),
                "Mrays per thread-CPU-second",
                &pairs,
                Target::RatioAtLeast(0.95),
            )
            .noted("the peer is our own single thread"),
        );
    }
    Ok(rows)
}

/// Time of a picture against the number of lights in it.
fn lights(root: &Path, options: &Options) -> Result<Vec<Row>, String> {
    let (mut rows, mut points) = (Vec::new(), Vec::new());
    for count in LIGHTS {
        let text = room(count);
        let input = Input::Text { name: "room", bytes: text.as_bytes(), base: root };
        let job: RenderJob = job::compile(input, "the room of many lights")?;
        let samples = f64::from(job.sampling.spp) * SIDE * SIDE;
        let mut times = Vec::new();
        for _ in 0..options.repetitions.unwrap_or(5) {
            let before = processor_seconds()?;
            job::render(&job, None)?;
            times.push((processor_seconds()? - before) / samples * 1e6);
        }
        let time = median(&mut times);
        points.push([(count as f64).log10(), time]);
        let name = format!("room with {count} area lights");
        rows.push(Row::alone(SECTION, name, "µs processor time per sample", time, Target::None));
    }
    let ([first, .., last], [few, .., many]) = (&points[..], LIGHTS) else {
        return Err("too few measurements".to_owned());
    };
    let exponent = (last[1] / first[1]).log10() / (many as f64 / few as f64).log10();
    rows.push(
        Row::alone(
            SECTION,
            format!("growth from {few} to {many} lights: cost ∝ lights^x"),
            "x",
            exponent,
            EXPONENT,
        )
        .noted("target/bench/lights.svg"),
    );
    let chart = Chart {
        title: "Cost of a sample against the number of lights".into(),
        x: Axis::new("log₁₀ lights"),
        y: Axis::new("processor time [µs]").including(&[0.0]).scaled(Scale::Linear),
        curves: vec![Curve::new("room, light tree", series_ink(0), points)],
    };
    let folder = root.join("target/bench");
    std::fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    std::fs::write(folder.join("lights.svg"), svg(&chart.draw())).map_err(|e| e.to_string())?;
    Ok(rows)
}

/// Side of the picture of the room [px].
const SIDE: f64 = 96.0;

/// A closed room whose ceiling and walls bear `count` small triangles that shine.
fn room(count: usize) -> String {
    let mut text = format!(
        "LookAt 0 0 -0.95  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 70\n\
         Film \"rgb\" \"integer xresolution\" {SIDE} \"integer yresolution\" {SIDE}\n\
         Sampler \"independent\" \"integer pixelsamples\" 16\n\
         Integrator \"path\" \"integer maxdepth\" 3 \"string lightsampler\" \"bvh\"\nWorldBegin\n\
         Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\n\
         Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3  4 5 6 4 6 7  0 1 5 0 5 4  1 2 6 1 6 5  2 3 7 2 7 6  3 0 4 3 4 7]\n\
         \"point3 P\" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1]\n"
    );
    let side = 0.3 / (count as f64).sqrt();
    let power = 40.0 / (count as f64 * side * side);
    let _ = writeln!(
        text,
        "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"float scale\" {power} \"bool twosided\" true"
    );
    for i in 0..count {
        // The golden and the plastic number spread points evenly over the unit square.
        let (u, v) = ((i as f64 * 0.754_877_666).fract(), (i as f64 * 0.569_840_291).fract());
        let (x, z) = (1.9 * u - 0.95, 1.9 * v - 0.95);
        let y = 0.9 + 0.08 * (i as f64 * 0.618_034).fract();
        let _ = writeln!(
            text,
            "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [{x} {y} {z} {} {y} {z} {x} {y} {}]",
            x + side,
            z + side
        );
    }
    text
}

/// Processor time of this process so far, all threads [s].
pub(super) fn processor_seconds() -> Result<f64, String> {
    // User and system time are fields 14 and 15.
    stat([11, 12])
}

/// Processor time of the processes that this one has started and that have ended [s].
pub(super) fn children_seconds() -> Result<f64, String> {
    stat([13, 14])
}

/// The sum of two times among the fields after the process's name.
fn stat(of: [usize; 2]) -> Result<f64, String> {
    let stat =
        std::fs::read_to_string("/proc/self/stat").map_err(|_| "no processor times here".to_owned())?;
    // The name in parentheses may hold spaces; times are in hundredths of a second.
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let field =
        |i: usize| fields.get(i).and_then(|f| f.parse::<f64>().ok()).ok_or("unreadable /proc/self/stat");
    Ok((field(of[0])? + field(of[1])?) / 100.0)
}
