//! Built-in names with their full declarations, written as RAPID modules.
//!
//! A routine is declared here only if its parameters are certain, or its required ones and a last
//! parameter [`OTHERS`]: `check` compares calls with them. Source: RAPID reference of `RobotWare` 6.

/// The modules.
pub const DECLARATIONS: [&str; 5] = [
    include_str!("declarations/types.sys"),
    include_str!("declarations/data.sys"),
    include_str!("declarations/motion.sys"),
    include_str!("declarations/program.sys"),
    include_str!("declarations/functions.sys"),
];

/// The name of a parameter that stands for optional ones which are not declared, in lower case.
pub const OTHERS: &str = "others";
