//! Names of `RobotWare` and its options about which nothing more is stated here.
//!
//! A program that uses one of them is not wrong because no file declares it. Names: RAPID reference
//! of `RobotWare` 6, application manuals of the options.

use std::collections::HashSet;
use std::sync::LazyLock;

use super::data::{error, predefined};
use super::functions::FUNCTIONS;
use super::index::{INSTRUCTIONS, function, instruction};

/// Names, by topic.
const NAMES: &[&str] = &[
    // Base, motion.
    "ActEventBuffer CopyFile CornerPathWarning DeactEventBuffer DitherAct DitherDeact DropSensor",
    "FricIdEvaluate FricIdInit FricIdSetFricLevels HollowWristReset IndAMove IndCMove IndDMove",
    "IndRMove LoadId ManLoadIdProc MToolRotCalib MToolTCPCalib PathLengthReset PathLengthStart",
    "PathLengthStop PathRecMoveBwd PathRecMoveFwd ProcerrRecovery ResetAxisMoveTime",
    "ResetTorqueMargin SetLeadThrough SoftElbow StartMoveRetry SToolRotCalib SToolTCPCalib",
    "SupSyncSensorOff SupSyncSensorOn SyncToSensor TriggDataCopy TriggDataReset TriggRampAO",
    "DropWObj GetJointData BrakeCheck CyclicBrakeCheck MotorTorque CollDetect",
    // Base, program, data, signals.
    "AliasIO AliasIOReset ArgName CancelLoad CheckProgRef ClearIOBuff EraseModule ErrRaise IError",
    "IOBusStart IOBusState IODisable IOEnable IRMQMessage MatrixSolve MatrixSolveQR MatrixSVD",
    "PackDNHeader ReadVar ReadVarArr RemoveAllCyclicBool RemoveCyclicBool RemoveDir ResetPPMoved",
    "RMQEmptyQueue RMQFindSlot RMQSendMessage SCWrite SenDevice SetupCyclicBool SiClose SiConnect",
    "SiGetCyclic SiSetCyclic SkipWarn SpyStart SpyStop StartLoad TextTabInstall TryInt",
    "UIMsgWriteAbort UIShow WarmStart WriteVarArr GetMaxNumberOfCyclicBool GetNextCyclicBool",
    "GetNumberOfCyclicBool IsBrakeCheckActive TextTabGet UIDnumTune SafetyControllerGetChecksum",
    "SafetyControllerGetOpModePinCode SafetyControllerGetSWVersion",
    "SafetyControllerGetUserChecksum SafetyControllerSyncRequest",
    // Servo tools, SoftMove, externally guided motion.
    "STCalib STClose STIndGun STIndGunReset STIsIndGun STIsOpen STOpen STTune STTuneReset",
    "CSSAct CSSDeact CSSDeactMoveL CSSForceOffsetAct CSSForceOffsetDeact CSSOffsetTune",
    "EGMActJoint EGMActMove EGMActPose EGMGetId EGMMoveC EGMMoveL EGMRunJoint EGMRunPose",
    "EGMSetupAI EGMSetupAO EGMSetupGI EGMSetupLTAPP EGMSetupUC EGMStop EGMStreamStart",
    "EGMStreamStop EGMWaitCond",
    // Arc welding, seam tracking.
    "ArcAdaptC ArcAdaptCEnd ArcAdaptL ArcAdaptLEnd ArcAdaptLStart ArcAdaptRepL ArcCalcC",
    "ArcCalcCEnd ArcCalcL ArcCalcLEnd ArcCalcLStart ArcRefresh ArcRepL ArcKill MPLoadPath",
    "MPOffsEaxOnPath MPReadInPath MPSavePath RecoveryMenu RecoveryMenuWR RecoveryPosReset",
    "RecoveryPosSet SetWRProcName PDispAdd PoseAdd OFrameChange SafetyRobT Search_1D Search_2D",
    "Search_3D Search_Groove Search_Part",
    // Spot welding, tool change, dispensing, nuts.
    "Calibrate CalibJ CalibL CloseHighLift IndGunMove IndGunMoveReset MeasureWearL NutJ NutL",
    "OpenHighLift ReCalcTCP SetForce SetTmSignal SpotML SpotMJ SwGetCalibData",
    "SwGetCurrSpotName SwGetCurrTargetName SwGetFixTipData SwSetIntForceData SwSetIntGunData",
    "SwSetIntSimData SwSetIntSpotData SyncWWObj TcCloseCover TcDropOffTool TcLockTool TcOpenCover",
    "TcPickupTool TcUnlockTool GetSignal GetSignalDnum",
    // Conveyor tracking, picking.
    "ActivateProfile CnvGenInstr CnvPredictReach CnvSync DeactProfile GetMaxUsageTime IndCnvAddObject",
    "IndCnvDisable IndCnvEnable IndCnvInit IndCnvReset LoadProfile RecordProfile ResetMaxUsageTime",
    "StoreProfile UseACCProfile UseReachableTargets WaitAndRecProf AckItmTgt FlushItmSrc GetItmTgt",
    "GetQueueLevel GetQueueTopLevel NextItmTgtType PriorityItmTgt QStartItmSrc QStopItmSrc",
    "ResetFlowCount SetItmSrc UseItmSrc",
    // Vision.
    "AliasCamera CamFlush CamGetExposure CamGetLoadedJob CamGetMode CamGetName CamGetParameter",
    "CamGetResult CamLoadJob CamNumberOfResults CamReqImage CamSetExposure CamSetParameter",
    "CamSetProgramMode CamSetRunMode CamStartLoadJob CamStartSetParameter CamWaitLoadJob",
    "CamWaitSetParameter",
    // Continuous and discrete application platform.
    "CapAPTrSetup CapAPTrSetupAI CapAPTrSetupAO CapAPTrSetupPERS CapCondSetDO CapEquiDist",
    "CapGetFailSigs CapLATrSetup CapNoProcess CapRefresh CAPSetStopMode CapWeaveSync ContactL ICap",
    "InitSuperv IPathPos RemoveSuperv SetupSuperv DaActProc DaCheckMMSOpt DaDeactAllProc",
    "DaDeactProc DaDefExtSig DaDefProcData DaDefProcSig DaDefUserData DaGetAppDescr DaGetAppIndex",
    "DaGetCurrData DaGetFstTimeEvt DaGetMP DaGetNumOfProcs DaGetNumOfRob DaGetPrcDescr",
    "DaGetRobotName DaGetTaskName DaProcMJ DaProcML DaSetCurrData DaSetupAppBehav DaStartManAction",
    // Force control, tool calibration.
    "FCAct FCCalib FCCondForce FCCondOrient FCCondPos FCCondReoriSpeed FCCondTCPSpeed FCCondTorque",
    "FCCondWaitWhile FCDeact FCGetForce FCGetProcessData FCIsForceMode FCLoadID FCPress1LStart",
    "FCPressC FCPressEnd FCPressL FCRefCircle FCRefForce FCRefLine FCRefMoveFrame FCRefRot",
    "FCRefSpiral FCRefSprForceCart FCRefStart FCRefStop FCRefTorque FCResetDampingTune",
    "FCResetLPFilterTune FCSetDampingTune FCSetLPFilterTune FCSpdChgAct FCSpdChgDeact",
    "FCSpdChgTunReset FCSpdChgTunSet FCSupvForce FCSupvOrient FCSupvPos FCSupvReoriSpeed",
    "FCSupvTCPSpeed FCSupvTorque BECheckTcp BEDebugState BERefPointer BESetupToolJ BETcpExtend",
    "BEUpdateTcp OffsToolPolar OffsToolXYZ",
    // Sensors, painting, production.
    "PrxActivAndStoreRecord PrxActivRecord PrxDbgStoreRecord PrxDeactRecord PrxGetMaxRecordpos",
    "PrxResetPos PrxResetRecords PrxSetPosOffset PrxSetRecordSampleTime PrxSetSyncalarm",
    "PrxStartRecord PrxStopRecord PrxStoreRecord PrxUseFileRecord ConsoleWrite IndexLookup",
    "IpsCommand IpsGetParam IpsSetParam PaintC PaintCommand PaintL PaintLDO PaintLSig",
    "PntProdUserLog SetBrush SetBrushFac ExecEngine PMgrAtSafe PMgrAtService PMgrAtState",
    "PMgrAtStation PMgrGetNextPart PMgrNextStation PMgrRunMenu PMgrSetNextPart PMgrTaskName",
    "PMgrTaskNumber",
    // Mechanical units as RobotWare names them.
    "ROB_1 ROB_2 ROB_3 ROB_4 ROB_L ROB_R",
    // Data.
    "USINT UINT UDINT ULINT SINT INT DINT LINT OPTIMAL_CYCLE_TIME_MODE LOW_SPEED_ACCURACY_MODE",
    "LOW_SPEED_STIFF_MODE ACCURACY_MODE TRIGG_MODE1 TRIGG_MODE2 TRIGG_MODE3 TOOL_LOAD_ID",
    "PAY_LOAD_ID IRBP_K IRBP_L IRBP_C IRBP_C_INDEX IRBP_T IRBP_R IRBP_A IRBP_B IRBP_D MASS_KNOWN",
    "MASS_WITH_AX3 C_MOTSET C_PROGDISP ARCWELD_ERR SPOTWELD_ERR PAINT_ERR PICKWARE_ERR",
];

