//! Runs that are killed at random moments by SIGKILL, SIGTERM or SIGINT, some of them several times,
//! and then left to finish.

use std::os::unix::process::ExitStatusExt;
use std::time::Duration;

use super::Trial;
use super::scene::Scene;

/// Length of averages that makes a sweep of some seconds.
const LENGTH: f64 = 1500.0;
/// Most kills of one sweep before it may finish.
const KILLS: usize = 3;
/// A run that is asked to stop does so within this time.
const STOPS: Duration = Duration::from_secs(2);
const SIGNALS: [(&str, i32); 3] = [("KILL", 9), ("TERM", 15), ("INT", 2)];

pub fn run(trial: &mut Trial) -> Result<(), String> {
    let scene = Scene::new(&trial.program, &trial.folder, LENGTH)?;
    while trial.goes_on() {
        let folder = scene.fresh()?.to_owned();
        let mut outcome = Ok(());
        for _ in 0..=trial.random.below(KILLS) {
            outcome = outcome.and(kill(trial, &scene)?);
        }
        let outcome = outcome.and_then(|()| scene.ends_well(&trial.program));
        trial.count(outcome, &[&folder]);
    }
    Ok(())
}

/// Kills one run; an error of ours is the outer one.
fn kill(trial: &mut Trial, scene: &Scene) -> Result<Result<(), String>, String> {
    let folder = scene.results();
    let folder = folder.parent().expect("results lie in a folder");
    let (signal, number) = *trial.random.of(&SIGNALS);
    // Half of the moments are spread over the run, the others gather at its beginning and its end.
    let fraction = match trial.random.below(4) {
        0 => 0.02 * trial.random.fraction(),
        1 => 0.9 + 0.15 * trial.random.fraction(),
        _ => trial.random.fraction(),
    };
    let mut running = trial.program.start(folder, &[], &["run", "sweep.toml"])?;
    if running.lasts(scene.took.mul_f64(fraction))? {
        running.signal(signal)?;
    }
    let answer = running.end(STOPS)?;
    let told = format!("{signal} after {fraction:.2} of the run");
    if answer.too_long {
        return Ok(Err(format!("{told}: still running {} s later", STOPS.as_secs())));
    }
    let expected = [Some(0), Some(128 + number)];
    let as_expected =
        expected.contains(&answer.status.code()) || answer.status.signal() == Some(number);
    if !as_expected {
        return Ok(Err(format!("{told}: {}\n{}", answer.status, answer.stderr)));
    }
    Ok(scene.is_whole().map_err(|why| format!("{told}: {why}")))
}
