//! Plots as inline SVG, written without a plotting library: colours come from the style sheet by
//! class, so one plot works for light, dark and print and single curves can be hidden; text stays
//! text.

mod cells;
mod escape;
mod frame;
mod gantt;
mod plot;
mod polyline;
mod scale;

pub use cells::{Cells, Shade};
pub use escape::escape;
pub use frame::{Frame, Size};
pub use gantt::{Bar, Row, gantt, histogram};
pub use plot::{Curve, NEAR, Plot, Rule};
pub use polyline::{MAX_POINTS, points, simplify};
pub use scale::Scale;
