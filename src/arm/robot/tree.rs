//! A TOML document as a tree of values with line and origin, and the overlay of such trees.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::RobotError;
use super::provenance::Provenance;

/// Largest depth of nesting in a robot file; the format needs four.
const MAX_DEPTH: usize = 16;

/// Alternative keys of one quantity: a key of an overlay also replaces its alternative.
const ALTERNATIVES: [[&str; 2]; 1] = [["loss_constant", "resistance"]];

/// A line of a file.
#[derive(Clone, Debug)]
pub(super) struct Place {
    file: Arc<str>,
    line: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.file, self.line)
    }
}

/// The values of `source`, `provenance` and `sd` for a value.
#[derive(Clone, Debug, Default)]
pub(super) struct Stated {
    pub(super) provenance: Option<Provenance>,
    pub(super) source: Option<String>,
    /// Only for the value itself, not for nested values.
    pub(super) sd: Option<Vec<f64>>,
}

/// A value with its place and origin.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) place: Place,
    pub(super) stated: Stated,
    pub(super) value: Value,
}

/// A TOML value.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(f64),
    Text(String),
    List(Vec<Node>),
    Table(BTreeMap<String, Node>),
    /// An unsupported type, in words.
    Other(&'static str),
}

impl Value {
    /// The kind of value in words.
    pub(super) fn kind(&self) -> String {
        match self {
            Value::Number(_) => "a number".into(),
            Value::Text(_) => "a text".into(),
            Value::List(_) => "a list".into(),
            Value::Table(_) => "a table".into(),
            Value::Other(kind) => (*kind).into(),
        }
    }
}

/// Reads a document; `file` names it in messages.
pub(super) fn parse(file: &str, text: &str) -> Result<Node, RobotError> {
    let builder = Builder { file: file.into(), text };
    let table = DeTable::parse(text).map_err(|error| RobotError::Syntax {
        place: builder.place(error.span().map_or(0, |span| span.start)).to_string(),
        message: error.message().to_owned(),
    })?;
    builder.table(builder.place(0), table.get_ref(), &Stated::default(), 0)
}

/// `over` on `base`: tables are merged by key, other values are replaced with their origins.
pub(super) fn overlay(base: Node, over: Node) -> Node {
    match (base.value, over.value) {
        (Value::Table(mut below), Value::Table(above)) => {
            for pair in ALTERNATIVES {
                for (given, other) in [(pair[0], pair[1]), (pair[1], pair[0])] {
                    if above.contains_key(given) && !above.contains_key(other) {
                        below.remove(other);
                    }
                }
            }
            for (key, node) in above {
                let merged = match below.remove(&key) {
                    Some(old) => overlay(old, node),
                    None => node,
                };
                below.insert(key, merged);
            }
            Node { place: over.place, stated: over.stated, value: Value::Table(below) }
        }
        (_, value) => Node { place: over.place, stated: over.stated, value },
    }
}

/// Adds the name of a robot as the type of the robots that extend it.
pub(super) fn with_type(mut base: Node) -> Node {
    if let Value::Table(entries) = &mut base.value
        && let Some(name) = entries.get("name").cloned()
    {
        entries.entry("type".to_owned()).or_insert(name);
    }
    base
}

struct Builder<'a> {
    file: Arc<str>,
    text: &'a str,
}

