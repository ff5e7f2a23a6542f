//! What RAPID's own instructions do, as far as movements, time and data go.
//!
//! Names: the instruction table of `RobotWare` 6. An instruction that is neither
//! here nor in the program is unknown: it may move the robot and write its
//! arguments.

use super::processes;

/// The form of a movement instruction: which positional arguments it takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MoveForm {
    /// `ToJointPos, Speed, Zone, Tool`
    AbsJ,
    /// `ToPoint, Speed, Zone, Tool`
    Joint,
    /// `ToPoint, Speed, Zone, Tool`
    Linear,
    /// `CirPoint, ToPoint, Speed, Zone, Tool`
    Circular,
    /// `ToJointPos, Speed, Zone` of external axes
    ExternalJoint,
}

/// How an instruction's positional arguments are arranged.
#[derive(Clone, Copy, Debug)]
pub struct MoveSignature {
    /// Interpolation.
    pub form: MoveForm,
    /// Positional arguments before the target or circle point.
    pub before: usize,
    /// Positional arguments between the speed and the zone or tool.
    pub between: usize,
    /// True if it has a zone argument; without one it ends as a stop point.
    pub zone: bool,
    /// True for Move… with nothing but movement in it; Trigg…, Search…, Move…DO and
    /// the like do more than move.
    pub plain: bool,
}

/// The one argument that an instruction writes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Written {
    /// Its place among the positional arguments.
    pub position: usize,
    /// Its name, in lower case.
    pub name: &'static str,
}

/// The argument to which an instruction writes, if that is one of several; `key` in lower case.
pub fn written(key: &str) -> Option<Written> {
    let (position, name) = match key {
        "searchl" | "searchc" => (1, "searchpoint"),
        "searchextj" => (1, "searchjointpos"),
        "wzboxdef" | "wzcyldef" | "wzsphdef" | "wzlimjointdef" | "wzhomejointdef" => (0, "shape"),
        "wzlimsup" | "wzdoset" | "wzenable" | "wzdisable" | "wzfree" => (0, "worldzone"),
        _ => return None,
    };
    Some(Written { position, name })
}

/// The signature of a movement instruction; `key` in lower case.
pub fn movement(key: &str) -> Option<MoveSignature> {
    use MoveForm::{AbsJ, Circular, ExternalJoint, Joint, Linear};
    let (form, before, between, zone, plain) = match key {
        "moveabsj" => (AbsJ, 0, 0, true, true),
        "movej" => (Joint, 0, 0, true, true),
        "movel" => (Linear, 0, 0, true, true),
        "movec" => (Circular, 0, 0, true, true),
        "moveextj" => (ExternalJoint, 0, 0, true, false),
        "movejdo" | "movejao" | "movejgo" | "movejsync" => (Joint, 0, 0, true, false),
        "moveldo" | "movelao" | "movelgo" | "movelsync" | "trigglios" | "movepnp" => {
            (Linear, 0, 0, true, false)
        }
        "movecdo" | "movecao" | "movecgo" | "movecsync" => (Circular, 0, 0, true, false),
        "triggj" | "triggjios" => (Joint, 0, usize::from(key == "triggj"), true, false),
        "triggl" => (Linear, 0, 1, true, false),
        "triggc" => (Circular, 0, 1, true, false),
        "triggabsj" => (AbsJ, 0, 1, true, false),
        // Signal, SearchPoint, ToPoint, Speed, Tool
        "searchl" => (Linear, 2, 0, false, false),
        "searchc" => (Circular, 2, 0, false, false),
        // Signal, SearchJointPos, ToJointPos, Speed
        "searchextj" => (ExternalJoint, 2, 0, false, false),
        _ => return processes::signature(key),
    };
    Some(MoveSignature { form, before, between, zone, plain })
}

/// Whether the procedure of this name (in any case) is an instruction that moves.
pub fn is_movement(name: &str) -> bool {
    movement(&name.to_ascii_lowercase()).is_some()
}

/// Whether it is one of the Move, Trigg or Search family, which do nothing for a process.
pub fn is_of_move_family(name: &str) -> bool {
    is_movement(name) && processes::signature(&name.to_ascii_lowercase()).is_none()
}

/// Instructions that write to some argument (or to all that the arguments reach).
const WRITING: &[&str] = &[
    "add",
    "bitclear",
    "bitset",
    "bookerrno",
    "clear",
    "clearpath",
    "clkread",
    "copyrawbytes",
    "decr",
    "erraise",
    "errwrite",
    "fitcircle",
    "getdataval",
    "getgroupsignalinfo",
    "getnextsym",
    "getsysdata",
    "gettrapdata",
    "incr",
    "invertdo",
    "opendir",
    "open",
    "packrawbytes",
    "readanybin",
    "readblock",
    "readcfgdata",
    "readerrdata",
    "readrawbytes",
    "readvarr",
    "rmqgetmessage",
    "rmqgetmsgdata",
    "rmqgetmsgheader",
    "rmqreadwait",
    "rmqsendwait",
    "setalldataval",
    "setdatasearch",
    "setdataval",
    "socketaccept",
    "socketcreate",
    "socketreceive",
    "socketreceivefrom",
    "sortdata",
    "textget",
    "tpreadfk",
    "tpreadnum",
    "tpreaddnum",
    "triggio",
    "triggequip",
    "triggint",
    "triggspeed",
    "triggstopproc",
    "triggcheckio",
    "unpackrawbytes",
    "uimsgbox",
    "waitload",
    "waitsensor",
    "isignaldi",
    "isignaldo",
    "isignalgi",
    "isignalgo",
    "isignalai",
    "isignalao",
    "itimer",
    "ipers",
    "ivarvalue",
    "iremote",
    "load",
];

