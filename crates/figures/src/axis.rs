//! One axis: from values to places on the page, and its ticks.
//!
//! Linear ticks stand at multiples of 1, 2 or 5 · 10ⁿ, logarithmic ones at powers of ten.

use super::canvas::Point;
use super::error::FigureError;
use super::label::Label;

/// How values turn into lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Lengths follow values.
    #[default]
    Linear,
    /// Lengths follow log₁₀ of the values; values of zero or less cannot be drawn.
    Log,
}

impl Scale {
    /// What is drawn to scale: the value, or its logarithm; none for what has no place.
    pub(super) fn transform(self, value: f64) -> Option<f64> {
        let transformed = match self {
            Self::Linear => value,
            Self::Log => value.log10(),
        };
        transformed.is_finite().then_some(transformed)
    }
}

/// A tick, with a number or without.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// Place on the page along the axis.
    pub(super) at: f64,
    /// Its number; none for a minor tick.
    pub(super) label: Option<Label>,
}

/// An axis laid over a stretch of the page.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    scale: Scale,
    /// Transformed values at the two ends.
    from: f64,
    to: f64,
    /// Places on the page of the two ends, in points.
    start: f64,
    end: f64,
}

/// The two axes laid over a frame.
#[derive(Clone, Copy)]
pub(super) struct Axes {
    pub(super) x: Axis,
    pub(super) y: Axis,
}

impl Axes {
    /// Where a point stands on the page; none for what cannot be drawn.
    pub(super) fn at(&self, x: f64, y: f64) -> Option<Point> {
        Some([self.x.at(x)?, self.y.at(y)?])
    }
}

/// Places far outside the page are kept within this many points, so that coordinates stay short.
const FAR: f64 = 1e5;

/// Intervals between numbers on one axis, at most; more say nothing to the eye.
const MOST_INTERVALS: f64 = 8.0;

/// Extents below this are drawn as none: their ticks would be lost in rounding.
const SMALLEST_EXTENT: f64 = 1e-290;

/// Ranges beyond this are refused: their steps would overflow.
const LARGEST: f64 = 1e300;

impl Axis {
    /// Lays a range, in transformed values, over the page from `start` to `end`.
    pub(super) fn new(scale: Scale, [from, to]: [f64; 2], [start, end]: [f64; 2]) -> Self {
        Self { scale, from, to, start, end }
    }

    /// Where a value stands on the page; none for a value that cannot be drawn.
    pub(super) fn at(&self, value: f64) -> Option<f64> {
        self.scale.transform(value).map(|t| self.place(t))
    }

    /// Whether a value lies within the range.
    pub(super) fn holds(&self, value: f64) -> bool {
        self.scale.transform(value).is_some_and(|t| t >= self.from && t <= self.to)
    }

    /// Major and minor ticks in ascending order, majors at least `spacing` points apart.
    pub(super) fn ticks(&self, spacing: f64) -> Vec<Tick> {
        let most = ((self.end - self.start).abs() / spacing).floor().clamp(1.0, MOST_INTERVALS);
        match self.scale {
            Scale::Linear => self.linear_ticks(most),
            Scale::Log => self.log_ticks(most),
        }
    }

    fn place(&self, transformed: f64) -> f64 {
        let share = (transformed - self.from) / (self.to - self.from);
        (self.start + share * (self.end - self.start)).clamp(-FAR, FAR)
    }

    fn linear_ticks(&self, most: f64) -> Vec<Tick> {
        let (leading, exponent) = nice_step((self.to - self.from) / most);
        let step = leading * 10f64.powi(exponent);
        let minors = if leading == 5.0 { 5 } else { 2 };
        let minor_step = step / f64::from(minors);
        // The slack keeps a tick on the very end of the range.
        let first = (self.from / minor_step - 1e-6).ceil() as i64;
        let last = (self.to / minor_step + 1e-6).floor() as i64;
        let largest = self.from.abs().max(self.to.abs());
        (first..=last)
            .map(|k| {
                let major = k.rem_euclid(minors.into()) == 0;
                let value = k as f64 * minor_step;
                let label = major.then(|| number(value, exponent, largest));
                Tick { at: self.place(value), label }
            })
            .collect()
    }

