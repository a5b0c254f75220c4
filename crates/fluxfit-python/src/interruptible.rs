//! Work in a thread of its own, so that Python's thread can look for signals: Ctrl-C leaves it at once. What was left ends by itself, and
//! its result is dropped.

use fluxfit::Step;
use pyo3::{exceptions::PyRuntimeError, prelude::*};
use std::{
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{RecvTimeoutError, Sender, channel},
    },
    time::Duration,
};

/// Between two looks for signals: a person takes no notice of it.
const LOOK: Duration = Duration::from_millis(50);

enum Message<T> {
    Step(&'static str, Option<(usize, usize)>),
    Done(T),
}

/// Takes the name of a step, and what is done of it and how much there is.
type Tell = Box<dyn Fn(&'static str, Option<(usize, usize)>) + Send>;

/// Who is told of each step, and says whether to go on.
pub(crate) struct Watcher {
    tell: Option<Tell>,
    left: Arc<AtomicBool>,
}

impl Watcher {
    /// Whether somebody still waits for the result.
    pub(crate) fn go_on(&self) -> ControlFlow<()> {
        if self.left.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Tells a step of an identification.
    pub(crate) fn step(&self, step: Step) -> ControlFlow<()> {
        if let Some(tell) = &self.tell {
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
            tell(name, count);
        }
        self.go_on()
    }
}

/// A flag that tells whoever works that nobody waits any more.
pub(crate) fn left_flag(watcher: &Watcher) -> Arc<AtomicBool> {
    Arc::clone(&watcher.left)
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
    let (sender, mut receiver) = channel::<Message<T>>();
    let left = Arc::new(AtomicBool::new(false));
    let steps: Option<Sender<Message<T>>> = progress.map(|_| sender.clone());
    let tell = steps.map(|steps| {
        // Nobody listens any more: then nobody waits either.
        let tell = move |name, count| drop(steps.send(Message::Step(name, count)));
        Box::new(tell) as Tell
    });
    let watcher = Watcher { tell, left: Arc::clone(&left) };
    let run = move || drop(sender.send(Message::Done(work(watcher))));
    std::thread::Builder::new().name("fluxfit".to_owned()).spawn(run).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    loop {
        let (back, message) = py.detach(move || {
            let message = receiver.recv_timeout(LOOK);
            (receiver, message)
        });
        receiver = back;
        let outcome = match message {
            Ok(Message::Done(value)) => return Ok(value),
            Ok(Message::Step(name, count)) => {
                let (done, total) = count.unzip();
                progress.map_or(Ok(()), |progress| progress.call1((name, done, total)).map(drop)).and_then(|()| py.check_signals())
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
