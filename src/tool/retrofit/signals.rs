//! The order and the time shifts of the signals of a program.

use std::collections::BTreeMap;

use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::What;

/// How the program uses a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SignalKind {
    /// It waits for the signal.
    Input,
    /// It sets the signal.
    Output,
}

/// A signal in one cycle before and after.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalShift {
    /// Name, as in its first use.
    pub name: String,
    /// Set or waited for.
    pub kind: SignalKind,
    /// Number of uses in a cycle.
    pub times: usize,
    /// Whether its values and its order among all signals are unchanged.
    pub order_kept: bool,
    /// Largest change of its time since the start of the cycle, s; later is positive.
    pub largest_shift_s: f64,
}

/// One use of a signal.
struct Change<'a> {
    name: &'a str,
    kind: SignalKind,
    value: &'a str,
    at: f64,
}

/// The signals of two cycles, by name.
pub(super) fn signals(before: &Simulation, after: &Simulation) -> Vec<SignalShift> {
    let (before, after) = (changes(before), changes(after));
    let mut found: BTreeMap<(String, SignalKind), SignalShift> = BTreeMap::new();
    for (index, change) in before.iter().enumerate() {
        let key = (change.name.to_lowercase(), change.kind);
        let signal = found.entry(key).or_insert_with(|| SignalShift {
            name: change.name.to_owned(),
            kind: change.kind,
            times: 0,
            order_kept: before.len() == after.len(),
            largest_shift_s: 0.0,
        });
        signal.times += 1;
        let Some(now) = after.get(index) else { continue };
        let same = |a: &Change<'_>, b: &Change<'_>| {
            a.name.eq_ignore_ascii_case(b.name) && a.kind == b.kind && a.value == b.value
        };
        signal.order_kept &= same(change, now);
        let shift = now.at - change.at;
        if shift.abs() > signal.largest_shift_s.abs() {
            signal.largest_shift_s = shift;
        }
    }
    found.into_values().collect()
}

fn changes(simulation: &Simulation) -> Vec<Change<'_>> {
    let mut changes = Vec::new();
    for event in &simulation.events {
        match &event.what {
            What::Output(output, _) => changes.push(Change {
                name: &output.signal,
                kind: SignalKind::Output,
                value: &output.value,
                at: event.t_start,
            }),
            What::Wait(record) => {
                // The signal arrives at the end of the wait.
                if let Some(name) = &record.wait.signal {
                    let at = event.t_start + event.duration;
                    changes.push(Change { name, kind: SignalKind::Input, value: "", at });
                }
            }
            What::Run(_) | What::Left(_) => {}
        }
    }
    changes
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::rapid::ir::movement::Output;
    use crate::rapid::text::{FileId, Span};
    use crate::retime::motion::timeline::Event;

    fn cycle(outputs: &[(&str, &str, f64)]) -> Simulation {
        let event = |(signal, value, t_start): &(&str, &str, f64)| Event {
            t_start: *t_start,
            duration: 0.0,
            what: What::Output(
                Output {
                    instruction: "SetDO".into(),
                    span: Span { file: FileId(0), start: 0, end: 0 },
                    signal: (*signal).into(),
                    value: (*value).into(),
                },
                0,
            ),
        };
        Simulation {
            events: outputs.iter().map(event).collect(),
            cycle_s: 9.0,
            repeats_from: None,
            unresolved: Vec::new(),
            assumed: Vec::new(),
            inputs_asked: BTreeSet::new(),
        }
    }

    #[test]
    fn shifts_and_changes_of_order_are_told_by_signal() {
        let before = cycle(&[("doA", "1", 1.0), ("doB", "1", 2.0), ("doA", "0", 3.0)]);
        let later = cycle(&[("doA", "1", 1.1), ("doB", "1", 1.5), ("doa", "0", 2.8)]);
        let found = signals(&before, &later);
        let shifts: Vec<f64> = found.iter().map(|signal| signal.largest_shift_s).collect();
        assert_eq!((found[0].name.as_str(), found[0].times), ("doA", 2));
        assert!((shifts[0] + 0.2).abs() < 1e-12 && (shifts[1] + 0.5).abs() < 1e-12, "{shifts:?}");
        assert!(found.iter().all(|signal| signal.order_kept));
        let swapped = cycle(&[("doB", "1", 1.0), ("doA", "1", 2.0), ("doA", "0", 3.0)]);
        assert!(signals(&before, &swapped).iter().all(|signal| !signal.order_kept));
        let short = cycle(&[("doA", "1", 1.0)]);
        assert!(signals(&before, &short).iter().all(|signal| !signal.order_kept));
    }
}
