//! Program flow, data, clocks, errors, modules and diagnosis.

use super::instruction::Effect::{Count as Counts, ExitCycle, FindsByName, Stop};
use super::instruction::{Count, Instruction, plain, unknown, writing};

const fn counting(name: &'static str, arguments: &'static str, count: Count) -> Instruction {
    writing(name, arguments).effect(Counts(count)).on_the_fly()
}

pub(super) const INSTRUCTIONS: &[Instruction] = &[
    counting("Add", "Name AddValue", Count::Up),
    writing("BitClear", "BitData BitPos"),
    writing("BitSet", "BitData BitPos"),
    writing("BookErrNo", "ErrorName"),
    plain("Break", "").effect(Stop),
    unknown("CallByVar", "Name Number").effect(FindsByName),
    counting("Clear", "Name", Count::Clear),
    plain("ClkReset", "Clock"),
    plain("ClkStart", "Clock"),
    plain("ClkStop", "Clock"),
    counting("Decr", "Name", Count::Down),
    plain("ExitCycle", "").effect(ExitCycle),
    writing("FitCircle", "Points \\NumPoints Plane Center Radius Normal \\RMS \\MaxErr"),
    writing("GetDataVal", "Object \\Block \\TaskRef \\TaskName Value"),
    writing("GetGroupSignalInfo", "Signal StartIndex NoOfSignals"),
    writing("GetSysData", "DestObject \\TaskRef \\TaskName \\ObjectName"),
    writing("GetTrapData", "TrapEvent"),
    counting("Incr", "Name", Count::Up),
    writing("Load", "\\Dynamic FilePath \\File \\CheckRef"),
    unknown("RaiseToUser", "\\Continue \\BreakOff \\ErrorNumber"),
    writing(
        "ReadErrData",
        "TrapEvent ErrorDomain ErrorId ErrorType \\Title \\Str1 \\Str2 \\Str3 \\Str4 \\Str5",
    ),
    plain("ResetRetryCount", ""),
    plain("Save", "\\TaskRef \\TaskName ModuleName \\FilePath \\File"),
    writing("SetAllDataVal", "Type \\TypeMod \\Object \\Hidden Value").effect(FindsByName),
    writing("SetDataSearch", "Type \\TypeMod \\Object \\PersSym \\VarSym \\ConstSym \\InTask"),
    writing("SetDataVal", "Object \\Block \\TaskRef \\TaskName Value").effect(FindsByName),
    writing("SortData", "Data \\NumPoints"),
    plain("SpyOff", ""),
    plain("SpyOn", "File"),
    plain("Stop", "\\NoRegain \\AllMoveTasks").effect(Stop),
    plain("SystemStopAction", "\\Stop \\StopBlock \\Halt"),
    plain("TestSignDefine", "Channel SignalId MechUnit Axis SampleTime"),
    plain("TestSignReset", ""),
    plain("Unload", "\\ErrIfChanged \\Save FilePath \\File"),
];

/// Names that are not in the reference: misspelt, or of another controller.
pub(super) const DOUBTFUL: &[Instruction] = &[
    plain("ActivEventBuffer", ""),
    plain("BreakPoint", ""),
    writing("ErRaise", "ErrorName ErrorId Argument1 Argument2 Argument3 Argument4 Argument5"),
    writing("IRemote", "Interrupt"),
    plain("Kill", ""),
    plain("MotionPlannersOff", ""),
    plain("ProcessShutdown", ""),
    writing("ReadVarr", "Device VarNo Value"),
    plain("ResetPPErr", ""),
    plain("TexTabInstall", "File"),
];
