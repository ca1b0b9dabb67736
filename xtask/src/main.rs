//! Developer chores of Steradian: `cargo xtask <command>`.

mod imports;
mod layers;

use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "usage: cargo xtask <command>

  layers    fail on an import that points the wrong way, on files that import each other,
            on a scattering or light variant named where it must not be, and on files over 800 lines
";

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match arguments.first().map(String::as_str) {
        Some("layers") => layers::check(&root.join("crates/steradian/src")),
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
