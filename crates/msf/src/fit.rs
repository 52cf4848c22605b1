//! Least squares through noisy exponents: a straight line where a zero is read off, and a parabola
//! over a wider window, which says by how much bending may move that zero.

use crate::Zero;

/// One exponent, of an orbit of its own: σ and Λ(σ).
pub(crate) type Sample = (f64, f64);

/// A slope counts when its square is this many of its variances.
const CERTAIN_SLOPE: f64 = 4.0;

/// A straight line y = mean + slope (x − centre), with the variances of mean and slope.
pub(crate) struct Line {
    centre: f64,
    mean: f64,
    slope: f64,
    variance_of_mean: f64,
    variance_of_slope: f64,
    /// Mean of (x − centre)².
    spread: f64,
}

impl Line {
    /// Least squares with equal weights; variances from the scatter about the line. None through
    /// fewer than three different points.
    pub fn through(samples: &[Sample]) -> Option<Self> {
        let n = samples.len() as f64;
        let centre = samples.iter().map(|(x, _)| x).sum::<f64>() / n;
        let mean = samples.iter().map(|(_, y)| y).sum::<f64>() / n;
        let spread: f64 = samples.iter().map(|(x, _)| (x - centre).powi(2)).sum();
        if samples.len() < 3 || spread <= 0.0 {
            return None;
        }
        let slope = samples.iter().map(|(x, y)| (x - centre) * (y - mean)).sum::<f64>() / spread;
        let residual: f64 =
            samples.iter().map(|(x, y)| (y - mean - slope * (x - centre)).powi(2)).sum();
        let variance = residual / (n - 2.0);
        Some(Self {
            centre,
            mean,
            slope,
            variance_of_mean: variance / n,
            variance_of_slope: variance / spread,
            spread: spread / n,
        })
    }

    /// Where the line crosses zero, if its slope has the sign expected beyond doubt. The error is
    /// that of the line alone.
    pub fn zero(&self, falling: bool) -> Option<Zero> {
        let certain = self.slope * self.slope > CERTAIN_SLOPE * self.variance_of_slope;
        (certain && (self.slope < 0.0) == falling).then(|| {
            let offset = -self.mean / self.slope;
            let variance = self.variance_of_mean + offset * offset * self.variance_of_slope;
            Zero {
                sigma: self.centre + offset,
                standard_error: variance.sqrt() / self.slope.abs(),
                falling,
                refined: false,
                step_shift: None,
            }
        })
    }

    /// Its slope.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// By how much a curvature, y = … + q (x − centre)², moves the zero of this line.
    pub fn bend(&self, curvature: f64) -> f64 {
        curvature.abs() * self.spread / self.slope.abs()
    }
}

/// The largest |q| that a parabola y = c + b x + q x² through the samples allows: its value and one
/// standard error. None through fewer than five different points.
pub(crate) fn curvature(samples: &[Sample]) -> Option<f64> {
    if samples.len() < 5 {
        return None;
    }
    let n = samples.len() as f64;
    let mean = |of: &dyn Fn(&Sample) -> f64| samples.iter().map(of).sum::<f64>() / n;
    let centre = mean(&|s| s.0);
    let scale = mean(&|s| (s.0 - centre).powi(2)).sqrt();
    if scale <= 0.0 {
        return None;
    }
    // Polynomials that are orthogonal over the samples, in u = (x − centre) / scale: 1, u, p(u).
    let u = |s: &Sample| (s.0 - centre) / scale;
    let third = mean(&|s| u(s).powi(3));
    let p = |s: &Sample| u(s).powi(2) - third * u(s) - 1.0;
    let norm = mean(&|s| p(s).powi(2));
    // Samples at two points only determine no parabola.
    if norm < 1e-9 {
        return None;
    }
    let [c, b, q] = [mean(&|s| s.1), mean(&|s| s.1 * u(s)), mean(&|s| s.1 * p(s)) / norm];
    let residual = mean(&|s| (s.1 - c - b * u(s) - q * p(s)).powi(2)) * n / (n - 3.0);
    let error = (residual / (n * norm)).sqrt();
    Some((q.abs() + error) / scale.powi(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(y: impl Fn(f64) -> f64) -> Vec<Sample> {
        (0..11).map(|k| f64::from(k) / 10.0).map(|x| (x, y(x))).collect()
    }

    #[test]
    fn a_parabola_has_its_curvature_and_bends_the_line_by_it() {
        // Through y = x² − 1/4 the line is x − 2/5 + …: at the zero, 1/2, it is off by q ⟨(x − ½)²⟩.
        let samples = samples(|x| x * x - 0.25);
        let q = curvature(&samples).unwrap();
        assert!((q - 1.0).abs() < 1e-6, "{q}");
        let line = Line::through(&samples).unwrap();
        let zero = line.zero(false).unwrap();
        let bend = line.bend(q);
        assert!(((zero.sigma - 0.5).abs() - bend).abs() < 1e-6, "{zero:?}, bent by {bend}");
    }

    #[test]
    fn too_few_points_determine_nothing() {
        assert!(Line::through(&[(1.0, 0.0), (1.0, 1.0), (1.0, 2.0)]).is_none());
        assert!(curvature(&[(0.0, 1.0), (1.0, 2.0), (0.0, 1.1), (1.0, 2.1), (1.0, 1.9)]).is_none());
    }
}
