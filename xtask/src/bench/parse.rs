//! Parsers of text and meshes against plain scans of the same bytes, in instructions.

use super::options::Options;
use super::row::{Row, Target};
use crate::counting::{Count, Scratch, Uncounted, count};
use crate::kernels::parsing::{self, OF_COLLECTION, OF_FILES};
use std::path::Path;

const SECTION: &str = "Parsing";

/// At no more than three times the cost of a scan.
const THIRD: Target = Target::RatioAtLeast(1.0 / 3.0);

const BY_STD: &str = "the peer splits at white space and takes what `str::parse::<f32>` makes of each word";
const BY_HAND: &str = "the peer adds up digits without a care for rounding, exponents, range or faults";
const WORDS: &str = "the peer adds up little-endian words of four bytes";

/// What is compared: name of the row, of our kernel, of the peer's, remark.
const COMPARED: &[[&str; 4]] = &[
    ["pbrt text of 19 MB, to a description", "pbrt", "pbrt std", BY_STD],
    ["pbrt text of 19 MB, to a description", "pbrt", "pbrt hand", BY_HAND],
    ["ASCII PLY of a million triangles", "ascii", "ascii std", BY_STD],
    ["ASCII PLY of a million triangles", "ascii", "ascii hand", BY_HAND],
    ["binary PLY of a million triangles", "triangles", "triangles scan", WORDS],
    ["binary PLY of half a million quadrilaterals", "quads", "quads scan", WORDS],
    ["binary PLY of the scene collection", "collection", "collection scan", WORDS],
];

/// Measures all.
pub(super) fn measure(_root: &Path, options: &Options) -> Result<Vec<Row>, String> {
    let explained = |e| match e {
        Uncounted::NoValgrind => "no valgrind, which counts instructions".to_owned(),
        Uncounted::Failed(reason) => reason,
    };
    let folder = Scratch::new("parse").map_err(|e| e.to_string())?;
    parsing::write_inputs(folder.path())?;
    let mut counts = count(OF_FILES, folder.path()).map_err(explained)?;
    if let Some(scenes) = &options.scenes {
        counts.extend(count(OF_COLLECTION, scenes).map_err(explained)?);
    }
    let find = |name: &str| counts.iter().find(|c| c.name == name);
    let row = |[name, ours, peer, remark]: &[&'static str; 4]| {
        let rate = |c: &Count| 1e3 / c.per_unit();
        let pair = [rate(find(ours)?), rate(find(peer)?)];
        Some(Row::compared(SECTION, *name, "bytes per 1000 instructions", &[pair], THIRD).noted(*remark))
    };
    Ok(COMPARED.iter().filter_map(row).collect())
}
