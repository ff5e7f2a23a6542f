//! Electrical power: what a robot takes now against what it took when the model was believed.
//!
//! Power has no nominal model, so a reference is fitted to the baseline: base power, losses of each joint
//! and of the drives, the share of braking power that is given back, and the lag of the meter,
//! `P = L·(base + g(S)·S)`, `S = Σ τ q̇ + Σ k τ² + c Σ |τ q̇|`; `g` differs with the sign of `S`.

mod cause;
mod diagnose;
mod found;
mod powers;
mod reference;
mod weighing;

pub use diagnose::diagnose_power;
pub use found::{PowerEffect, PowerFound};
pub use powers::Powers;
