//! Ctrl-C, a request to terminate, and a terminal that was closed. Work that has a best so far is done [`gently`]: it asks [`go_on`] and
//! ends by itself. Any other work ends at once, says what it was, and leaves no half-written file; work with a
//! [rough answer](or_roughly) computes it first. A second signal ends at once in any case.

use crate::terminal;
use fluxfit_files::discard_unfinished;
use std::{
    ops::ControlFlow,
    sync::{
        Mutex, MutexGuard, PoisonError,
        atomic::{AtomicI32, Ordering},
    },
};

/// What a shell adds to the number of the signal that ended a program, to make an exit status of it: 130 after Ctrl-C.
const BY_SIGNAL: i32 = 128;

/// Number of the signal that came; zero, as long as none has.
static SIGNAL: AtomicI32 = AtomicI32::new(0);

static WORK: Mutex<Work> = Mutex::new(Work { what: String::new(), is_gentle: false, roughly: None });

/// What goes on.
struct Work {
    what: String,
    is_gentle: bool,
    roughly: Option<Roughly>,
}

/// What shows a rough answer in place of the one that is interrupted.
type Roughly = Box<dyn FnOnce() + Send>;

fn work() -> MutexGuard<'static, Work> {
    // Each change leaves it whole.
    WORK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Whether a hangup is ignored, as `nohup` has it: the lowest bit of the set of ignored signals. Where the system does not tell, it is left
/// alone too.
#[cfg(unix)]
fn ignores_hangup() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.is_none_or(|mask| mask & 1 != 0)
}

/// Listens from now on.
pub(crate) fn listen() -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use signal_hook::{
            consts::{SIGHUP, SIGINT, SIGTERM},
            iterator::Signals,
        };
        let signals = [SIGINT, SIGTERM, SIGHUP];
        let mut signals = Signals::new(if ignores_hangup() { &signals[..2] } else { &signals[..] })?;
        std::thread::Builder::new().name("signals".to_owned()).spawn(move || signals.forever().for_each(came))?;
    }
    #[cfg(windows)]
    {
        /// Number of Ctrl-C where there are signals.
        const INTERRUPT: i32 = 2;
        ctrlc::set_handler(|| came(INTERRUPT)).map_err(std::io::Error::other)?;
    }
    Ok(())
}

/// Says what goes on: what a signal would interrupt.
pub(crate) fn doing(what: &str) {
    what.clone_into(&mut work().what);
}

/// Lets work end by itself that asks [`go_on`], or is over soon.
pub(crate) fn gently<T>(ends: impl FnOnce() -> T) -> T {
    be_gentle(true);
    let done = ends();
    be_gentle(false);
    done
}

/// Does work that a signal ends with a rough answer instead.
pub(crate) fn or_roughly<T>(show: impl FnOnce() + Send + 'static, work: impl FnOnce() -> T) -> T {
    self::work().roughly = Some(Box::new(show));
    let done = work();
    // What a signal took away is being shown, and ends the program: the whole answer comes too late.
    while self::work().roughly.take().is_none() {
        std::thread::park();
    }
    done
}

/// Whether the work from now on ends by itself.
pub(crate) fn be_gentle(is_gentle: bool) {
    work().is_gentle = is_gentle;
}

/// Whether to go on.
pub(crate) fn go_on() -> ControlFlow<()> {
    if exit_status().is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// The exit status of an interrupted command.
pub(crate) fn exit_status() -> Option<u8> {
    match SIGNAL.load(Ordering::Relaxed) {
        0 => None,
        signal => u8::try_from(BY_SIGNAL + signal).ok(),
    }
}

fn came(signal: i32) {
    // Held to the end: no work becomes gentle, or over, meanwhile.
    let mut work = work();
    let is_first = SIGNAL.swap(signal, Ordering::Relaxed) == 0;
    if is_first && work.is_gentle {
        terminal::interrupted(&format!("{} ends with the best so far; once more ends it at once", work.what));
        return;
    }
    discard_unfinished();
    terminal::interrupted(&format!("while {}", work.what));
    if let Some(roughly) = work.roughly.take().filter(|_| is_first) {
        // In a thread of its own: a second signal ends it.
        let show = move || {
            roughly();
            end(signal);
        };
        if std::thread::Builder::new().spawn(show).is_ok() {
            return;
        }
    }
    end(signal);
}

fn end(signal: i32) {
    #[expect(clippy::exit, reason = "the main thread cannot be asked")]
    std::process::exit(BY_SIGNAL + signal);
}
