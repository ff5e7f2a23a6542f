//! The frame of a plot: axes, grid, ticks, and position of a value.

use std::fmt::Write;

use super::escape::escape;
use super::scale::Scale;

/// Margins for tick labels and axis titles, px.
const LEFT: f64 = 52.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 20.0;
const BOTTOM: f64 = 36.0;

/// Size of a plot with its labels, px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// px.
    pub width: f64,
    /// px.
    pub height: f64,
}

/// A plot's coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    size: Size,
    /// Abscissa.
    pub x: Scale,
    /// Ordinate.
    pub y: Scale,
}

impl Frame {
    /// A frame with these scales.
    pub fn new(size: Size, x: Scale, y: Scale) -> Frame {
        Frame { size, x, y }
    }

    /// Position of a value, px from the top left corner.
    pub fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let Size { width, height } = self.size;
        [
            LEFT + self.x.share(x) * (width - LEFT - RIGHT),
            height - BOTTOM - self.y.share(y) * (height - TOP - BOTTOM),
        ]
    }

    /// Left, top, right and bottom of the area inside the axes, px.
    pub fn area(&self) -> [f64; 4] {
        [LEFT, TOP, self.size.width - RIGHT, self.size.height - BOTTOM]
    }

    /// The whole plot: axes with titles, and `content` on top. `name` is the text for screen
    /// readers.
    pub fn svg(&self, name: &str, x_title: &str, y_title: &str, content: &str) -> String {
        let Size { width, height } = self.size;
        let mut out = format!(
            "<svg viewBox=\"0 0 {width:.0} {height:.0}\" role=\"img\" aria-label=\"{}\">",
            escape(name)
        );
        let [left, top, right, bottom] = self.area();
        for (value, label) in self.y.ticks() {
            let [_, y] = self.at(0.0, value);
            let class = if value == 0.0 { "zero" } else { "grid" };
            let _ = write!(
                out,
                "<line class=\"{class}\" x1=\"{left:.1}\" y1=\"{y:.1}\" x2=\"{right:.1}\" \
                 y2=\"{y:.1}\"/><text class=\"tick end\" x=\"{:.1}\" y=\"{:.1}\">{label}</text>",
                left - 6.0,
                y + 4.0,
            );
        }
        for (value, label) in self.x.ticks() {
            let [x, _] = self.at(value, 0.0);
            let _ = write!(
                out,
                "<line class=\"grid\" x1=\"{x:.1}\" y1=\"{top:.1}\" x2=\"{x:.1}\" \
                 y2=\"{bottom:.1}\"/><text class=\"tick middle\" x=\"{x:.1}\" y=\"{:.1}\">\
                 {label}</text>",
                bottom + 15.0,
            );
        }
        let _ = write!(
            out,
            "<text class=\"title\" x=\"{left:.1}\" y=\"12\">{}</text>\
             <text class=\"title end\" x=\"{right:.1}\" y=\"{:.1}\">{}</text>{content}</svg>",
            escape(y_title),
            height - 5.0,
            escape(x_title),
        );
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corners_of_the_area_are_the_ends_of_the_scales() {
        let size = Size { width: 600.0, height: 300.0 };
        let frame = Frame::new(size, Scale::new(0.0, 2.0, 4), Scale::new(-1.0, 1.0, 4));
        let [left, top, right, bottom] = frame.area();
        assert_eq!(frame.at(0.0, -1.0), [left, bottom]);
        assert_eq!(frame.at(2.0, 1.0), [right, top]);
    }
}
