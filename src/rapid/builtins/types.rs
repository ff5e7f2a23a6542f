//! Data types and the components of records, in the order of an aggregate.
//!
//! Source: RAPID reference, data types.

/// The kind of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalKind {
    /// 0 or 1.
    Digital,
    /// A whole number from 0.
    Group,
    /// Any number.
    Analog,
}

/// A predefined data type.
#[derive(Clone, Copy, Debug)]
pub struct DataType {
    /// Its name.
    pub name: &'static str,
    /// The components of a record as a parameter list; without a type they are `num`.
    components: &'static str,
    /// The kind of signal, if it is a signal type.
    pub signal: Option<SignalKind>,
}

const fn atomic(name: &'static str) -> DataType {
    record(name, "")
}

const fn signal(name: &'static str, kind: SignalKind) -> DataType {
    DataType { signal: Some(kind), ..atomic(name) }
}

const fn record(name: &'static str, components: &'static str) -> DataType {
    DataType { name, components, signal: None }
}

impl DataType {
    /// Name and type of each component of a record; none of an atomic type.
    pub fn components(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        let parts = self.components.split_whitespace();
        parts.map(|part| part.split_once(':').unwrap_or((part, "num")))
    }
}

/// The predefined type of this name; `key` in lower case.
pub fn data_type(key: &str) -> Option<&'static DataType> {
    TYPES.binary_search_by(|ty| ty.name.cmp(key)).ok().map(|index| &TYPES[index])
}

const MOTION_SETTINGS: &str = "vel:veldata acc:accdata sing:singdata conf:confsupdata pathresol \
    motionsup:bool tunevalue acclim:bool accmax decellim:bool decelmax cirpathreori \
    worldacclim:bool worldaccmax evtbufferact:bool";
const STOP_POINT: &str = "type:stoppoint progsynch:bool inpos:inposdata stoptime followtime \
    signal:string relation:opnum checkvalue";

/// Sorted by name.
pub(super) const TYPES: &[DataType] = &[
    record("accdata", "acc ramp finepramp"),
    atomic("bool"),
    atomic("byte"),
    atomic("clock"),
    record("confdata", "cf1 cf4 cf6 cfx"),
    record("confsupdata", "jsup:bool lsup:bool ax1 ax4 ax6"),
    atomic("dnum"),
    atomic("errnum"),
    record("extjoint", "eax_a eax_b eax_c eax_d eax_e eax_f"),
    record("inposdata", "position speed mintime maxtime"),
    atomic("intnum"),
    record("jointtarget", "robax:robjoint extax:extjoint"),
    record("loaddata", "mass cog:pos aom:orient ix iy iz"),
    record("motsetdata", MOTION_SETTINGS),
    atomic("num"),
    atomic("opnum"),
    record("orient", "q1 q2 q3 q4"),
    record("pos", "x y z"),
    record("pose", "trans:pos rot:orient"),
    record("progdisp", "pdisp:pose eoffs:extjoint"),
    record("robjoint", "rax_1 rax_2 rax_3 rax_4 rax_5 rax_6"),
    record("robtarget", "trans:pos rot:orient robconf:confdata extax:extjoint"),
    signal("signalai", SignalKind::Analog),
    signal("signalao", SignalKind::Analog),
    signal("signaldi", SignalKind::Digital),
    signal("signaldo", SignalKind::Digital),
    signal("signalgi", SignalKind::Group),
    signal("signalgo", SignalKind::Group),
    record("singdata", "wrist:bool lockaxis4:bool arm:bool base:bool"),
    record("speeddata", "v_tcp v_ori v_leax v_reax"),
    atomic("stoppoint"),
    record("stoppointdata", STOP_POINT),
    atomic("string"),
    record("tooldata", "robhold:bool tframe:pose tload:loaddata"),
    record("veldata", "oride max"),
    record("wobjdata", "robhold:bool ufprog:bool ufmec:string uframe:pose oframe:pose"),
    record("zonedata", "finep:bool pzone_tcp pzone_ori pzone_eax zone_ori zone_leax zone_reax"),
];
