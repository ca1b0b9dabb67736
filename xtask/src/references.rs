//! Renders the scenes that have reference pictures and compares them, by the collection's own comparison tool.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// One line of the collection's table.
struct Entry {
    name: String,
    file: String,
    kind: String,
    size: [u32; 2],
    spp: u32,
}

/// `references --scenes DIR --python EXE [--only NAME]`: all scenes of kind `surface`, or one of any kind.
pub(crate) fn run(root: &Path, arguments: &[String]) -> Result<String, String> {
    // Else a slip costs minutes.
    let known = ["--scenes", "--python", "--only"];
    for pair in arguments.chunks(2) {
        match pair {
            [name, _] if known.contains(&name.as_str()) => {}
            [name, ..] => return Err(format!("`{name}`: expected {} and a value", known.join(", "))),
            [] => {}
        }
    }
    let option = |name: &str| arguments.iter().position(|a| a == name).and_then(|i| arguments.get(i + 1));
    let scenes = option("--scenes").map_or_else(|| root.join("../shared/scenes"), PathBuf::from);
    let python = option("--python").map_or("python3", String::as_str);
    let tool = scenes.join("../tools/compare_exr.py");
    let table = std::fs::read_to_string(scenes.join("scenes.tsv")).map_err(|e| format!("scenes.tsv: {e}"))?;
    let wanted = |e: &Entry| option("--only").map_or(e.kind == "surface", |only| *only == e.name);
    let entries: Vec<Entry> = table.lines().filter_map(parse).filter(wanted).collect();
    if entries.is_empty() {
        return Err("no scene of that name".to_owned());
    }

    let build = Command::new("cargo")
        .args(["build", "--release", "--quiet", "--package", "steradian-cli"])
        .current_dir(root)
        .status()
        .map_err(|e| e.to_string())?;
    if !build.success() {
        return Err("the build failed".to_owned());
    }
    let output = root.join("target/references");
    std::fs::create_dir_all(&output).map_err(|e| e.to_string())?;

    let (mut report, mut failures) = (String::new(), 0);
    for entry in &entries {
        let exr = output.join(format!("{}.exr", entry.name));
        let start = Instant::now();
        let status = Command::new(root.join("target/release/steradian"))
            .args(["render", "--quiet", "--spp", &entry.spp.to_string()])
            .arg("--resolution")
            .arg(format!("{}x{}", entry.size[0], entry.size[1]))
            .arg(scenes.join(&entry.file))
            .arg("-o")
            .arg(&exr)
            .arg("-o")
            .arg(exr.with_extension("png"))
            .status()
            .map_err(|e| e.to_string())?;
        let seconds = start.elapsed().as_secs_f64();
        let line = if status.success() {
            let reference = scenes.join("references").join(format!("{}.exr", entry.name));
            let compared = Command::new(python)
                .arg(&tool)
                .args([&exr, &reference])
                .output()
                .map_err(|e| format!("{python}: {e}"))?;
            failures += u32::from(!compared.status.success());
            let text = if compared.stdout.is_empty() { compared.stderr } else { compared.stdout };
            String::from_utf8_lossy(&text).trim().to_owned()
        } else {
            failures += 1;
            "FAIL the render failed".to_owned()
        };
        crate::emit(&format!("{:18} {seconds:7.1} s  {line}", entry.name));
    }
    let _ = write!(report, "{} of {} scenes agree", entries.len() as u32 - failures, entries.len());
    if failures == 0 { Ok(report) } else { Err(report) }
}

fn parse(line: &str) -> Option<Entry> {
    if line.starts_with('#') {
        return None;
    }
    let mut fields = line.split('\t');
    let (name, file, kind) = (fields.next()?, fields.next()?, fields.next()?);
    let (width, height, spp) =
        (fields.next()?.parse().ok()?, fields.next()?.parse().ok()?, fields.next()?.parse().ok()?);
    Some(Entry { name: name.into(), file: file.into(), kind: kind.into(), size: [width, height], spp })
}
