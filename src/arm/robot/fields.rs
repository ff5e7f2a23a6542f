//! Typed reading of one table of a robot file; keys that were not read are an error.

use std::collections::BTreeMap;

use super::error::RobotError;
use super::names::nearest;
use super::provenance::Origin;
use super::tree::{Node, Place, Value};

/// The numbers a key accepts.
#[derive(Clone, Copy)]
pub(super) enum Accepts {
    Finite,
    NonNegative,
    Positive,
    /// 0 to 1.
    Share,
    /// From the first to the second value; description in words.
    Between(f64, f64, &'static str),
}

impl Accepts {
    pub(super) fn holds(self, x: f64) -> bool {
        x.is_finite()
            && match self {
                Accepts::Finite => true,
                Accepts::NonNegative => x >= 0.0,
                Accepts::Positive => x > 0.0,
                Accepts::Share => (0.0..=1.0).contains(&x),
                Accepts::Between(least, most, _) => (least..=most).contains(&x),
            }
    }

    pub(super) fn words(self) -> &'static str {
        match self {
            Accepts::Finite => "a finite number",
            Accepts::NonNegative => "0 or more",
            Accepts::Positive => "more than 0",
            Accepts::Share => "between 0 and 1",
            Accepts::Between(_, _, words) => words,
        }
    }
}

/// Lengths within a robot \[m\].
pub(super) const LENGTH: Accepts = Accepts::Between(
    -50.0,
    50.0,
    "a length in metres, at most 50 (in millimetres it would be 1000 times more)",
);
/// Angles of a placement \[rad\].
pub(super) const ANGLE: Accepts = Accepts::Between(
    -13.0,
    13.0,
    "an angle in radians, at most two turns (180 degrees are 3.14159)",
);
/// Bounds of a joint \[rad\]; an endless joint has 100 turns to either side.
pub(super) const TURN: Accepts = Accepts::Between(
    -2000.0,
    2000.0,
    "an angle in radians, at most 50, or 628 for an endless joint (180 degrees are 3.14159)",
);
/// Numbers from this size on have an exponent in messages.
const EXPONENT_FROM: f64 = 1e9;
/// Largest bound of a bounded joint \[rad\].
pub(super) const MAX_BOUND: f64 = 50.0;
/// Smallest bound of an endless joint \[rad\].
const MIN_ENDLESS_BOUND: f64 = 600.0;

/// One table, read key by key.
pub(super) struct Fields {
    name: String,
    place: Place,
    entries: BTreeMap<String, Node>,
    known: Vec<String>,
    origins: Vec<Origin>,
    /// The origins of the tables below this one that were read.
    inner: Vec<Origin>,
}

impl Fields {
    /// The table in `node`; `name` is its name in messages and origins, empty for the document.
    pub(super) fn new(name: &str, node: Node) -> Result<Fields, RobotError> {
        match node.value {
            Value::Table(entries) => Ok(Fields {
                name: name.to_owned(),
                place: node.place,
                entries,
                known: Vec::new(),
                origins: Vec::new(),
                inner: Vec::new(),
            }),
            other => Err(RobotError::Type {
                place: node.place.to_string(),
                key: name.to_owned(),
                found: other.kind(),
                expected: "a table".into(),
            }),
        }
    }

    /// Position of the table.
    pub(super) fn place(&self) -> String {
        self.place.to_string()
    }

    /// Position of an unread key, or of the table if it is missing.
    pub(super) fn place_of(&self, key: &str) -> String {
        self.entries.get(key).map_or_else(|| self.place(), |node| node.place.to_string())
    }

    /// The origins of the read keys, first those of the tables below; an error if a key was not read.
    pub(super) fn finish(self) -> Result<Vec<Origin>, RobotError> {
        if let Some((key, node)) = self.entries.first_key_value() {
            return Err(RobotError::UnknownKey {
                place: node.place.to_string(),
                key: key.clone(),
                table: self.table_words(),
                known: self.known,
            });
        }
        Ok([self.inner, self.origins].concat())
    }

    /// What `read` makes of a table below this one, if it is present. All its keys must be read.
    pub(super) fn part<T>(
        &mut self,
        key: &str,
        read: impl FnOnce(&mut Fields) -> Result<T, RobotError>,
    ) -> Result<Option<T>, RobotError> {
        self.table(key)?.map(|table| self.read_whole(table, read)).transpose()
    }

    /// The same for each table of a list.
    pub(super) fn parts<T>(
        &mut self,
        key: &str,
        mut read: impl FnMut(&mut Fields) -> Result<T, RobotError>,
    ) -> Result<Vec<T>, RobotError> {
        let tables = self.tables(key)?.into_iter();
        tables.map(|table| self.read_whole(table, &mut read)).collect()
    }

