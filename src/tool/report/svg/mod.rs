//! Plots as inline SVG.
//!
//! Written here rather than with a plotting library: colours come from the page's style sheet by
//! class, so that one plot serves light, dark and print, and a reader can hide single curves;
//! text stays text; and the little that is needed (ticks, polylines) is less than an adapter.

mod escape;
mod frame;
mod plot;
mod polyline;
mod scale;

pub use escape::escape;
pub use frame::{Frame, Size};
pub use plot::{Curve, NEAR, Plot, Rule};
pub use polyline::{MAX_POINTS, points, simplify};
pub use scale::Scale;
