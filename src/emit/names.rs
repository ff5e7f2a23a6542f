//! Names that no module of the program has.

use std::collections::BTreeSet;

use serde::Serialize;

use crate::ir::hir::{Block, Expr, ExprKind, Routine, StmtKind};
use crate::ir::program::Program;
use crate::text::Span;

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

/// A guard of a program whose module of streams is not among the files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingStreams {
    /// The function that it calls.
    pub function: String,
    /// Where.
    pub span: Span,
    /// The file that declares it.
    pub module: String,
}

/// The first guard that calls a function of a module of streams that the program does not have.
pub fn missing_streams(program: &Program) -> Option<MissingStreams> {
    program.modules.iter().enumerate().find_map(|(m, module)| {
        let mut blocks = module.routines.iter().flat_map(Routine::blocks);
        blocks.find_map(|block| guard(program, m, block))
    })
}

fn guard(program: &Program, module: usize, block: &Block) -> Option<MissingStreams> {
    block.iter().find_map(|stmt| {
        if let StmtKind::If { branches, .. } = &stmt.kind
            && let Some(ExprKind::Call(name, _)) = branches.first().map(|(c, _)| &first(c).kind)
            && let Some(round) = round_of(&name.key)
            && program.resolve(module, &name.key).is_none()
        {
            return Some(MissingStreams {
                function: name.text.clone(),
                span: name.span,
                module: format!("{}.mod", module_name(round)),
            });
        }
        stmt.kind.blocks().into_iter().find_map(|inner| guard(program, module, inner))
    })
}

/// The first part of a conjunction.
fn first(condition: &Expr) -> &Expr {
    match &condition.kind {
        ExprKind::Binary(_, left, _) => first(left),
        _ => condition,
    }
}

/// The round in which a lower-case name is that of [`Names::at`].
fn round_of(key: &str) -> Option<usize> {
    match key.strip_prefix("jp")?.strip_suffix("at")? {
        "" => Some(1),
        round => round.strip_suffix('_')?.parse().ok(),
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
