//! Movement instructions without a process.

use super::instruction::MoveForm::{AbsJ, Circular, ExternalJoint, Joint, Linear};
use super::instruction::MoveKind::{Event, Plain, Search};
use super::instruction::{Instruction, MoveForm, MoveKind, plain};

const fn movement(
    name: &'static str,
    form: MoveForm,
    kind: MoveKind,
    arguments: &'static str,
) -> Instruction {
    plain(name, arguments).moving(form, kind)
}

const TO_POINT: &str = "ToPoint \\ID Speed \\T Zone Tool \\WObj Signal Value \\TLoad";
const TO_CIRCLE: &str = "CirPoint ToPoint \\ID Speed \\T Zone Tool \\WObj Signal Value \\TLoad";
const GROUP_TO_POINT: &str =
    "ToPoint \\ID Speed \\T Zone Tool \\WObj Signal \\Value \\DValue \\TLoad";
const GROUP_TO_CIRCLE: &str =
    "CirPoint ToPoint \\ID Speed \\T Zone Tool \\WObj Signal \\Value \\DValue \\TLoad";
const SYNC_TO_POINT: &str = "ToPoint \\ID Speed \\T Zone Tool \\WObj ProcName \\TLoad";
const SYNC_TO_CIRCLE: &str = "CirPoint ToPoint \\ID Speed \\T Zone Tool \\WObj ProcName \\TLoad";
const MOVE_C: &str =
    "\\Conc CirPoint ToPoint \\ID Speed \\V \\T Zone \\Z \\Inpos Tool \\WObj \\Corr \\TLoad";
const MOVE_L: &str =
    "\\Conc ToPoint \\ID Speed \\V \\T Zone \\Z \\Inpos Tool \\WObj \\Corr \\TLoad";
const MOVE_ABS_J: &str =
    "\\Conc ToJointPos \\ID \\NoEOffs Speed \\V \\T Zone \\Z \\Inpos Tool \\WObj \\TLoad";
const SEARCH_L: &str = "\\Stop \\PStop \\SStop \\Sup Signal:signaldi \\Flanks \\PosFlank \\NegFlank \
    \\HighLevel \\LowLevel SearchPoint= ToPoint \\ID Speed \\V \\T Tool \\WObj \\Corr \\TLoad";
const SEARCH_C: &str = "\\Stop \\PStop \\SStop \\Sup Signal:signaldi \\Flanks \\PosFlank \\NegFlank \
    \\HighLevel \\LowLevel SearchPoint= CirPoint ToPoint \\ID Speed \\V \\T Tool \\WObj \\Corr \\TLoad";
const SEARCH_EXT_J: &str = "\\Stop \\PStop \\SStop \\Sup Signal:signaldi \\Flanks \\PosFlank \
    \\NegFlank \\HighLevel \\LowLevel SearchJointPos= ToJointPos \\ID \\UseEOffs Speed \\T";
const TRIGG_ABS_J: &str = "\\Conc ToJointPos \\ID \\NoEOffs Speed \\T Trigg_1 \\T2 \\T3 \\T4 \\T5 \
    \\T6 \\T7 \\T8 Zone \\Inpos Tool \\WObj \\TLoad";
const TRIGG_C: &str = "\\Conc CirPoint ToPoint \\ID Speed \\T Trigg_1 \\T2 \\T3 \\T4 \\T5 \\T6 \\T7 \
    \\T8 Zone \\Inpos Tool \\WObj \\Corr \\TLoad";
const TRIGG_J: &str = "\\Conc ToPoint \\ID Speed \\T Trigg_1 \\T2 \\T3 \\T4 \\T5 \\T6 \\T7 \\T8 Zone \
    \\Inpos Tool \\WObj \\TLoad";
const TRIGG_L: &str = "\\Conc ToPoint \\ID Speed \\T Trigg_1 \\T2 \\T3 \\T4 \\T5 \\T6 \\T7 \\T8 Zone \
    \\Inpos Tool \\WObj \\Corr \\TLoad";
const TRIGG_J_IOS: &str = "ToPoint \\ID Speed \\T \\TriggData1 \\TriggData2 \\TriggData3 Zone \
    \\Inpos Tool \\WObj \\TLoad";
const TRIGG_L_IOS: &str = "\\Conc ToPoint \\ID Speed \\T \\TriggData1 \\TriggData2 \\TriggData3 Zone \
    \\Inpos Tool \\WObj \\Corr \\TLoad";

pub(super) const INSTRUCTIONS: &[Instruction] = &[
    movement("MoveAbsJ", AbsJ, Plain, MOVE_ABS_J),
    movement("MoveC", Circular, Plain, MOVE_C),
    movement("MoveCAO", Circular, Event, TO_CIRCLE),
    movement("MoveCDO", Circular, Event, TO_CIRCLE),
    movement("MoveCGO", Circular, Event, GROUP_TO_CIRCLE),
    movement("MoveCSync", Circular, Event, SYNC_TO_CIRCLE),
    movement(
        "MoveExtJ",
        ExternalJoint,
        Event,
        "\\Conc ToJointPos \\ID \\UseEOffs Speed \\T Zone \\Inpos",
    ),
    movement(
        "MoveJ",
        Joint,
        Plain,
        "\\Conc ToPoint \\ID Speed \\V \\T Zone \\Z \\Inpos Tool \\WObj \\TLoad",
    ),
    movement("MoveJAO", Joint, Event, TO_POINT),
    movement("MoveJDO", Joint, Event, TO_POINT),
    movement("MoveJGO", Joint, Event, GROUP_TO_POINT),
    movement("MoveJSync", Joint, Event, SYNC_TO_POINT),
    movement("MoveL", Linear, Plain, MOVE_L),
    movement("MoveLAO", Linear, Event, TO_POINT),
    movement("MoveLDO", Linear, Event, TO_POINT),
    movement("MoveLGO", Linear, Event, GROUP_TO_POINT),
    movement("MoveLSync", Linear, Event, SYNC_TO_POINT),
    movement("MovePnP", Linear, Event, "ToPoint Speed Zone Tool \\WObj \\TLoad"),
    movement("SearchC", Circular, Search, SEARCH_C),
    movement("SearchExtJ", ExternalJoint, Search, SEARCH_EXT_J),
    movement("SearchL", Linear, Search, SEARCH_L),
    movement("TriggAbsJ", AbsJ, Event, TRIGG_ABS_J),
    movement("TriggC", Circular, Event, TRIGG_C),
    movement("TriggJ", Joint, Event, TRIGG_J),
    movement("TriggJIOs", Joint, Event, TRIGG_J_IOS),
    movement("TriggL", Linear, Event, TRIGG_L),
    movement("TriggLIOs", Linear, Event, TRIGG_L_IOS),
];
