//! Numbers of an experiment: finite, of the right sign, and of a size that can be computed at all.

use dynamics::{BLOCKS, Schedule};
use eigensync::numbers::plain;
use eigensync::{ALL_PAIRS, Bound};

use super::checker::Checker;
use crate::spec::{EvenGrid, Grid};
use user::Result;

/// The most points of a grid, and the most runs of a sweep.
const MOST_POINTS: f64 = 1e6;
/// The most steps of a stage: years on one processor, weeks on a hundred.
const MOST_STEPS: f64 = 1e16;
/// The most time-averaged errors kept in memory, 16 bytes each.
const MOST_ERRORS: f64 = 1e9;

impl Checker<'_> {
    /// A grid's values: finite, ascending, and at least so many.
    pub(super) fn grid(&self, key: &str, grid: &Grid, least: usize) -> Result<Vec<f64>> {
        if let Grid::Even(even) = grid {
            self.even_grid(key, even)?;
        }
        let mut values = grid.values();
        if values.len() < least {
            let points = if values.len() == 1 { "point" } else { "points" };
            let message = format!("has {} {points}, but needs {least} or more", values.len());
            return Err(self.problem(key, message));
        }
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Err(self.problem(key, format!("contains {value}; its values must be finite")));
        }
        values.sort_by(f64::total_cmp);
        match values.windows(2).find(|pair| pair[0] == pair[1]) {
            None => Ok(values),
            Some(pair) => {
                Err(self.problem(key, format!("contains {} more than once", plain(pair[0]))))
            }
        }
    }

    fn even_grid(&self, key: &str, &EvenGrid { from, to, points }: &EvenGrid) -> Result<()> {
        for (name, value) in [("from", from), ("to", to)] {
            if !value.is_finite() {
                let message = format!("is {value}, but must be finite");
                return Err(self.problem(&format!("{key}.{name}"), message));
            }
        }
        let [low, high] = [from, to].map(plain);
        if to < from {
            let message = format!("runs down from {low} to {high}; its values must ascend");
            return Err(self.problem(key, message).hint("exchange `from` and `to`"));
        }
        if points == 1 && from != to {
            let message = format!("has 1 point, but runs from {low} to {high}");
            return Err(self
                .problem(key, message)
                .hint("take more `points`, or `to` equal `from`"));
        }
        self.at_most(&format!("{key}.points"), f64::from(points), MOST_POINTS)
    }

    pub(super) fn positive(&self, key: &str, value: f64) -> Result<()> {
        if value.is_finite() && value > 0.0 {
            return Ok(());
        }
        Err(self.problem(key, format!("is {}, but must be finite and above zero", plain(value))))
    }

    /// A bound on errors, in a sweep that observes all pairs or does not.
    pub(super) fn bound(&self, key: &str, bound: Bound, pairs: bool) -> Result<()> {
        match bound {
            Bound::Fixed(error) => self.positive(key, error),
            Bound::OfLargest(_) if !pairs => {
                let message = format!(
                    "needs the errors of all pairs, kept for networks of up to {ALL_PAIRS} nodes"
                );
                Err(self.problem(key, message).hint("give the bound as a number"))
            }
            Bound::OfLargest(fraction) if fraction > 0.0 && fraction < 1.0 => Ok(()),
            Bound::OfLargest(fraction) => {
                let message = format!("is {}, but must be between 0 and 1", plain(fraction));
                Err(self.problem(&format!("{key}.of_largest"), message))
            }
        }
    }

    pub(super) fn not_negative(&self, key: &str, value: f64) -> Result<()> {
        if value.is_finite() && value >= 0.0 {
            return Ok(());
        }
        Err(self.problem(key, format!("is {}, but must be finite and not negative", plain(value))))
    }

    pub(super) fn at_most(&self, key: &str, value: f64, most: f64) -> Result<()> {
        if value <= most {
            return Ok(());
        }
        Err(self.problem(key, format!("is {}, but the most is {}", plain(value), plain(most))))
    }

    /// An average must be cut into blocks of at least one interval each.
    pub(super) fn blocks(&self, key: &str, value: f64, interval: (f64, &str)) -> Result<()> {
        let least = BLOCKS as f64 * interval.0 * self.shortened;
        // A hair of slack, since the least is itself a product of decimal fractions.
        if value >= least * (1.0 - 1e-9) {
            return Ok(());
        }
        let quick = if self.shortened > 1.0 { ", ten times more with --quick" } else { "" };
        let message = format!(
            "is {}, but the {BLOCKS} blocks of its standard error need {} or more ({BLOCKS} × \
             {}{quick})",
            plain(value),
            plain(least),
            interval.1
        );
        Err(self.problem(key, message))
    }

    /// Refuses work that no machine will finish.
    pub(super) fn feasible(&self, table: &str, steps: f64) -> Result<()> {
        if steps <= MOST_STEPS {
            return Ok(());
        }
        let message = format!(
            "asks for {steps:.0e} steps of the integrator, which would take years; the most is \
             {MOST_STEPS:.0e}"
        );
        let hint = format!(
            "its steps are those of `{table}.transient` and `{table}.average`, over `{table}.step`, \
             for every point of its grid"
        );
        Err(self.problem(table, message).hint(hint))
    }

    /// Refuses a sweep of more runs, results or steps than can ever be had.
    pub(super) fn affordable(
        &self,
        seeds: u64,
        points: usize,
        schedule: &Schedule,
        (n_nodes, pairs): (usize, bool),
    ) -> Result<()> {
        let (n, runs) = (n_nodes as f64, seeds as f64 * points as f64);
        if runs > MOST_POINTS {
            let message = format!(
                "is {}, which makes {} runs at {points} values of epsilon; the most is {}",
                plain(seeds as f64),
                plain(runs),
                plain(MOST_POINTS)
            );
            return Err(self.problem("sweep.seeds", message));
        }
        let errors = runs * if pairs { 0.5 * n * (n - 1.0) } else { 2.0 * n };
        if errors > MOST_ERRORS {
            let message = format!(
                "keeps {errors:.1e} errors ({} runs of {n} nodes), {:.0} GB; the most is \
                 {MOST_ERRORS:.0e}",
                plain(runs),
                errors * 16e-9
            );
            let hint = "take fewer `seeds` or fewer values of `epsilon`";
            return Err(self.problem("sweep", message).hint(hint));
        }
        let steps = (schedule.transient + schedule.average) / schedule.step;
        self.feasible("sweep", runs * n * steps)
    }
}
