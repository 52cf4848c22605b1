//! (μ − S)⁻¹ X for blocks X, by the factors of S − μ·1.
//!
//! P (S − μ) Pᵀ = L D Lᵀ with all pivots negative, so (μ − S)⁻¹ = −Pᵀ L⁻ᵀ D⁻¹ L⁻¹ P: down the
//! columns of L, a division by the pivots, and up again. Entries of X lie node by node, so that an
//! entry of L is read once for all vectors, and four columns of a panel at a time, so that a row of X
//! is. The network falls into two parts and a separator where the tree of elimination branches: the
//! parts go side by side. Where they are cut depends on L alone, so no bit depends on the threads.
//!
//! Source: T. A. Davis, Direct Methods for Sparse Linear Systems (SIAM, 2006), chapters 3 and 4.

use crate::factorisation::factors::{Factors, Panel};
use crate::factorisation::symbolic::Symbolic;
use crate::vectors::block::Block;

/// (μ − S)⁻¹ in factors.
pub(crate) struct Inverse<'s> {
    factors: Factors<'s>,
    shift: f64,
    parts: Parts,
}

/// Panels of the first part, of the second, and of the separator: neither part has rows in the other.
#[derive(Clone, Copy)]
struct Parts {
    second: usize,
    separator: usize,
}

impl Parts {
    /// The parts that take the least time side by side.
    ///
    /// In a postordered tree of elimination the panels before the p-th, and those from there to the
    /// parent of the one before it, are in different subtrees.
    fn of(factors: &Factors<'_>) -> Self {
        let n_panels = factors.n_panels();
        let mut panel_of = vec![n_panels; factors.n_rows()];
        let mut work = vec![0; n_panels + 1];
        for (p, panel) in factors.panels().enumerate() {
            panel_of[panel.start..panel.start + panel.width].fill(p);
            work[p + 1] = work[p] + panel.values.len();
        }
        let parent = |panel: Panel<'_>| panel.below.first().map(|&row| panel_of[row as usize]);
        let parents: Vec<usize> = factors.panels().map(|p| parent(p).unwrap_or(n_panels)).collect();
        let time = |parts: &Self| {
            let Self { second, separator } = *parts;
            let beside = work[second].max(work[separator] - work[second]);
            beside + work[n_panels] - work[separator]
        };
        let cuts = (1..n_panels).map(|p| Self { second: p, separator: parents[p - 1].max(p) });
        let whole = Self { second: 0, separator: 0 };
        let best = cuts.min_by_key(time).unwrap_or(whole);
        let apart = |&p: &usize| p < best.second || p >= best.separator;
        if parents[..best.second].iter().all(apart) { best } else { whole }
    }
}

impl<'s> Inverse<'s> {
    /// Factorises μ − S; none when it is not positive definite.
    pub fn new(symbolic: &'s Symbolic<'_>, shift: f64) -> Option<Self> {
        let factors = symbolic.factors(shift)?;
        let negative = |panel: Panel<'_>| (0..panel.width).all(|k| panel.column(k)[0] < 0.0);
        let is_definite = factors.panels().all(negative);
        let parts = Parts::of(&factors);
        is_definite.then_some(Self { factors, shift, parts })
    }

    /// μ.
    pub fn shift(&self) -> f64 {
        self.shift
    }

    /// Vectors over nodes, in the order of elimination.
    pub fn to_elimination(&self, x: &Block) -> Block {
        self.factors.order().map_or_else(|| x.clone(), |(order, _)| x.reordered(order))
    }

    /// Vectors in the order of elimination, over nodes.
    pub fn to_nodes(&self, x: &Block) -> Block {
        self.factors.order().map_or_else(|| x.clone(), |(_, places)| x.reordered(places))
    }

    /// X ← (μ − S)⁻¹ X for vectors in the order of elimination.
    pub fn apply(&self, x: &mut Block) {
        match x.width() {
            1 => self.solve::<1>(x),
            2 => self.solve::<2>(x),
            3 => self.solve::<3>(x),
            4 => self.solve::<4>(x),
            5 => self.solve::<5>(x),
            6 => self.solve::<6>(x),
            7 => self.solve::<7>(x),
            8 => self.solve::<8>(x),
            width => unreachable!("blocks are at most 8 wide, not {width}"),
        }
    }

    /// Y ← −L⁻ᵀ D⁻¹ L⁻¹ Y.
    fn solve<const B: usize>(&self, y: &mut Block) {
        let (y, _) = y.data_mut().as_chunks_mut::<B>();
        let Parts { second, separator } = self.parts;
        let n_panels = self.factors.n_panels();
        let row = |p: usize| if p < n_panels { self.factors.panel(p).start } else { y.len() };
        let (second_row, separator_row) = (row(second), row(separator));
        let (parts, top) = y.split_at_mut(separator_row);
        let (left, right) = parts.split_at_mut(second_row);
        let down = |part: &mut [[f64; B]], panels: std::ops::Range<usize>, first: usize| {
            let mut above = vec![[0.0; B]; top.len()];
            for panel in panels.map(|p| self.factors.panel(p)) {
                Rows { first, part, beyond: separator_row }.down(&panel, &mut above);
            }
            above
        };
        let (from_left, from_right) =
            rayon::join(|| down(left, 0..second, 0), || down(right, second..separator, second_row));
        for ((y, l), r) in top.iter_mut().zip(&from_left).zip(&from_right) {
            subtract(y, -1.0, l);
            subtract(y, -1.0, r);
        }
        let mut rows = Rows { first: separator_row, part: top, beyond: usize::MAX };
        for p in separator..n_panels {
            rows.down(&self.factors.panel(p), &mut []);
        }
        for p in (separator..n_panels).rev() {
            rows.up(&self.factors.panel(p), &[]);
        }
        let top = &*top;
        let up = |part: &mut [[f64; B]], panels: std::ops::Range<usize>, first: usize| {
            for panel in panels.rev().map(|p| self.factors.panel(p)) {
                Rows { first, part, beyond: separator_row }.up(&panel, top);
            }
        };
        rayon::join(|| up(left, 0..second, 0), || up(right, second..separator, second_row));
    }
}