    /// The same for a given table below this one.
    pub(super) fn read_whole<T>(
        &mut self,
        mut table: Fields,
        read: impl FnOnce(&mut Fields) -> Result<T, RobotError>,
    ) -> Result<T, RobotError> {
        let part = read(&mut table)?;
        self.inner.extend(table.finish()?);
        Ok(part)
    }

    /// The node of a key, if present.
    pub(super) fn take(&mut self, key: &str) -> Option<Node> {
        self.known.push(key.to_owned());
        self.entries.remove(key)
    }

    /// Whether the key is present and unread.
    pub(super) fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// Whether an unread key has a list.
    pub(super) fn is_list(&self, key: &str) -> bool {
        self.entries.get(key).is_some_and(|node| matches!(node.value, Value::List(_)))
    }

    /// The unread keys.
    pub(super) fn keys(&self) -> Vec<String> {
        self.entries.keys().cloned().collect()
    }

    /// The value, or an error for a missing key.
    pub(super) fn required<T>(&self, key: &str, value: Option<T>) -> Result<T, RobotError> {
        value.ok_or_else(|| RobotError::Missing {
            place: self.place(),
            table: self.table_words(),
            key: key.to_owned(),
            instead: nearest(key, self.entries.keys().map(String::as_str)).map(str::to_owned),
        })
    }

    /// What `read` finds at a key, or an error for a missing key.
    pub(super) fn must<T>(
        &mut self,
        key: &str,
        read: impl FnOnce(&mut Fields, &str) -> Result<Option<T>, RobotError>,
    ) -> Result<T, RobotError> {
        let value = read(self, key)?;
        self.required(key, value)
    }

    /// A text.
    pub(super) fn text(&mut self, key: &str) -> Result<Option<String>, RobotError> {
        let Some(node) = self.take(key) else { return Ok(None) };
        match &node.value {
            Value::Text(text) => Ok(Some(text.clone())),
            _ => Err(self.wrong_type(key, &node, "a text")),
        }
    }

    /// One of several words.
    pub(super) fn choice<T: Copy>(
        &mut self,
        key: &str,
        words: &[(&str, T)],
    ) -> Result<Option<T>, RobotError> {
        let list = words.iter().map(|(word, _)| format!("\"{word}\"")).collect::<Vec<_>>();
        let expected = list.join(" or ");
        self.noted(key, |fields, node| {
            let Value::Text(text) = &node.value else {
                return Err(fields.wrong_type(key, node, &expected));
            };
            let found = words.iter().find(|(word, _)| word == text);
            found.map(|(_, value)| *value).ok_or_else(|| RobotError::Value {
                place: node.place.to_string(),
                key: fields.path(key),
                value: format!("\"{text}\""),
                must: expected.clone(),
            })
        })
    }

    /// A number.
    pub(super) fn number(
        &mut self,
        key: &str,
        accepts: Accepts,
    ) -> Result<Option<f64>, RobotError> {
        self.noted(key, |fields, node| fields.as_number(key, node, accepts))
    }

    /// A joint number, counted from 1 in the file and from 0 in the result.
    pub(super) fn joint(&mut self, key: &str, dof: usize) -> Result<usize, RobotError> {
        let node = self.must(key, |fields, key| Ok(fields.take(key)))?;
        let value = self.as_number(key, &node, Accepts::Positive)?;
        if value.fract() != 0.0 || value > dof as f64 {
            return Err(RobotError::Value {
                place: node.place.to_string(),
                key: self.path(key),
                value: value.to_string(),
                must: format!("a joint number from 1 to {dof}"),
            });
        }
        Ok(value as usize - 1)
    }

    /// A list of one number for each of `dof` joints.
    pub(super) fn per_joint(
        &mut self,
        key: &str,
        dof: usize,
        accepts: Accepts,
    ) -> Result<Option<Vec<f64>>, RobotError> {
        self.numbers(key, dof, &per_joint_words(dof), accepts)
    }

    /// A list of exactly `N` numbers.
    pub(super) fn array<const N: usize>(
        &mut self,
        key: &str,
        accepts: Accepts,
    ) -> Result<Option<[f64; N]>, RobotError> {
        let list = self.numbers(key, N, &format!("{N} numbers"), accepts)?;
        Ok(list.and_then(|list| <[f64; N]>::try_from(list).ok()))
    }

    /// An interval `[low, high]`.
    pub(super) fn interval(&mut self, key: &str) -> Result<Option<[f64; 2]>, RobotError> {
        self.noted(key, |fields, node| fields.as_interval(key, node))
    }

    /// An interval for each of `dof` joints.
    pub(super) fn intervals(
        &mut self,
        key: &str,
        dof: usize,
    ) -> Result<Option<Vec<[f64; 2]>>, RobotError> {
        self.noted(key, |fields, node| {
            let items = fields.as_list(key, node, dof, &per_joint_words(dof))?;
            items.iter().map(|item| fields.as_interval(key, item)).collect()
        })
    }

