//! Files, sockets, message queues, raw bytes, and messages to the operator.

use super::instruction::Effect::Wait as Waits;
use super::instruction::{Instruction, Wait, plain, writing};

const fn outside(name: &'static str, arguments: &'static str) -> Instruction {
    writing(name, arguments).effect(Waits(Wait::Outside))
}

const fn operator(name: &'static str, arguments: &'static str) -> Instruction {
    writing(name, arguments).effect(Waits(Wait::Operator))
}

const UI_MSG_BOX: &str = "\\Header MsgLine1 \\MsgLine2 \\MsgLine3 \\MsgLine4 \\MsgLine5 \\Wrap \
    \\Buttons \\Icon \\Image \\Result \\MaxTime \\DIBreak \\DOBreak \\BreakFlag";
const UI_MSG_WRITE: &str = "Icon MsgLine1 \\MsgLine2 \\MsgLine3 \\MsgLine4 \\MsgLine5 \\Wrap";
const TP_READ: &str = "Answer TPText \\MaxTime \\DIBreak \\DOBreak \\BreakFlag";
const TP_READ_FK: &str =
    "Answer TPText FK1 FK2 FK3 FK4 FK5 \\MaxTime \\DIBreak \\DOBreak \\BreakFlag";
const SOCKET_RECEIVE: &str = "Socket \\Str \\RawData \\Data \\ReadNoOfBytes \\NoRecBytes \\Time";
const SOCKET_RECEIVE_FROM: &str =
    "Socket \\Str \\RawData \\Data \\NoRecBytes RemoteAddress RemotePort \\Time";

pub(super) const INSTRUCTIONS: &[Instruction] = &[
    writing("ClearRawBytes", "RawData \\FromIndex"),
    plain("Close", "IODevice"),
    plain("CloseDir", "Dev"),
    writing("CopyRawBytes", "FromRawData FromIndex ToRawData ToIndex \\NoOfBytes"),
    plain("ErrLog", "ErrorId \\W \\I Argument1 Argument2 Argument3 Argument4 Argument5"),
    writing("ErrWrite", "\\W \\I Header Reason \\RL2 \\RL3 \\RL4").on_the_fly(),
    plain("MakeDir", "Path"),
    writing("Open", "Object \\File IODevice \\Read \\Write \\Append \\Bin"),
    writing("OpenDir", "Dev Path"),
    writing("PackRawBytes", "Value RawData \\Network StartIndex \\Hex1 \\IntX \\Float4 \\ASCII"),
    writing("ReadAnyBin", "IODevice Data \\Time"),
    writing("ReadBlock", "Device BlockNo FileName \\TaskName"),
    writing("ReadCfgData", "InstancePath Attribute CfgData \\ListNo"),
    writing("ReadRawBytes", "IODevice RawData \\NoOfBytes \\Time"),
    plain("RemoveFile", "Path"),
    plain("RenameFile", "OldPath NewPath"),
    plain("Rewind", "IODevice"),
    writing("RMQGetMessage", "Message"),
    writing("RMQGetMsgData", "Message Data"),
    writing("RMQGetMsgHeader", "Message \\Header \\SenderId \\UserDef"),
    outside("RMQReadWait", "Message \\TimeOut"),
    outside("RMQSendWait", "Slot SendData \\UserDef Message ReceiveDataType ReceiveData \\TimeOut"),
    plain("SaveCfgData", "FilePath \\File Domain"),
    outside("SocketAccept", "Socket ClientSocket \\ClientAddress \\Time"),
    plain("SocketBind", "Socket LocalAddress LocalPort"),
    plain("SocketClose", "Socket"),
    outside("SocketConnect", "Socket Address Port \\Time"),
    writing("SocketCreate", "Socket \\UDP"),
    plain("SocketListen", "Socket"),
    outside("SocketReceive", SOCKET_RECEIVE),
    outside("SocketReceiveFrom", SOCKET_RECEIVE_FROM),
    plain("SocketSend", "Socket \\Str \\RawData \\Data \\NoOfBytes"),
    plain("SocketSendTo", "Socket RemoteAddress RemotePort \\Str \\RawData \\Data \\NoOfBytes"),
    plain("TPErase", "").on_the_fly(),
    operator("TPReadDnum", TP_READ),
    operator("TPReadFK", TP_READ_FK),
    operator("TPReadNum", TP_READ),
    plain("TPShow", "Window").on_the_fly(),
    plain("TPWrite", "String \\Num \\Bool \\Pos \\Orient \\Dnum").on_the_fly(),
    operator("UIMsgBox", UI_MSG_BOX),
    plain("UIMsgWrite", UI_MSG_WRITE).on_the_fly(),
    writing("UnpackRawBytes", "RawData \\Network StartIndex Value \\Hex1 \\IntX \\Float4 \\ASCII"),
    plain("Write", "IODevice String \\Num \\Bool \\Pos \\Orient \\Dnum \\NoNewLine"),
    plain("WriteAnyBin", "IODevice Data"),
    plain("WriteBin", "IODevice Buffer NChar"),
    plain("WriteBlock", "Device BlockNo FileName \\TaskName"),
    plain("WriteCfgData", "InstancePath Attribute CfgData \\ListNo"),
    plain("WriteRawBytes", "IODevice RawData \\NoOfBytes"),
    plain("WriteStrBin", "IODevice Str"),
    plain("WriteVar", "Device VarNo VarData \\TaskName"),
];
