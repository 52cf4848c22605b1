//! SIGINT, SIGTERM and SIGHUP: a run stops within a second, whatever it is doing, keeps what it has
//! computed, says how to go on, and exits with 128 and the number of the signal.
//!
//! A thread waits for them, so that nothing has to be done inside a handler. Simulations look at
//! [`is_stopping`] at every sample, leave their states and say so; all other work is broken off where
//! it stands: results are put in place in one step, and journals drop what was not written to its end.
//! The second signal ends the program at once.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError, mpsc};
use std::time::Duration;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::flag;
use signal_hook::iterator::Signals;
use signal_hook::low_level::exit;

use crate::bar;
use crate::output::complain;
use journal::Journal;
use user::{Problem, Result};

/// How long simulations have to leave their states, and how long the rest may take.
const TO_LEAVE: Duration = Duration::from_millis(600);
const TO_SAY: Duration = Duration::from_millis(250);

/// Whether the program has been told to stop.
static STOPPING: AtomicBool = AtomicBool::new(false);
/// Simulations that are running and will leave their states.
static RUNNING: AtomicUsize = AtomicUsize::new(0);
/// Whether they have, and who waits for it.
static LEFT: (Mutex<bool>, Condvar) = (Mutex::new(false), Condvar::new());
/// What of the run in progress is kept, once all of it has been written.
static KEPT: Mutex<Option<Arc<Journal>>> = Mutex::new(None);

/// Waits for signals from now on. One that was ignored when the program started, as by `nohup`, stays so.
pub fn watch() -> Result<()> {
    let failed = |error| Problem::from_error("signals cannot be waited for", error);
    let ignored = ignored();
    let watched: Vec<i32> =
        [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| !ignored(*signal)).collect();
    let mut signals = Signals::new(&watched).map_err(failed)?;
    let armed = Arc::new(AtomicBool::new(false));
    for &signal in &watched {
        // In this order: the first signal arms what the second one does.
        flag::register_conditional_shutdown(signal, 128 + signal, armed.clone()).map_err(failed)?;
        flag::register(signal, armed.clone()).map_err(failed)?;
    }
    // A file that may grow no larger is an error of writing, told as any other.
    flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false))).map_err(failed)?;
    let wait = move || {
        if let Some(signal) = signals.forever().next() {
            stop(signal);
        }
    };
    std::thread::Builder::new().name("signals".into()).spawn(wait).map_err(failed)?;
    Ok(())
}

/// Whether the program has been told to stop.
pub fn is_stopping() -> bool {
    STOPPING.load(Ordering::Relaxed)
}

/// A simulation begins that leaves its states when the program is told to stop.
pub fn running() {
    RUNNING.fetch_add(1, Ordering::SeqCst);
}

/// It has come to its end.
pub fn has_run() {
    RUNNING.fetch_sub(1, Ordering::SeqCst);
}

/// Says that all that was to be left has been left, and waits for the end.
pub fn leave() -> ! {
    let (left, waiting) = &LEFT;
    *left.lock().unwrap_or_else(PoisonError::into_inner) = true;
    waiting.notify_all();
    loop {
        std::thread::park();
    }
}

/// Does some work whose journal is asked, where a signal ends it, to write what is left and to say what
/// is kept.
pub fn keeping<T>(journal: &Arc<Journal>, work: impl FnOnce() -> T) -> T {
    let remember = |kept| *KEPT.lock().unwrap_or_else(PoisonError::into_inner) = kept;
    remember(Some(journal.clone()));
    let result = work();
    remember(None);
    result
}

fn stop(signal: i32) -> ! {
    STOPPING.store(true, Ordering::SeqCst);
    if RUNNING.load(Ordering::SeqCst) > 0 {
        let (left, waiting) = &LEFT;
        let left = left.lock().unwrap_or_else(PoisonError::into_inner);
        let _ = waiting.wait_timeout_while(left, TO_LEAVE, |left| !*left);
    }
    // Who reads what is said, or writes the journal, may keep this waiting; not for long.
    let (done, is_done) = mpsc::channel();
    let say = move || {
        farewell(signal);
        let _ = done.send(());
    };
    if std::thread::Builder::new().spawn(say).is_ok() {
        let _ = is_done.recv_timeout(TO_SAY);
    }
    exit(128 + signal)
}

fn farewell(signal: i32) {
    bar::clear();
    let name = signal_hook::low_level::signal_name(signal).unwrap_or("a signal");
    let kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner).clone();
    match kept {
        Some(journal) => {
            journal.flush();
            complain!("stopped by {name}: {}", journal.what_is_kept());
        }
        None => complain!("stopped by {name}"),
    }
}

/// Which signals the program was started to ignore, as Linux tells; none elsewhere.
fn ignored() -> impl Fn(i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    move |signal| mask >> (signal - 1) & 1 == 1
}
