//! Additional actions of a movement instruction.

use crate::rapid::ir::movement::Movement;

/// `trigger`, `search`, `process`, `output` or `call`; `None` for a plain movement.
pub(super) fn mark(movement: &Movement) -> Option<&'static str> {
    if movement.plain {
        return None;
    }
    let key = movement.instruction.to_lowercase();
    Some(match key.as_str() {
        _ if key.starts_with("trigg") => "trigger",
        _ if key.starts_with("search") => "search",
        _ if key.ends_with("sync") => "call",
        _ if key.starts_with("move") => "output",
        _ => "process",
    })
}
