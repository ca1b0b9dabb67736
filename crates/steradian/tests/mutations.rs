//! Damaged input: whatever the bytes, a scene is refused with located errors or rendered; nothing panics, nothing hangs.
#![allow(clippy::expect_used, clippy::panic, reason = "tests fail by panicking")]

#[path = "support/specimens.rs"]
mod specimens;

use specimens::{SPECIMENS, file_system, files};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};
use steradian::color::UpsamplingTables;
use steradian::math::hash::Pcg32;
use steradian::render::{CancelToken, RenderOptions, Silent};
use steradian::scene::import::pbrt::{Imported, Input, import};
use steradian::scene::{MemoryFiles, Overrides, Severity, compile_with_tables};

/// Longest time that one case may take, on a machine that is busy with other work.
const PATIENCE: Duration = Duration::from_secs(30);

/// What becomes of a damaged scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    Refused,
    Rendered,
}

/// A scene and the files that it reads.
struct Case {
    text: Vec<u8>,
    files: MemoryFiles,
}

impl Case {
    /// Imports, compiles and renders 4 × 4 pixels with one short path each. Panics when what is said is not what is done.
    fn run(&self, tables: &UpsamplingTables) -> Outcome {
        let input = Input::Text { name: "damaged.pbrt", bytes: &self.text, base: Path::new("") };
        let Imported { scene, sources, mut diagnostics } = import(&[input], &self.files);
        let job = scene.and_then(|mut desc| {
            let small = Overrides {
                spp: Some(1),
                resolution: Some([4, 4]),
                max_depth: Some(3),
                ..Overrides::default()
            };
            small.apply(&mut desc).expect("the overrides are valid");
            compile_with_tables(desc, &self.files, tables, &mut diagnostics)
        });
        // Showing the messages visits every span.
        let shown = diagnostics.display(&sources).to_string();
        assert_eq!(job.is_none(), diagnostics.has_errors(), "{shown}");
        for d in diagnostics.iter().filter(|d| d.severity == Severity::Error) {
            assert!(d.span.is_some(), "an error without a place: {}", d.message);
        }
        let Some(job) = job else { return Outcome::Refused };
        let options = RenderOptions { threads: Some(1), ..RenderOptions::default() };
        let rendered = steradian::render::render(&job, &options, &Silent, &CancelToken::new());
        let frame = rendered.unwrap_or_else(|e| panic!("compiled, but not rendered: {e}")).frame;
        assert!(frame.channels().iter().all(|c| !c.values.is_empty()));
        Outcome::Rendered
    }
}

fn below(r: &mut Pcg32, n: usize) -> usize {
    r.next_u32() as usize % n.max(1)
}

fn pick<'a, T: ?Sized>(r: &mut Pcg32, list: &[&'a T]) -> &'a T {
    list[below(r, list.len())]
}

/// Numbers that have broken programs before.
const NUMBERS: [&str; 40] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "3",
    "4",
    "7",
    "8",
    "0.5",
    "-0.5",
    "1e-7",
    "1e-20",
    "1e-38",
    "1e-45",
    "-1e-45",
    "1e5",
    "1e10",
    "1e19",
    "1e30",
    "-1e30",
    "3e38",
    "-3e38",
    "1e39",
    "1e999",
    "nan",
    "-nan",
    "inf",
    "100",
    "180",
    "360",
    "1000",
    "65535",
    "65536",
    "16777217",
    "2147483647",
    "-2147483648",
    "4294967296",
    "9999999999",
    ".",
];

/// Pieces of language to insert anywhere.
const PIECES: [&str; 14] = [
    " [ ",
    " ] ",
    " \" ",
    " # ",
    " AttributeBegin ",
    " AttributeEnd ",
    " ObjectBegin \"o\" ",
    " ObjectEnd ",
    " ReverseOrientation ",
    " WorldBegin ",
    " Scale 1 1 1e-20 ",
    " Scale 1e15 1 1 ",
    " Include \"part.pbrt\" ",
    " \"float alpha\" 0.2 ",
];

/// The tokens of a text: quoted strings, brackets and words, without what separates them.
fn tokens(text: &[u8]) -> Vec<std::ops::Range<usize>> {
    let mut list = Vec::new();
    let mut at = 0;
    while at < text.len() {
        let start = at;
        at += 1;
        match text[start] {
            b'"' => {
                while at < text.len() && text[at] != b'"' && text[at] != b'\n' {
                    at += 1;
                }
                at = (at + 1).min(text.len());
            }
            b'[' | b']' => {}
            c if c.is_ascii_whitespace() => continue,
            _ => {
                while at < text.len() && !text[at].is_ascii_whitespace() && !b"\"[]".contains(&text[at]) {
                    at += 1;
                }
            }
        }
        list.push(start..at);
    }
    list
}

fn is_number(token: &[u8]) -> bool {
    token.iter().any(u8::is_ascii_digit) && token.iter().all(|c| b"0123456789+-.eE".contains(c))
}

