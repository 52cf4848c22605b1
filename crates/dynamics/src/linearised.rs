//! States with a tangent each, and what equations make of them, component by component.

/// States with a tangent each, component by component.
#[derive(Clone, Copy)]
pub struct Linearised<'a> {
    /// The states.
    pub value: &'a [&'a [f64]],
    /// The tangents.
    pub tangent: &'a [&'a [f64]],
}

/// Where slopes of states and of their tangents go, component by component.
pub struct LinearisedMut<'a, 'b> {
    /// F(x).
    pub value: &'a mut [&'b mut [f64]],
    /// DF(x) δ.
    pub tangent: &'a mut [&'b mut [f64]],
}
