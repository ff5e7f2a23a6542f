//! What a program may run next: the first statements after a place that do more than compute.
//!
//! The graphs of all routines are followed without regard to the values of conditions, and from the
//! end of a routine to all its callers, so the result holds for each execution.

use std::collections::{BTreeMap, BTreeSet};

use super::graph::{Graph, NodeId, Step};
use super::hir::{Callee, Routine, RoutineKind, StmtKind};
use super::program::{Program, RoutineId, Symbol};
use crate::rapid::builtins::{Instruction, instruction};
use crate::rapid::text::Span;

/// A node of the graph of a routine.
type Place = (RoutineId, NodeId);

/// The control flow of a program over all its routines.
pub struct Upcoming<'p> {
    program: &'p Program,
    graphs: BTreeMap<RoutineId, Graph<'p>>,
    /// The node of each statement without inner statements.
    places: BTreeMap<Span, Place>,
    /// The calls of each procedure, those with a computed name counted for all procedures.
    calls: BTreeMap<RoutineId, Vec<Place>>,
    /// The routine that starts the program; what follows its end is not known.
    entry: RoutineId,
}

/// What a step does before the next movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quiet {
    /// It only computes: nobody can tell whether it runs before or during a movement.
    Yes,
    /// It does more.
    No,
}

/// Why it is not known what comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// A condition, value or loop that is not quiet decides.
    Decision(Span),
    /// The end of this routine: something else than a call may have started it.
    End(RoutineId),
    /// The statement is in a BACKWARD or UNDO handler, which no graph contains.
    Handler,
}

