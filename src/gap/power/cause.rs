//! What may change the power.

use super::powers::Powers;
use super::reference::Reference;
use crate::arm::effects::{Effect, find};

/// Times after which brakes close on a joint that rests \[s\].
const TIMEOUTS: [f64; 8] = [0.0, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0];

/// Deviations of the form of a law.
pub(super) const FORMS: usize = 2;

/// A possible cause: its column.
pub(super) struct Cause<'a> {
    pub effect: &'static Effect,
    /// Joint, from 0.
    pub joint: Option<usize>,
    /// The least that its value can be: what there is may go.
    pub least: f64,
    lag: f64,
    column: Column<'a>,
    coordinate: Coordinate,
}

/// Power of value 1, row by row.
type Column<'a> = Box<dyn Fn(&Powers) -> Vec<f64> + Send + Sync + 'a>;

/// What the form of a law may depend on: time in the log, torque or rate of a joint.
enum Coordinate {
    Time,
    Torque(usize),
    Rate(usize),
}

impl Cause<'_> {
    /// Its power of value 1, as the meter shows it, row by row.
    pub(super) fn of(&self, log: &Powers) -> Vec<f64> {
        log.lagged((self.column)(log), self.lag)
    }

    /// Deviations of its form: the law times Legendre polynomials of its coordinate from 0 to 1.
    pub(super) fn forms(&self, log: &Powers) -> [Vec<f64>; FORMS] {
        let x: Vec<f64> = match self.coordinate {
            Coordinate::Time => (0..log.rows()).map(|row| row as f64).collect(),
            Coordinate::Torque(joint) => log.tau[joint].iter().map(|x| x.abs()).collect(),
            Coordinate::Rate(joint) => log.qd[joint].iter().map(|x| x.abs()).collect(),
        };
        let most = x.iter().fold(f64::MIN_POSITIVE, |most, x| most.max(*x));
        let column = (self.column)(log);
        let times = |of: fn(f64) -> f64| {
            let all = column.iter().zip(&x).map(|(column, x)| column * of(x / most));
            log.lagged(all.collect(), self.lag)
        };
        [times(|x| 2.0 * x - 1.0), times(|x| 6.0 * x * (x - 1.0) + 1.0)]
    }
}

/// The causes that may be named.
pub(super) fn causes<'a>(reference: &'a Reference, may: &dyn Fn(&str) -> bool) -> Vec<Cause<'a>> {
    let mut all = Vec::new();
    let mut add = |id: &str, joint, least, coordinate, column| {
        let Some(effect) = find(id).filter(|_| may(id)) else { return };
        all.push(Cause { effect, joint, least, lag: reference.lag, coordinate, column });
    };
    let base = -reference.base;
    add("base_load", None, base, Coordinate::Time, Box::new(|log| vec![1.0; log.rows()]));
    // What hangs on the link of the drives takes what joints give back.
    add("base_load", None, base, Coordinate::Time, by_row(|log, row| reference.share(log, row)));
    // Brakes of single axes, or of all together, are held open while these move; their coils may hang on
    // the link, too.
    for timeout in TIMEOUTS {
        let share = move |log: &Powers| log.released(timeout);
        add("brake_power", None, base, Coordinate::Time, Box::new(share));
        let any = move |log: &Powers| -> Vec<f64> {
            share(log).iter().map(|x| f64::from(*x > 0.0)).collect()
        };
        add("brake_power", None, base, Coordinate::Time, Box::new(any));
        let on_link = move |log: &Powers| {
            let of_row = |(row, any): (usize, f64)| any * reference.share(log, row);
            any(log).into_iter().enumerate().map(of_row).collect()
        };
        add("brake_power", None, base, Coordinate::Time, Box::new(on_link));
    }
    if reference.given_back > 0.0 {
        let kept = |log: &Powers, row| -reference.given_back * reference.sum(log, row).min(0.0);
        add("no_regeneration", None, 0.0, Coordinate::Time, by_row(kept));
    }
    for (j, loss) in reference.loss.iter().enumerate() {
        let share = |log: &Powers, row| reference.share(log, row);
        let copper = move |log: &Powers, row: usize| share(log, row) * log.tau[j][row].powi(2);
        let inverter = move |log: &Powers, row: usize| share(log, row) * log.tau[j][row].abs();
        let iron = move |log: &Powers, row: usize| share(log, row) * log.qd[j][row].powi(2);
        add("copper_loss", Some(j), -loss, Coordinate::Torque(j), by_row(copper));
        add("inverter_loss", Some(j), 0.0, Coordinate::Torque(j), by_row(inverter));
        add("iron_loss", Some(j), 0.0, Coordinate::Rate(j), by_row(iron));
    }
    all
}

fn by_row<'a>(column: impl Fn(&Powers, usize) -> f64 + Send + Sync + 'a) -> Column<'a> {
    Box::new(move |log| (0..log.rows()).map(|row| column(log, row)).collect())
}
