//! Look-up by name.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::function::Function;
use super::instruction::{Instruction, MoveSignature};
use super::{communication, functions, movements, processes, program, settings, signals};

/// The tables of the instructions, one for each topic.
pub(super) const INSTRUCTIONS: [&[Instruction]; 7] = [
    communication::INSTRUCTIONS,
    movements::INSTRUCTIONS,
    processes::INSTRUCTIONS,
    program::DOUBTFUL,
    program::INSTRUCTIONS,
    settings::INSTRUCTIONS,
    signals::INSTRUCTIONS,
];

static BY_NAME: LazyLock<HashMap<String, &Instruction>> = LazyLock::new(|| {
    let all = INSTRUCTIONS.into_iter().flatten();
    all.map(|entry| (entry.name.to_lowercase(), entry)).collect()
});

/// Computed once, because the executor needs one for each movement.
static SIGNATURES: LazyLock<HashMap<&str, MoveSignature>> = LazyLock::new(|| {
    let all = BY_NAME.iter();
    all.filter_map(|(key, entry)| Some((key.as_str(), entry.movement()?))).collect()
});

static FUNCTIONS_BY_NAME: LazyLock<HashMap<String, &Function>> = LazyLock::new(|| {
    functions::FUNCTIONS.iter().map(|entry| (entry.name.to_lowercase(), entry)).collect()
});

/// The instruction of this name; `key` in lower case. A name that is neither here nor in the
/// program may move the robot and write to its arguments.
pub fn instruction(key: &str) -> Option<&'static Instruction> {
    BY_NAME.get(key).copied()
}

/// The function of this name; `key` in lower case.
pub fn function(key: &str) -> Option<&'static Function> {
    FUNCTIONS_BY_NAME.get(key).copied()
}

/// The signature of a movement instruction; `key` in lower case.
pub fn movement(key: &str) -> Option<MoveSignature> {
    SIGNATURES.get(key).copied()
}

/// Whether the procedure of this name (in any case) is an instruction that moves.
pub fn is_movement(name: &str) -> bool {
    instruction(&name.to_ascii_lowercase()).is_some_and(Instruction::is_movement)
}

/// Whether it belongs to the Move, Trigg or Search family, which run no process.
pub fn is_of_move_family(name: &str) -> bool {
    instruction(&name.to_ascii_lowercase()).is_some_and(Instruction::is_of_move_family)
}

/// Whether an undeclared procedure of this name (lower case) may write to its arguments.
pub fn may_write(key: &str) -> bool {
    instruction(key).is_none_or(Instruction::may_write)
}