impl Builder<'_> {
    fn place(&self, offset: usize) -> Place {
        let before = self.text.get(..offset).unwrap_or_default();
        let line = 1 + before.matches('\n').count();
        Place { file: Arc::clone(&self.file), line }
    }

    fn table(
        &self,
        place: Place,
        table: &DeTable<'_>,
        outer: &Stated,
        depth: usize,
    ) -> Result<Node, RobotError> {
        let stated = self.stated(table, "source", "provenance", outer)?;
        let mut entries = BTreeMap::new();
        for (key, value) in table {
            let name: &str = key.get_ref();
            if name == "source" || name == "provenance" {
                continue;
            }
            let base = name.strip_suffix("_source").or_else(|| name.strip_suffix("_provenance"));
            if base.is_some_and(|base| table.contains_key(base)) && value.get_ref().is_str() {
                continue;
            }
            if name.strip_suffix("_sd").is_some_and(|base| table.contains_key(base)) {
                continue;
            }
            let mut own = self.stated(
                table,
                &format!("{name}_source"),
                &format!("{name}_provenance"),
                &stated,
            )?;
            let sd_key = format!("{name}_sd");
            let sd = table.get(sd_key.as_str());
            let sd = sd.map(|sd| self.deviations(&sd_key, sd, count(value.get_ref())));
            own.sd = sd.transpose()?;
            let node = self.node(key.span().start, value, &own, depth + 1)?;
            entries.insert(name.to_owned(), node);
        }
        Ok(Node { place, stated, value: Value::Table(entries) })
    }

    fn stated(
        &self,
        table: &DeTable<'_>,
        source_key: &str,
        provenance_key: &str,
        outer: &Stated,
    ) -> Result<Stated, RobotError> {
        let mut stated = outer.clone();
        if let Some(value) = table.get(source_key) {
            stated.source = Some(self.text(source_key, value)?.to_owned());
        }
        if let Some(value) = table.get(provenance_key) {
            let word = self.text(provenance_key, value)?;
            let known = Provenance::WORDS.iter().find(|(name, _)| *name == word);
            let Some((_, provenance)) = known else {
                return Err(RobotError::Value {
                    place: self.place(value.span().start).to_string(),
                    key: provenance_key.to_owned(),
                    value: format!("\"{word}\""),
                    must: "datasheet, identified, paper, estimated or assumed".into(),
                });
            };
            stated.provenance = Some(*provenance);
        }
        Ok(stated)
    }

    /// The standard deviations of a value: one, or one per number.
    fn deviations(
        &self,
        key: &str,
        value: &Spanned<DeValue<'_>>,
        numbers: usize,
    ) -> Result<Vec<f64>, RobotError> {
        let place = || self.place(value.span().start).to_string();
        let node = self.node(value.span().start, value, &Stated::default(), 0)?;
        let items = match node.value {
            Value::List(items) => items,
            _ => vec![node],
        };
        let deviation = |item: Node| match item.value {
            Value::Number(sd) if sd >= 0.0 && sd.is_finite() => Ok(sd),
            Value::Number(sd) => Err(RobotError::Value {
                place: place(),
                key: key.to_owned(),
                value: sd.to_string(),
                must: "0 or more: a standard deviation".into(),
            }),
            other => Err(RobotError::Type {
                place: place(),
                key: key.to_owned(),
                found: other.kind(),
                expected: "a number or a list of numbers".into(),
            }),
        };
        let found = items.into_iter().map(deviation).collect::<Result<Vec<f64>, _>>()?;
        if found.len() == 1 || found.len() == numbers {
            return Ok(found);
        }
        Err(RobotError::Length {
            place: place(),
            key: key.to_owned(),
            found: found.len(),
            expected: format!("1, or {numbers} as the value has"),
        })
    }

    fn text<'v>(&self, key: &str, value: &'v Spanned<DeValue<'_>>) -> Result<&'v str, RobotError> {
        value.get_ref().as_str().ok_or_else(|| RobotError::Type {
            place: self.place(value.span().start).to_string(),
            key: key.to_owned(),
            found: kind(value.get_ref()).to_owned(),
            expected: "a text".into(),
        })
    }

    fn node(
        &self,
        offset: usize,
        value: &Spanned<DeValue<'_>>,
        stated: &Stated,
        depth: usize,
    ) -> Result<Node, RobotError> {
        let place = self.place(offset);
        if depth > MAX_DEPTH {
            return Err(RobotError::Syntax {
                place: place.to_string(),
                message: format!("nested more than {MAX_DEPTH} deep"),
            });
        }
        let value = match value.get_ref() {
            DeValue::Table(table) => return self.table(place, table, stated, depth),
            DeValue::Array(array) => Value::List(
                array
                    .iter()
                    .map(|item| self.node(item.span().start, item, stated, depth + 1))
                    .collect::<Result<_, _>>()?,
            ),
            DeValue::String(text) => Value::Text(text.to_string()),
            DeValue::Integer(number) => {
                let digits = number.as_str().replace('_', "");
                let value = match number.radix() {
                    10 => digits.parse().unwrap_or(f64::NAN),
                    radix => i64::from_str_radix(&digits, radix).map_or(f64::NAN, |n| n as f64),
                };
                Value::Number(value)
            }
            DeValue::Float(number) => {
                Value::Number(number.as_str().replace('_', "").parse().unwrap_or(f64::NAN))
            }
            other => Value::Other(kind(other)),
        };
        Ok(Node { place, stated: stated.clone(), value })
    }
}

/// Number of numbers in a value.
fn count(value: &DeValue<'_>) -> usize {
    match value {
        DeValue::Integer(_) | DeValue::Float(_) => 1,
        DeValue::Array(items) => items.iter().map(|item| count(item.get_ref())).sum(),
        _ => 0,
    }
}

fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "a truth value",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}
