//! What an oscillator does by itself.

/// What the isolated oscillator does, by its largest Lyapunov exponent Λ(0).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Isolated {
    /// Λ(0) > 0.
    #[default]
    Chaotic,
    /// Λ(0) = 0 within its errors: a periodic orbit, or chaos too weak to tell.
    Periodic,
    /// Λ(0) < 0: it comes to rest at a fixed point. Nodes are equal there without any coupling, if all
    /// come to the same one: [`crate::MasterStability::rests`].
    AtRest,
}
