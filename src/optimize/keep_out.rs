//! What a movement that may leave its path must not come near: boxes and planes of the cell.

use crate::kinematics::{Body, Tcp};
use crate::motion::timeline::Run;
use crate::robot::Model;

use super::corridor::Freedom;

/// Arm and tool of a run among what the cell keeps free; `None` where the run keeps to its path,
/// which is the program's own choice, or where nothing is to be kept free.
pub fn body<'a>(model: &'a Model, run: &Run, freedom: &Freedom) -> Option<Body<'a>> {
    let free = run.moves.iter().any(|record| freedom.of(&record.movement) > 0.0);
    if !free || freedom.keep_out.is_empty() {
        return None;
    }
    let tool = match &run.legs.first()?.tool {
        Tcp::Held(tool) => tool.translation.vector,
        Tcp::Stationary(_) => nalgebra::Vector3::zeros(),
    };
    Some(Body::new(model, tool, &freedom.keep_out))
}

/// Distance over which room becomes a share of a limit, m.
const SCALE: f64 = 0.1;

/// The room as a share of a limit: 1 where as much is left as is to be kept (m), more where less.
pub(super) fn share(body: &Body<'_>, q: &[f64], kept: f64) -> f64 {
    let [room, _] = body.margins(q);
    (1.0 + (kept - room) / SCALE).max(0.0)
}
