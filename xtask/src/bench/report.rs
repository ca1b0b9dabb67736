//! The report: one Markdown page with machine, versions, command and every figure beside its target.

use super::row::{Row, Target};
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

/// The page.
pub(crate) fn markdown(root: &Path, command: &str, rows: &[Row], remarks: &[String]) -> String {
    let mut page = String::from("# Benchmarks\n\n");
    for (name, value) in machine(root) {
        let _ = writeln!(page, "* {name}: {value}");
    }
    let _ = writeln!(page, "* command: `{command}`\n");
    page.push_str(
        "Ratios are ours over the peer's, larger is better, medians over interleaved repetitions on the same machine; \
         in brackets the smallest and largest of a repetition.\n",
    );
    let mut section = "";
    for row in rows {
        if row.section != section {
            section = row.section;
            let _ = write!(
                page,
                "\n## {section}\n\n| what | ours | peer | unit | ratio | target | met | remark |\n|---|---:|---:|---|---:|---|---|---|\n"
            );
        }
        page.push_str(&line(row));
    }
    if !remarks.is_empty() {
        page.push_str("\n## Not measured\n\n");
        for remark in remarks {
            let _ = writeln!(page, "* {remark}");
        }
    }
    page
}

fn line(row: &Row) -> String {
    let ratio = if row.ratio.is_nan() {
        String::new()
    } else {
        format!("{:.2} ({:.2}–{:.2})", row.ratio, row.spread[0], row.spread[1])
    };
    let target = match row.target {
        Target::RatioAtLeast(x) => format!("ratio ≥ {x}"),
        Target::AtMost(x) => format!("≤ {x}"),
        Target::AtLeast(x) => format!("≥ {x}"),
        Target::None => String::new(),
    };
    let met = match row.met() {
        Some(true) => "yes",
        Some(false) => "**no**",
        None => "",
    };
    format!(
        "| {} | {} | {} | {} | {ratio} | {target} | {met} | {} |\n",
        row.name,
        figure(row.ours),
        figure(row.peer),
        row.unit,
        row.note
    )
}

/// Three significant digits; nothing for what was not measured.
fn figure(x: f64) -> String {
    if x.is_nan() {
        return String::new();
    }
    let digits = (2.0 - x.abs().max(1e-9).log10().floor()).clamp(0.0, 6.0);
    format!("{x:.*}", digits as usize)
}

/// What the figures depend on.
fn machine(root: &Path) -> Vec<(&'static str, String)> {
    let said = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).current_dir(root).output().ok()?;
        let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        (output.status.success() && !text.is_empty()).then_some(text)
    };
    let unknown = || "unknown".to_owned();
    let cpuinfo = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let field = |name: &str| {
        let line = cpuinfo.lines().find(|l| l.starts_with(name))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let model = field("model name").unwrap_or_else(unknown);
    let family = field("cpu family").map(|f| format!(", family {f}")).unwrap_or_default();
    let caches = field("cache size").map(|c| format!(", cache {c}")).unwrap_or_default();
    vec![
        ("processor", format!("{model}{family}{caches}, {threads} threads offered")),
        ("system", said("uname", &["-srm"]).unwrap_or_else(unknown)),
        ("compiler", said("rustc", &["--version"]).unwrap_or_else(unknown)),
        ("commit", said("git", &["rev-parse", "--short", "HEAD"]).unwrap_or_else(unknown)),
        ("date", said("date", &["-u", "+%Y-%m-%d %H:%M UTC"]).unwrap_or_else(unknown)),
        ("load when it ended", std::fs::read_to_string("/proc/loadavg").unwrap_or_else(|_| unknown())),
    ]
    .into_iter()
    .map(|(name, value)| (name, value.trim().to_owned()))
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_keep_three_digits() {
        let read = [0.0, 0.012_345, 1.0, 12.345, 999.6, 123_456.0].map(figure);
        assert_eq!(read, ["0.000000", "0.0123", "1.00", "12.3", "1000", "123456"]);
    }
}
