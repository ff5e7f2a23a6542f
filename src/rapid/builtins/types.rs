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
    /// Name and type of each component of a record; none of an atomic type.
    pub components: &'static [(&'static str, &'static str)],
    /// The kind of signal, if it is a signal type.
    pub signal: Option<SignalKind>,
}

const fn atomic(name: &'static str) -> DataType {
    DataType { name, components: &[], signal: None }
}

const fn signal(name: &'static str, kind: SignalKind) -> DataType {
    DataType { signal: Some(kind), ..atomic(name) }
}

const fn record(
    name: &'static str,
    components: &'static [(&'static str, &'static str)],
) -> DataType {
    DataType { components, ..atomic(name) }
}

/// The predefined type of this name; `key` in lower case.
pub fn data_type(key: &str) -> Option<&'static DataType> {
    TYPES.binary_search_by(|ty| ty.name.cmp(key)).ok().map(|index| &TYPES[index])
}

/// Sorted by name.
pub(super) const TYPES: &[DataType] = &[
    record("accdata", &[("acc", "num"), ("ramp", "num"), ("finepramp", "num")]),
    atomic("bool"),
    atomic("byte"),
    atomic("clock"),
    record("confdata", &[("cf1", "num"), ("cf4", "num"), ("cf6", "num"), ("cfx", "num")]),
    record(
        "confsupdata",
        &[("jsup", "bool"), ("lsup", "bool"), ("ax1", "num"), ("ax4", "num"), ("ax6", "num")],
    ),
    atomic("dnum"),
    atomic("errnum"),
    record(
        "extjoint",
        &[
            ("eax_a", "num"),
            ("eax_b", "num"),
            ("eax_c", "num"),
            ("eax_d", "num"),
            ("eax_e", "num"),
            ("eax_f", "num"),
        ],
    ),
    record(
        "inposdata",
        &[("position", "num"), ("speed", "num"), ("mintime", "num"), ("maxtime", "num")],
    ),
    atomic("intnum"),
    record("jointtarget", &[("robax", "robjoint"), ("extax", "extjoint")]),
    record(
        "loaddata",
        &[
            ("mass", "num"),
            ("cog", "pos"),
            ("aom", "orient"),
            ("ix", "num"),
            ("iy", "num"),
            ("iz", "num"),
        ],
    ),
    record(
        "motsetdata",
        &[
            ("vel", "veldata"),
            ("acc", "accdata"),
            ("sing", "singdata"),
            ("conf", "confsupdata"),
            ("pathresol", "num"),
            ("motionsup", "bool"),
            ("tunevalue", "num"),
            ("acclim", "bool"),
            ("accmax", "num"),
            ("decellim", "bool"),
            ("decelmax", "num"),
            ("cirpathreori", "num"),
            ("worldacclim", "bool"),
            ("worldaccmax", "num"),
            ("evtbufferact", "bool"),
        ],
    ),
    atomic("num"),
    atomic("opnum"),
    record("orient", &[("q1", "num"), ("q2", "num"), ("q3", "num"), ("q4", "num")]),
    record("pos", &[("x", "num"), ("y", "num"), ("z", "num")]),
    record("pose", &[("trans", "pos"), ("rot", "orient")]),
    record("progdisp", &[("pdisp", "pose"), ("eoffs", "extjoint")]),
    record(
        "robjoint",
        &[
            ("rax_1", "num"),
            ("rax_2", "num"),
            ("rax_3", "num"),
            ("rax_4", "num"),
            ("rax_5", "num"),
            ("rax_6", "num"),
        ],
    ),
    record(
        "robtarget",
        &[("trans", "pos"), ("rot", "orient"), ("robconf", "confdata"), ("extax", "extjoint")],
    ),
    signal("signalai", SignalKind::Analog),
    signal("signalao", SignalKind::Analog),
    signal("signaldi", SignalKind::Digital),
    signal("signaldo", SignalKind::Digital),
    signal("signalgi", SignalKind::Group),
    signal("signalgo", SignalKind::Group),
    record(
        "singdata",
        &[("wrist", "bool"), ("lockaxis4", "bool"), ("arm", "bool"), ("base", "bool")],
    ),
    record(
        "speeddata",
        &[("v_tcp", "num"), ("v_ori", "num"), ("v_leax", "num"), ("v_reax", "num")],
    ),
    atomic("stoppoint"),
    record(
        "stoppointdata",
        &[
            ("type", "stoppoint"),
            ("progsynch", "bool"),
            ("inpos", "inposdata"),
            ("stoptime", "num"),
            ("followtime", "num"),
            ("signal", "string"),
            ("relation", "opnum"),
            ("checkvalue", "num"),
        ],
    ),
    atomic("string"),
    record("tooldata", &[("robhold", "bool"), ("tframe", "pose"), ("tload", "loaddata")]),
    record("veldata", &[("oride", "num"), ("max", "num")]),
    record(
        "wobjdata",
        &[
            ("robhold", "bool"),
            ("ufprog", "bool"),
            ("ufmec", "string"),
            ("uframe", "pose"),
            ("oframe", "pose"),
        ],
    ),
    record(
        "zonedata",
        &[
            ("finep", "bool"),
            ("pzone_tcp", "num"),
            ("pzone_ori", "num"),
            ("pzone_eax", "num"),
            ("zone_ori", "num"),
            ("zone_leax", "num"),
            ("zone_reax", "num"),
        ],
    ),
];
