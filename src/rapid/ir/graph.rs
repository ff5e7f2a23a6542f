//! The control flow of a routine as a graph.
//!
//! A node is a decision or a statement without inner statements. Loops are cycles whatever
//! their bounds: `exec` unrolls them at execution.

use std::collections::BTreeMap;

use super::hir::{Block, Expr, ExprKind, Routine, Stmt, StmtKind};

/// Index of a node in [`Graph::nodes`].
pub type NodeId = usize;

/// The control flow of a routine.
#[derive(Debug)]
pub struct Graph<'h> {
    /// The nodes; the first is [`Step::Entry`], the second [`Step::Exit`].
    pub nodes: Vec<Node<'h>>,
}

/// A node with its outgoing edges.
#[derive(Debug)]
pub struct Node<'h> {
    /// What happens.
    pub step: Step<'h>,
    /// The outgoing edges: condition and target.
    pub next: Vec<(When, NodeId)>,
}

/// What happens at a node.
#[derive(Clone, Copy, Debug)]
pub enum Step<'h> {
    /// The routine begins.
    Entry,
    /// The routine or the program ends.
    Exit,
    /// A statement without inner statements.
    Statement(&'h Stmt),
    /// The condition of an `IF`, `ELSEIF` or `WHILE`.
    Condition(&'h Expr),
    /// The head of this `FOR`: counts, and leaves the loop after the last value.
    Count(&'h Stmt),
    /// The value of a `TEST`.
    Test(&'h Expr),
}

/// The condition of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum When {
    /// Always.
    Always,
    /// The condition holds; the `FOR` loop continues.
    True,
    /// The condition does not hold; the `FOR` loop ends.
    False,
    /// The value is in this `CASE`, counted from 0.
    Case(usize),
    /// The value is in no `CASE`.
    Otherwise,
    /// An error is raised.
    Error,
    /// `RETRY` or `TRYNEXT`: the statement to resume is unknown, so the edge leads to the exit.
    Resume,
}

/// The open edges that lead to the next statement.
type Ends = Vec<(When, NodeId)>;

impl<'h> Graph<'h> {
    /// The graph of a routine with its error handlers, without `BACKWARD` and `UNDO`.
    pub fn new(routine: &'h Routine) -> Graph<'h> {
        let node = |step| Node { step, next: Vec::new() };
        let mut builder = Builder {
            graph: Graph { nodes: vec![node(Step::Entry), node(Step::Exit)] },
            labels: BTreeMap::new(),
            jumps: Vec::new(),
            raises: Vec::new(),
        };
        let ends = builder.block(&routine.body, vec![(When::Always, ENTRY)]);
        builder.connect(&ends, EXIT);
        let raises = std::mem::take(&mut builder.raises);
        let mut untaken = raises.clone();
        for (_, handler) in &routine.error {
            untaken.clear();
            let ends = builder.block(handler, raises.clone());
            builder.connect(&ends, EXIT);
        }
        untaken.append(&mut builder.raises);
        builder.connect(&untaken, EXIT);
        for (from, label) in std::mem::take(&mut builder.jumps) {
            // A missing label is an error in the program.
            let to = builder.labels.get(label).copied().unwrap_or(EXIT);
            builder.connect(&[(When::Always, from)], to);
        }
        builder.graph
    }

    /// Which nodes can be reached from the entry. Only `RAISE` has an edge to a handler: without
    /// `RAISE` in the routine, a handler counts as unreachable.
    pub fn reachable(&self) -> Vec<bool> {
        let mut reached = vec![false; self.nodes.len()];
        let mut open = vec![ENTRY];
        while let Some(id) = open.pop() {
            if !std::mem::replace(&mut reached[id], true) {
                open.extend(self.nodes[id].next.iter().map(|(_, to)| *to));
            }
        }
        reached
    }
}

const ENTRY: NodeId = 0;
const EXIT: NodeId = 1;

struct Builder<'h> {
    graph: Graph<'h>,
    labels: BTreeMap<&'h str, NodeId>,
    jumps: Vec<(NodeId, &'h str)>,
    raises: Ends,
}

impl<'h> Builder<'h> {
    fn node(&mut self, step: Step<'h>, from: &[(When, NodeId)]) -> NodeId {
        let id = self.graph.nodes.len();
        self.graph.nodes.push(Node { step, next: Vec::new() });
        self.connect(from, id);
        id
    }

    fn connect(&mut self, from: &[(When, NodeId)], to: NodeId) {
        for (when, id) in from {
            self.graph.nodes[*id].next.push((*when, to));
        }
    }

    fn block(&mut self, block: &'h Block, from: Ends) -> Ends {
        block.iter().fold(from, |from, stmt| self.statement(stmt, from))
    }

    /// Adds a statement after `from`. The depth of the recursion is limited by the parser.
    fn statement(&mut self, stmt: &'h Stmt, mut from: Ends) -> Ends {
        match &stmt.kind {
            StmtKind::If { branches, otherwise } => {
                let mut ends = Ends::new();
                for (condition, block) in branches {
                    let id = self.node(Step::Condition(condition), &from);
                    ends.append(&mut self.block(block, vec![(When::True, id)]));
                    from = vec![(When::False, id)];
                }
                if let Some(block) = otherwise {
                    from = self.block(block, from);
                }
                ends.append(&mut from);
                ends
            }
            StmtKind::While { condition, body } => {
                let ends = self.repeat(Step::Condition(condition), body, &from);
                // `WHILE TRUE` ends only by a jump, a return or an error.
                if matches!(condition.kind, ExprKind::Bool(true)) { Ends::new() } else { ends }
            }
            StmtKind::For { body, .. } => self.repeat(Step::Count(stmt), body, &from),
            StmtKind::Test { value, cases, default } => {
                let id = self.node(Step::Test(value), &from);
                let mut ends = Ends::new();
                for (index, (_, block)) in cases.iter().enumerate() {
                    ends.append(&mut self.block(block, vec![(When::Case(index), id)]));
                }
                let mut rest = vec![(When::Otherwise, id)];
                if let Some(block) = default {
                    rest = self.block(block, rest);
                }
                ends.append(&mut rest);
                ends
            }
            kind => {
                let id = self.node(Step::Statement(stmt), &from);
                match kind {
                    StmtKind::Goto(label) => self.jumps.push((id, &label.key)),
                    StmtKind::Return(_) | StmtKind::Exit => {
                        self.connect(&[(When::Always, id)], EXIT);
                    }
                    StmtKind::Raise(_) => self.raises.push((When::Error, id)),
                    StmtKind::Retry | StmtKind::TryNext => {
                        self.connect(&[(When::Resume, id)], EXIT);
                    }
                    _ => {
                        if let StmtKind::Label(label) = kind {
                            self.labels.insert(&label.key, id);
                        }
                        return vec![(When::Always, id)];
                    }
                }
                Ends::new()
            }
        }
    }

    fn repeat(&mut self, head: Step<'h>, body: &'h Block, from: &[(When, NodeId)]) -> Ends {
        let id = self.node(head, from);
        let ends = self.block(body, vec![(When::True, id)]);
        self.connect(&ends, id);
        vec![(When::False, id)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::ir::lower;
    use crate::rapid::syntax;
    use crate::rapid::text::FileId;

    /// One line per node: its number, its first word and its outgoing edges.
    fn shown(body: &str) -> String {
        let text = format!("MODULE M\nPROC p()\n{body}\nENDPROC\nENDMODULE");
        let parse = syntax::parse(text.as_bytes());
        assert!(parse.errors.is_empty(), "{body}: {:?}", parse.errors);
        let modules = lower(FileId(0), &parse, text.as_bytes());
        let graph = Graph::new(&modules[0].routines[0]);
        let word = |start: u32| text[start as usize..].split([' ', ';', ':', '\n']).next();
        let nodes =
            graph.nodes.iter().zip(graph.reachable()).enumerate().map(|(id, (node, here))| {
                let name = match node.step {
                    Step::Entry => "entry",
                    Step::Exit => "exit",
                    Step::Count(_) => "FOR",
                    Step::Statement(stmt) => word(stmt.span.start).unwrap_or(""),
                    Step::Condition(expr) | Step::Test(expr) => word(expr.span.start).unwrap_or(""),
                };
                let next: Vec<String> =
                    node.next.iter().map(|(when, to)| format!("{when:?}>{to}")).collect();
                let dead = if here { "" } else { " dead" };
                format!("{id} {name}{dead} {}", next.join(" ")).trim_end().to_owned()
            });
        nodes.collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn branches_join_after_their_end() {
        let graph = shown("IF a THEN x; ELSEIF b THEN RETURN; ELSE y; ENDIF z;");
        let expected = "0 entry Always>2\n1 exit\n2 a True>3 False>4\n3 x Always>7\n\
                        4 b True>5 False>6\n5 RETURN Always>1\n6 y Always>7\n7 z Always>1";
        assert_eq!(graph, expected);
    }

    #[test]
    fn loops_are_cycles() {
        let graph = shown("FOR i FROM 1 TO 3 DO x; ENDFOR WHILE a DO ENDWHILE");
        let expected = "0 entry Always>2\n1 exit\n2 FOR True>3 False>4\n3 x Always>2\n\
                        4 a True>4 False>1";
        assert_eq!(graph, expected);
    }

    #[test]
    fn only_jumps_leave_endless_loops() {
        let graph = shown("WHILE TRUE DO IF a GOTO out; x; ENDWHILE y; out: z;");
        let expected = "0 entry Always>2\n1 exit\n2 TRUE True>3\n3 a True>4 False>5\n\
                        4 GOTO Always>7\n5 x Always>2\n6 y dead Always>7\n7 out Always>8\n\
                        8 z Always>1";
        assert_eq!(graph, expected);
    }

    #[test]
    fn cases_jumps_and_errors_have_their_edges() {
        let graph =
            shown("again: TEST n CASE 1: x; CASE 2: RAISE; ENDTEST GOTO again; y; ERROR TRYNEXT;");
        let expected = "0 entry Always>2\n1 exit\n2 again Always>3\n\
                        3 n Case(0)>4 Case(1)>5 Otherwise>6\n4 x Always>6\n5 RAISE Error>8\n\
                        6 GOTO Always>2\n7 y dead Always>1\n8 TRYNEXT Resume>1";
        assert_eq!(graph, expected);
    }
}
