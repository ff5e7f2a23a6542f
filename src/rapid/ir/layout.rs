//! The components of RAPID's predefined records, in their order.
//!
//! Source: RAPID reference, data types; aggregates fill them in this order.

/// Name and type of each component.
pub type Components = &'static [(&'static str, &'static str)];

/// The components of a predefined record type; `None` for atomic and unknown types.
pub fn components(type_key: &str) -> Option<Components> {
    Some(match type_key {
        "pos" => &[("x", "num"), ("y", "num"), ("z", "num")],
        "orient" => &[("q1", "num"), ("q2", "num"), ("q3", "num"), ("q4", "num")],
        "pose" => &[("trans", "pos"), ("rot", "orient")],
        "confdata" => &[("cf1", "num"), ("cf4", "num"), ("cf6", "num"), ("cfx", "num")],
        "extjoint" => &[
            ("eax_a", "num"),
            ("eax_b", "num"),
            ("eax_c", "num"),
            ("eax_d", "num"),
            ("eax_e", "num"),
            ("eax_f", "num"),
        ],
        "robjoint" => &[
            ("rax_1", "num"),
            ("rax_2", "num"),
            ("rax_3", "num"),
            ("rax_4", "num"),
            ("rax_5", "num"),
            ("rax_6", "num"),
        ],
        "robtarget" => {
            &[("trans", "pos"), ("rot", "orient"), ("robconf", "confdata"), ("extax", "extjoint")]
        }
        "jointtarget" => &[("robax", "robjoint"), ("extax", "extjoint")],
        "loaddata" => &[
            ("mass", "num"),
            ("cog", "pos"),
            ("aom", "orient"),
            ("ix", "num"),
            ("iy", "num"),
            ("iz", "num"),
        ],
        "tooldata" => &[("robhold", "bool"), ("tframe", "pose"), ("tload", "loaddata")],
        "wobjdata" => &[
            ("robhold", "bool"),
            ("ufprog", "bool"),
            ("ufmec", "string"),
            ("uframe", "pose"),
            ("oframe", "pose"),
        ],
        "speeddata" => &[("v_tcp", "num"), ("v_ori", "num"), ("v_leax", "num"), ("v_reax", "num")],
        "zonedata" => &[
            ("finep", "bool"),
            ("pzone_tcp", "num"),
            ("pzone_ori", "num"),
            ("pzone_eax", "num"),
            ("zone_ori", "num"),
            ("zone_leax", "num"),
            ("zone_reax", "num"),
        ],
        "stoppointdata" => &[
            ("type", "stoppoint"),
            ("progsynch", "bool"),
            ("inpos", "inposdata"),
            ("stoptime", "num"),
            ("followtime", "num"),
            ("signal", "string"),
            ("relation", "opnum"),
            ("checkvalue", "num"),
        ],
        "inposdata" => {
            &[("position", "num"), ("speed", "num"), ("mintime", "num"), ("maxtime", "num")]
        }
        "progdisp" => &[("pdisp", "pose"), ("eoffs", "extjoint")],
        "motsetdata" => &[
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
        "veldata" => &[("oride", "num"), ("max", "num")],
        "accdata" => &[("acc", "num"), ("ramp", "num"), ("finepramp", "num")],
        "singdata" => {
            &[("wrist", "bool"), ("lockaxis4", "bool"), ("arm", "bool"), ("base", "bool")]
        }
        "confsupdata" => {
            &[("jsup", "bool"), ("lsup", "bool"), ("ax1", "num"), ("ax4", "num"), ("ax6", "num")]
        }
        _ => return None,
    })
}
