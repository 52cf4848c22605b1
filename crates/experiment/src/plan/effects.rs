//! Keys that would change nothing where they stand: whoever writes one expects something of it, and is
//! told that it would not come.

use super::checker::Checker;
use crate::spec::{FigureKind, MethodKind, MsfMethod, NetworkSpec};
use graph::formats::{Choice, FORMATS};
use user::Result;

/// Keys of `[figure]` beside `kind`.
const FIGURE_KEYS: [&str; 8] = [
    "eigenvectors",
    "letter",
    "layout",
    "panels",
    "mark_modes",
    "source_transitions",
    "error_scale",
    "spread",
];

/// Keys of `[network.file]` that files of some formats have no use for.
const FILE_KEYS: [(Choice, &str); 4] = [
    (Choice::Variable, "variable"),
    (Choice::Attributes, "attributes"),
    (Choice::Block, "block"),
    (Choice::Rows, "rows"),
];

impl Checker<'_> {
    /// Refuses every key that has no effect.
    pub(super) fn effects(&self) -> Result<()> {
        self.of_figure()?;
        self.of_file()?;
        if let Some(sweep) = &self.experiment.sweep
            && !sweep.is_auto()
            && !matches!(sweep.method, Some(MethodKind::Dopri5 | MethodKind::Dop853))
        {
            let reason = "the steps of rk4 and rk8 are all `sweep.step` long; auto and the adaptive methods, dopri5 \
                          and dop853, have a tolerance";
            self.without_effect("sweep", "tolerance", reason)?;
        }
        if self.experiment.msf.method == MsfMethod::Rk4 {
            let reason = "the steps of rk4 are all `msf.step` long; Taylor series have a tolerance";
            self.without_effect("msf", "tolerance", reason)?;
        }
        if let Some(sweep) = &self.experiment.sweep
            && sweep.method == Some(MethodKind::Auto)
        {
            self.without_effect("sweep", "step", "`method = \"auto\"` chooses it")?;
        }
        if self.experiment.sweep.is_none() && self.experiment.regions.is_some() {
            let reason = "regions are compared at the couplings of a [sweep], and there is none";
            return Err(self.problem("regions", format!("has no effect: {reason}")));
        }
        Ok(())
    }

    /// Refuses a key if it is written.
    fn without_effect(&self, table: &str, key: &str, reason: &str) -> Result<()> {
        let pointer = format!("/{}/{key}", table.replace('.', "/"));
        if self.written.pointer(&pointer).is_none() {
            return Ok(());
        }
        let message = format!("has no effect here: {reason}");
        Err(self.problem(&format!("{table}.{key}"), message).hint("leave it out"))
    }

    fn of_figure(&self) -> Result<()> {
        let kind = self.experiment.figure.kind;
        let has_sweep = self.experiment.sweep.is_some();
        let (used, reason): (&[&str], _) = match kind {
            FigureKind::Sweep if has_sweep => (
                &[
                    "letter",
                    "panels",
                    "layout",
                    "mark_modes",
                    "source_transitions",
                    "error_scale",
                    "spread",
                ],
                "it is for figures of the kind \"matrices\"",
            ),
            FigureKind::Sweep => (
                &["letter", "panels", "layout"],
                "without a [sweep] the figure shows the network, the predicted states and Λ(σ)",
            ),
            FigureKind::Matrices => (
                &["eigenvectors", "panels", "layout"],
                "figures of the kind \"matrices\" have the network, eigenvectors and matrices, in \
                 panels with letters of their own",
            ),
            FigureKind::Regions => (
                &["panels"],
                "figures of the kind \"regions\" show nodes at their places, and no more",
            ),
            FigureKind::None => (&[], "there is no figure"),
        };
        let unused = FIGURE_KEYS.iter().filter(|key| !used.contains(key));
        unused.copied().try_for_each(|key| self.without_effect("figure", key, reason))
    }

    fn of_file(&self) -> Result<()> {
        let NetworkSpec::File(spec) = &self.experiment.network else { return Ok(()) };
        for (choice, key) in FILE_KEYS.into_iter().filter(|(choice, _)| !spec.format().has(*choice))
        {
            let those = with(choice);
            let reason = match choice {
                Choice::Variable => format!(
                    "files of this format hold one network; those of {those} may hold several \
                     matrices"
                ),
                Choice::Attributes => format!("only files of {those} have attributes"),
                Choice::Block | Choice::Rows => {
                    "files of this format hold links, not the rows and columns of a matrix".into()
                }
            };
            self.without_effect("network.file", key, &reason)?;
        }
        Ok(())
    }
}

/// The names of the formats whose files leave this open.
fn with(choice: Choice) -> String {
    let names: Vec<_> = FORMATS.iter().filter(|f| f.has(choice)).map(|f| f.name).collect();
    match &names[..] {
        [before @ .., last] if !before.is_empty() => format!("{} and {last}", before.join(", ")),
        _ => names.concat(),
    }
}
