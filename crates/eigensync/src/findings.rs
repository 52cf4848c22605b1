//! What a study found, and questions that its numbers answer.

use clustering::{CascadeTree, Partition, State, StateLabels};
use msf::{MasterStability, Transition};
use spectra::Spectrum;

use crate::{Agreement, Seen, Simulated, StepEffect, Synchrony, Warning};

/// Everything computed in one study.
pub struct Findings {
    /// The modes of the coupling matrix.
    pub spectrum: Spectrum,
    /// Λ(σ) and its stable set.
    pub msf: MasterStability,
    /// The critical couplings: where each eigenspace changes its stability, and by which zero of Λ.
    pub transitions: Vec<Transition>,
    /// Whether, and where, all nodes synchronise.
    pub synchrony: Synchrony,
    /// Predicted states, from large ε down; neighbours differ in their clusters.
    pub cascade: Vec<State>,
    /// Of each of these states.
    pub labels: Vec<StateLabels>,
    /// The same states as trees, labelled: one for each run of states in which clusters only split.
    pub trees: Vec<CascadeTree>,
    /// The sweep; none where none was asked for.
    pub simulated: Option<Simulated>,
    /// What the step of the integrator does to the errors of the sweep, at some of its couplings.
    pub step_effects: Vec<StepEffect>,
    /// At every ε of the sweep; empty without one, or without all pairs.
    pub agreement: Vec<Agreement>,
    /// What must be known beside these numbers, in the order in which it came up.
    pub warnings: Vec<Warning>,
}

impl Findings {
    /// The clusters predicted at a coupling strength; none where the prediction does not reach.
    pub fn predicted_at(&self, epsilon: f64) -> Option<&Partition> {
        self.cascade.iter().find(|state| state.holds_at(epsilon)).map(|state| &*state.clusters)
    }

    /// The transition at a coupling strength, such as an end of a predicted state; none at ends that are
    /// none of a mode that was computed.
    pub fn transition_at(&self, epsilon: f64) -> Option<&Transition> {
        msf::transition_at(&self.transitions, epsilon)
    }

    /// The transitions of a mode, counted from 0, by ascending σ.
    pub fn transitions_of(&self, mode: usize) -> impl Iterator<Item = &Transition> {
        let first = self.transitions.partition_point(|transition| transition.modes.end <= mode);
        self.transitions[first..].iter().take_while(move |t| t.modes.contains(&mode))
    }

    /// The clusters predicted on either side of critical couplings that may, within two standard errors,
    /// lie on the other side of this ε; none for a side that is not predicted.
    pub fn predicted_about(&self, epsilon: f64) -> Vec<Option<&Partition>> {
        let is_near = |t: &&Transition| {
            (t.epsilon - epsilon).abs() <= 2.0 * t.standard_error && t.epsilon.is_finite()
        };
        let near: Vec<f64> = self.transitions.iter().filter(is_near).map(|t| t.epsilon).collect();
        let [low, high] =
            near.iter().fold([epsilon; 2], |[low, high], &at| [low.min(at), high.max(at)]);
        if near.is_empty() {
            return Vec::new();
        }
        let is_met =
            |state: &&State| state.epsilon.0 <= high && state.epsilon.1.is_none_or(|to| low <= to);
        let mut met: Vec<Option<&Partition>> =
            self.cascade.iter().filter(is_met).map(|state| Some(&*state.clusters)).collect();
        let [top, bottom] = [self.cascade.first(), self.cascade.last()];
        let ends_above = top.and_then(|state| state.epsilon.1).is_some_and(|to| to <= high);
        let ends_below = bottom.is_some_and(|state| low <= state.epsilon.0);
        met.extend((ends_above || ends_below).then_some(None));
        met
    }

    /// Whether something is predicted at every ε.
    pub fn is_predicted_everywhere(&self) -> bool {
        let [first, last] = [self.cascade.first(), self.cascade.last()];
        first.is_some_and(|state| state.epsilon.1.is_none())
            && last.is_some_and(|state| state.epsilon.0 == 0.0)
    }

    /// ε at which these nodes cease to be in one predicted cluster as ε falls; none if they never are
    /// or never cease to be.
    pub fn predicted_loss(&self, cluster: &[usize]) -> Option<f64> {
        let is_together = |state: &&State| together(state, cluster);
        let lost = self
            .cascade
            .iter()
            .skip_while(|state| !is_together(state))
            .find(|s| !is_together(s))?;
        lost.epsilon.1
    }

    /// Where these clusters were seen in the sweep: looked for at the strongest couplings at which
    /// they are predicted and of which the sweep has a point, or anywhere if there are none. None
    /// without a sweep.
    pub fn seen(&self, clusters: &[Vec<usize>]) -> Option<Seen> {
        let simulated = self.simulated.as_ref()?;
        let holds = |state: &State| clusters.iter().all(|cluster| together(state, cluster));
        let runs = self.cascade.chunk_by(|a, b| holds(a) == holds(b));
        let ranges = runs.filter(|run| holds(&run[0])).map(range_of);
        let has_point = |range: &(f64, Option<f64>)| {
            simulated
                .epsilon
                .iter()
                .any(|&epsilon| epsilon > range.0 && range.1.is_none_or(|to| epsilon <= to))
        };
        Some(simulated.seen(clusters, ranges.into_iter().find(has_point)))
    }

    /// How many runs of the sweep lie in the range of a state, and how many of these escaped; none
    /// without a sweep.
    pub fn runs_in(&self, state: &State) -> Option<[usize; 2]> {
        let simulated = self.simulated.as_ref()?;
        let inside = |at: &usize| state.holds_at(simulated.epsilon[*at]);
        let positions: Vec<usize> = (0..simulated.epsilon.len()).filter(inside).collect();
        let escaped = positions.iter().map(|&at| simulated.escaped(at)).sum();
        Some([positions.len() * simulated.seeds.len(), escaped])
    }

    /// Where the clusters of one predicted state were seen in the sweep: looked for in its range and
    /// above, as far as the states there hold them too.
    pub fn state_seen(&self, state: usize, clusters: &[Vec<usize>]) -> Option<Seen> {
        let holds = |state: &&State| clusters.iter().all(|cluster| together(state, cluster));
        let above = self.cascade[..state].iter().rev().take_while(holds).count();
        let range = range_of(&self.cascade[state - above..=state]);
        Some(self.simulated.as_ref()?.seen(clusters, Some(range)))
    }
}

/// Whether a state has these nodes in one cluster.
fn together(state: &State, cluster: &[usize]) -> bool {
    let of = state.clusters.cluster_of();
    cluster.iter().all(|&node| of[node] == of[cluster[0]])
}

/// The range of ε of neighbouring states, from strong coupling down.
fn range_of(states: &[State]) -> (f64, Option<f64>) {
    (states[states.len() - 1].epsilon.0, states[0].epsilon.1)
}
