//! The bar of a stage on the terminal, with an estimate of the time left; silent when standard error is
//! not a terminal.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use user::Stage;
use user::text::printable;

use crate::output::is_quiet;
use crate::suite;

/// The bar on the terminal, for whoever has to clear it from another thread.
static SHOWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// Clears the line of the bar, if there is one.
pub fn clear() {
    if let Some(bar) = SHOWN.lock().unwrap_or_else(PoisonError::into_inner).take() {
        bar.finish_and_clear();
    }
}

/// Shows a stage that begins.
pub fn shown(stage: &Stage<'_>) -> ProgressBar {
    let bar = stage.steps.map_or_else(ProgressBar::new_spinner, ProgressBar::new);
    if is_quiet() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    let template = match stage.steps {
        Some(_) => "{prefix} [{bar:30}] {percent:>3} %  {elapsed} so far, about {eta} left  {msg}",
        None => "{prefix} {spinner} {elapsed}  {msg}",
    };
    let style = ProgressStyle::with_template(template).expect("the template is a constant");
    bar.set_style(style.progress_chars("=> "));
    bar.set_prefix(format!("{}{} {}", suite::place(), printable(stage.id), stage.name));
    bar.set_position(stage.done);
    bar.reset_eta();
    bar.enable_steady_tick(Duration::from_millis(200));
    *SHOWN.lock().unwrap_or_else(PoisonError::into_inner) = Some(bar.clone());
    bar
}
