//! The families of instructions that move the robot.

/// Instructions that move the robot along a path, in lower case, ascending.
const MOVEMENTS: [&str; 27] = [
    "moveabsj",
    "movec",
    "movecao",
    "movecdo",
    "movecgo",
    "movecsync",
    "moveextj",
    "movej",
    "movejao",
    "movejdo",
    "movejgo",
    "movejsync",
    "movel",
    "movelao",
    "moveldo",
    "movelgo",
    "movelsync",
    "movepnp",
    "searchc",
    "searchextj",
    "searchl",
    "triggabsj",
    "triggc",
    "triggj",
    "triggjios",
    "triggl",
    "trigglios",
];

/// Whether the procedure of this name (in any case) is an instruction of the
/// Move, Trigg or Search family.
#[must_use]
pub fn is_movement(name: &str) -> bool {
    MOVEMENTS.binary_search(&name.to_ascii_lowercase().as_str()).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn movements_are_told_from_their_neighbours() {
        assert!(MOVEMENTS.is_sorted());
        for name in ["MoveJ", "MOVEABSJ", "triggL", "SearchExtJ", "MoveLDO"] {
            assert!(is_movement(name), "{name}");
        }
        // Conditions, interrupts and procedures that only sound alike.
        for name in ["TriggIO", "TriggEquip", "TriggCheckIO", "MoveHome", "StartMove", "Search"] {
            assert!(!is_movement(name), "{name}");
        }
    }
}
