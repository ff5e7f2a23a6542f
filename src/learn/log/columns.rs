//! Assignment of the columns of a file to channels.

use super::channel::{Channel, Named};
use super::error::LogError;

/// Column names from `--map`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ColumnMap {
    /// Name of a channel, such as `tau1` or `q1_deg`, and its column.
    pairs: Vec<(String, String)>,
    /// Whether `part` and `payload` are read under these names.
    products: bool,
}

impl ColumnMap {
    /// Reads `tau1=MotorTorque_1,q1_deg=J1`.
    ///
    /// # Errors
    /// A part is not `CHANNEL=COLUMN`, or a channel is unknown or repeated.
    pub fn parse(text: &str) -> Result<ColumnMap, LogError> {
        let mut pairs: Vec<(String, String)> = Vec::new();
        for part in text.split(',').filter(|part| !part.trim().is_empty()) {
            let pair = part.split_once('=').filter(|(_, column)| !column.trim().is_empty());
            let (channel, column) = pair.ok_or_else(|| LogError::Map(part.trim().to_owned()))?;
            let (channel, column) = (channel.trim().to_owned(), column.trim().to_owned());
            if Channel::named(&channel).is_none() {
                return Err(LogError::UnknownChannel(channel));
            }
            if pairs.iter().any(|(known, _)| known.eq_ignore_ascii_case(&channel)) {
                return Err(LogError::MappedTwice(channel));
            }
            if let Some((other, _)) = pairs.iter().find(|(_, known)| *known == column) {
                return Err(LogError::ColumnTwice { column, other: other.clone(), name: channel });
            }
            pairs.push((channel, column));
        }
        Ok(ColumnMap { pairs, products: false })
    }

    /// Also reads the columns that tell what is made, `part` and `payload`.
    #[must_use]
    pub fn with_products(self) -> ColumnMap {
        ColumnMap { products: true, ..self }
    }

    /// The channel of a column name.
    fn named(&self, column: &str) -> Option<Named> {
        if let Some((channel, _)) = self.pairs.iter().find(|(_, known)| known == column) {
            return Channel::named(channel);
        }
        let named = Channel::named(column)?;
        if named.channel.is_product() && !self.products {
            return None;
        }
        // A mapped channel does not use its default name.
        let taken = |(channel, _): &(String, String)| {
            Channel::named(channel).is_some_and(|other| other.channel == named.channel)
        };
        (!self.pairs.iter().any(taken)).then_some(named)
    }
}

/// A recognised column.
pub(super) struct Column {
    pub(super) index: usize,
    pub(super) name: String,
    pub(super) named: Named,
}

/// The recognised columns among `names`.
pub(super) fn recognised(names: &[String], map: &ColumnMap) -> Vec<Column> {
    let column = |(index, name): (usize, &String)| {
        let name = name.trim().to_owned();
        Some(Column { index, named: map.named(&name)?, name })
    };
    names.iter().enumerate().filter_map(column).collect()
}

/// Checks that the columns form a log; `names` are all columns of the file.
///
/// # Errors
/// No time, two columns for one channel, a missing joint, or a missing mapped column.
pub(super) fn check(columns: &[Column], names: &[String], map: &ColumnMap) -> Result<(), LogError> {
    let header = || {
        let joined: String = names.join(",").chars().take(80).collect();
        joined.trim_end_matches('\r').to_owned()
    };
    for (channel, column) in &map.pairs {
        if !names.iter().any(|name| name.trim() == column) {
            let (channel, column) = (channel.clone(), column.clone());
            return Err(LogError::NoColumn { channel, column, header: header() });
        }
    }
    if !columns.iter().any(|column| column.named.channel == Channel::Time) {
        return Err(LogError::NoTime(header()));
    }
    for (i, column) in columns.iter().enumerate() {
        let channel = column.named.channel;
        if let Some(other) = columns[..i].iter().find(|other| other.named.channel == channel) {
            return Err(LogError::Twice { first: other.name.clone(), second: column.name.clone() });
        }
        let Some(joint) = channel.joint() else { continue };
        let has = |joint: usize| {
            columns
                .iter()
                .map(|other| other.named.channel)
                .any(|other| other.is_same_quantity(channel) && other.joint() == Some(joint))
        };
        if let Some(missing) = (0..joint).find(|before| !has(*before)) {
            return Err(LogError::Gap { found: column.name.clone(), missing: missing + 1 });
        }
    }
    Ok(())
}
