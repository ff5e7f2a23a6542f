//! A map: cells over two axes, coloured by a value.

use std::fmt::Write;

use super::escape::escape;
use super::frame::{Frame, Size};
use super::scale::Scale;

/// Most and fewest cells along each axis.
const MOST: usize = 28;
const FEWEST: usize = 6;
/// Points per cell, in the mean.
const POINTS: f64 = 4.0;
/// Least opacity of a cell.
const FAINT: f64 = 0.08;
/// Ticks of each axis.
const TICKS: usize = 6;

/// What is known of a point.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub enum Shade {
    /// Not possible at all.
    Impossible,
    /// Possible, but refused.
    Refused,
    /// Its value, %.
    Value(f64),
}

/// A map of points with values; of several points in a cell the largest value counts, and any value
/// more than none.
#[derive(Clone, Debug)]
pub struct Cells<'a> {
    /// Text for screen readers.
    pub name: &'a str,
    /// Titles with unit.
    pub titles: [&'a str; 2],
    /// Range of each axis.
    pub ranges: [[f64; 2]; 2],
    /// Points.
    pub points: &'a [([f64; 2], Shade)],
    /// Marks: place, class of the style sheet, and text.
    pub marks: &'a [([f64; 2], &'static str, &'static str)],
}

impl Cells<'_> {
    /// The map as SVG. Cells have their share of the largest value as opacity; cells with negative
    /// values have another class.
    pub fn svg(&self, size: Size) -> String {
        let [x, y] = self.ranges.map(|[low, high]| Scale::exact(low, high, TICKS));
        let frame = Frame::new(size, x, y);
        let count = (self.points.len() as f64 / POINTS).sqrt() as usize;
        let count = count.clamp(FEWEST, MOST);
        let mut cells: Vec<Option<Shade>> = vec![None; count * count];
        for (place, shade) in self.points {
            let [i, j] = [0, 1].map(|axis| {
                let [low, high] = self.ranges[axis];
                let share = (place[axis] - low) / (high - low);
                ((share * count as f64) as usize).min(count - 1)
            });
            let cell = &mut cells[i * count + j];
            if cell.is_none_or(|before| *shade > before) {
                *cell = Some(*shade);
            }
        }
        let most = cells.iter().fold(0.0, |most: f64, cell| match cell {
            Some(Shade::Value(value)) => most.max(value.abs()),
            _ => most,
        });
        let mut content = String::new();
        for (index, cell) in cells.iter().enumerate() {
            let at = |axis: usize, k: usize| {
                let [low, high] = self.ranges[axis];
                low + (high - low) * k as f64 / count as f64
            };
            let (i, j) = (index / count, index % count);
            let [left, bottom] = frame.at(at(0, i), at(1, j));
            let [right, top] = frame.at(at(0, i + 1), at(1, j + 1));
            let (class, opacity, title) = match cell {
                Some(Shade::Value(value)) => {
                    let share = if most > 0.0 { value.abs() / most } else { 0.0 };
                    let class = if *value < 0.0 { "cell costs" } else { "cell" };
                    (class, FAINT + (1.0 - FAINT) * share, format!("{value:.2} %"))
                }
                Some(Shade::Refused) => ("cell refused", 1.0, "refused".to_owned()),
                Some(Shade::Impossible) => ("cell closed", 1.0, "out of reach".to_owned()),
                None => continue,
            };
            let _ = write!(
                content,
                "<rect class=\"{class}\" x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" \
                 height=\"{:.1}\" fill-opacity=\"{opacity:.2}\"><title>{title}</title></rect>",
                right - left,
                bottom - top,
            );
        }
        for (place, class, text) in self.marks {
            let [x, y] = frame.at(place[0], place[1]);
            // The text is inside of the map.
            let is_right = x > 0.5 * size.width;
            let (beside, side) =
                if is_right { (x - 10.0, " class=\"end\"") } else { (x + 10.0, "") };
            let _ = write!(
                content,
                "<circle class=\"{}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\"/><text{side} \
                 x=\"{beside:.1}\" y=\"{:.1}\">{}</text>",
                escape(class),
                if y > 0.5 * size.height { y - 8.0 } else { y + 16.0 },
                escape(text),
            );
        }
        frame.svg(self.name, self.titles[0], self.titles[1], &content)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_value_of_a_cell_counts() {
        let points = [
            ([0.01, 0.01], Shade::Value(1.0)),
            ([0.02, 0.01], Shade::Value(3.0)),
            ([0.03, 0.02], Shade::Refused),
            ([0.9, 0.9], Shade::Impossible),
            ([0.91, 0.91], Shade::Refused),
            ([0.5, 0.5], Shade::Value(-2.0)),
        ];
        let map = Cells {
            name: "map",
            titles: ["x", "y"],
            ranges: [[0.0, 1.0]; 2],
            points: &points,
            marks: &[],
        };
        let svg = map.svg(Size { width: 400.0, height: 300.0 });
        assert_eq!(svg.matches("<rect").count(), 3);
        assert!(svg.contains("3.00 %") && !svg.contains("1.00 %"));
        assert_eq!(svg.matches("cell refused").count(), 1);
        assert_eq!(svg.matches("cell costs").count(), 1);
    }
}
