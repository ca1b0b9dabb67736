//! Developer chores of Steradian: `cargo xtask <command>`.

mod bench;
mod counting;
mod faults;
mod gate;
mod imports;
mod kernels;
mod layers;
mod mitsuba_bsdfs;
mod references;

use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask <command>

  layers    fail on an import that points the wrong way, on files that import each other,
            on a scattering or light variant named where it must not be, and on files over 800 lines
  faults    plant faults into scattering functions and show which laws catch them
  references [--scenes DIR] [--python EXE] [--only NAME]
            render the scenes of the collection that have reference pictures and compare them
  bench [SECTION...] [--embree LIB] [--python EXE] [--baseline EXE] [--scenes DIR] [--reps N] [--triangles N] [--output FILE]
            measure speed against the peers that are there, and write one report
  gate [--update]
            fail when a kernel takes more instructions than xtask/gate/instructions.toml says; needs valgrind
  mitsuba-bsdfs [--python EXE] [--bsdf FILE]
            f and densities of our scattering functions against those of Mitsuba 3, FILE among them
";

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match arguments.first().map(String::as_str) {
        Some("layers") => layers::check(&root.join("crates/steradian/src")),
        Some("faults") => faults::run(&root),
        Some("references") => references::run(&root, &arguments[1..]),
        Some("bench") => bench::run(&root, &arguments[1..]),
        Some("gate") => gate::run(&root, &arguments[1..]),
        Some("kernels") => kernels::run(&arguments[1..]),
        Some("mitsuba-bsdfs") => mitsuba_bsdfs::run(&arguments[1..]),
        _ => Err(USAGE.to_owned()),
    };
    match outcome {
        Ok(report) => {
            emit(&report);
            ExitCode::SUCCESS
        }
        Err(report) => {
            emit(&report);
            ExitCode::FAILURE
        }
    }
}

#[expect(clippy::print_stdout, reason = "the one place where this program speaks")]
fn emit(text: &str) {
    println!("{text}");
}