    /// A table below this one.
    pub(super) fn table(&mut self, key: &str) -> Result<Option<Fields>, RobotError> {
        let Some(node) = self.take(key) else { return Ok(None) };
        Fields::new(&self.path(key), node).map(Some)
    }

    /// A list of tables below this one, named `KEY 1`, `KEY 2`, ….
    pub(super) fn tables(&mut self, key: &str) -> Result<Vec<Fields>, RobotError> {
        let Some(node) = self.take(key) else { return Ok(Vec::new()) };
        let Value::List(items) = node.value else {
            return Err(self.wrong_type(key, &node, "a list of tables"));
        };
        let name = self.path(key);
        items
            .into_iter()
            .enumerate()
            .map(|(i, item)| Fields::new(&format!("{name} {}", i + 1), item))
            .collect()
    }

    /// A list of `len` numbers; `expected` describes it.
    pub(super) fn numbers(
        &mut self,
        key: &str,
        len: usize,
        expected: &str,
        accepts: Accepts,
    ) -> Result<Option<Vec<f64>>, RobotError> {
        self.noted(key, |fields, node| {
            let items = fields.as_list(key, node, len, expected)?;
            items.iter().map(|item| fields.as_number(key, item, accepts)).collect()
        })
    }

    fn as_list<'n>(
        &self,
        key: &str,
        node: &'n Node,
        len: usize,
        expected: &str,
    ) -> Result<&'n [Node], RobotError> {
        let Value::List(items) = &node.value else {
            return Err(self.wrong_type(key, node, expected));
        };
        if items.len() == len {
            return Ok(items);
        }
        Err(RobotError::Length {
            place: node.place.to_string(),
            key: self.path(key),
            found: items.len(),
            expected: expected.to_owned(),
        })
    }

    fn as_number(&self, key: &str, node: &Node, accepts: Accepts) -> Result<f64, RobotError> {
        let Value::Number(value) = node.value else {
            return Err(self.wrong_type(key, node, "a number"));
        };
        if accepts.holds(value) { Ok(value) } else { Err(self.refused(key, node, value, accepts)) }
    }

    fn refused(&self, key: &str, node: &Node, value: f64, accepts: Accepts) -> RobotError {
        RobotError::Value {
            place: node.place.to_string(),
            key: self.path(key),
            value: if value.abs() < EXPONENT_FROM {
                value.to_string()
            } else {
                format!("{value:e}")
            },
            must: accepts.words().into(),
        }
    }

    fn as_interval(&self, key: &str, node: &Node) -> Result<[f64; 2], RobotError> {
        let items = self.as_list(key, node, 2, "2 numbers, [low, high]")?;
        let [low, high] =
            [self.as_number(key, &items[0], TURN)?, self.as_number(key, &items[1], TURN)?];
        for (item, bound) in items.iter().zip([low, high]) {
            if !is_turn(bound) {
                return Err(self.refused(key, item, bound, TURN));
            }
        }
        if low < high {
            return Ok([low, high]);
        }
        Err(RobotError::Value {
            place: node.place.to_string(),
            key: self.path(key),
            value: format!("[{low}, {high}]"),
            must: "[low, high] with low < high".into(),
        })
    }

    /// What `read` makes of the value of a key, whose origin is noted, if it is present.
    fn noted<T>(
        &mut self,
        key: &str,
        read: impl FnOnce(&Fields, &Node) -> Result<T, RobotError>,
    ) -> Result<Option<T>, RobotError> {
        let Some(node) = self.take(key) else { return Ok(None) };
        let value = read(self, &node)?;
        self.origins.push(Origin {
            table: self.name.clone(),
            key: key.to_owned(),
            provenance: node.stated.provenance,
            source: node.stated.source,
            sd: node.stated.sd,
        });
        Ok(Some(value))
    }

    /// The key with its table for messages.
    pub(super) fn path(&self, key: &str) -> String {
        if self.name.is_empty() { key.to_owned() } else { format!("{}.{key}", self.name) }
    }

    fn table_words(&self) -> String {
        if self.name.is_empty() { "the robot".into() } else { format!("[{}]", self.name) }
    }

    fn wrong_type(&self, key: &str, node: &Node, expected: &str) -> RobotError {
        RobotError::Type {
            place: node.place.to_string(),
            key: self.path(key),
            found: node.value.kind(),
            expected: expected.to_owned(),
        }
    }
}

/// Whether the bound \[rad\] is possible for a bounded or an endless joint.
pub(super) fn is_turn(bound: f64) -> bool {
    bound.abs() <= MAX_BOUND || is_endless(bound)
}

/// Whether the bound \[rad\] is that of an endless joint.
pub(super) fn is_endless(bound: f64) -> bool {
    bound.abs() >= MIN_ENDLESS_BOUND
}

fn per_joint_words(dof: usize) -> String {
    format!("{dof}, one for each joint")
}
