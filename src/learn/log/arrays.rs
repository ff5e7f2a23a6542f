//! A log from arrays.

use super::columns::{ColumnMap, check, recognised};
use super::data::Log;
use super::error::LogError;
use super::rows::Rows;

impl Log {
    /// The log of `columns` of equal length, with the names of a file's columns: `t` \[s\], `q1`
    /// \[rad\] or `q1_deg`, `tau1` \[Nm\] ([`Channel`](super::Channel) lists all). Unknown names
    /// are skipped; rows with a value that is not finite or a time that does not ascend are in
    /// [`rejected`](Log::rejected). Rows count from 1.
    ///
    /// # Errors
    /// Columns of different lengths, no time, a missing joint, fewer than
    /// [`MIN_ROWS`](super::MIN_ROWS) usable rows.
    pub fn from_columns(columns: &[(&str, &[f64])]) -> Result<Log, LogError> {
        let map = ColumnMap::default();
        let names: Vec<String> = columns.iter().map(|(name, _)| (*name).to_owned()).collect();
        let known = recognised(&names, &map);
        check(&known, &names, &map)?;
        let mut rows = Rows::new(&known);
        let lengths = || known.iter().map(|column| columns[column.index].1.len());
        let count = lengths().max().unwrap_or(0);
        if let Some((column, rows)) = known.iter().zip(lengths()).find(|(_, rows)| *rows != count) {
            return Err(LogError::Lengths { name: column.name.clone(), rows, count });
        }
        for row in 0..count {
            let value = |column: &super::columns::Column| match columns[column.index].1[row] {
                value if value.is_finite() => Ok(value * column.named.unit),
                value => Err(format!("{} is '{value}', not a number", column.name)),
            };
            let values: Result<Vec<f64>, String> = known.iter().map(value).collect();
            rows.push(row as u64 + 1, values);
        }
        rows.finish()
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::super::channel::Channel;
    use super::*;

    #[test]
    fn arrays_are_checked_like_a_file() {
        let t: Vec<f64> = (0..20).map(|i| 0.01 * f64::from(i)).collect();
        let mut q = vec![90.0; 20];
        q[3] = f64::NAN;
        let log = Log::from_columns(&[("t", &t), ("q1_deg", &q), ("tau1", &t)]).unwrap();
        assert_eq!(log.rejected.iter().map(|of| of.row).collect::<Vec<_>>(), [4]);
        let position = log.column(Channel::Position(0)).unwrap();
        assert_eq!(position, [std::f64::consts::FRAC_PI_2; 19]);
        assert!(matches!(Log::from_columns(&[("q1", &q)]), Err(LogError::NoTime(_))));
        let ragged = Log::from_columns(&[("t", &t), ("q1", &q), ("tau1", &t[..19])]);
        let expected = LogError::Lengths { name: "tau1".into(), rows: 19, count: 20 };
        assert_eq!(ragged.err(), Some(expected));
        // A column that is skipped may have any length.
        assert!(Log::from_columns(&[("t", &t), ("q1", &t), ("note", &t[..3])]).is_ok());
    }
}
