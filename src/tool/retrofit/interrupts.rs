//! Interrupt routines: their effect on running movements, and the data that they write.

use std::collections::BTreeSet;

use super::statements::{places_written_by_functions, written_places};
use crate::rapid::builtins::{self, Instruction, Source, is_movement, may_write};
use crate::rapid::ir::hir::{Block, Callee, Expr, ExprKind, Routine, StmtKind};
use crate::rapid::ir::program::{DataId, Program, RoutineId, Symbol};
use crate::rapid::ir::walk::statements;
use crate::retime::optimize::reason::Reason;

/// The first effect of a connected interrupt routine on movements.
pub(super) fn interrupt_hazard(program: &Program) -> Option<Reason> {
    traps(program).into_iter().find_map(|(trap, reach)| {
        let what = reach.hazard()?;
        Some(Reason::Interrupt(format!(
            "the interrupt routine {trap} is connected somewhere in the program and may run {what} \
             meanwhile"
        )))
    })
}

/// Module data that connected interrupt routines may write, and those that they may read.
pub(super) fn data_of_interrupts(program: &Program) -> [BTreeSet<DataId>; 2] {
    let [mut written, mut read] = [BTreeSet::new(), BTreeSet::new()];
    for (_, mut reach) in traps(program) {
        written.append(&mut reach.written);
        read.append(&mut reach.read);
    }
    [written, read]
}

/// The connected interrupt routines by name, with everything that they run.
fn traps(program: &Program) -> Vec<(String, Reach)> {
    let mut found = Vec::new();
    for (m, module) in program.modules.iter().enumerate() {
        for block in module.routines.iter().flat_map(Routine::blocks) {
            for stmt in statements(block) {
                let StmtKind::Connect { trap, .. } = &stmt.kind else { continue };
                let mut reach = Reach::default();
                reach.call(program, m, &trap.text);
                // A work list instead of recursion: calls may be deep.
                while let Some(id) = reach.open.pop() {
                    let routine = program.routine(id);
                    for expr in routine.data.iter().filter_map(|data| data.init.as_ref()) {
                        reach.expr(program, id.module, expr);
                        reach.add_writes(
                            program,
                            id.module,
                            &places_written_by_functions(vec![expr]),
                        );
                    }
                    for block in routine.blocks() {
                        reach.block(program, id.module, block);
                    }
                }
                found.push((trap.text.clone(), reach));
            }
        }
    }
    found
}

/// Everything that an interrupt routine runs, directly or indirectly.
#[derive(Default)]
struct Reach {
    /// Visited routines, by module and index.
    seen: BTreeSet<(usize, usize)>,
    /// Routines still to visit.
    open: Vec<RoutineId>,
    /// The first instruction that changes movements.
    changes: Option<String>,
    /// The first movement.
    moves: Option<String>,
    /// Whether it stores the interrupted path.
    stores_path: bool,
    /// Module data that it may write: by assignment, or as an argument.
    written: BTreeSet<DataId>,
    /// Module data that its expressions name.
    read: BTreeSet<DataId>,
}

impl Reach {
    fn hazard(&self) -> Option<&str> {
        let moves = self.moves.as_deref().filter(|_| !self.stores_path);
        self.changes.as_deref().or(moves)
    }

    fn call(&mut self, program: &Program, module: usize, name: &str) {
        let key = name.to_lowercase();
        let Some(Symbol::Routine(id)) = program.resolve(module, &key) else {
            let instruction = builtins::instruction(&key);
            if instruction.is_some_and(|found| found.changes_motion) {
                self.changes.get_or_insert(name.to_owned());
            }
            if instruction.is_some_and(Instruction::finds_by_name) {
                self.changes
                    .get_or_insert(format!("{name}, which finds data or procedures by name"));
            }
            if is_movement(&key) {
                self.moves.get_or_insert(name.to_owned());
            }
            self.stores_path |= key == "storepath";
            let function = builtins::function(&key);
            let is_known = instruction.is_some_and(Instruction::is_known)
                || function.is_some_and(|found| found.source != Source::NotCalculated);
            if !is_known {
                self.changes.get_or_insert(format!("{name}, of which nothing is known here,"));
            }
            return;
        };
        if self.seen.insert((id.module, id.index)) {
            self.open.push(id);
        }
    }

    fn add_writes(&mut self, program: &Program, module: usize, places: &[&Expr]) {
        for name in places.iter().filter_map(|place| place.base()) {
            if let Some(Symbol::Data(id)) = program.resolve(module, &name.key) {
                self.written.insert(id);
            }
        }
    }

    /// Adds the functions that an expression calls, and the data that it names.
    fn expr(&mut self, program: &Program, module: usize, expr: &Expr) {
        if let ExprKind::Ref(name) = &expr.kind
            && let Some(Symbol::Data(id)) = program.resolve(module, &name.key)
        {
            self.read.insert(id);
        }
        if let ExprKind::Call(name, _) = &expr.kind {
            self.call(program, module, &name.text);
        }
        for part in expr.parts() {
            self.expr(program, module, part);
        }
    }

    fn block(&mut self, program: &Program, module: usize, block: &Block) {
        let may_write = |key: &str| program.resolve(module, key).is_some() || may_write(key);
        for stmt in statements(block) {
            self.add_writes(program, module, &written_places(stmt, may_write));
            if let StmtKind::Call(call) = &stmt.kind {
                match &call.callee {
                    Callee::Name(name) => self.call(program, module, &name.text),
                    Callee::Late(_) => {
                        self.changes.get_or_insert("a procedure with a computed name".into());
                    }
                }
            }
            for expr in stmt.kind.exprs() {
                self.expr(program, module, expr);
            }
        }
    }
}
