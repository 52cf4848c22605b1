//! What a run computes at length: the curve Λ(σ), the spectrum, the replicas of the sweep (`sweep`).
//! Each is taken from the journal if an earlier run has left it there, and kept in it otherwise.

mod sweep;

use std::time::Instant;

use dynamics::DynamicsError;
use dynamics::lyapunov::Times;
use msf::MasterStability;
use spectra::Spectrum;

use crate::journal::{Journal, Key, Kind, is_worth_keeping};
use crate::plan::{Node, Plan};
use crate::problem::{Problem, Result, plain};
use crate::progress::Stages;

pub use sweep::{effects_of_step, simulate};

/// The master stability functions computed so far: experiments that ask for the same one share it.
#[derive(Default)]
pub struct Curves(Vec<(Node, msf::Request, MasterStability)>);

impl Curves {
    /// The curve of a plan, computed unless an earlier plan, or an earlier run, had the same node and
    /// request.
    pub fn of(&mut self, plan: &Plan, journal: &Journal) -> Result<MasterStability> {
        let same = |known: &&(Node, msf::Request, MasterStability)| {
            known.0 == plan.node && known.1 == plan.msf
        };
        let known = self.0.iter().find(same).map(|(_, _, curve)| curve.clone());
        let is_known = known.is_some();
        let key = Key::of(Kind::Curve, &(&plan.node, &plan.msf));
        let curve = journal.once((Kind::Curve, key), || {
            let compute = |progress: dynamics::Progress<'_>| {
                msf::master_stability(&plan.node.equations(), &plan.msf, progress)
            };
            known.map_or_else(|| plan.stages.measured("msf", plan.msf_steps(), compute), Ok)
        });
        let curve = curve.map_err(|error| msf_problem(plan, &error))?;
        refuse_overflow(plan, &curve)?;
        if !is_known {
            self.0.push((plan.node.clone(), plan.msf.clone(), curve.clone()));
        }
        Ok(curve)
    }
}

/// How far the curve must reach, by a first look at powers of two.
pub fn reach(
    node: &Node,
    times: &Times,
    stages: &Stages,
    journal: &Journal,
) -> std::result::Result<f64, msf::MsfError> {
    const SEED: u64 = 1;
    let key = Key::of(Kind::Look, &(node, times, SEED));
    journal.once((Kind::Look, key), || {
        let look =
            |progress: dynamics::Progress<'_>| msf::reach(&node.equations(), times, SEED, progress);
        stages.measured("first look at the msf", 16 * times.steps(), look)
    })
}

/// The modes of a plan. They are kept where writing them costs little beside computing them again.
pub fn spectrum(plan: &Plan, request: &spectra::Request, journal: &Journal) -> Result<Spectrum> {
    let key = Key::of(Kind::Spectrum, &(matrix(plan), request));
    if let Some(spectrum) = journal.take(Kind::Spectrum, &key) {
        return Ok(spectrum);
    }
    let started = Instant::now();
    let spectrum = plan.stages.told("spectrum", |tell| {
        spectra::leading_modes_with(&plan.matrix, request, &|advance| tell(&advanced(advance)))
    });
    let spectrum = spectrum.map_err(|error| {
        Problem::from_error("the spectrum could not be computed", error).in_file(&plan.file)
    })?;
    let bytes = 8.0 * spectrum.n_modes() as f64 * plan.network.n_nodes() as f64;
    if is_worth_keeping(bytes, started.elapsed()) {
        journal.keep(Kind::Spectrum, &key, &spectrum);
    }
    Ok(spectrum)
}

/// What the coupling matrix of a plan is known by.
fn matrix(plan: &Plan) -> (&str, usize, u8) {
    (&plan.links_hash, plan.network.n_nodes(), plan.experiment.coupling.matrix as u8)
}

fn advanced(advance: spectra::Advance) -> String {
    let spectra::Advance { products, converged, wanted } = advance;
    format!("{converged} of {wanted} modes found, {products} matrix-vector products")
}

fn msf_problem(plan: &Plan, error: &msf::MsfError) -> Problem {
    let what = "the master stability function could not be computed";
    let problem = Problem::from_error(what, error).in_file(&plan.file);
    if !matches!(error, msf::MsfError::Dynamics(DynamicsError::Escaped { .. })) {
        return problem;
    }
    problem.hint(format!(
        "either the parameters of [oscillator.{}] leave it no bounded attractor, or `msf.step` is \
         too long for it",
        plan.node.model.name()
    ))
}

/// A perturbation may grow beyond all numbers between two renormalisations.
fn refuse_overflow(plan: &Plan, msf: &MasterStability) -> Result<()> {
    let Some(at) = msf.lambda.iter().position(|lambda| !lambda.mean.is_finite()) else {
        return Ok(());
    };
    let message = format!(
        "reaches {}, where perturbations grow beyond all numbers between two renormalisations",
        plain(msf.sigma[at])
    );
    let hint = "end the grid earlier, or shorten `msf.renormalise` and `msf.step`";
    Err(Problem::with_key(&plan.file, "msf.sigma", message).hint(hint))
}
