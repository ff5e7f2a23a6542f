//! Changes of a cell by an operator, another task, an input or a service technician.

use std::collections::BTreeMap;

use joulepath::arm::robot::{Model, find};
use joulepath::rapid::ir::hir::{
    Block, Data, DataKind, Expr, ExprKind, RoutineKind, StmtKind, UnaryOp,
};
use joulepath::rapid::ir::lower;
use joulepath::rapid::syntax;
use joulepath::rapid::text::{FileId, SourceFile, Span};
use joulepath::retime::motion::Options;

use crate::support::Random;

/// A change.
#[derive(Clone, Debug)]
pub(crate) enum Change {
    /// New value of data: name, index of the number or truth value in it, and kind of change.
    Datum { name: String, index: usize, how: How },
    /// Level of an input.
    Input { signal: String, level: f64 },
    /// A statement at a mark.
    Statement { mark: usize, text: String },
    /// Another start of the robot, rad.
    Start([f64; 6]),
    /// Another robot.
    Robot(&'static str),
    /// The base of the robot moves along x, m.
    Base(f64),
    /// Number of passes of the endless loop.
    Passes(u32),
    /// The operator's speed override, share.
    Override(f64),
}

/// Change of a number.
#[derive(Clone, Copy, Debug)]
pub(crate) enum How {
    /// Adds a value.
    By(f64),
    /// Multiplies by a factor.
    Times(f64),
    /// Inverts a truth value.
    Turn,
}

/// A number or truth value in the initial value of data.
#[derive(Clone, Debug)]
pub(crate) struct Slot {
    name: String,
    type_key: String,
    index: usize,
    is_bool: bool,
    value: f64,
}

/// The possible changes of a program.
pub(crate) struct Cell {
    pub(crate) slots: Vec<Slot>,
    pub(crate) signals: Vec<String>,
    /// Marks at which a statement has the same effect in both programs.
    pub(crate) outside: Vec<usize>,
    /// Marks at which another task may write.
    pub(crate) writes: Vec<usize>,
    /// `PERS` data, which other tasks may write: name and type.
    pub(crate) shared: Vec<(String, String)>,
}

/// Mark before a statement: a comment on its own line.
pub(crate) fn mark(index: usize) -> String {
    format!("!@{index}@")
}

/// The program with a mark before each statement that begins a line, and the number of marks.
pub(crate) fn marked(text: &str) -> (String, usize) {
    let parse = syntax::parse(text.as_bytes());
    let modules = lower(FileId(0), &parse, text.as_bytes());
    let mut places = Vec::new();
    for routine in modules.iter().flat_map(|module| &module.routines) {
        if matches!(routine.kind, RoutineKind::Proc) {
            statements(&routine.body, text, &mut places);
        }
    }
    places.sort_unstable();
    let mut marked = text.to_owned();
    for (index, at) in places.iter().enumerate().rev() {
        marked.insert_str(*at, &format!("{}\n", mark(index)));
    }
    (marked, places.len())
}

fn statements(block: &Block, text: &str, places: &mut Vec<usize>) {
    for stmt in block {
        let at = stmt.span.start as usize;
        let line = text[..at].rfind('\n').map_or(0, |i| i + 1);
        if text[line..at].trim().is_empty() && !matches!(stmt.kind, StmtKind::Data(_)) {
            places.push(at);
        }
        for inner in stmt.kind.blocks() {
            statements(inner, text, places);
        }
    }
}

/// Whether a mark is in the branch that a stream replaces.
pub(crate) fn is_within(text: &str, index: usize) -> bool {
    text.find(&mark(index)).is_some_and(|at| guard_of(text, at).is_some())
}

/// Start of the guard whose other branch contains a place.
fn guard_of(text: &str, at: usize) -> Option<usize> {
    text[..at].rfind("IF jpFits").filter(|start| {
        let between = &text[*start..at];
        between.contains("ELSE") && !between.contains("ENDIF")
    })
}

impl Cell {
    pub(crate) fn new(
        text: &str,
        signals: Vec<String>,
        outside: Vec<usize>,
        writes: Vec<usize>,
    ) -> Cell {
        let mut slots = Vec::new();
        let mut shared = Vec::new();
        for data in declared(text) {
            if data.kind == DataKind::Pers {
                shared.push((data.name.text.clone(), data.type_name.key.clone()));
            }
            let Some(init) = &data.init else { continue };
            for (index, (_, value)) in leaves(init).into_iter().enumerate() {
                let (is_bool, value) = match value {
                    Leaf::Num(x) if x.abs() < 1e8 => (false, x),
                    Leaf::Bool(_) => (true, 0.0),
                    Leaf::Num(_) => continue,
                };
                slots.push(Slot {
                    name: data.name.text.clone(),
                    type_key: data.type_name.key.clone(),
                    index,
                    is_bool,
                    value,
                });
            }
        }
        Cell { slots, signals, outside, writes, shared }
    }

