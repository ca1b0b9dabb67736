//! A gate against kernels that grow slower, without timing anything: what they cost in instructions must stay below what the
//! checked-in table says, which depends on nothing but the code, the compiler and the instructions that the processor offers.

use crate::counting::{Count, Uncounted, count};
use crate::kernels;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

const TABLE: &str = "xtask/gate/instructions.toml";

/// By how much a kernel may cost more than the table says: small changes elsewhere move the code generator's choices.
const TOLERANCE: f64 = 0.05;

/// `gate [--update]`: fails when a kernel costs more than its bound, or writes the table anew.
pub(crate) fn run(root: &Path, arguments: &[String]) -> Result<String, String> {
    let update = match arguments {
        [] => false,
        [one] if one == "--update" => true,
        _ => return Err("usage: cargo xtask gate [--update]".to_owned()),
    };
    let path = root.join(TABLE);
    let kernels = kernels::gated();
    let counts = match count(&kernels, root) {
        Err(Uncounted::NoValgrind) => return Ok("gate skipped: no valgrind".to_owned()),
        other => other.map_err(|e| format!("gate: {e:?}"))?,
    };
    let found = Table {
        compiler: compiler(),
        processor: processor(),
        costs: counts.iter().map(|c| (c.name.clone(), c.per_unit())).collect(),
    };
    if update {
        std::fs::write(&path, found.write(&counts)).map_err(|e| format!("{}: {e}", path.display()))?;
        return Ok(format!("{TABLE} now says what the {} kernels cost", counts.len()));
    }
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    Table::read(&text).and_then(|table| compare(&table, &found, &counts))
}

/// The table, or what would have to stand in it.
struct Table {
    compiler: String,
    processor: String,
    /// Instructions a unit, by kernel.
    costs: BTreeMap<String, f64>,
}

impl Table {
    fn read(text: &str) -> Result<Self, String> {
        let mut table = Self { compiler: String::new(), processor: String::new(), costs: BTreeMap::new() };
        for line in text.lines().map(str::trim) {
            if line.is_empty() || line.starts_with(['#', '[']) {
                continue;
            }
            let (key, value) = line.split_once(" = ").ok_or_else(|| format!("{TABLE}: `{line}`"))?;
            match key {
                "compiler" => value.trim_matches('"').clone_into(&mut table.compiler),
                "processor" => value.trim_matches('"').clone_into(&mut table.processor),
                kernel => {
                    let cost = value.parse().map_err(|_| format!("{TABLE}: `{value}` is no number"))?;
                    table.costs.insert(kernel.trim_matches('"').to_owned(), cost);
                }
            }
        }
        Ok(table)
    }

    fn write(&self, counts: &[Count]) -> String {
        let Self { compiler, processor, .. } = self;
        let mut text = format!(
            "# Instructions that a unit of work of each kernel takes; written by `cargo xtask gate --update`.\n\
             compiler = \"{compiler}\"\nprocessor = \"{processor}\"\n\n[instructions]\n"
        );
        for count in counts {
            let _ = writeln!(text, "\"{}\" = {:.2}", count.name, count.per_unit());
        }
        text
    }
}

/// `Ok` and `Err` both carry the table to print.
fn compare(table: &Table, found: &Table, counts: &[Count]) -> Result<String, String> {
    let mut text = format!("{:42} {:>12} {:>12} {:>8}\n", "instructions a unit", "table", "now", "change");
    let mut faults = 0;
    for Count { name, .. } in counts {
        let now = found.costs[name];
        let Some(&before) = table.costs.get(name) else {
            faults += 1;
            let _ = writeln!(text, "{name:42} {:>12} {now:12.2}          not in the table", "");
            continue;
        };
        let change = now / before - 1.0;
        let verdict = if change > TOLERANCE {
            faults += 1;
            "  TOO MUCH"
        } else if change < -TOLERANCE {
            "  cheaper: `gate --update` keeps it so"
        } else {
            ""
        };
        let _ = writeln!(text, "{name:42} {before:12.2} {now:12.2} {:+7.1}%{verdict}", change * 100.0);
    }
    for name in table.costs.keys().filter(|name| !found.costs.contains_key(*name)) {
        faults += 1;
        let _ = writeln!(text, "{name:42} is in the table only");
    }
    if faults == 0 {
        return Ok(text + "gate passed");
    }
    let elsewhere = [(&table.compiler, &found.compiler), (&table.processor, &found.processor)];
    match elsewhere.iter().find(|(then, now)| then != now) {
        Some((then, now)) => Ok(text
            + &format!(
                "gate not decided: the table is of \"{then}\", this is \"{now}\"; run `gate --update`"
            )),
        None => Err(text
            + &format!(
                "gate failed: {faults} kernels; where the cost is meant, run `cargo xtask gate --update`"
            )),
    }
}

/// The compiler that this program is built with, as far as its name on the path says.
fn compiler() -> String {
    let output = Command::new("rustc").arg("--version").output();
    output.map(|o| String::from_utf8_lossy(&o.stdout).trim().to_owned()).unwrap_or_default()
}

/// The instructions that kernels choose among at run time; valgrind offers those of the processor up to AVX2 and FMA.
fn processor() -> String {
    #[cfg(target_arch = "x86_64")]
    let wide = if std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma") {
        " with AVX2 and FMA"
    } else {
        ""
    };
    #[cfg(not(target_arch = "x86_64"))]
    let wide = "";
    format!("{}{wide}", std::env::consts::ARCH)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(compiler: &str, cost: f64) -> Table {
        let costs = BTreeMap::from([("a kernel, of sorts".to_owned(), cost)]);
        Table { compiler: compiler.to_owned(), processor: "p".to_owned(), costs }
    }

    #[test]
    fn only_the_same_compiler_can_fail_the_gate() {
        let counts = [Count { name: "a kernel, of sorts".to_owned(), units: 10, instructions: 1060 }];
        let now = table("rustc 2", 106.0);
        assert!(compare(&table("rustc 2", 100.0), &now, &counts).unwrap_err().contains("TOO MUCH"));
        assert!(compare(&table("rustc 1", 100.0), &now, &counts).unwrap().contains("not decided"));
        assert!(compare(&table("rustc 2", 102.0), &now, &counts).unwrap().ends_with("passed"));
        let renamed = Table { costs: BTreeMap::from([("gone".to_owned(), 1.0)]), ..table("rustc 2", 1.0) };
        assert!(compare(&renamed, &now, &counts).is_err());
    }

    #[test]
    fn a_table_reads_back_as_it_was_written() {
        let counts = [Count { name: "a kernel, of sorts".to_owned(), units: 4, instructions: 1050 }];
        let read = Table::read(&table("rustc 1.2 (abc)", 0.0).write(&counts)).unwrap();
        assert_eq!((read.compiler.as_str(), read.processor.as_str()), ("rustc 1.2 (abc)", "p"));
        assert_eq!(read.costs["a kernel, of sorts"], 262.5);
    }
}
