//! Instructions that pieces of work execute, counted by valgrind: the same number whatever else the machine does.
//!
//! The program runs itself under `valgrind --tool=callgrind`; in there each kernel is prepared and then executed between two
//! calls of [`boundary`], at which valgrind writes down what it has counted since the last one.

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A piece of work whose instructions are counted.
#[derive(Clone, Copy)]
pub(crate) struct Kernel {
    /// Name in tables and on the command line.
    pub(crate) name: &'static str,
    /// Prepares the work, from the files of a folder if it needs any.
    pub(crate) prepare: fn(&Path) -> Result<Work, String>,
}

/// Prepared work; returns how many units it did.
pub(crate) type Work = Box<dyn FnOnce() -> u64>;

/// What a kernel costs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Count {
    /// The kernel.
    pub(crate) name: String,
    /// Units of work that it did.
    pub(crate) units: u64,
    /// Instructions that it took.
    pub(crate) instructions: u64,
}

impl Count {
    /// Instructions a unit.
    pub(crate) fn per_unit(&self) -> f64 {
        self.instructions as f64 / self.units.max(1) as f64
    }
}

/// Why nothing was counted.
#[derive(Debug)]
pub(crate) enum Uncounted {
    /// There is no valgrind here.
    NoValgrind,
    /// Something went wrong.
    Failed(String),
}

/// Where valgrind writes down its counts.
#[inline(never)]
fn boundary() {
    black_box(());
}

/// Executes kernels between boundaries; returns a line `name units` for each. This is what runs under valgrind.
pub(crate) fn execute(kernels: &[Kernel], folder: &Path) -> Result<String, String> {
    let mut lines = String::new();
    for kernel in kernels {
        let work = (kernel.prepare)(folder).map_err(|e| format!("{}: {e}", kernel.name))?;
        boundary();
        let units = work();
        boundary();
        lines += &format!("{} {units}\n", kernel.name);
    }
    Ok(lines)
}

/// Counts the instructions of kernels, which find their files in `folder`. The command `kernels` of this program must lead to
/// [`execute`].
pub(crate) fn count(kernels: &[Kernel], folder: &Path) -> Result<Vec<Count>, Uncounted> {
    let failed = |e: &dyn std::fmt::Display| Uncounted::Failed(e.to_string());
    let program = std::env::current_exe().map_err(|e| failed(&e))?;
    let scratch = Scratch::new("counts").map_err(|e| failed(&e))?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--dump-before=*counting*boundary*", "--dump-line=no", "--quiet"])
        .arg(format!("--callgrind-out-file={}", scratch.0.join("counts").display()))
        .arg(program)
        .arg("kernels")
        .arg(folder)
        .args(kernels.iter().map(|k| k.name))
        // A pool of one thread: what many threads do while they wait for each other differs from run to run.
        .env("RAYON_NUM_THREADS", "1")
        .output();
    let output = match output {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Err(Uncounted::NoValgrind),
        other => other.map_err(|e| failed(&e))?,
    };
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    if !output.status.success() {
        return Err(failed(&format!("{said}{}", String::from_utf8_lossy(&output.stderr))));
    }
    let parts = scratch.parts().map_err(|e| failed(&e))?;
    pair(&said, &parts).map_err(Uncounted::Failed)
}

/// Joins what the kernels said with the parts that valgrind wrote: before each of two boundaries a kernel, and one at the end.
fn pair(said: &str, parts: &[u64]) -> Result<Vec<Count>, String> {
    let lines: Vec<(&str, &str)> = said.lines().filter_map(|l| l.rsplit_once(' ')).collect();
    if parts.len() != 2 * lines.len() + 1 {
        return Err(format!("valgrind wrote {} parts for {} kernels", parts.len(), lines.len()));
    }
    lines
        .iter()
        .zip(parts.chunks_exact(2))
        .map(|((name, units), part)| {
            let units = units.parse().map_err(|_| format!("{name}: `{units}` is no count"))?;
            Ok(Count { name: (*name).to_owned(), units, instructions: part[1] })
        })
        .collect()
}

/// A folder that is removed in the end.
pub(crate) struct Scratch(PathBuf);

impl Scratch {
    pub(crate) fn new(name: &str) -> std::io::Result<Self> {
        let path = std::env::temp_dir().join(format!("steradian-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path)?;
        Ok(Self(path))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// The totals of the parts, in their order.
    fn parts(&self) -> Result<Vec<u64>, String> {
        let mut parts = Vec::new();
        for entry in std::fs::read_dir(&self.0).map_err(|e| e.to_string())? {
            let path = entry.map_err(|e| e.to_string())?.path();
            let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            parts.push(part(&text).ok_or_else(|| format!("{} has no totals", path.display()))?);
        }
        parts.sort_unstable();
        Ok(parts.into_iter().map(|(_, total)| total).collect())
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // Nothing can be done about a folder that stays.
        drop(std::fs::remove_dir_all(&self.0));
    }
}

/// Number and total of a part as callgrind writes it.
fn part(text: &str) -> Option<(u64, u64)> {
    let field = |name: &str| {
        let line = text.lines().find_map(|l| l.strip_prefix(name))?;
        line.split_whitespace().next()?.parse().ok()
    };
    Some((field("part:")?, field("totals:").or_else(|| field("summary:"))?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kernel_has_the_part_between_its_boundaries() {
        let counts = pair("a b 10\nc 2\n", &[100, 50, 7, 8, 9]).unwrap();
        assert_eq!((counts[0].name.as_str(), counts[0].per_unit()), ("a b", 5.0));
        assert_eq!((counts[1].name.as_str(), counts[1].per_unit()), ("c", 4.0));
        assert!(pair("a 1\n", &[1, 2]).is_err());
        assert_eq!(part("version: 1\npart: 3\nevents: Ir\nsummary: 8\ntotals: 9\n"), Some((3, 9)));
        assert_eq!(part("part: 3\n"), None);
    }
}