    /// A random change.
    pub(crate) fn draw(&self, random: &mut Random) -> Change {
        let robots = ["IRB1600-10/1.2", "IRB1600-6/1.45", "IRB2600-12/1.65"];
        match random.below(20) {
            0..=9 if !self.slots.is_empty() => self.datum(random),
            10 | 11 if !self.signals.is_empty() => {
                let signal = self.signals[random.below(self.signals.len())].clone();
                Change::Input { signal, level: random.below(3) as f64 }
            }
            12..=14 if !self.outside.is_empty() => self.setting(random),
            15 if !self.writes.is_empty() && !self.shared.is_empty() => self.write(random),
            16 | 17 => Change::Start(std::array::from_fn(|j| {
                let home = [0.0, -12.0, 14.0, 0.0, 60.0, 0.0][j];
                f64::to_radians(home + sign(random) * log(random, 0.005, 5.0))
            })),
            18 => match random.below(5) {
                0 => Change::Base(sign(random) * log(random, 0.0005, 0.05)),
                i => Change::Robot(robots[i % robots.len()]),
            },
            _ => match random.below(3) {
                0 => Change::Override([0.05, 0.25, 0.5, 0.99][random.below(4)]),
                _ => Change::Passes(1 + random.below(3) as u32),
            },
        }
    }

    fn datum(&self, random: &mut Random) -> Change {
        let slot = &self.slots[random.below(self.slots.len())];
        let small = slot.value == slot.value.round() && slot.value.abs() <= 12.0;
        let how = match slot.type_key.as_str() {
            _ if slot.is_bool => How::Turn,
            "robtarget" | "pose" | "pos" if slot.index < 3 => {
                How::By(sign(random) * log(random, 0.05, 50.0))
            }
            "robtarget" | "pose" => How::By(sign(random) * log(random, 1e-5, 0.02)),
            "jointtarget" => How::By(sign(random) * log(random, 0.003, 5.0)),
            "speeddata" | "zonedata" => How::Times(log(random, 0.2, 1.5)),
            "num" if small => How::By(sign(random)),
            "tooldata" | "wobjdata" | "loaddata" | "num" => {
                How::By(sign(random) * log(random, 0.05, 50.0))
            }
            _ => How::Times(log(random, 0.9, 1.1)),
        };
        Change::Datum { name: slot.name.clone(), index: slot.index, how }
    }

    fn setting(&self, random: &mut Random) -> Change {
        let settings = [
            "VelSet 60,5000;",
            "VelSet 100,300;",
            "AccSet 50,100;",
            "AccSet 100,40;",
            "SingArea\\Wrist;",
            "ConfL\\Off;",
            "ConfJ\\Off;",
            "PDispSet [[12,-7,9],[1,0,0,0]];",
            "PDispOff;",
            "PathAccLim TRUE\\AccMax:=1.5,TRUE\\DecelMax:=1.5;",
            "WorldAccLim\\On:=1.2;",
            "SpeedRefresh 40;",
        ];
        let text = settings[random.below(settings.len())].to_owned();
        Change::Statement { mark: self.outside[random.below(self.outside.len())], text }
    }