    fn log_ticks(&self, most: f64) -> Vec<Tick> {
        let decades = self.to - self.from;
        let step = (decades / most).ceil().max(1.0) as i64;
        let first = self.from.floor() as i64;
        let last = (self.to + 1e-9).floor() as i64;
        let mut ticks = Vec::new();
        for decade in first..=last {
            let label = (decade.rem_euclid(step) == 0)
                .then(|| Label::text("10").superscript(&decade.to_string()));
            let digits = if step == 1 { 1..=9 } else { 1..=1 };
            ticks.extend(
                digits
                    .map(|digit| (decade as f64 + f64::from(digit).log10(), digit))
                    .map(|(t, digit)| (t, if digit == 1 { label.clone() } else { None })),
            );
        }
        ticks.retain(|&(t, _)| t >= self.from - 1e-9 && t <= self.to + 1e-9);
        ticks.into_iter().map(|(t, label)| Tick { at: self.place(t), label }).collect()
    }
}

/// The smallest of 1, 2, 5 · 10ⁿ that is not under `raw`, as leading digit and exponent.
fn nice_step(raw: f64) -> (f64, i32) {
    let exponent = raw.log10().floor() as i32;
    let leading = raw / 10f64.powi(exponent);
    match [1.0, 2.0, 5.0].into_iter().find(|&nice| leading <= nice * (1.0 + 1e-9)) {
        Some(nice) => (nice, exponent),
        None => (1.0, exponent + 1),
    }
}

/// A number to the decimals of its step, 10^exponent; very large or small ones as a · 10ⁿ.
fn number(value: f64, exponent: i32, largest: f64) -> Label {
    let plain = |v: f64, decimals: i32| {
        let text = format!("{v:.*}", decimals.max(0) as usize);
        // Rounding may leave a minus sign before a zero.
        let is_zero = text.chars().all(|c| matches!(c, '-' | '.' | '0'));
        if is_zero { text.replace('-', "") } else { text.replace('-', "−") }
    };
    if largest < 1e5 && exponent >= -4 {
        return Label::text(plain(value, -exponent));
    }
    if value == 0.0 {
        return Label::text("0");
    }
    let power = largest.log10().floor() as i32;
    let mantissa = plain(value / 10f64.powi(power), power - exponent);
    Label::text(format!("{mantissa}×10")).superscript(&power.to_string())
}

