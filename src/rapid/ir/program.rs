//! The modules of a task and its symbols.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::hir::{
    Arg, Call, Callee, Data, DataKind, Expr, ExprKind, Ident, Module, ParamMode, Routine,
    RoutineKind, Scope, Stmt, StmtKind, TypeDefKind,
};
use super::user;
use super::walk::arguments_with_places;
use crate::rapid::builtins::{self, ArgumentPlace, DataType};
use crate::rapid::text::Span;

/// A data object at module level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct DataId {
    /// Index of the module.
    pub module: usize,
    /// Index in the module's data.
    pub index: usize,
}

/// A routine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct RoutineId {
    /// Index of the module.
    pub module: usize,
    /// Index in the module's routines.
    pub index: usize,
}

/// The meaning of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symbol {
    /// Data at module level.
    Data(DataId),
    /// A routine.
    Routine(RoutineId),
    /// More than one declaration: a `Clash`.
    Ambiguous,
}

/// A name that is declared more than once in one scope.
#[derive(Clone, Debug)]
pub struct Clash {
    /// The name as in the first declaration.
    pub name: Ident,
    /// The module in which it is local; `None` for global names.
    pub module: Option<usize>,
    /// The name in each of the declarations.
    pub spans: Vec<Span>,
}

/// What may change data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Writer {
    /// A statement of the program.
    Program,
    /// Only a call of an undeclared routine with this name.
    UnknownCall(Arc<str>),
}

/// The modules of one task with their symbol tables.
#[derive(Debug)]
pub struct Program {
    /// The modules, in the order of the input.
    pub modules: Vec<Module>,
    /// Names declared more than once.
    pub clashes: Vec<Clash>,
    global: BTreeMap<String, Symbol>,
    local: Vec<BTreeMap<String, Symbol>>,
    written: BTreeMap<DataId, Writer>,
}

/// The declarations of each name, by the module in which it is local.
type Declarations<'a> = BTreeMap<(Option<usize>, &'a str), Vec<(Symbol, &'a Ident)>>;

impl Program {
    /// Builds the symbol tables; a name that is declared twice becomes [`Symbol::Ambiguous`].
    pub fn new(mut modules: Vec<Module>) -> Program {
        modules.extend(user::missing(&modules));
        let mut declared = Declarations::new();
        for (m, module) in modules.iter().enumerate() {
            let data = module.data.iter().enumerate().map(|(index, data)| {
                (data.scope, Symbol::Data(DataId { module: m, index }), &data.name)
            });
            let routines = module.routines.iter().enumerate().map(|(index, routine)| {
                (routine.scope, Symbol::Routine(RoutineId { module: m, index }), &routine.name)
            });
            for (scope, symbol, name) in data.chain(routines) {
                let table = (scope == Scope::Local).then_some(m);
                declared.entry((table, &name.key)).or_default().push((symbol, name));
            }
        }
        let mut global = BTreeMap::new();
        let mut local = vec![BTreeMap::new(); modules.len()];
        let mut clashes = Vec::new();
        for ((module, key), list) in declared {
            let symbol = if let [(symbol, _)] = list.as_slice() {
                *symbol
            } else {
                let spans = list.iter().map(|(_, name)| name.span).collect();
                clashes.push(Clash { name: list[0].1.clone(), module, spans });
                Symbol::Ambiguous
            };
            let table = module.map_or(&mut global, |m| &mut local[m]);
            table.insert(key.to_owned(), symbol);
        }
        let mut program = Program { modules, clashes, global, local, written: BTreeMap::new() };
        program.written = program.find_written();
        program
    }

    /// The meaning of `key` in a module.
    pub fn resolve(&self, module: usize, key: &str) -> Option<Symbol> {
        self.local[module].get(key).or_else(|| self.global.get(key)).copied()
    }

    /// The meaning of `key` among the global names.
    pub fn resolve_global(&self, key: &str) -> Option<Symbol> {
        self.global.get(key).copied()
    }

    /// The routines of all modules.
    pub fn routines(&self) -> impl Iterator<Item = (RoutineId, &Routine)> {
        self.modules.iter().enumerate().flat_map(|(module, body)| {
            let routines = body.routines.iter().enumerate();
            routines.map(move |(index, routine)| (RoutineId { module, index }, routine))
        })
    }

    /// The statements of compact IFs.
    pub fn in_compact_ifs(&self) -> BTreeSet<Span> {
        let statements = self.routines().flat_map(|(_, routine)| routine.statements());
        statements.filter_map(Stmt::compact).map(|(_, only)| only.span).collect()
    }

    /// The declaration.
    pub fn data(&self, id: DataId) -> &Data {
        &self.modules[id.module].data[id.index]
    }

    /// The routine.
    pub fn routine(&self, id: RoutineId) -> &Routine {
        &self.modules[id.module].routines[id.index]
    }

    /// True if some statement of the program may change this data.
    pub fn is_written(&self, id: DataId) -> bool {
        self.written.contains_key(&id)
    }

    /// What may change this data, if anything.
    pub fn writer(&self, id: DataId) -> Option<&Writer> {
        self.written.get(&id)
    }

    /// The declarations of a global name, if there is more than one.
    pub fn clash(&self, name: &str) -> Option<&Clash> {
        let key = name.to_lowercase();
        self.clashes.iter().find(|clash| clash.module.is_none() && clash.name.key == key)
    }

    /// The routine that starts the program: a procedure with this global name.
    pub fn entry(&self, name: &str) -> Option<RoutineId> {
        match self.resolve_global(&name.to_lowercase())? {
            Symbol::Routine(id) if matches!(self.routine(id).kind, RoutineKind::Proc) => Some(id),
            _ => None,
        }
    }

    /// Component names and types of a record type, aliases followed.
    pub fn components(&self, type_key: &str) -> Option<Vec<(String, String)>> {
        let mut key = type_key.to_owned();
        // An alias chain is short; a circular one ends here.
        for _ in 0..16 {
            let known = builtins::data_type(&key).into_iter().flat_map(DataType::components);
            let parts: Vec<_> = known.map(|(name, ty)| (name.to_owned(), ty.to_owned())).collect();
            if !parts.is_empty() {
                return Some(parts);
            }
            let def = self.modules.iter().flat_map(|m| &m.types).find(|t| t.name.key == key)?;
            match &def.kind {
                TypeDefKind::Record(parts) => {
                    let parts = parts.iter().map(|(ty, name)| (name.key.clone(), ty.key.clone()));
                    return Some(parts.collect());
                }
                TypeDefKind::Alias(target) => key.clone_from(&target.key),
            }
        }
        None
    }

    /// The module data that an assignment or a call may write.
    fn find_written(&self) -> BTreeMap<DataId, Writer> {
        let mut found = Written::default();
        // A written parameter makes the arguments of its callers written: repeat until stable.
        loop {
            found.changed = false;
            for (id, routine) in self.routines() {
                let scope = RoutineScope { program: self, id };
                for stmt in routine.statements() {
                    scope.statement(stmt, &mut found);
                }
            }
            if !found.changed {
                return found.data;
            }
        }
    }
}

#[derive(Default)]
struct Written {
    data: BTreeMap<DataId, Writer>,
    /// Parameters by reference, by index.
    params: BTreeMap<(RoutineId, usize), Writer>,
    changed: bool,
}

/// Adds a writer; [`Writer::Program`] replaces [`Writer::UnknownCall`]. True if this changed it.
fn add<K: Ord>(written: &mut BTreeMap<K, Writer>, key: K, writer: &Writer) -> bool {
    match written.entry(key) {
        Entry::Vacant(place) => {
            place.insert(writer.clone());
            true
        }
        Entry::Occupied(mut known)
            if *writer == Writer::Program && *known.get() != Writer::Program =>
        {
            known.insert(Writer::Program);
            true
        }
        Entry::Occupied(_) => false,
    }
}

struct RoutineScope<'a> {
    program: &'a Program,
    id: RoutineId,
}

