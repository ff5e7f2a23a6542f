//! Examination of a diagnosis on logs of real robots: known effects are added to measured torques.
//!
//! The residuals of a case ([`Cases`]) are those of a real robot. Its log is cut into blocks; the blocks form
//! three parts. The effect is added to two parts (`log` and `heldout`), the third part remains as
//! measured (`baseline`). The model of a case is identified from the whole log ([`Arm`]).
//! What that model lacks is in all three parts alike, and a diagnosis must not name it.
//!
//! Each effect of the torque has laws that the library of effects does not have: other functional
//! forms, or differential equations integrated along the measured motion. The size of an
//! effect is chosen from its share of the joint's torque.

mod arm;
mod case;
mod catalogue;
mod cut;
mod environment;
mod error;
mod friction;
mod law;
mod measurement;
mod motion;
mod series;
#[cfg(test)]
mod tests;
mod transmission;
mod visible;

pub use arm::Arm;
pub use case::Cases;
pub use error::InjectError;
