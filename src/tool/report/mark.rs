//! What a movement instruction does besides moving.

use crate::rapid::ir::movement::Movement;

/// `trigger`, `search`, `process`, `output` or `call`; none for an instruction that only moves.
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