/// Instructions that neither move the robot nor write to their arguments.
const HARMLESS: &[&str] = &[
    "accset",
    "actunit",
    "clkreset",
    "clkstart",
    "clkstop",
    "cirpathmode",
    "close",
    "closedir",
    "confj",
    "confl",
    "corrclear",
    "corrcon",
    "corrdiscon",
    "corrwrite",
    "deactunit",
    "eoffsoff",
    "eoffson",
    "eoffsset",
    "errlog",
    "exitcycle",
    "gripload",
    "idelete",
    "idisable",
    "ienable",
    "isleep",
    "iwatch",
    "kill",
    "makedir",
    "mechunitload",
    "motionplannersoff",
    "motionprocessmodeset",
    "motionsup",
    "pathacclim",
    "pathresol",
    "pdispoff",
    "pdispon",
    "pdispset",
    "pulsedo",
    "removefile",
    "renamefile",
    "reset",
    "resetaxisdistance",
    "resetpperr",
    "resetretrycount",
    "restopath",
    "rewind",
    "savecfgdata",
    "save",
    "set",
    "setao",
    "setdo",
    "setgo",
    "setsysdata",
    "singarea",
    "socketclose",
    "socketbind",
    "socketconnect",
    "socketlisten",
    "socketsend",
    "socketsendto",
    "softact",
    "softdeact",
    "speedlimaxis",
    "speedlimcheckpoint",
    "speedrefresh",
    "spyoff",
    "spyon",
    "stop",
    "storepath",
    "systemstopaction",
    "testsigndefine",
    "testsignreset",
    "textabinstall",
    "tperase",
    "tpshow",
    "tpwrite",
    "tuneservo",
    "tunereset",
    "uimsgwrite",
    "unload",
    "velset",
    "waitai",
    "waitao",
    "waitdi",
    "waitdo",
    "waitgi",
    "waitgo",
    "waitrob",
    "waitsynctask",
    "waittestandset",
    "waittime",
    "waituntil",
    "waitwobj",
    "worldacclim",
    "write",
    "writeanybin",
    "writebin",
    "writeblock",
    "writecfgdata",
    "writerawbytes",
    "writestrbin",
    "writevar",
    "break",
    "breakpoint",
    "clearrawbytes",
    "egmreset",
    "stopmove",
    "startmove",
    "stopmovereset",
    "raisetouser",
    "processshutdown",
    "activeventbuffer",
    "waitsync",
    "syncmoveoff",
    "syncmoveon",
    "syncmoveundo",
    "syncmovesuspend",
    "syncmoveresume",
    "indreset",
];

/// Instructions that wait for somebody or something outside the program.
const WAITING: &[&str] = &[
    "rmqreadwait",
    "rmqsendwait",
    "socketaccept",
    "socketreceive",
    "tpreaddnum",
    "tpreadfk",
    "tpreadnum",
    "uimsgbox",
    "waitsensor",
    "waitsync",
    "waitsynctask",
    "waittestandset",
    "waitwobj",
];

/// True if the instruction waits, for how long is not in the program.
pub fn is_waiting(key: &str) -> bool {
    WAITING.contains(&key)
}

/// True if the instruction is one of RAPID's own and leaves its arguments unchanged.
pub fn is_harmless(key: &str) -> bool {
    HARMLESS.contains(&key)
}

/// True if the instruction is one of RAPID's own that may write to its arguments.
pub fn is_writing(key: &str) -> bool {
    WRITING.contains(&key) || written(key).is_some()
}

/// Instructions that write to data, or call procedures, which they find by a name that is a value.
pub fn finds_by_name(key: &str) -> bool {
    matches!(key, "callbyvar" | "setdataval" | "setalldataval")
}

/// True if a call of this name, not declared in the program, may write to its arguments.
pub fn may_write(key: &str) -> bool {
    written(key).is_some() || (movement(key).is_none() && !is_harmless(key))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn movements_are_told_from_their_neighbours() {
        for name in ["MoveJ", "MOVEABSJ", "triggL", "SearchExtJ", "MoveLDO"] {
            assert!(is_movement(name) && is_of_move_family(name), "{name}");
        }
        for name in ["ArcLStart", "SPOTL"] {
            assert!(is_movement(name) && !is_of_move_family(name), "{name}");
        }
        // Conditions, interrupts and procedures that only sound alike.
        for name in ["TriggIO", "TriggEquip", "TriggCheckIO", "MoveHome", "StartMove", "Search"] {
            assert!(!is_movement(name), "{name}");
        }
    }
}
