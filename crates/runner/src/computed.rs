//! What a run computes at length: the curve Λ(σ), the spectrum, the replicas of the sweep (`sweep`).
//! Each is taken from the journal if an earlier run has left it there, and kept in it otherwise.

mod failure;
mod sweep;
mod trajectories;

pub use failure::Failure;
pub use sweep::states_of;

use std::cell::RefCell;
use std::time::Instant;

use dynamics::lyapunov::{Integrator, Times};
use dynamics::{Progress, Run};
use eigensync::numbers::{four_digits, two_digits};
use eigensync::{Compute, Error, Simulated, StepEffect, Study, Sweep, Warning};
use msf::MasterStability;
use spectra::Spectrum;

use crate::warning;
use experiment::Node;
use journal::{Journal, Key, Kind, is_worth_keeping};

use crate::Work;

/// The master stability functions computed so far: experiments that ask for the same one share it. And the
/// last spectrum, for an answer that is made twice.
#[derive(Default)]
pub struct Curves {
    known: Vec<(Node, msf::Request, MasterStability)>,
    spectrum: Option<(Key, Spectrum)>,
    keeps_spectrum: bool,
}

impl Curves {
    /// For an answer that is made twice, with one spectrum.
    pub fn of_two_answers() -> Self {
        Self { keeps_spectrum: true, ..Self::default() }
    }
}

/// Computes the study of a plan, and tells whoever watches.
pub struct Kept<'a> {
    work: &'a Work<'a>,
    curves: RefCell<&'a mut Curves>,
}

impl<'a> Kept<'a> {
    /// Shares the curves with other experiments.
    pub fn new(work: &'a Work<'a>, curves: &'a mut Curves) -> Self {
        Self { work, curves: RefCell::new(curves) }
    }
}

impl Compute for Kept<'_> {
    type Error = Failure;

    /// Computed unless an earlier plan, or an earlier run, had the same node and request.
    fn curve(&self, study: &Study) -> Result<MasterStability, Failure> {
        let &Work { plan, journal, stages } = self.work;
        let mut curves = self.curves.borrow_mut();
        let same = |known: &&(Node, msf::Request, MasterStability)| {
            known.0 == plan.node && known.1 == study.msf
        };
        let known = curves.known.iter().find(same).map(|(_, _, curve)| curve.clone());
        let is_known = known.is_some();
        let key = curve_key(journal, &plan.node, &study.msf);
        let curve = journal.once((Kind::Curve, key), || {
            let compute = |progress: Progress<'_>, ahead: &dyn Fn(u64, &str)| {
                let steps = study.msf.times.steps();
                let advance = |zero: msf::Advance| {
                    ahead(zero.exponents_ahead as u64 * steps, &refined(zero));
                };
                msf::master_stability_with(&study.node, &study.msf, progress, &advance)
            };
            known.map_or_else(|| stages.extended("msf", study.msf_steps(), compute), Ok)
        });
        let curve = curve.map_err(Error::Curve)?;
        if !is_known {
            curves.known.push((plan.node.clone(), study.msf.clone(), curve.clone()));
        }
        Ok(curve)
    }

    /// Kept where writing it costs little beside computing it again.
    fn spectrum(&self, study: &Study, request: &spectra::Request) -> Result<Spectrum, Failure> {
        let &Work { journal, stages, .. } = self.work;
        let key = journal.key(Kind::Spectrum, &(self.work.matrix(), request));
        if let Some(spectrum) = journal.take(Kind::Spectrum, &key) {
            return Ok(spectrum);
        }
        if let Some((known, spectrum)) = &self.curves.borrow().spectrum
            && *known == key
        {
            return Ok(spectrum.clone());
        }
        let started = Instant::now();
        let spectrum = stages.told("spectrum", |tell| {
            spectra::leading_modes_with(&study.matrix, request, &|advance| tell(&advanced(advance)))
        });
        let spectrum = spectrum.map_err(Error::Spectrum)?;
        let bytes = 8.0 * spectrum.n_modes() as f64 * study.network.n_nodes() as f64;
        if is_worth_keeping(bytes, started.elapsed()) {
            journal.keep(Kind::Spectrum, &key, &spectrum);
        }
        let mut curves = self.curves.borrow_mut();
        if curves.keeps_spectrum {
            curves.spectrum = Some((key, spectrum.clone()));
        }
        Ok(spectrum)
    }

    fn runs(&self, _study: &Study, sweep: &Sweep) -> Result<Vec<Run>, Failure> {
        sweep::runs(self.work, sweep)
    }

    fn step_effects(
        &self,
        _study: &Study,
        sweep: &Sweep,
        simulated: &Simulated,
    ) -> Result<Vec<StepEffect>, Failure> {
        Ok(sweep::effects_of_step(self.work, sweep, simulated).map_err(Error::Sweep)?)
    }

    fn stage<T>(
        &self,
        name: &str,
        n_steps: Option<u64>,
        work: impl FnOnce(Progress<'_>) -> T,
    ) -> T {
        match n_steps {
            Some(n_steps) => self.work.stages.measured(name, n_steps, work),
            None => self.work.stages.unmeasured(name, || work(dynamics::QUIET)),
        }
    }

    fn warn(&self, warning: &Warning) {
        warning::say(&self.work.plan.id, warning, &**self.work.stages.watch());
    }
}

/// What a curve is known by.
pub fn curve_key(journal: &Journal, node: &Node, request: &msf::Request) -> Key {
    journal.key(Kind::Curve, &(node, request))
}

/// Times of a first look at Λ, which finds how far a curve must reach: as long as a look needs, and at most ten
/// times as long as those that are asked for.
pub fn first_look(is_map: bool, asked: &Times) -> Times {
    const HURRY: f64 = 10.0;
    let (transient, average) = if is_map { (1000.0, 20_000.0) } else { (500.0, 4000.0) };
    Times {
        integrator: Integrator::Auto { tolerance: 1e-6 },
        transient: f64::min(transient, HURRY * asked.transient),
        average: f64::min(average, HURRY * asked.average),
        ..*asked
    }
}

/// Seed of the first look.
pub const LOOK_SEED: u64 = 1;

/// What a first look is known by.
pub fn look_key(journal: &Journal, node: &Node, times: &Times) -> Key {
    journal.key(Kind::Look, &(node, times, LOOK_SEED))
}

/// How far the refinement of a zero has come.
pub fn refined(zero: msf::Advance) -> String {
    let [sigma, wanted] = [four_digits(zero.sigma), two_digits(zero.wanted)];
    format!("zero at sigma = {sigma} ± {}, asked ± {wanted}", two_digits(zero.standard_error))
}

fn advanced(advance: spectra::Advance) -> String {
    let spectra::Advance { products, converged, wanted } = advance;
    format!("{converged} of {wanted} modes found, {products} matrix-vector products")
}
