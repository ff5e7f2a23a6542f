//! Which data hold state that a controller saves with a program.

use crate::rapid::ir::hir::{Data, DataKind, TypeDefKind};
use crate::rapid::ir::program::Program;

/// Types that define motion: a `PERS` of such a type is taught or calibrated, not counted.
const MOTION: [&str; 7] =
    ["jointtarget", "loaddata", "robtarget", "speeddata", "tooldata", "wobjdata", "zonedata"];
/// Deepest nesting of records that is looked into.
const MAX_DEPTH: usize = 16;

/// Whether the value of data is state: a `PERS` whose type does not define motion.
pub(super) fn is_state(program: &Program, data: &Data) -> bool {
    data.kind == DataKind::Pers && !defines_motion(program, &data.type_name.key, 0)
}

fn defines_motion(program: &Program, type_key: &str, depth: usize) -> bool {
    if MOTION.contains(&type_key) {
        return true;
    }
    if depth >= MAX_DEPTH {
        return false;
    }
    let types = program.modules.iter().flat_map(|module| &module.types);
    let is_below = |ty: &str| defines_motion(program, ty, depth + 1);
    types.filter(|def| def.name.key == type_key).any(|def| match &def.kind {
        TypeDefKind::Record(parts) => parts.iter().any(|(ty, _)| is_below(&ty.key)),
        TypeDefKind::Alias(of) => is_below(&of.key),
    })
}
