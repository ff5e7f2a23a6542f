//! Names that no module of the program has.

use std::collections::BTreeSet;

use serde::Serialize;

use crate::ir::program::Program;

/// The names of a streams module.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Names {
    /// Prefix of all names.
    pub prefix: String,
    /// The module.
    pub module: String,
    /// Function: the robot stands at a joint target.
    pub at: String,
    /// Function: two joint targets are the same.
    pub same_joints: String,
    /// Function: two robtargets are the same.
    pub same_target: String,
}

impl Names {
    /// Names whose prefix begins no name in the program.
    pub fn free(program: &Program) -> Names {
        let taken = taken(program);
        let mut prefix = "jp".to_owned();
        let mut round = 1;
        while taken.iter().any(|name| name.starts_with(&prefix))
            || taken.contains(&module_name(round).to_lowercase())
        {
            round += 1;
            prefix = format!("jp{round}_");
        }
        Names {
            module: module_name(round),
            at: format!("{prefix}At"),
            same_joints: format!("{prefix}SameJoints"),
            same_target: format!("{prefix}SameTarget"),
            prefix,
        }
    }
}

fn module_name(round: usize) -> String {
    if round == 1 { "Joulepath".to_owned() } else { format!("Joulepath{round}") }
}

fn taken(program: &Program) -> BTreeSet<String> {
    let mut taken = BTreeSet::new();
    for module in &program.modules {
        taken.insert(module.name.key.clone());
        taken.extend(module.types.iter().map(|t| t.name.key.clone()));
        taken.extend(module.data.iter().map(|d| d.name.key.clone()));
        for routine in &module.routines {
            taken.insert(routine.name.key.clone());
            taken.extend(routine.params.iter().map(|p| p.name.key.clone()));
            taken.extend(routine.data.iter().map(|d| d.name.key.clone()));
        }
    }
    taken
}
