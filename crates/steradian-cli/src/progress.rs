//! Progress on the terminal: a bar where one is looking, plain lines elsewhere.

use crate::output::note;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal as _;
use std::sync::Mutex;
use std::time::{Duration, Instant};
use steradian::render::{Progress, ProgressSink};
use steradian::scene::RenderJob;

/// How progress is shown.
pub(crate) enum Reporter {
    Quiet,
    Bar(ProgressBar),
    Lines(Mutex<Lines>),
}

/// State of the plain-line reporter.
pub(crate) struct Lines {
    next_percent: u32,
    next_time: Instant,
}

/// Plain lines come at every tenth of the work, and not more often than this.
const LINE_INTERVAL: Duration = Duration::from_secs(2);

impl Reporter {
    pub(crate) fn new(quiet: bool) -> Self {
        if quiet {
            return Self::Quiet;
        }
        if !std::io::stderr().is_terminal() {
            return Self::Lines(Mutex::new(Lines { next_percent: 10, next_time: Instant::now() }));
        }
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr_with_hz(10));
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3}%  {msg}") {
            bar.set_style(style);
        }
        Self::Bar(bar)
    }

    /// Says what is about to be rendered, where lines are kept: a log should tell what its numbers are about.
    pub(crate) fn begin(&self, job: &RenderJob) {
        if let Self::Lines(_) = self {
            let [x0, x1, y0, y1] = job.film.window();
            let spp = job.sampling.spp;
            let samples = match job.sampling.noise {
                None => format!("{spp} spp"),
                Some(noise) => format!("up to {spp} spp for a noise of {noise}"),
            };
            note(&format!("rendering {} x {} pixels with {samples}", x1 - x0, y1 - y0));
        }
    }

    pub(crate) fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

impl ProgressSink for Reporter {
    fn update(&self, p: &Progress) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => {
                bar.set_length(p.samples_total);
                bar.set_position(p.samples_done);
                bar.set_message(describe(p));
            }
            Self::Lines(lines) => {
                // A poisoned lock means another thread is already unwinding: there is nothing to report then.
                let Ok(mut lines) = lines.lock() else { return };
                let percent = (p.fraction() * 100.0) as u32;
                let now = Instant::now();
                if percent >= lines.next_percent && now >= lines.next_time {
                    lines.next_percent = percent / 10 * 10 + 10;
                    lines.next_time = now + LINE_INTERVAL;
                    note(&format!("{percent:>3}%  {}", describe(p)));
                }
            }
        }
    }
}

fn describe(p: &Progress) -> String {
    let eta = p.remaining().map_or_else(|| "?".to_owned(), clock);
    format!("{} spp  {:.2} Mrays/s  {} | {eta}", p.spp_done, p.mrays_per_second(), clock(p.elapsed))
}

/// h:mm:ss, or m:ss below an hour.
pub(crate) fn clock(d: Duration) -> String {
    let s = d.as_secs();
    if s >= 3600 {
        format!("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
    } else {
        format!("{}:{:02}", s / 60, s % 60)
    }
}