impl RoutineScope<'_> {
    fn statement(&self, stmt: &Stmt, found: &mut Written) {
        match &stmt.kind {
            StmtKind::Assign { target, .. } | StmtKind::Connect { interrupt: target, .. } => {
                self.target(target, &Writer::Program, found);
            }
            StmtKind::Call(call) => self.call(call, found),
            _ => {}
        }
        for (name, args) in stmt.kind.exprs().into_iter().flat_map(Expr::calls) {
            let function = builtins::function(&name.key);
            self.arguments(Some(name), args, found, |place| match function {
                Some(function) => function.writes_to(place).then_some(Writer::Program),
                None => Some(Writer::UnknownCall(name.text.as_str().into())),
            });
        }
    }

    fn call(&self, call: &Call, found: &mut Written) {
        let (text, name) = match &call.callee {
            Callee::Name(name) => (name.text.as_str(), Some(name)),
            Callee::Late(_) => ("%…%", None),
        };
        let instruction = name.and_then(|name| builtins::instruction(&name.key));
        self.arguments(name, &call.args, found, |place| match instruction {
            Some(instruction) if !instruction.may_write_to(place) => None,
            Some(instruction) if instruction.is_writing() => Some(Writer::Program),
            _ => Some(Writer::UnknownCall(text.into())),
        });
    }

    /// The arguments of a call; `outside` is what writes to an argument if the program does not declare
    /// the routine.
    fn arguments(
        &self,
        name: Option<&Ident>,
        args: &[Arg],
        found: &mut Written,
        outside: impl Fn(ArgumentPlace<'_>) -> Option<Writer>,
    ) {
        let callee = name.and_then(|name| self.program.resolve(self.id.module, &name.key));
        for (place, expr) in arguments_with_places(args) {
            let writer = if let Some(Symbol::Routine(id)) = callee {
                let params = &self.program.routine(id).params;
                let index = match place {
                    ArgumentPlace::Name(key) => params.iter().position(|p| p.name.key == key),
                    ArgumentPlace::Position(n) => {
                        let required = params.iter().enumerate().filter(|(_, p)| !p.optional);
                        required.map(|(i, _)| i).nth(n)
                    }
                };
                index.and_then(|index| found.params.get(&(id, index)).cloned())
            } else if let (Some(name), Some(_)) = (name, callee) {
                Some(Writer::UnknownCall(name.text.as_str().into()))
            } else {
                outside(place)
            };
            if let Some(writer) = writer {
                self.target(expr, &writer, found);
            }
        }
    }

    fn target(&self, expr: &Expr, writer: &Writer, found: &mut Written) {
        match &expr.kind {
            ExprKind::Ref(name) => {
                let routine = self.program.routine(self.id);
                if let Some(index) = routine.params.iter().position(|p| p.name.key == name.key) {
                    if routine.params[index].mode != ParamMode::In {
                        found.changed |= add(&mut found.params, (self.id, index), writer);
                    }
                } else if !routine.data.iter().any(|d| d.name.key == name.key)
                    && let Some(Symbol::Data(id)) = self.program.resolve(self.id.module, &name.key)
                    && self.program.data(id).kind != DataKind::Const
                {
                    found.changed |= add(&mut found.data, id, writer);
                }
            }
            ExprKind::Field(base, _) | ExprKind::Index(base, _) => {
                self.target(base, writer, found);
            }
            _ => {}
        }
    }
}
