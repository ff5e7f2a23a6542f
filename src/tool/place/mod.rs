//! Where work objects, the base of the robot or the tool's mounting angle should be: the whole cycle
//! is simulated with their frames moved, and the energy of the candidates is compared.
//!
//! A candidate is the program with other numbers in the declarations of its frames (or the robot at
//! another place). So what is written, what is simulated and what is promised are the same.

mod bounds;
mod candidate;
mod error;
mod frame;
mod limits;
mod placement;
mod pool;
mod search;
mod surrogate;

pub use bounds::{AXES, Bounds};
pub use candidate::Placed;
pub use error::PlaceError;
pub use limits::Room;
pub use placement::{Placement, Refusals};
pub use search::{Best, Count, Found, Goal, Outlook, place};
