//! Process instructions: welding or dispensing during a movement.
//!
//! Arguments: application manuals of arc welding, spot welding, dispensing and the Continuous
//! Application Platform. Instructions with uncertain arguments are left out: an unknown
//! instruction counts as one that may move the robot.

use super::instruction::MoveForm::{AbsJ, Circular, ExternalJoint, Joint, Linear};
use super::instruction::MoveKind::{Application, ArcWeld, Dispense, SpotWeld, Transfer};
use super::instruction::{Instruction, plain};

const TO_POINT: &str = "ToPoint \\ID Speed Seam Weld \\Weave Zone Tool \\WObj \\Track \\TLoad";
const TO_CIRCLE: &str =
    "CirPoint ToPoint \\ID Speed Seam Weld \\Weave Zone Tool \\WObj \\Track \\TLoad";

const fn arc_l(name: &'static str) -> Instruction {
    plain(name, TO_POINT).moving(Linear, ArcWeld)
}

const fn arc_c(name: &'static str) -> Instruction {
    plain(name, TO_CIRCLE).moving(Circular, ArcWeld)
}

pub(super) const INSTRUCTIONS: &[Instruction] = &[
    arc_c("ArcC"),
    arc_c("ArcC1"),
    arc_c("ArcC1End"),
    arc_c("ArcC1Start"),
    arc_c("ArcC2"),
    arc_c("ArcC2End"),
    arc_c("ArcC2Start"),
    arc_c("ArcCEnd"),
    arc_c("ArcCStart"),
    arc_l("ArcL"),
    arc_l("ArcL1"),
    arc_l("ArcL1End"),
    arc_l("ArcL1Start"),
    arc_l("ArcL2"),
    arc_l("ArcL2End"),
    arc_l("ArcL2Start"),
    arc_l("ArcLEnd"),
    arc_l("ArcLStart"),
    plain("ArcMoveAbsJ", "ToJointPos \\ID Speed Zone Tool \\WObj").moving(AbsJ, Transfer),
    plain("ArcMoveC", "CirPoint ToPoint \\ID Speed Zone Tool \\WObj").moving(Circular, Transfer),
    plain("ArcMoveExtJ", "ToJointPos \\ID Speed Zone").moving(ExternalJoint, Transfer),
    plain("ArcMoveJ", "ToPoint \\ID Speed Zone Tool \\WObj").moving(Joint, Transfer),
    plain("ArcMoveL", "ToPoint \\ID Speed Zone Tool \\WObj").moving(Linear, Transfer),
    plain("CapC", "CirPoint ToPoint \\ID Speed Cdata Weavestart Weave Zone \\Inpos Tool \\WObj")
        .moving(Circular, Application),
    plain("CapL", "ToPoint \\ID Speed Cdata Weavestart Weave Zone \\Inpos Tool \\WObj")
        .moving(Linear, Application),
    plain("DispC", "\\On \\Off CirPoint ToPoint Speed Bead Zone Tool \\WObj")
        .moving(Circular, Dispense),
    plain("DispL", "\\On \\Off ToPoint Speed Bead Zone Tool \\WObj").moving(Linear, Dispense),
    plain("SpotJ", "ToPoint \\ID Speed Gun Spot \\InPos Tool \\WObj").moving(Joint, SpotWeld),
    plain("SpotL", "ToPoint \\ID Speed Gun Spot \\InPos Tool \\WObj").moving(Linear, SpotWeld),
];
