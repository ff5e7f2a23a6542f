//! Movements of external axes: the time during which the robot waits for them.

use super::arguments::Arguments;
use super::executor::Executor;
use super::waits::Length;
use crate::rapid::builtins::MoveSignature;
use crate::rapid::ir::hir::Stmt;
use crate::rapid::ir::value::Datum;

/// Values from here on mean that the axis does not exist (RAPID: 9E9).
const ABSENT: f64 = 8.9e9;
/// Indices of the speeds of linear and rotating external axes in a `speeddata`.
const LINEAR: usize = 2;
const TURNING: usize = 3;

impl Executor<'_> {
    /// `MoveExtJ target, speed …`: lasts as long as the slowest axis needs at its speed.
    pub(super) fn external(
        &mut self,
        stmt: &Stmt,
        text: &str,
        signature: MoveSignature,
        arguments: &Arguments<'_>,
    ) {
        let mut positional = arguments.positional.iter().copied().skip(signature.before);
        let target = arguments.option_value("tojointpos").or_else(|| positional.next());
        let speed = arguments.option_value("speed").or_else(|| positional.next());
        let target = target.and_then(|expr| axes(&self.eval(expr).datum));
        let speed = speed.and_then(|expr| match self.eval(expr).datum {
            // The program does not state the kind of the axes; `vlinN` has no rotation speed.
            Datum::List(items) => [TURNING, LINEAR]
                .into_iter()
                .filter_map(|i| items.get(i).and_then(Datum::num))
                .find(|speed| *speed > 0.0),
            _ => None,
        });
        let stated = arguments.option_value("t").and_then(|expr| self.eval(expr).datum.num());
        let from = std::mem::replace(&mut self.external_axes, target.clone());
        let length = match (stated, from.zip(target), speed) {
            (Some(time), _, _) if time >= 0.0 && time.is_finite() => Length::Stated(time),
            (None, Some((from, to)), Some(speed)) if speed > 0.0 => {
                let ways = from.iter().zip(&to).filter(|(a, b)| **a < ABSENT && **b < ABSENT);
                let longest = ways.map(|(a, b)| (b - a).abs()).fold(0.0, f64::max);
                self.assume(
                    "external axes move at the speed of their movement, without acceleration"
                        .to_owned(),
                );
                Length::Stated(longest / speed)
            }
            _ => Length::Unknown(
                "external axes, of which it is not known where they stood or how fast they are"
                    .into(),
            ),
        };
        self.wait(stmt.span, text, length, None);
    }
}

/// The external axes of a `jointtarget`.
fn axes(datum: &Datum) -> Option<Vec<f64>> {
    let Datum::List(parts) = datum else { return None };
    let Datum::List(axes) = parts.get(1)? else { return None };
    axes.iter().map(Datum::num).collect()
}