    /// Another task writes to shared data.
    fn write(&self, random: &mut Random) -> Change {
        let (name, kind) = &self.shared[random.below(self.shared.len())];
        let by = sign(random) * log(random, 0.05, 50.0);
        let text = match kind.as_str() {
            "wobjdata" => format!("{name}.uframe.trans.x:={name}.uframe.trans.x+({by});"),
            "robtarget" => format!("{name}.trans.z:={name}.trans.z+({by});"),
            "tooldata" => format!("{name}.tframe.trans.z:={name}.tframe.trans.z+({by});"),
            "num" => format!("{name}:={name}+({by});"),
            "pose" => format!("{name}.trans.y:={name}.trans.y+({by});"),
            "bool" => format!("{name}:=NOT {name};"),
            _ => String::new(),
        };
        Change::Statement { mark: self.writes[random.below(self.writes.len())], text }
    }
}

fn sign(random: &mut Random) -> f64 {
    if random.below(2) == 0 { -1.0 } else { 1.0 }
}

/// Log-uniform.
fn log(random: &mut Random, from: f64, to: f64) -> f64 {
    let share = random.below(1 << 20) as f64 / f64::from(1 << 20);
    from * (to / from).powf(share)
}

enum Leaf {
    Num(f64),
    Bool(bool),
}

/// The numbers and truth values in an initial value, with their spans.
fn leaves(expr: &Expr) -> Vec<(Span, Leaf)> {
    match &expr.kind {
        ExprKind::Num(x) => vec![(expr.span, Leaf::Num(*x))],
        ExprKind::Bool(b) => vec![(expr.span, Leaf::Bool(*b))],
        ExprKind::Unary(UnaryOp::Minus, inner) => match &inner.kind {
            ExprKind::Num(x) => vec![(expr.span, Leaf::Num(-x))],
            _ => Vec::new(),
        },
        ExprKind::Aggregate(items) => items.iter().flat_map(leaves).collect(),
        _ => Vec::new(),
    }
}

fn declared(text: &str) -> Vec<Data> {
    let parse = syntax::parse(text.as_bytes());
    let modules = lower(FileId(0), &parse, text.as_bytes());
    modules.into_iter().flat_map(|module| module.data).collect()
}

/// A program and its conditions after some changes.
pub(crate) struct Changed {
    pub(crate) files: Vec<SourceFile>,
    pub(crate) options: Options,
    pub(crate) model: Model,
}

/// Applies changes equally to an original or a retrofit.
pub(crate) fn apply(files: &[String], model: &Model, changes: &[Change]) -> Changed {
    let mut texts = files.to_vec();
    let mut options = Options::default();
    let mut model = model.clone();
    for change in changes {
        match change {
            Change::Datum { name, index, how } => {
                for text in &mut texts {
                    change_datum(text, name, *index, *how);
                }
            }
            Change::Input { signal, level } => {
                options.levels.insert(signal.to_lowercase(), *level);
            }
            Change::Statement { mark: index, text: statement } => {
                for text in &mut texts {
                    insert(text, &mark(*index), statement);
                }
            }
            Change::Start(q) => options.start = Some(*q),
            Change::Robot(name) => model = find(name).unwrap(),
            Change::Base(x) => model.kinematics.base.translation.x += x,
            Change::Passes(passes) => options.passes = Some(*passes),
            Change::Override(share) => options.speed_override = Some(*share),
        }
    }
    let files = texts
        .into_iter()
        .enumerate()
        .map(|(i, text)| SourceFile::new(FileId(i as u32), format!("m{i}.mod"), text.into_bytes()))
        .collect();
    Changed { files, options, model }
}

fn change_datum(text: &mut String, name: &str, index: usize, how: How) {
    let Some(data) = declared(text).into_iter().find(|data| data.name.text == name) else { return };
    let Some(init) = &data.init else { return };
    let Some((span, leaf)) = leaves(init).into_iter().nth(index) else { return };
    let new = match (leaf, how) {
        (Leaf::Num(x), How::By(d)) => format!("{:.6}", x + d),
        (Leaf::Num(x), How::Times(f)) => format!("{:.6}", x * f),
        (Leaf::Bool(b), How::Turn) => if b { "FALSE" } else { "TRUE" }.to_owned(),
        _ => return,
    };
    text.replace_range(span.start as usize..span.end as usize, &new);
}

/// Inserts a statement at a mark. If a stream replaces the branch of the mark, the statement also
/// follows the stream: the other task writes in any case.
fn insert(text: &mut String, mark: &str, statement: &str) {
    let Some(at) = text.find(mark) else { return };
    let guard = guard_of(text, at);
    text.insert_str(at + mark.len(), &format!("\n{statement}\n"));
    if let Some(run) = guard.and_then(|start| text[start..at].find("jpRun").map(|i| start + i)) {
        let end = run + text[run..].find(';').unwrap() + 1;
        text.insert_str(end, &format!(" {statement}"));
    }
}

/// Name of the kind of a change, for the report.
pub(crate) fn kind(change: &Change) -> &'static str {
    match change {
        Change::Datum { .. } => "datum",
        Change::Input { .. } => "input",
        Change::Statement { text, .. } if text.contains(":=") && !text.contains('\\') => "write",
        Change::Statement { .. } => "setting",
        Change::Start(_) => "start",
        Change::Robot(_) | Change::Base(_) => "robot",
        Change::Passes(_) => "passes",
        Change::Override(_) => "override",
    }
}

/// Number of changes of each kind.
pub(crate) type Counts = BTreeMap<&'static str, usize>;