/// The range of an axis in transformed values: what was asked for, or what the data cover with a
/// margin (`margin` over the extent on either side; whole decades on a logarithmic axis).
///
/// None when there is nothing that can be drawn.
///
/// # Errors
/// [`FigureError::BadRange`] where the ends asked for do not ascend or cannot be drawn, or where
/// the data reach beyond 1e300.
pub(super) fn range(
    values: impl Iterator<Item = f64>,
    asked: Option<[f64; 2]>,
    scale: Scale,
    margin: f64,
    panel: &str,
) -> Result<Option<[f64; 2]>, FigureError> {
    let bad = |from, to| FigureError::BadRange { panel: panel.into(), from, to };
    if let Some([from, to]) = asked {
        let ends = scale.transform(from).zip(scale.transform(to));
        let (low, high) = ends.ok_or(bad(from, to))?;
        let is_range = low >= -LARGEST && high <= LARGEST && high - low > SMALLEST_EXTENT;
        return if is_range { Ok(Some([low, high])) } else { Err(bad(from, to)) };
    }
    let extent =
        values.filter_map(|v| scale.transform(v)).fold(None, |extent: Option<[f64; 2]>, t| {
            Some(extent.map_or([t, t], |[low, high]| [low.min(t), high.max(t)]))
        });
    let Some([low, high]) = extent else { return Ok(None) };
    let padded = match scale {
        Scale::Log => [low.floor(), (low.floor() + 1.0).max(high.ceil())],
        // A constant still needs an extent to be drawn in, and so does what nearly is one.
        Scale::Linear if high - low <= (1e-9 * low.abs().max(high.abs())).max(SMALLEST_EXTENT) => {
            let half = if low.abs() <= SMALLEST_EXTENT { 1.0 } else { 0.1 * low.abs() };
            [low - half, high + half]
        }
        Scale::Linear => [low - margin * (high - low), high + margin * (high - low)],
    };
    let is_small = padded.iter().all(|end| end.abs() <= LARGEST);
    if is_small { Ok(Some(padded)) } else { Err(bad(low, high)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(axis: Axis, spacing: f64) -> Vec<String> {
        let text = |l: &Label| l.pieces(1.0).into_iter().map(|p| p.text).collect::<String>();
        axis.ticks(spacing).iter().filter_map(|t| t.label.as_ref().map(text)).collect()
    }

    fn linear(from: f64, to: f64) -> Axis {
        Axis::new(Scale::Linear, [from, to], [0.0, 100.0])
    }

    #[test]
    fn ticks_from_one_to_five_are_the_integers() {
        assert_eq!(numbers(linear(1.0, 5.0), 20.0), ["1", "2", "3", "4", "5"]);
    }

    #[test]
    fn decimals_follow_the_step_and_zero_has_no_sign() {
        assert_eq!(numbers(linear(-0.52, 0.5), 30.0), ["−0.5", "0.0", "0.5"]);
        assert_eq!(numbers(linear(0.1, 1.3), 30.0), ["0.5", "1.0"]);
    }

    #[test]
    fn very_small_numbers_carry_a_power_of_ten() {
        assert_eq!(numbers(linear(0.0, 2e-9), 50.0), ["0", "1×10−9", "2×10−9"]);
        assert_eq!(numbers(linear(0.0, 2e7), 50.0), ["0", "1×107", "2×107"]);
    }

    #[test]
    fn many_decades_are_thinned_out_evenly() {
        let axis = Axis::new(Scale::Log, [-16.0, 1.0], [0.0, 100.0]);
        assert_eq!(numbers(axis, 25.0), ["10−15", "10−10", "10−5", "100"]);
    }

    #[test]
    fn a_value_at_the_middle_of_the_decades_stands_in_the_middle() {
        let axis = Axis::new(Scale::Log, [-2.0, 2.0], [200.0, 0.0]);
        assert_eq!(axis.at(1.0), Some(100.0));
        assert_eq!([axis.at(0.0), axis.at(-1.0), axis.at(f64::NAN)], [None; 3]);
    }

    #[test]
    fn constant_data_get_an_extent_and_no_data_get_none() {
        let of = |values: &[f64]| range(values.iter().copied(), None, Scale::Linear, 0.0, "(a)");
        assert_eq!(of(&[3.0, 3.0]).unwrap(), Some([2.7, 3.3]));
        assert_eq!(of(&[0.0]).unwrap(), Some([-1.0, 1.0]));
        assert_eq!(of(&[f64::NAN, f64::INFINITY]).unwrap(), None);
        assert!(matches!(of(&[-1.7e308, 1.7e308]), Err(FigureError::BadRange { .. })));
    }

    #[test]
    fn descending_or_logarithmically_impossible_ends_are_refused() {
        let ask = |ends, scale| range([].into_iter(), Some(ends), scale, 0.0, "(a)");
        assert!(ask([1.0, 0.0], Scale::Linear).is_err());
        assert!(ask([0.0, 1.0], Scale::Log).is_err());
        assert_eq!(ask([0.1, 10.0], Scale::Log).unwrap(), Some([-1.0, 1.0]));
    }
}
