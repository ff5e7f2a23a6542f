//! Instructions that change how movements run, and that stop or start motion.

use super::instruction::Effect::{Ends, Unmodelled, Wait};
use super::instruction::Wait::Outside;
use super::instruction::{Instruction, Setting, plain, setting, unknown, writing};

/// A setting that is not simulated.
const fn unmodelled(name: &'static str, arguments: &'static str) -> Instruction {
    plain(name, arguments).effect(Unmodelled).changing_motion()
}

const CIRCLE_MODES: &str = "\\PathFrame \\ObjectFrame \\CirPointOri \\Wrist45 \\Wrist46 \\Wrist56";

pub(super) const INSTRUCTIONS: &[Instruction] = &[
    setting("AccSet", "Acc Ramp \\FinePointRamp", Setting::AccSet).on_the_fly(),
    plain("ActUnit", "MechUnit"),
    setting("CirPathMode", CIRCLE_MODES, Setting::CirPathMode).on_the_fly(),
    writing("ClearPath", "").changing_motion(),
    setting("ConfJ", "\\On \\Off", Setting::ConfJ).on_the_fly(),
    setting("ConfL", "\\On \\Off", Setting::ConfL).on_the_fly(),
    plain("CorrClear", "").effect(Ends(&["corrcon"])).changing_motion(),
    unmodelled("CorrCon", "Descr"),
    plain("CorrDiscon", "Descr").effect(Ends(&["corrcon"])).changing_motion(),
    plain("CorrWrite", "Descr Data").changing_motion(),
    plain("DeactUnit", "MechUnit"),
    plain("EGMReset", "EGMid"),
    plain("EOffsOff", "").effect(Ends(&["eoffsset", "eoffson"])).changing_motion(),
    unmodelled("EOffsOn", "\\ExeP ProgPoint"),
    unmodelled("EOffsSet", "EAxOffs"),
    setting("GripLoad", "Load", Setting::GripLoad),
    plain("IndReset", "MecUnit Axis \\RefPos \\RefNum \\Short \\Fwd \\Bwd \\Old"),
    plain("MechUnitLoad", "MechUnit AxisNo Load"),
    setting("MotionProcessModeSet", "Mode", Setting::MotionProcessMode),
    plain("MotionSup", "\\On \\Off \\TuneValue").on_the_fly(),
    setting("PathAccLim", "AccLim \\AccMax DecelLim \\DecelMax", Setting::PathAccLim).on_the_fly(),
    unknown("PathRecStart", "ID").effect(Unmodelled),
    unknown("PathRecStop", "\\Clear").effect(Ends(&["pathrecstart"])),
    setting("PathResol", "PathSampleTime", Setting::PathResol),
    setting("PDispOff", "", Setting::PDispOff),
    setting("PDispOn", "\\Rot \\ExeP ProgPoint Tool \\WObj", Setting::PDispOn),
    setting("PDispSet", "DispFrame", Setting::PDispSet),
    plain("ResetAxisDistance", "MechUnit AxisNo"),
    plain("RestoPath", ""),
    setting("SetSysData", "SourceObject \\ObjectName", Setting::SystemData),
    setting("SingArea", "\\Wrist \\LockAxis4 \\Arm \\Base \\Off", Setting::SingArea).on_the_fly(),
    unmodelled("SoftAct", "\\MechUnit Axis Softness \\Ramp"),
    plain("SoftDeact", "\\Ramp").effect(Ends(&["softact"])).changing_motion(),
    unmodelled("SpeedLimAxis", "MechUnit AxisNo AxisSpeed"),
    plain("SpeedLimCheckPoint", "RobSpeed"),
    setting("SpeedRefresh", "Override", Setting::SpeedRefresh).on_the_fly(),
    plain("StartMove", "\\AllMotionTasks"),
    unknown("StepBwdPath", "StepLength StepTime").changing_motion(),
    plain("StopMove", "\\Quick \\AllMotionTasks"),
    plain("StopMoveReset", "\\AllMotionTasks"),
    plain("StorePath", "\\KeepSync"),
    plain("SyncMoveOff", "SyncID \\TimeOut").effect(Wait(Outside)),
    plain("SyncMoveOn", "SyncID TaskList \\TimeOut").effect(Wait(Outside)),
    plain("SyncMoveResume", ""),
    plain("SyncMoveSuspend", ""),
    plain("SyncMoveUndo", ""),
    plain("TuneReset", "").effect(Ends(&["tuneservo"])).changing_motion(),
    unmodelled("TuneServo", "MecUnit Axis TuneValue \\Type"),
    setting("VelSet", "Override Max", Setting::VelSet).on_the_fly(),
    setting("WorldAccLim", "\\On \\Off", Setting::WorldAccLim).on_the_fly(),
];
