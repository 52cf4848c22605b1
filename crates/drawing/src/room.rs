//! What a figure has room for, known before anything is computed: `check` foresees it, and the figure
//! is drawn so. Numbers are never left out with it: the tables have them all.

use eigensync::ALL_PAIRS;
use eigensync::Sweep;
use eigensync::numbers::plain;
use experiment::Plan;
use experiment::spec::FigureKind;

/// Curves that a reader can tell apart; the others are thin and grey.
const TOLD_APART: usize = 16;
/// Curves that are drawn at all.
const DRAWN: usize = 300;
/// Columns of matrices, or of views in space, that stay large enough to be read.
const COLUMNS: usize = 4;

/// Which curves of a sweep are drawn, by their numbers.
#[derive(Debug, PartialEq)]
pub struct Curves {
    /// With a colour and a name each.
    pub named: Vec<usize>,
    /// Thin and grey.
    pub grey: Vec<usize>,
}

/// All curves where they can be told apart, else those of the largest clusters in the order of the
/// experiment; the sizes are all the same for single nodes.
pub fn curves(sizes: &[usize]) -> Curves {
    let mut by_size: Vec<usize> = (0..sizes.len()).collect();
    by_size.sort_by_key(|&curve| std::cmp::Reverse(sizes[curve]));
    let (named, rest) = by_size.split_at(sizes.len().min(TOLD_APART));
    let mut named = named.to_vec();
    named.sort_unstable();
    let grey = rest.iter().copied().take(DRAWN - TOLD_APART).collect();
    Curves { named, grey }
}

/// The sizes of what each curve of a sweep is about: clusters, else nodes beside the reference.
pub fn curve_sizes(sweep: &Sweep, n_nodes: usize) -> Vec<usize> {
    let observables = &sweep.observables;
    match observables.reference {
        _ if !observables.clusters.is_empty() => {
            observables.clusters.iter().map(Vec::len).collect()
        }
        Some(_) => vec![1; n_nodes.saturating_sub(1)],
        None => Vec::new(),
    }
}

/// The positions in a sweep of so many couplings that have a column, the largest ε first: all of them
/// or, evenly spread, as many as have room.
pub fn columns(n_epsilon: usize) -> Vec<usize> {
    if n_epsilon <= COLUMNS {
        return (0..n_epsilon).rev().collect();
    }
    let place = |column: usize| (column * (n_epsilon - 1) + (COLUMNS - 1) / 2) / (COLUMNS - 1);
    (0..COLUMNS).rev().map(place).collect()
}

/// What of a plan its figure will not show as asked, in words.
pub fn foreseen(plan: &Plan) -> Vec<String> {
    let Some(sweep) = &plan.study.sweep else { return Vec::new() };
    let asked_for = plan.figure.kind;
    let room = match plan.figure_kind() {
        FigureKind::None => None,
        FigureKind::Sweep => of_curves(sweep, plan.study.network.n_nodes()),
        FigureKind::Matrices | FigureKind::Regions => of_columns(&sweep.epsilon),
    };
    let instead = (asked_for != plan.figure_kind()).then(|| {
        format!(
            "there are no matrices: the errors of all pairs are kept for networks of up to \
             {ALL_PAIRS} nodes; the sweep is shown instead"
        )
    });
    instead.into_iter().chain(room).collect()
}

fn of_curves(sweep: &Sweep, n_nodes: usize) -> Option<String> {
    let sizes = curve_sizes(sweep, n_nodes);
    let what = if sweep.observables.clusters.is_empty() { "nodes" } else { "clusters" };
    let Curves { named, grey } = curves(&sizes);
    let drawn = named.len() + grey.len();
    let grey = match grey.len() {
        0 => return None,
        _ if drawn == sizes.len() => "the others are grey".to_owned(),
        n => format!("{n} others are grey, and the rest is not drawn"),
    };
    let named = match what {
        "nodes" => format!("the first {}", named.len()),
        _ => format!("the {} largest", named.len()),
    };
    let n_curves = sizes.len();
    Some(format!("the curves of {n_curves} {what} cannot be told apart: {named} are named, {grey}"))
}

fn of_columns(epsilon: &[f64]) -> Option<String> {
    let shown = columns(epsilon.len());
    let values = || shown.iter().rev().map(|&position| plain(epsilon[position]));
    (shown.len() < epsilon.len()).then(|| {
        format!(
            "{} values of epsilon have no room: {} of them are shown ({})",
            epsilon.len(),
            shown.len(),
            values().collect::<Vec<_>>().join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_curves_are_all_named_and_of_many_the_largest() {
        assert_eq!(curves(&[2, 5, 3]), Curves { named: vec![0, 1, 2], grey: vec![] });
        let sizes: Vec<usize> = (0..36).collect();
        let many = curves(&sizes);
        assert_eq!(many.named, (20..36).collect::<Vec<_>>());
        assert_eq!(many.grey.len(), 20);
        assert_eq!(curves(&[1; 100_000]).grey.len(), DRAWN - TOLD_APART);
    }

    #[test]
    fn columns_are_spread_from_the_largest_coupling_to_the_smallest() {
        assert_eq!(columns(3), [2, 1, 0]);
        assert_eq!(columns(6), [5, 3, 2, 0]);
        assert_eq!(columns(1_000_000), [999_999, 666_666, 333_333, 0]);
        assert!(columns(0).is_empty());
    }
}
