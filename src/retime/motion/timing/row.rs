//! A limit at one point of a path as a row in u = s̈ and b = ṡ².

/// |u · `u` + b · `b` + √b · `root` + `constant`| ≤ 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    /// Factor of s̈.
    pub u: f64,
    /// Factor of ṡ².
    pub b: f64,
    /// Factor of ṡ.
    pub root: f64,
    /// Constant term.
    pub constant: f64,
}

impl Row {
    /// Linear interpolation to `other` at the share `x`.
    pub(crate) fn toward(&self, other: &Row, x: f64) -> Row {
        let mix = |a: f64, b: f64| a + x * (b - a);
        Row {
            u: mix(self.u, other.u),
            b: mix(self.b, other.b),
            root: mix(self.root, other.root),
            constant: mix(self.constant, other.constant),
        }
    }

    /// Bound on the absolute value for |u| and b up to these values; `root` is √b.
    pub(super) fn largest(&self, u: f64, b: f64, root: f64) -> f64 {
        // Avoids 0 · ∞ for a row without inertia.
        let inertial = if self.u == 0.0 { 0.0 } else { self.u.abs() * u };
        inertial + self.b.abs() * b + self.root.abs() * root + self.constant.abs()
    }

    /// The row without the absolute value.
    pub(crate) fn value(&self, u: f64, b: f64) -> f64 {
        self.u * u + self.b * b + self.root * b.sqrt() + self.constant
    }
}
