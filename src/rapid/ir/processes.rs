//! Process instructions: they weld or dispense while they move the robot.
//!
//! Arguments as in the application manuals of arc welding, spot welding, dispensing and the
//! Continuous Application Platform. Those whose arguments are not certain are left out: an unknown
//! instruction may move the robot anywhere.

use super::instructions::{MoveForm, MoveSignature};

/// The signature of a process instruction; `key` in lower case.
pub(super) fn signature(key: &str) -> Option<MoveSignature> {
    use MoveForm::{AbsJ, Circular, ExternalJoint, Joint, Linear};
    let (form, between, zone) = match key {
        // ToPoint, Speed, Seam, Weld, Zone, Tool
        _ if is_arc(key) => (if key.starts_with("arcc") { Circular } else { Linear }, 2, true),
        // Movements between welds, with the arguments of MoveJ and its kin.
        "arcmovej" => (Joint, 0, true),
        "arcmovel" => (Linear, 0, true),
        "arcmovec" => (Circular, 0, true),
        "arcmoveabsj" => (AbsJ, 0, true),
        "arcmoveextj" => (ExternalJoint, 0, true),
        // ToPoint, Speed, Gun, Spot, Tool
        "spotl" => (Linear, 2, false),
        "spotj" => (Joint, 2, false),
        // ToPoint, Speed, Bead, Zone, Tool
        "displ" => (Linear, 1, true),
        "dispc" => (Circular, 1, true),
        // ToPoint, Speed, Cdata, Weavestart, Weave, Zone, Tool
        "capl" => (Linear, 3, true),
        "capc" => (Circular, 3, true),
        _ => return None,
    };
    Some(MoveSignature { form, before: 0, between, zone, plain: false })
}

/// What the simulation leaves out of a process; `key` in lower case.
pub(super) fn unmodelled(key: &str) -> Option<&'static str> {
    match key {
        _ if is_arc(key) => Some(
            "how fast it welds and how long the arc takes to start is said by its seam and weld \
             data: it is simulated at its speed argument, without waiting",
        ),
        "capl" | "capc" => Some(
            "how fast the process runs and how long it takes to start is said by its process data: \
             it is simulated at its speed argument, without waiting",
        ),
        "spotl" | "spotj" => Some("how long the spot weld takes is not known: it counts 0 s"),
        _ => None,
    }
}

/// Whether an instruction welds with an arc: `ArcL`, `ArcC`, with `1` or `2` for the system, and
/// `Start` or `End`.
fn is_arc(key: &str) -> bool {
    let rest = key.strip_prefix("arcl").or_else(|| key.strip_prefix("arcc"));
    let rest = rest.map(|rest| rest.strip_prefix(['1', '2']).unwrap_or(rest));
    matches!(rest, Some("" | "start" | "end"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn welds_are_told_from_what_sounds_alike() {
        for name in ["arcl", "arclstart", "arc", "arcc2end", "arcc", "arcl1", "arcl1start"] {
            assert_eq!(is_arc(name), name != "arc", "{name}");
        }
        for name in ["arccalcl", "arcmovel", "arcrefresh", "arcl3", "arclstartend"] {
            assert!(!is_arc(name), "{name}");
        }
        assert!(signature("arcrefresh").is_none());
        assert!(unmodelled("arcmovel").is_none());
    }
}