/// Damages a text by token: numbers most of all, because the grammar survives that.
fn damage_text(text: &mut Vec<u8>, donors: &[&str], r: &mut Pcg32) {
    let list = tokens(text);
    if list.is_empty() {
        return text.push(b' ');
    }
    let token = list[below(r, list.len())].clone();
    match below(r, 16) {
        0..=9 => {
            let numbers: Vec<_> = list.iter().filter(|t| is_number(&text[(*t).clone()])).collect();
            if let Some(number) = numbers.get(below(r, numbers.len())) {
                let with = pick(r, &NUMBERS);
                text.splice((*number).clone(), with.bytes());
            }
        }
        10 => drop(text.drain(token)),
        11 => {
            let mut copy = text[token.clone()].to_vec();
            copy.push(b' ');
            text.splice(token.start..token.start, copy);
        }
        12 => {
            let other = list[below(r, list.len())].clone();
            let (a, b) = if token.start <= other.start { (token, other) } else { (other, token) };
            if a.end <= b.start {
                let (first, second) = (text[a.clone()].to_vec(), text[b.clone()].to_vec());
                text.splice(b, first);
                text.splice(a, second);
            }
        }
        13 => {
            let donor = donors[below(r, donors.len())].as_bytes();
            let pieces = tokens(donor);
            let start = below(r, pieces.len());
            let end = (start + 1 + below(r, 6)).min(pieces.len());
            if let (Some(from), Some(to)) = (pieces.get(start), pieces.get(end.saturating_sub(1))) {
                text.splice(token, donor[from.start..to.end].iter().copied());
            }
        }
        14 => drop(text.splice(token.start..token.start, pick(r, &PIECES).bytes())),
        _ => damage_bytes(text, r),
    }
}

/// Damages bytes of any format.
fn damage_bytes(bytes: &mut Vec<u8>, r: &mut Pcg32) {
    if bytes.is_empty() {
        return bytes.push(0);
    }
    let at = below(r, bytes.len());
    let until = (at + 1 + below(r, 16)).min(bytes.len());
    match below(r, 6) {
        0 => bytes[at] = below(r, 256) as u8,
        1 => bytes[at] ^= 1 << below(r, 8),
        2 => drop(bytes.drain(at..until)),
        3 => bytes.truncate(at),
        4 => {
            let copy = bytes[at..until].to_vec();
            bytes.splice(at..at, copy);
        }
        _ => bytes[at..until].fill(pick(r, &[&0_u8, &0xff, &0x7f, &0x80]).to_owned()),
    }
}

/// Runs `count` cases on all cores; fails at the first that panics, and when one takes longer than [`PATIENCE`].
///
/// Cases are numbered from 0 and `make` is a pure function of the number, so that a failure can be repeated.
fn run_all(count: u64, make: impl Fn(u64) -> Case + Send + Sync + 'static) -> u64 {
    let make = Arc::new(make);
    let next = Arc::new(AtomicU64::new(0));
    let tables = UpsamplingTables::new();
    let (sender, receiver) = mpsc::channel();
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    for worker in 0..threads {
        let (make, next, sender, tables) =
            (Arc::clone(&make), Arc::clone(&next), sender.clone(), tables.clone());
        std::thread::spawn(move || {
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= count {
                    return;
                }
                let begun = sender.send((worker, number, None));
                let case = make(number);
                let outcome = catch_unwind(AssertUnwindSafe(|| case.run(&tables)));
                let ended = sender.send((worker, number, Some(outcome.map_err(|_| case.text))));
                if begun.is_err() || ended.is_err() {
                    return;
                }
            }
        });
    }
    drop(sender);
    let mut running: Vec<Option<(u64, Instant)>> = vec![None; threads];
    let (mut done, mut rendered) = (0, 0);
    while done < count {
        match receiver.recv_timeout(Duration::from_secs(1)) {
            Ok((worker, number, None)) => running[worker] = Some((number, Instant::now())),
            Ok((worker, number, Some(outcome))) => {
                running[worker] = None;
                done += 1;
                match outcome {
                    Ok(outcome) => rendered += u64::from(outcome == Outcome::Rendered),
                    Err(text) => {
                        panic!("case {number} panicked (see above):\n{}", String::from_utf8_lossy(&text))
                    }
                }
            }
            Err(mpsc::RecvTimeoutError::Timeout) => {}
            Err(mpsc::RecvTimeoutError::Disconnected) => panic!("the workers have gone"),
        }
        for (number, since) in running.iter().flatten() {
            assert!(
                since.elapsed() < PATIENCE,
                "case {number} hangs:\n{}",
                String::from_utf8_lossy(&make(*number).text)
            );
        }
    }
    rendered
}

#[test]
fn the_specimens_are_free_of_errors() {
    let (files, tables) = (file_system(&files()), UpsamplingTables::new());
    for s in SPECIMENS {
        let case = Case { text: s.text.as_bytes().to_vec(), files: files.clone() };
        assert_eq!(case.run(&tables), Outcome::Rendered, "{}", s.name);
    }
}

#[test]
fn ten_thousand_damaged_scenes_neither_panic_nor_hang() {
    let files = file_system(&files());
    let rendered = run_all(10_000, move |number| {
        let r = &mut Pcg32::new(number, 1);
        let mut text = SPECIMENS[below(r, SPECIMENS.len())].text.as_bytes().to_vec();
        let donors = SPECIMENS.map(|s| s.text);
        for _ in 0..=below(r, 3) {
            damage_text(&mut text, &donors, r);
        }
        Case { text, files: files.clone() }
    });
    // Enough get past the importer and the compiler to put the renderer to the test.
    assert!((2000..9000).contains(&rendered), "{rendered} of 10 000 were rendered");
}

#[test]
fn damaged_meshes_pictures_spectra_and_parts_neither_panic_nor_hang() {
    let originals = files();
    let rendered = run_all(2000, move |number| {
        let r = &mut Pcg32::new(number, 2);
        let mut damaged = originals.clone();
        let chosen = below(r, damaged.len());
        let (name, bytes) = &mut damaged[chosen];
        for _ in 0..=below(r, 3) {
            damage_bytes(bytes, r);
        }
        // A scene that reads the file.
        let readers: Vec<_> = SPECIMENS.iter().filter(|s| s.text.contains(*name)).collect();
        let text = readers[below(r, readers.len())].text.as_bytes().to_vec();
        Case { text, files: file_system(&damaged) }
    });
    assert!((300..1900).contains(&rendered), "{rendered} of 2000 were rendered");
}
