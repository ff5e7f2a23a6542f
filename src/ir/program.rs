//! The modules of a task and its symbols.

use std::collections::{BTreeMap, BTreeSet};

use super::hir::{
    ArgKind, Block, Call, Callee, Data, DataKind, Expr, ExprKind, Module, ParamMode, Routine,
    RoutineKind, Scope, StmtKind, TypeDefKind,
};
use super::{instructions, layout};

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

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symbol {
    /// Data at module level.
    Data(DataId),
    /// A routine.
    Routine(RoutineId),
}

/// The modules of one task with their symbol tables.
#[derive(Debug)]
pub struct Program {
    /// The modules, in the order of the input.
    pub modules: Vec<Module>,
    global: BTreeMap<String, Symbol>,
    local: Vec<BTreeMap<String, Symbol>>,
    written: BTreeSet<DataId>,
}

impl Program {
    /// Builds the symbol tables; where a global name occurs twice, the first one wins.
    pub fn new(modules: Vec<Module>) -> Program {
        let mut global = BTreeMap::new();
        let mut local = vec![BTreeMap::new(); modules.len()];
        for (m, module) in modules.iter().enumerate() {
            for (index, data) in module.data.iter().enumerate() {
                let symbol = Symbol::Data(DataId { module: m, index });
                let table = if data.scope == Scope::Local { &mut local[m] } else { &mut global };
                table.entry(data.name.key.clone()).or_insert(symbol);
            }
            for (index, routine) in module.routines.iter().enumerate() {
                let symbol = Symbol::Routine(RoutineId { module: m, index });
                let table = if routine.scope == Scope::Local { &mut local[m] } else { &mut global };
                table.entry(routine.name.key.clone()).or_insert(symbol);
            }
        }
        let mut program = Program { modules, global, local, written: BTreeSet::new() };
        program.written = program.find_written();
        program
    }

    /// What `key` means in a module.
    pub fn resolve(&self, module: usize, key: &str) -> Option<Symbol> {
        self.local[module].get(key).or_else(|| self.global.get(key)).copied()
    }

    /// What `key` means outside all modules.
    pub fn resolve_global(&self, key: &str) -> Option<Symbol> {
        self.global.get(key).copied()
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
        self.written.contains(&id)
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
            if let Some(known) = layout::components(&key) {
                return Some(known.iter().map(|(n, t)| ((*n).into(), (*t).into())).collect());
            }
            let def = self.modules.iter().flat_map(|m| &m.types).find(|t| t.name.key == key)?;
            match &def.kind {
                TypeDefKind::Record(parts) => {
                    return Some(
                        parts.iter().map(|(ty, name)| (name.key.clone(), ty.key.clone())).collect(),
                    );
                }
                TypeDefKind::Alias(target) => key.clone_from(&target.key),
            }
        }
        None
    }

    /// Module data that some assignment, or an argument that is written through, names.
    fn find_written(&self) -> BTreeSet<DataId> {
        let mut found = Written::default();
        // A parameter found written makes its callers' arguments written: repeat until stable.
        loop {
            let before = (found.data.len(), found.params.len());
            for (module, body) in self.modules.iter().enumerate() {
                for (index, routine) in body.routines.iter().enumerate() {
                    let scope = RoutineScope { program: self, id: RoutineId { module, index } };
                    for block in routine.blocks() {
                        scope.find(block, &mut found);
                    }
                }
            }
            if before == (found.data.len(), found.params.len()) {
                return found.data;
            }
        }
    }
}

#[derive(Default)]
struct Written {
    data: BTreeSet<DataId>,
    /// Parameters by reference, by index.
    params: BTreeSet<(RoutineId, usize)>,
}

struct RoutineScope<'a> {
    program: &'a Program,
    id: RoutineId,
}

impl RoutineScope<'_> {
    fn find(&self, block: &Block, found: &mut Written) {
        for stmt in block {
            match &stmt.kind {
                StmtKind::Assign { target, .. } => self.target(target, found),
                StmtKind::Call(call) => self.call(call, found),
                StmtKind::Connect { interrupt, .. } => self.target(interrupt, found),
                _ => {}
            }
            for inner in stmt.kind.blocks() {
                self.find(inner, found);
            }
        }
    }

    fn call(&self, call: &Call, found: &mut Written) {
        let callee = match &call.callee {
            Callee::Name(name) => self.program.resolve(self.id.module, &name.key),
            Callee::Late(_) => None,
        };
        let harmless = match &call.callee {
            Callee::Name(name) => callee.is_none() && !instructions::may_write(&name.key),
            Callee::Late(_) => false,
        };
        if harmless {
            return;
        }
        let mut position = 0;
        for arg in &call.args {
            let (expr, name) = match &arg.kind {
                ArgKind::Positional(expr) => (expr, None),
                ArgKind::Named(name, expr) | ArgKind::Optional(name, Some(expr)) => {
                    (expr, Some(&name.key))
                }
                ArgKind::Optional(_, None) | ArgKind::Conditional(..) => continue,
            };
            let writes = match callee {
                Some(Symbol::Routine(id)) => {
                    let params = &self.program.routine(id).params;
                    let index = if let Some(key) = name {
                        params.iter().position(|p| p.name.key == *key)
                    } else {
                        let required = params.iter().enumerate().filter(|(_, p)| !p.optional);
                        required.map(|(i, _)| i).nth(position)
                    };
                    index.is_some_and(|index| found.params.contains(&(id, index)))
                }
                _ => true,
            };
            if writes {
                self.target(expr, found);
            }
            position += usize::from(name.is_none());
        }
    }

    fn target(&self, expr: &Expr, found: &mut Written) {
        match &expr.kind {
            ExprKind::Ref(name) => {
                let routine = self.program.routine(self.id);
                if let Some(index) = routine.params.iter().position(|p| p.name.key == name.key) {
                    if routine.params[index].mode != ParamMode::In {
                        found.params.insert((self.id, index));
                    }
                } else if !routine.data.iter().any(|d| d.name.key == name.key)
                    && let Some(Symbol::Data(id)) = self.program.resolve(self.id.module, &name.key)
                    && self.program.data(id).kind != DataKind::Const
                {
                    found.data.insert(id);
                }
            }
            ExprKind::Field(base, _) | ExprKind::Index(base, _) => self.target(base, found),
            _ => {}
        }
    }
}
