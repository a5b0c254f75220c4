//! Work in a thread of its own, so that Python's thread can look for signals: Ctrl-C leaves it at once. What was left ends by itself, and
//! its result is dropped.

use fluxfit::Step;
use pyo3::{exceptions::PyRuntimeError, prelude::*};
use std::{
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{Receiver, RecvTimeoutError, Sender, channel},
    },
    time::Duration,
};

/// Between two looks for signals: a person takes no notice of it.
const LOOK: Duration = Duration::from_millis(50);

enum Message<T> {
    Step(&'static str, Option<usize>, Option<usize>),
    Done(T),
}

/// Takes the name of a step, and what is done of it and how much there is, where that is known.
type Tell = Box<dyn Fn(&'static str, Option<usize>, Option<usize>) + Send>;

/// Who is told of each step, and says whether to go on.
pub(crate) struct Watcher {
    tell: Option<Tell>,
    left: Arc<AtomicBool>,
}

impl Watcher {
    /// Whether somebody still waits for the result.
    pub(crate) fn go_on(&self) -> ControlFlow<()> {
        self.asker()()
    }

    /// The same question, for several threads.
    pub(crate) fn asker(&self) -> impl Fn() -> ControlFlow<()> + Sync + use<> {
        let left = Arc::clone(&self.left);
        move || if left.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Tells how many motors are finished, and of how many.
    pub(crate) fn motors(&self, done: usize, of: Option<usize>) {
        self.tell("motors", Some(done), of);
    }

    fn tell(&self, step: &'static str, done: Option<usize>, of: Option<usize>) {
        if let Some(tell) = &self.tell {
            tell(step, done, of);
        }
    }

    /// Tells a step of an identification.
    pub(crate) fn step(&self, step: Step) -> ControlFlow<()> {
        if self.tell.is_some() {
            let (name, count) = match step {
                Step::OperatingPoints => ("operating points", None),
                Step::VoltageTiming => ("voltage timing", None),
                Step::Faults => ("faults", None),
                Step::Fit { simulations, usual } => ("fit", Some((simulations, usual))),
                Step::Uncertainty => ("uncertainty", None),
                Step::Search { iteration, limit } => ("search", Some((iteration, limit))),
                Step::Nameplate => ("nameplate", None),
                Step::Validation => ("validation", None),
                _ => ("work", None),
            };
            let (done, of) = count.unzip();
            self.tell(name, done, of);
        }
        self.go_on()
    }
}

/// Does the work, without the interpreter's lock. `progress` is called with the name of each step, what is done of it and how much there
/// is.
///
/// # Errors
/// If a signal came, or `progress` raised.
pub(crate) fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Watcher) -> T + Send + 'static,
) -> PyResult<T> {
    let (watcher, sender, watched) = watched(progress.is_some());
    let run = move || drop(sender.send(Message::Done(work(watcher))));
    std::thread::Builder::new().name("fluxfit".to_owned()).spawn(run).map_err(no_thread)?;
    watched.wait(py, progress)
}

/// The same for work on what is borrowed: after a signal it is waited for, so it should ask soon whether to go on.
///
/// # Errors
/// As [`interruptible`].
pub(crate) fn interruptible_on_borrowed<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Watcher) -> T + Send,
) -> PyResult<T> {
    let (watcher, sender, watched) = watched(progress.is_some());
    std::thread::scope(|scope| {
        let run = move || drop(sender.send(Message::Done(work(watcher))));
        let thread = std::thread::Builder::new().name("fluxfit".to_owned()).spawn_scoped(scope, run).map_err(no_thread)?;
        let outcome = watched.wait(py, progress);
        // Other threads of Python go on meanwhile. What it panicked with was said already.
        drop(py.detach(|| thread.join()));
        outcome
    })
}

fn no_thread(error: std::io::Error) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}

/// What Python's thread keeps of the work.
struct Watched<T> {
    receiver: Receiver<Message<T>>,
    left: Arc<AtomicBool>,
}

/// Who looks on in the work's thread, what it sends its result by, and who waits for it.
fn watched<T: Send + 'static>(has_progress: bool) -> (Watcher, Sender<Message<T>>, Watched<T>) {
    let (sender, receiver) = channel::<Message<T>>();
    let left = Arc::new(AtomicBool::new(false));
    let tell = has_progress.then(|| {
        let steps = sender.clone();
        // Nobody listens any more: then nobody waits either.
        Box::new(move |name, done, of| drop(steps.send(Message::Step(name, done, of)))) as Tell
    });
    (Watcher { tell, left: Arc::clone(&left) }, sender, Watched { receiver, left })
}

impl<T: Send> Watched<T> {
    /// Waits for the result, calls `progress` and looks for signals.
    fn wait(self, py: Python<'_>, progress: Option<&Bound<'_, PyAny>>) -> PyResult<T> {
        let Self { mut receiver, left } = self;
        loop {
            let (back, message) = py.detach(move || {
                let message = receiver.recv_timeout(LOOK);
                (receiver, message)
            });
            receiver = back;
            let outcome = match message {
                Ok(Message::Done(value)) => return Ok(value),
                Ok(Message::Step(name, done, of)) => {
                    progress.map_or(Ok(()), |progress| progress.call1((name, done, of)).map(drop)).and_then(|()| py.check_signals())
                }
                Err(RecvTimeoutError::Timeout) => py.check_signals(),
                Err(RecvTimeoutError::Disconnected) => {
                    Err(PyRuntimeError::new_err("the computation ended without a result: please report this"))
                }
            };
            if let Err(error) = outcome {
                left.store(true, Ordering::Relaxed);
                return Err(error);
            }
        }
    }
}
