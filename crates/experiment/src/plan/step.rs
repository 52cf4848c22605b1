//! Whether a method can take the step that is asked of it, at the largest σ = ε|λ| that a run comes to: the
//! σ of the last point of the curve, and for a sweep its largest ε times |λ_N|.

use dynamics::lyapunov::takes_series;
use dynamics::{LinearSteps, Method, StepVerdict};
use eigensync::numbers::{four_digits, plain, two_digits};
use eigensync::{Study, Sweep, Warning};

use graph::CouplingMatrix;

use super::checker::Checker;
use user::Result;

/// Where a step is taken, and what would help beside a shorter one.
struct Step<'a> {
    key: &'a str,
    /// Key of the summary that is in doubt where the step is.
    about: &'static str,
    method: Method,
    step: f64,
    /// The largest σ, and what it is.
    sigma: f64,
    reached_by: &'a str,
    instead: &'a str,
}

impl Checker<'_> {
    /// Judges the steps of a plan: that of the master stability function at the end of its grid, and
    /// that of a sweep at its largest ε for the fastest mode of the network. Returns doubts.
    pub(super) fn steps(&self, study: &Study) -> Result<Vec<Warning>> {
        let mut doubts = Vec::new();
        let step = study.msf.times.step;
        let msf::Node { dynamics, coupling } = &study.node;
        if let Some(&last) = study.msf.sigma.last()
            // The steps of series follow from what they have to damp.
            && !takes_series(dynamics.as_ref(), coupling, &study.msf.times)
            && let Some(steps) = self.linear_steps(study, step)
        {
            let of_msf = Step {
                key: "msf.step",
                about: "msf.stable",
                method: Method::Rk4,
                step,
                sigma: last,
                reached_by: "the end of `msf.sigma`",
                instead: "or end the grid earlier",
            };
            doubts.extend(self.judge(&steps, &of_msf)?);
        }
        match &study.sweep {
            Some(sweep) if matches!(sweep.method, Method::Rk4 | Method::Dop853) => {
                doubts.extend(self.sweep_step(study, sweep)?);
            }
            _ => {}
        }
        Ok(doubts)
    }

    fn sweep_step(&self, study: &Study, sweep: &Sweep) -> Result<Option<Warning>> {
        let step = sweep.schedule.step;
        let Some(steps) = self.linear_steps(study, step) else { return Ok(None) };
        let epsilon = sweep.epsilon[sweep.epsilon.len() - 1];
        let bound = fastest_bound(&study.matrix);
        // |λ_N| need not be known where the step is sound even so.
        if steps.judge(epsilon * bound, (sweep.method, step)) == StepVerdict::Sound {
            return Ok(None);
        }
        let fastest = spectra::smallest_eigenvalue(&study.matrix).map_or(bound, f64::abs);
        let reached_by =
            format!("epsilon = {} times |λ_N| = {}", plain(epsilon), four_digits(fastest));
        let of_sweep = Step {
            key: "sweep.step",
            about: "simulations",
            method: sweep.method,
            step,
            sigma: epsilon * fastest,
            reached_by: &reached_by,
            instead: "or weaker couplings, or `method = \"dop853\"`, which chooses its own step",
        };
        self.judge(&steps, &of_sweep)
    }

    /// None for a map, and for an orbit that escapes by itself, which the run will say.
    fn linear_steps(&self, study: &Study, step: f64) -> Option<LinearSteps> {
        let msf::Node { dynamics, coupling } = &study.node;
        let seed = self.experiment.seed;
        let along = || LinearSteps::along_orbit(dynamics.as_ref(), coupling, step, seed).ok();
        (!dynamics.is_map()).then(along).flatten()
    }

    /// Refuses a step at which the method makes deviations grow that the equations damp: the end of a stable
    /// set or an escape would be no property of the oscillators. Of a step that damps them at another
    /// rate the doubt is told.
    fn judge(&self, steps: &LinearSteps, step: &Step<'_>) -> Result<Option<Warning>> {
        let &Step { key, about, method, step, sigma, reached_by, instead } = step;
        let name = if method == Method::Rk4 { "RK4" } else { "DOP853" };
        let way_out = || match steps.sound_step(sigma, (method, step)) {
            Some(shorter) => format!("take a step of {} or less, {instead}", rounded_down(shorter)),
            None => instead.trim_start_matches("or ").to_owned(),
        };
        let at = format!("at sigma = {}, {reached_by}", four_digits(sigma));
        match steps.judge(sigma, (method, step)) {
            StepVerdict::Sound => Ok(None),
            StepVerdict::Doubtful { exact, by_method } => {
                let message = format!(
                    "`{key}` of {} is long for {name} {at}: along the isolated orbit deviations grow at \
                     a mean rate of {} by {name} and of {} by the equations, or it is unstable on parts \
                     of it; {}",
                    plain(step),
                    two_digits(by_method),
                    two_digits(exact),
                    way_out()
                );
                Ok(Some(Warning { about, message }))
            }
            StepVerdict::Unstable { factor } => {
                let message = format!(
                    "is {}, too long for {name} {at}: along the isolated orbit a step makes deviations \
                     that the equations damp grow by a factor of {}; it holds up to sigma = {}",
                    plain(step),
                    two_digits(factor),
                    two_digits(steps.stable_up_to(sigma, (method, step)))
                );
                Err(self.problem(key, message).hint(way_out()))
            }
        }
    }
}

/// What |λ_N| does not exceed, by Gershgorin.
pub(super) fn fastest_bound(matrix: &CouplingMatrix) -> f64 {
    let diagonal = matrix.matrix().diag_iter().flatten();
    2.0 * diagonal.fold(0.0f64, |largest, w| largest.max(w.abs()))
}

/// Two significant digits, and not more than the number.
fn rounded_down(number: f64) -> String {
    let unit = 10f64.powf(number.log10().floor() - 1.0);
    two_digits((number / unit).floor() * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_that_would_do_is_never_rounded_up() {
        assert_eq!([0.008_99, 0.0125, 1.0].map(rounded_down), ["0.0089", "0.012", "1"]);
    }
}