impl<'p> Upcoming<'p> {
    /// The control flow of a program that starts with `entry`.
    pub fn new(program: &'p Program, entry: RoutineId) -> Upcoming<'p> {
        let graphs: BTreeMap<RoutineId, Graph<'p>> =
            program.routines().map(|(id, routine)| (id, Graph::new(routine))).collect();
        let mut places = BTreeMap::new();
        let mut calls: BTreeMap<RoutineId, Vec<Place>> = BTreeMap::new();
        let mut late = Vec::new();
        for (id, graph) in &graphs {
            for (node, step) in graph.nodes.iter().map(|node| node.step).enumerate() {
                let Step::Statement(stmt) = step else { continue };
                places.insert(stmt.span, (*id, node));
                match called(program, *id, step) {
                    Called::Routine(to) => calls.entry(to).or_default().push((*id, node)),
                    Called::Any => late.push((*id, node)),
                    Called::None => {}
                }
            }
        }
        for (id, routine) in program.routines() {
            if matches!(routine.kind, RoutineKind::Proc) && !late.is_empty() {
                calls.entry(id).or_default().extend(&late);
            }
        }
        Upcoming { program, graphs, places, calls, entry }
    }

    /// The statements that may be the first after `stmt` to do more than compute.
    ///
    /// # Errors
    /// They are not known.
    pub fn after(
        &self,
        stmt: Span,
        quiet: &dyn Fn(RoutineId, Step<'p>) -> Quiet,
    ) -> Result<BTreeSet<Span>, Unknown> {
        let mut found = BTreeSet::new();
        let mut seen: BTreeSet<Place> = BTreeSet::new();
        let mut open = self.next(*self.places.get(&stmt).ok_or(Unknown::Handler)?);
        while let Some(place) = open.pop() {
            if !seen.insert(place) {
                continue;
            }
            let (id, node) = place;
            match self.graphs[&id].nodes[node].step {
                Step::Exit => {
                    let callers = self.callers(id).ok_or(Unknown::End(id))?;
                    open.extend(callers.iter().flat_map(|at| self.next(*at)));
                }
                step => match (called(self.program, id, step), quiet(id, step), step) {
                    (Called::Routine(to), Quiet::Yes, _) => open.push((to, ENTRY)),
                    (Called::None, Quiet::Yes, _) => open.extend(self.next(place)),
                    (.., Step::Statement(stmt)) => {
                        found.insert(stmt.span);
                    }
                    (.., Step::Count(stmt)) => return Err(Unknown::Decision(stmt.span)),
                    (.., Step::Condition(expr) | Step::Test(expr)) => {
                        return Err(Unknown::Decision(expr.span));
                    }
                    (.., Step::Entry | Step::Exit) => {}
                },
            }
        }
        Ok(found)
    }

    /// The nodes after a node.
    fn next(&self, (id, node): Place) -> Vec<Place> {
        self.graphs[&id].nodes[node].next.iter().map(|(_, to)| (id, *to)).collect()
    }

    /// The calls to which a routine returns. `None` if something else may have started it.
    fn callers(&self, id: RoutineId) -> Option<&[Place]> {
        let routine = self.program.routine(id);
        let is_called = matches!(routine.kind, RoutineKind::Proc) && id != self.entry;
        // Statements of these handlers are in no graph.
        let is_whole =
            |(_, other): (RoutineId, &Routine)| other.backward.is_none() && other.undo.is_none();
        let known = is_called && self.program.routines().all(is_whole);
        self.calls.get(&id).filter(|_| known).map(Vec::as_slice)
    }
}

/// [`Step::Entry`] in each graph.
const ENTRY: NodeId = 0;

/// What a step calls.
enum Called {
    None,
    Routine(RoutineId),
    /// A procedure whose name is computed.
    Any,
}

fn called(program: &Program, at: RoutineId, step: Step<'_>) -> Called {
    let Step::Statement(stmt) = step else { return Called::None };
    let StmtKind::Call(call) = &stmt.kind else { return Called::None };
    match &call.callee {
        Callee::Late(_) => Called::Any,
        Callee::Name(name) => match program.resolve(at.module, &name.key) {
            Some(Symbol::Routine(id)) => Called::Routine(id),
            Some(_) => Called::Any,
            None if instruction(&name.key).is_some_and(Instruction::finds_by_name) => Called::Any,
            None => Called::None,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::ir::hir::Expr;
    use crate::rapid::ir::{hir, lower};
    use crate::rapid::syntax;
    use crate::rapid::text::FileId;

    /// Assignments and conditions on data are quiet, those on `diA` and calls of instructions are not.
    fn quiet(_: RoutineId, step: Step<'_>) -> Quiet {
        let reads_input = |expr: &Expr| match &expr.kind {
            hir::ExprKind::Ref(name) => name.key == "dia",
            _ => false,
        };
        let is_quiet = match step {
            Step::Statement(stmt) => match &stmt.kind {
                StmtKind::Call(call) => {
                    matches!(&call.callee, Callee::Name(name) if name.key.starts_with('r'))
                }
                StmtKind::Assign { .. }
                | StmtKind::Return(_)
                | StmtKind::Label(_)
                | StmtKind::Goto(_) => true,
                _ => false,
            },
            Step::Condition(expr) | Step::Test(expr) => !reads_input(expr),
            _ => true,
        };
        if is_quiet { Quiet::Yes } else { Quiet::No }
    }

    /// The first words of what may follow the statement `MoveX`, in the order of the text.
    fn after(routines: &str) -> Option<String> {
        let text = format!("MODULE M\n{routines}\nENDMODULE");
        let parse = syntax::parse(text.as_bytes());
        assert!(parse.errors.is_empty(), "{routines}: {:?}", parse.errors);
        let program = Program::new(lower(FileId(0), &parse, text.as_bytes()));
        let entry = program.entry("main").expect("a main");
        let start = text.find("MoveX").expect("the statement") as u32;
        let upcoming = Upcoming::new(&program, entry);
        let stmt = upcoming.places.keys().find(|span| span.start == start).expect("its span");
        let word = |span: Span| text[span.start as usize..].split([' ', ';']).next();
        let found = upcoming.after(*stmt, &quiet).ok()?;
        Some(found.into_iter().filter_map(word).collect::<Vec<_>>().join(" "))
    }

    #[test]
    fn the_end_of_a_routine_leads_to_all_its_callers() {
        let program =
            "PROC main() rA; MoveB; IF n=1 THEN rA; MoveC; ENDIF rA; n:=2; rD; stop; ENDPROC
            PROC rA() MoveX; ENDPROC PROC rD() IF n=2 RETURN; MoveD; ENDPROC";
        assert_eq!(after(program).as_deref(), Some("MoveB MoveC stop MoveD"));
    }

    #[test]
    fn loops_and_jumps_are_followed() {
        let program = "PROC main() FOR i FROM 1 TO 3 DO MoveA; MoveX; n:=n+1; ENDFOR
            again: IF n>3 GOTO again; MoveB; ENDPROC";
        assert_eq!(after(program).as_deref(), Some("MoveA MoveB"));
    }

    #[test]
    fn a_decision_on_an_input_and_the_end_of_the_program_are_open() {
        let program = "PROC main() MoveX; IF diA MoveB; MoveC; ENDPROC";
        assert_eq!(after(program), None);
        assert_eq!(after("PROC main() MoveX; n:=1; ENDPROC"), None);
        assert_eq!(after("PROC main() MoveX; n:=1; stop; ENDPROC").as_deref(), Some("stop"));
    }

    #[test]
    fn a_call_with_a_computed_name_may_be_of_any_procedure() {
        let program = "PROC main() %name%; MoveB; ENDPROC PROC rA() MoveX; ENDPROC";
        assert_eq!(after(program).as_deref(), Some("MoveB"));
        let program = "PROC main() rA; MoveB; ENDPROC PROC rA() MoveX; ENDPROC TRAP t rA; ENDTRAP";
        assert_eq!(after(program), None);
    }
}
