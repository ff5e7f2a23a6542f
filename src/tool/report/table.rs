//! Plain text tables.

/// Alignment of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// For text.
    Left,
    /// For figures.
    Right,
}

/// A table: the header, then rows with the same number of cells.
pub fn table(header: &[(&str, Align)], rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        rows.iter()
            .filter_map(|row| row.get(column))
            .map(|cell| cell.chars().count())
            .chain([header[column].0.chars().count()])
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let line = |cells: &[String]| {
        let mut out = String::new();
        for (i, cell) in cells.iter().enumerate() {
            if i > 0 {
                out.push_str("  ");
            }
            let fill = " ".repeat(widths[i].saturating_sub(cell.chars().count()));
            match header[i].1 {
                Align::Left => {
                    out.push_str(cell);
                    out.push_str(&fill);
                }
                Align::Right => {
                    out.push_str(&fill);
                    out.push_str(cell);
                }
            }
        }
        out.trim_end().to_owned()
    };
    let names: Vec<String> = header.iter().map(|(name, _)| (*name).to_owned()).collect();
    let mut out = line(&names);
    out.push('\n');
    let total: usize = widths.iter().sum::<usize>() + 2 * (widths.len() - 1);
    out.push_str(&"-".repeat(total));
    out.push('\n');
    for row in rows {
        out.push_str(&line(row));
        out.push('\n');
    }
    out
}