/// Starts of the names of constants: error numbers, states and modes of options.
const CONSTANTS: &[&str] = &[
    "ALL_DOMAINS",
    "AW_",
    "BUSSTATE_",
    "CAP_",
    "CORR_",
    "CSS_",
    "CT_",
    "EE_",
    "EGM_",
    "EIO_DOMAIN",
    "ERR_",
    "FC_",
    "GAP_",
    "IOBUS_",
    "IOUNIT_",
    "LTAPP__",
    "MMC_DOMAIN",
    "MOC_DOMAIN",
    "MPM_",
    "OP_",
    "PM_",
    "PROC_DOMAIN",
    "ROB_LM1_LOAD_VAL",
    "ROB_LOAD_VAL",
    "ROB_NOT_LOAD_VAL",
    "SEN_",
    "SIGORIG_",
    "SIO_DOMAIN",
    "STATE_",
    "SYS_DOMAIN",
    "SYS_ERR_",
    "TC_ERR_",
    "TSP_",
    "TUNE_",
    "btn",
    "disk",
    "usbdisk",
];

static BY_NAME: LazyLock<HashSet<String>> = LazyLock::new(|| {
    NAMES.iter().flat_map(|line| line.split_whitespace()).map(str::to_lowercase).collect()
});

/// Whether `RobotWare` or one of its options has this name, or has constants that begin like it; `key`
/// in lower case.
pub fn is_known(key: &str) -> bool {
    let starts =
        |start: &str| key.get(..start.len()).is_some_and(|head| head.eq_ignore_ascii_case(start));
    is_listed(key) || CONSTANTS.iter().any(|start| starts(start))
}

/// Whether `RobotWare` or one of its options surely has this name; `key` in lower case.
pub fn is_listed(key: &str) -> bool {
    instruction(key).is_some()
        || function(key).is_some()
        || predefined(key).is_some()
        || error(key).is_some()
        || BY_NAME.contains(key)
}

/// The names of the instructions and functions whose parameters are known.
pub fn routine_names() -> impl Iterator<Item = &'static str> {
    let instructions = INSTRUCTIONS.into_iter().flatten().map(|entry| entry.name);
    instructions.chain(FUNCTIONS.iter().map(|entry| entry.name))
}
