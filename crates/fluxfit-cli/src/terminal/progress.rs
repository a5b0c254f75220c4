//! How far work is that takes longer than a second: on standard error, and only where that is a terminal.

use super::{HAS_PROGRESS, detail};
use crate::interrupt;
use fluxfit_units::significant;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::{
    fmt::Write,
    io::IsTerminal,
    sync::{
        atomic::Ordering,
        mpsc::{RecvTimeoutError, Sender, channel},
    },
    thread::JoinHandle,
    time::Duration,
};

/// What takes no longer needs no progress.
const PATIENCE: Duration = Duration::from_secs(1);

/// Between two turns of a sign of life: fast enough to be seen moving.
const TICK: Duration = Duration::from_millis(100);

const COUNTED: &str = "{msg} {wide_bar} {human_pos}/{human_len}, {rate}, {eta} left";
const BYTES: &str = "{msg} {wide_bar} {decimal_bytes}/{decimal_total_bytes}, {decimal_bytes_per_sec}, {eta} left";
/// Beyond as many steps as it usually takes.
const LONGER: &str = "{spinner} {msg}, {human_pos} so far, {rate}, {elapsed}";
const UNKNOWN: &str = "{spinner} {msg}, {elapsed}";

/// A line that tells how far work is; it goes when this is dropped.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// Who waits for the second to pass, and how to tell that there is no need.
    waiting: Option<(Sender<()>, JoinHandle<()>)>,
}

/// Work of unknown length: a sign of life.
pub(crate) fn unknown(what: &str) -> Progress {
    Progress::new(what, UNKNOWN)
}

/// Work of unknown length that tells nothing on the way.
pub(crate) fn working<T>(what: String, work: impl FnOnce() -> T) -> T {
    let _progress = unknown(&what);
    work()
}

/// Work of so many steps.
pub(crate) fn counting(what: &str, steps: usize) -> Progress {
    let progress = Progress::new(what, COUNTED);
    progress.bar.set_length(steps as u64);
    progress
}

/// The reading of so many bytes.
pub(crate) fn reading(what: &str, bytes: u64) -> Progress {
    let progress = Progress::new(what, BYTES);
    progress.bar.set_length(bytes);
    progress
}

impl Progress {
    fn new(what: &str, template: &str) -> Self {
        began(what);
        let bar =
            ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()).with_style(style(template)).with_message(what.to_owned());
        let is_wanted = HAS_PROGRESS.load(Ordering::Relaxed) && std::io::stderr().is_terminal();
        Self { waiting: is_wanted.then(|| show_later(&bar)).flatten(), bar }
    }

    /// Who may be told that so much more is done.
    pub(crate) fn teller(&self) -> impl Fn(u64) + 'static {
        let bar = self.bar.clone();
        move |more| bar.inc(more)
    }

    /// So much more is done.
    pub(crate) fn add(&self, more: usize) {
        self.bar.inc(more as u64);
    }

    /// Goes over to work of unknown length.
    pub(crate) fn turn_to(&self, what: &str) {
        began(what);
        self.bar.set_style(style(UNKNOWN));
        self.bar.set_message(what.to_owned());
    }

    /// Is at `done` of `steps` steps, or of as many as it usually takes: beyond them the bar would have to go back. The first call goes
    /// over to such work.
    pub(crate) fn count(&self, what: &str, done: usize, steps: usize) {
        let begins = self.bar.message() != what;
        if begins {
            began(what);
        }
        // Before the bar is drawn: it would begin with what the work before left.
        if done <= steps {
            self.bar.set_length(steps as u64);
        }
        self.bar.set_position(done as u64);
        if begins {
            self.bar.reset_eta();
        }
        if done > steps {
            self.bar.set_style(style(LONGER));
        } else if begins {
            self.bar.set_style(style(COUNTED));
        }
        if begins {
            self.bar.set_message(what.to_owned());
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((finished, thread)) = self.waiting.take() {
            drop(finished);
            // It does nothing that could fail.
            let _ = thread.join();
        }
        self.bar.finish_and_clear();
    }
}

/// Says what begins to whoever wants to know.
fn began(what: &str) {
    interrupt::doing(what);
    detail(|| what.to_owned());
}

fn style(template: &str) -> ProgressStyle {
    let rate = |state: &ProgressState, out: &mut dyn Write| {
        let _ = write!(out, "{}/s", significant(state.per_sec(), 3));
    };
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()).with_key("rate", rate)
}

/// Draws the bar from the second on; without a thread for it, never.
fn show_later(bar: &ProgressBar) -> Option<(Sender<()>, JoinHandle<()>)> {
    let (finished, wait) = channel();
    let bar = bar.clone();
    let show = move || {
        if wait.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
            bar.set_draw_target(ProgressDrawTarget::stderr());
            bar.enable_steady_tick(TICK);
        }
    };
    std::thread::Builder::new().spawn(show).ok().map(|thread| (finished, thread))
}
