//! Values of RAPID data, and their dependences.

use std::sync::Arc;

use crate::rapid::text::Span;

/// A value without its type.
#[derive(Clone, Debug, PartialEq)]
pub enum Datum {
    /// `num`, `dnum` and their aliases.
    Num(f64),
    /// `bool`.
    Bool(bool),
    /// `string`.
    Text(Arc<str>),
    /// Record or array, components in order.
    List(Vec<Datum>),
    /// A name that no module declares, assumed to be an I/O signal of the system.
    Signal(Arc<str>),
    /// Unknown, with the reason.
    Unknown(Arc<Unknown>),
}

/// Why a value is not known.
#[derive(Debug, PartialEq)]
pub struct Unknown {
    /// The reason in words.
    pub reason: String,
    /// The place in the source that causes it.
    pub span: Span,
}

impl Datum {
    /// A list of numbers.
    pub(super) fn nums(values: impl IntoIterator<Item = f64>) -> Datum {
        Datum::List(values.into_iter().map(Datum::Num).collect())
    }

    /// An unknown value.
    pub fn unknown(reason: impl Into<String>, span: Span) -> Datum {
        Datum::Unknown(Arc::new(Unknown { reason: reason.into(), span }))
    }

    /// The number, if it is one.
    pub fn num(&self) -> Option<f64> {
        match self {
            Datum::Num(x) => Some(*x),
            _ => None,
        }
    }

    /// The first unknown part, if there is one.
    pub fn first_unknown(&self) -> Option<&Arc<Unknown>> {
        match self {
            Datum::Unknown(u) => Some(u),
            Datum::List(items) => items.iter().find_map(Datum::first_unknown),
            _ => None,
        }
    }
}

/// Something other than a constant that a value depends on.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dependence {
    /// A loop variable, a parameter or a variable of the routine; its name as written.
    Local(Arc<str>),
    /// A variable of a function, which its callers can't name.
    Inner(Arc<str>),
    /// A variable that the program writes.
    Variable(Arc<str>),
    /// A `PERS` whose stored value may differ from the source.
    Persistent(Arc<str>),
    /// A `PERS` tool, work object or load that the program does not write: used as in the source.
    TrustedPersistent(Arc<str>),
    /// Data, and the undeclared routine that may change it.
    Exposed(Arc<str>, Arc<str>),
    /// An input signal, taken at an assumed level.
    Input(Arc<str>),
    /// The robot's position at the moment of execution.
    RobotState,
}

/// The dependences of a value, sorted, each once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origin(Vec<Dependence>);

impl Origin {
    /// A value that depends on one thing.
    pub fn of(dependence: Dependence) -> Origin {
        Origin(vec![dependence])
    }

    /// Adds what `other` depends on.
    pub fn join(&mut self, other: &Origin) {
        for dependence in &other.0 {
            if let Err(at) = self.0.binary_search(dependence) {
                self.0.insert(at, dependence.clone());
            }
        }
    }

    /// Whether an input is among them.
    pub(super) fn has_input(&self) -> bool {
        self.iter().any(|dependence| matches!(dependence, Dependence::Input(_)))
    }

    /// The dependences in order.
    pub fn iter(&self) -> impl Iterator<Item = &Dependence> {
        self.0.iter()
    }
}

/// A value with its type and origin.
#[derive(Clone, Debug)]
pub struct Value {
    /// The value.
    pub datum: Datum,
    /// Lower-case type name; empty for an aggregate that has no type yet.
    pub type_key: Arc<str>,
    /// Its dependences.
    pub origin: Origin,
}

impl Value {
    /// A constant of a type.
    pub fn constant(datum: Datum, type_key: &str) -> Value {
        Value { datum, type_key: type_key.into(), origin: Origin::default() }
    }

    /// An unknown value.
    pub fn unknown(reason: impl Into<String>, span: Span) -> Value {
        Value::constant(Datum::unknown(reason, span), "")
    }
}
