//! Runs that are killed at random moments by SIGKILL, SIGTERM or SIGINT, some of them several times,
//! and then left to finish. No replica that was finished before a kill is computed again.

use std::os::unix::process::ExitStatusExt;

use super::Trial;
use super::journal::{Replicas, replicas};
use super::program::STOPS;
use super::scene::Scene;

/// Length of averages that makes a sweep of some seconds.
const LENGTH: f64 = 1500.0;
/// Most kills of one sweep before it may finish.
const KILLS: usize = 3;
const SIGNALS: [(&str, i32); 3] = [("KILL", 9), ("TERM", 15), ("INT", 2)];

pub fn run(trial: &mut Trial) -> Result<(), String> {
    let scene = Scene::new(&trial.program, &trial.folder, LENGTH)?;
    while trial.goes_on() {
        let folder = scene.fresh()?.to_owned();
        let mut outcome = Ok(Replicas::new());
        for _ in 0..=trial.random.below(KILLS) {
            if let Ok(finished) = outcome {
                outcome = kill(trial, &scene, &finished)?;
            }
        }
        let outcome = outcome.and_then(|finished| {
            scene.ends_well(&trial.program)?;
            match (scene.taken_over()?, finished.len()) {
                (taken, finished) if taken == finished => Ok(()),
                (taken, finished) => {
                    Err(format!("{finished} replicas were finished, {taken} were taken over"))
                }
            }
        });
        trial.count(outcome, &[&folder]);
    }
    Ok(())
}

/// Kills one run and gives the replicas that are finished then, those of earlier runs among them; an
/// error of ours is the outer one.
fn kill(
    trial: &mut Trial,
    scene: &Scene,
    before: &Replicas,
) -> Result<Result<Replicas, String>, String> {
    let folder = scene.results();
    let folder = folder.parent().expect("results lie in a folder");
    let (signal, number) = *trial.random.of(&SIGNALS);
    // Half of the moments are spread over the run, the others gather at its beginning and its end.
    let fraction = match trial.random.below(4) {
        0 => 0.02 * trial.random.fraction(),
        1 => 0.9 + 0.15 * trial.random.fraction(),
        _ => trial.random.fraction(),
    };
    let earlier = scene.summary()?;
    let mut running = trial.program.start(folder, &[], &["run", "sweep.toml"])?;
    if running.lasts(scene.took.mul_f64(fraction))? {
        running.signal(signal)?;
    }
    let answer = running.end(STOPS)?;
    let told = format!("{signal} after {fraction:.2} of the run");
    if answer.too_long {
        return Ok(Err(format!("{told}: still running {} s later", STOPS.as_secs_f64())));
    }
    let expected = [Some(0), Some(128 + number)];
    let as_expected =
        expected.contains(&answer.status.code()) || answer.status.signal() == Some(number);
    if !as_expected {
        return Ok(Err(format!("{told}: {}\n{}", answer.status, answer.stderr)));
    }
    let outcome = scene.is_whole().and_then(|()| {
        let now = replicas(&scene.unfinished())?;
        let lost = before.difference(&now).count();
        // The journal goes once the results that it was for are in place.
        let is_done = scene.summary()? != earlier;
        if lost == 0 || is_done {
            Ok(now)
        } else {
            Err(format!("{lost} finished replicas are lost"))
        }
    });
    Ok(outcome.map_err(|why| format!("{told}: {why}")))
}