/// Rows of Y that belong to a part; those from `beyond` on belong to the separator.
struct Rows<'y, const B: usize> {
    first: usize,
    part: &'y mut [[f64; B]],
    beyond: usize,
}

impl<const B: usize> Rows<'_, B> {
    /// Y ← L⁻¹ Y for the columns of a panel.
    fn down(&mut self, panel: &Panel<'_>, above: &mut [[f64; B]]) {
        let triangle = panel.start - self.first;
        if panel.width == 1 {
            let (x, beyond) = (self.part[triangle], self.beyond);
            for (&i, &l) in panel.below.iter().zip(&panel.values[1..]) {
                let i = i as usize;
                let part = &mut *self.part;
                let y_i =
                    if i < beyond { &mut part[i - self.first] } else { &mut above[i - beyond] };
                subtract(y_i, l, &x);
            }
            return;
        }
        for k in 0..panel.width {
            let (y_k, rest) = self.part[triangle + k..triangle + panel.width]
                .split_first_mut()
                .expect("a column");
            for (y_i, l_ik) in rest.iter_mut().zip(&panel.column(k)[1..]) {
                subtract(y_i, *l_ik, y_k);
            }
        }
        let fours = panel.width / 4;
        (0..fours).for_each(|k| self.below_down::<4>(panel, 4 * k, above));
        (4 * fours..panel.width).for_each(|k| self.below_down::<1>(panel, k, above));
    }

    /// Y ← −L⁻ᵀ D⁻¹ Y for the columns of a panel.
    fn up(&mut self, panel: &Panel<'_>, above: &[[f64; B]]) {
        let triangle = panel.start - self.first;
        if panel.width == 1 {
            let mut x = self.part[triangle].map(|entry| -entry / panel.values[0]);
            for (&i, &l) in panel.below.iter().zip(&panel.values[1..]) {
                let i = i as usize;
                let y_i = if i < self.beyond {
                    &self.part[i - self.first]
                } else {
                    &above[i - self.beyond]
                };
                subtract(&mut x, l, y_i);
            }
            self.part[triangle] = x;
            return;
        }
        for k in 0..panel.width {
            let minus = -1.0 / panel.column(k)[0];
            self.part[triangle + k].iter_mut().for_each(|entry| *entry *= minus);
        }
        let fours = panel.width / 4;
        (0..fours).for_each(|k| self.below_up::<4>(panel, 4 * k, above));
        (4 * fours..panel.width).for_each(|k| self.below_up::<1>(panel, k, above));
        for k in (0..panel.width).rev() {
            let (y_k, rest) = self.part[triangle + k..triangle + panel.width]
                .split_first_mut()
                .expect("a column");
            for (y_i, l_ik) in rest.iter().zip(&panel.column(k)[1..]) {
                subtract(y_k, *l_ik, y_i);
            }
        }
    }

    /// The rectangle's part of Y ← L⁻¹ Y for C columns.
    fn below_down<const C: usize>(&mut self, panel: &Panel<'_>, k: usize, above: &mut [[f64; B]]) {
        let columns = rectangle::<C>(panel, k);
        let first = panel.start - self.first + k;
        let x: [[f64; B]; C] = std::array::from_fn(|k| self.part[first + k]);
        let n_inside = panel.below.partition_point(|&i| (i as usize) < self.beyond);
        for (r, &i) in panel.below.iter().enumerate() {
            let y_i = if r < n_inside {
                &mut self.part[i as usize - self.first]
            } else {
                &mut above[i as usize - self.beyond]
            };
            let mut y = *y_i;
            for k in 0..C {
                subtract(&mut y, columns[k][r], &x[k]);
            }
            *y_i = y;
        }
    }

    /// The rectangle's part of Y ← L⁻ᵀ Y for C columns.
    fn below_up<const C: usize>(&mut self, panel: &Panel<'_>, k: usize, above: &[[f64; B]]) {
        let columns = rectangle::<C>(panel, k);
        let first = panel.start - self.first + k;
        let mut x: [[f64; B]; C] = std::array::from_fn(|k| self.part[first + k]);
        let n_inside = panel.below.partition_point(|&i| (i as usize) < self.beyond);
        for (r, &i) in panel.below.iter().enumerate() {
            let y_i = if r < n_inside {
                self.part[i as usize - self.first]
            } else {
                above[i as usize - self.beyond]
            };
            for k in 0..C {
                subtract(&mut x[k], columns[k][r], &y_i);
            }
        }
        self.part[first..first + C].copy_from_slice(&x);
    }
}

/// C columns of the rectangle of a panel.
fn rectangle<'s, const C: usize>(panel: &Panel<'s>, first: usize) -> [&'s [f64]; C] {
    let n_below = panel.below.len();
    std::array::from_fn(|k| {
        let end = (first + k + 1) * panel.n_rows();
        &panel.values[end - n_below..end]
    })
}

/// y ← y − l x.
#[inline(always)]
fn subtract<const B: usize>(y: &mut [f64; B], l: f64, x: &[f64; B]) {
    for v in 0..B {
        y[v] -= l * x[v];
    }
}
