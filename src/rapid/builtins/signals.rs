//! Waits, signals, interrupts, trigger events and world zones.

use super::instruction::Effect::{Output, Wait as Waits, ZoneOutput};
use super::instruction::{Instruction, Level, Wait, plain, writing};

/// An instruction that waits.
const fn wait(name: &'static str, arguments: &'static str, wait: Wait) -> Instruction {
    plain(name, arguments).effect(Waits(wait))
}

/// An instruction that sets an output.
const fn output(name: &'static str, arguments: &'static str, level: Level) -> Instruction {
    plain(name, arguments).effect(Output(level))
}

const WAIT_AI: &str =
    "Signal:signalai \\LT \\GT Value \\MaxTime \\ValueAtTimeout \\TimeFlag \\Visualize";
const WAIT_AO: &str =
    "Signal:signalao \\LT \\GT Value \\MaxTime \\ValueAtTimeout \\TimeFlag \\Visualize";
const WAIT_GI: &str =
    "Signal:signalgi \\NOTEQ \\LT \\GT Value \\MaxTime \\ValueAtTimeout \\TimeFlag";
const WAIT_GO: &str =
    "Signal:signalgo \\NOTEQ \\LT \\GT Value \\MaxTime \\ValueAtTimeout \\TimeFlag";
const I_ANALOG_IN: &str = "\\Single \\SingleSafe Signal:signalai Condition HighValue LowValue \
    DeltaValue \\DPos \\DNeg Interrupt";
const I_ANALOG_OUT: &str = "\\Single \\SingleSafe Signal:signalao Condition HighValue LowValue \
    DeltaValue \\DPos \\DNeg Interrupt";

pub(super) const INSTRUCTIONS: &[Instruction] = &[
    plain("IDelete", "Interrupt"),
    plain("IDisable", ""),
    plain("IEnable", ""),
    output("InvertDO", "Signal:signaldo", Level::Inverse),
    writing("IPers", "\\Single \\SingleSafe Name Interrupt"),
    writing("ISignalAI", I_ANALOG_IN),
    writing("ISignalAO", I_ANALOG_OUT),
    writing("ISignalDI", "\\Single \\SingleSafe Signal:signaldi TriggValue Interrupt"),
    writing("ISignalDO", "\\Single \\SingleSafe Signal:signaldo TriggValue Interrupt"),
    writing("ISignalGI", "\\Single \\SingleSafe Signal:signalgi Interrupt"),
    writing("ISignalGO", "\\Single \\SingleSafe Signal:signalgo Interrupt"),
    plain("ISleep", "Interrupt"),
    writing("ITimer", "\\Single \\SingleSafe Time Interrupt"),
    writing("IVarValue", "Device VarNo Value Interrupt \\Unit \\DeadBand \\ReportAtTool"),
    plain("IWatch", "Interrupt"),
    output("PulseDO", "\\High \\PLength Signal:signaldo", Level::Pulse),
    output("Reset", "Signal:signaldo", Level::Low),
    output("Set", "Signal:signaldo", Level::High),
    output("SetAO", "Signal:signalao Value", Level::Given),
    output("SetDO", "\\SDelay \\Sync Signal:signaldo Value", Level::Given),
    output("SetGO", "\\SDelay Signal:signalgo Value", Level::Given),
    writing(
        "TriggCheckIO",
        "TriggData Distance \\Start \\Time Signal Relation CheckValue \\StopMove Interrupt",
    ),
    writing("TriggEquip", "TriggData Distance \\Start EquipLag \\DOp \\GOp \\AOp SetValue"),
    writing("TriggInt", "TriggData Distance \\Start \\Time Interrupt"),
    writing("TriggIO", "TriggData Distance \\Start \\Time \\DOp \\GOp \\AOp SetValue \\DODelay"),
    writing("TriggSpeed", "TriggData Distance \\Start ScaleLag AOp ScaleValue \\DipLag \\ErrDO"),
    writing("TriggStopProc", "RestartRef \\DO1 \\GO1 \\GO2 \\GO3 \\GO4 ShadowDO"),
    wait("WaitAI", WAIT_AI, Wait::Input),
    wait("WaitAO", WAIT_AO, Wait::Output),
    wait("WaitDI", "Signal:signaldi Value \\MaxTime \\TimeFlag \\Visualize", Wait::Input),
    wait("WaitDO", "Signal:signaldo Value \\MaxTime \\TimeFlag \\Visualize", Wait::Output),
    wait("WaitGI", WAIT_GI, Wait::Input),
    wait("WaitGO", WAIT_GO, Wait::Output),
    writing("WaitLoad", "\\UnloadPath \\UnloadFile LoadNo \\CheckRef").effect(Waits(Wait::Outside)),
    wait("WaitRob", "\\InPos \\ZeroSpeed", Wait::Standstill),
    writing("WaitSensor", "MechUnit \\RelDist \\PredTime \\MaxTime \\TimeFlag")
        .effect(Waits(Wait::Outside)),
    wait("WaitSync", "SyncID", Wait::Outside),
    wait("WaitSyncTask", "\\InPos SyncID TaskList \\TimeOut", Wait::Outside),
    wait("WaitTestAndSet", "Object=", Wait::Outside),
    wait("WaitTime", "\\InPos Time", Wait::Time),
    wait("WaitUntil", "\\InPos Cond \\MaxTime \\TimeFlag \\PollRate \\Visualize", Wait::Condition),
    wait("WaitWObj", "WObj \\RelDist \\PredTime \\MaxTime \\TimeFlag", Wait::Outside),
    plain("WZBoxDef", "\\Inside \\Outside Shape= LowPoint HighPoint"),
    plain("WZCylDef", "\\Inside \\Outside Shape= CentrePoint Radius Height"),
    plain("WZDisable", "WorldZone="),
    plain("WZDOSet", "\\Temp \\Stat WorldZone= \\Inside \\Before Shape Signal SetValue")
        .effect(ZoneOutput),
    plain("WZEnable", "WorldZone="),
    plain("WZFree", "WorldZone="),
    plain("WZHomeJointDef", "\\Inside \\Outside Shape= MiddleJointVal DeltaJointVal"),
    plain("WZLimJointDef", "\\Inside \\Outside Shape= LowJointVal HighJointVal"),
    plain("WZLimSup", "\\Temp \\Stat WorldZone= Shape"),
    plain("WZSphDef", "\\Inside \\Outside Shape= CentrePoint Radius"),
];
