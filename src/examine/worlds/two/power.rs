//! Electric power of the robot, and faults of it.
//!
//! Copper loss, iron loss after G. Bertotti (IEEE Trans. Magn. 24, 1988), a bus capacitor with a brake
//! chopper (D. Meike, L. Ribickis, Energy efficient use of robotics in the automobile industry, ICAR
//! 2011), base load with fans, coils of brakes.

use super::plant::Record;
use super::robot::Robot;
use crate::examine::worlds::api::{Truth, single};
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;
use std::f64::consts::TAU;

/// What a power fault sees at one instant: time \[s\], rates, torques, and power given back \[W\].
struct Seen<'a> {
    t: f64,
    v: &'a Row,
    tau: &'a Row,
    given: f64,
}

/// A power fault: power more \[W\] by joint; that of the robot is in the first.
pub(super) struct Loss(Box<Law>);

/// A law of it.
type Law = dyn Fn(&Seen, &mut State) -> Row;

/// The everyday power of the robot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Everyday {
    /// Relative rise of copper loss at the end of warming up.
    pub(super) warm: f64,
    /// Loss of the inverter, share of the mechanical power.
    pub(super) inverter: f64,
    /// Time constant of the meter \[s\].
    pub(super) meter: f64,
    /// Ripple of the base load \[W\], and its frequency \[Hz\].
    pub(super) base: (f64, f64),
}

/// Speed below which an axis stands \[rad/s\], and time after which its brake closes \[s\].
const STAND: (f64, f64) = (0.004, 0.35);
/// Time constant of the pull-in of a brake coil \[s\].
const PULL_IN: f64 = 0.15;

/// Power at the rows of a record \[W\], and what the fault adds, in all and by joint.
pub(super) fn power(
    robot: &Robot,
    everyday: &Everyday,
    fault: Option<&Loss>,
    record: &Record,
    rate: f64,
) -> (Vec<f64>, Vec<f64>, Row) {
    let n = robot.arm.n();
    let (mut out, mut added, mut shares) = (Vec::new(), Vec::new(), [0.0; MAX]);
    let mut state = State { dt: 1.0 / rate, ..State::default() };
    let mut shown = [f64::NAN; 2];
    for (row, (v, tau)) in record.v.iter().zip(&record.motor).enumerate() {
        let t = record.t.get(row).copied().unwrap_or(0.0);
        let warm = 1.0 + everyday.warm * (1.0 - (-t.max(0.0) / 120.0).exp());
        let mut whole = robot.base_w + everyday.base.0 * (TAU * everyday.base.1 * t).sin();
        let mut braking = 0.0;
        for i in 0..n {
            let mechanical = tau[i] * v[i];
            whole += warm * robot.loss[i] * tau[i] * tau[i] + everyday.inverter * mechanical.abs();
            if mechanical > 0.0 {
                whole += mechanical;
            } else {
                braking += mechanical;
            }
        }
        whole += robot.regeneration * braking;
        let mut extra = 0.0;
        if let Some(loss) = fault {
            let seen = Seen { t, v, tau, given: -robot.regeneration * braking };
            let parts = (loss.0)(&seen, &mut state);
            for (share, part) in shares.iter_mut().zip(parts) {
                *share += part.abs();
                extra += part;
            }
        }
        // The meter shows a filtered power.
        for (place, value) in shown.iter_mut().zip([whole + extra, extra]) {
            if place.is_nan() {
                *place = value;
            }
            *place += (value - *place) * state.dt / (everyday.meter + state.dt);
        }
        out.push(shown[0]);
        added.push(shown[1]);
    }
    (out, added, shares)
}

/// Memory of the faults.
#[derive(Default)]
struct State {
    dt: f64,
    /// Energy in the bus capacitor \[J\].
    stored: f64,
    /// Time since each axis moved, and since the brakes were released \[s\].
    still: Row,
    open: f64,
}

/// The number of axes whose brakes are open; follows how long they stand and are open.
fn released(n: usize, v: &Row, state: &mut State) -> f64 {
    let mut moving = 0.0;
    for (still, v) in state.still.iter_mut().zip(v).take(n) {
        *still = if v.abs() > STAND.0 { 0.0 } else { *still + state.dt };
        moving += if *still < STAND.1 { 1.0 } else { 0.0 };
    }
    state.open = if moving > 0.0 { state.open + state.dt } else { 0.0 };
    moving
}

/// What sizes of power faults are drawn from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Means<'a> {
    /// Mean power beyond the base load \[W\].
    pub(super) power: f64,
    /// Base load \[W\].
    pub(super) base: f64,
    /// Mean square torque by joint \[(Nm)²\].
    pub(super) torque: &'a Row,
    /// Mean square speed by joint \[rad²/s²\].
    pub(super) speed: &'a Row,
    /// Mean power given back \[W\].
    pub(super) braking: f64,
    pub(super) n: usize,
}

/// A loss of the whole robot.
fn whole(law: impl Fn(&Seen, &mut State) -> f64 + 'static) -> Loss {
    Loss(Box::new(move |x, state| single(0, law(x, state))))
}

/// A loss of joints with sizes by joint; `law` takes joint, speed and torque.
fn by_joint(sizes: Row, law: impl Fn(&Seen, usize, f64, f64) -> f64 + 'static) -> Loss {
    let of = move |x: &Seen, i: usize| match sizes[i] {
        0.0 => 0.0,
        size => size * law(x, i, x.v[i].abs(), x.tau[i].abs()),
    };
    Loss(Box::new(move |x, _| std::array::from_fn(|i| of(x, i))))
}

pub(super) fn draw(which: usize, m: &Means, rng: &mut Rng) -> (Truth, Loss) {
    // Base load and brakes are measured by the base load, losses by the rest.
    let mean = if which > 3 { m.base } else { m.power.max(5.0) };
    let size = mean * rng.log_between(0.08, 0.8);
    let second = rng.chance(0.5);
    let n = m.n;
    match which {
        0 | 2 => of_joints(which, size, second, m, rng),
        1 => {
            let rms = m.torque.map(|square| square.sqrt().max(1e-6));
            let size = size / (0..n).map(|i| m.torque[i].sqrt()).sum::<f64>().max(1e-6);
            let sizes = std::array::from_fn(|i| if i < n { size } else { 0.0 });
            let (form, loss) = if second {
                let law = move |i: usize, torque: f64| {
                    let full = 1.2 * rms[i];
                    full * (torque / full).tanh()
                };
                ("dead time", by_joint(sizes, move |_, i, _, torque| law(i, torque)))
            } else {
                let law = move |i: usize, torque: f64| torque + torque * torque / (4.0 * rms[i]);
                ("conduction and switching", by_joint(sizes, move |_, i, _, torque| law(i, torque)))
            };
            let mut truth = Truth::new("inverter_loss", form, &[]);
            truth.tell("per_current", None, size, false);
            (truth, loss)
        }
        3 => {
            let (form, loss) = if second {
                let bound = 0.3 * m.braking;
                let loss = whole(move |x, _| (x.given - bound).max(0.0));
                ("braking power above a bound is burnt", loss)
            } else {
                let room = rng.between(0.05, 0.4) * m.braking;
                // What would be given back goes to the capacitor, then to the resistor.
                let loss = whole(move |x, state| {
                    let energy = x.given * state.dt;
                    let kept = energy.min((room - state.stored).max(0.0));
                    state.stored += kept - state.stored * (state.dt / 0.5).min(1.0);
                    (energy - kept) / state.dt
                });
                ("bus capacitor and chopper", loss)
            };
            (Truth::new("no_regeneration", form, &[]), loss)
        }
        4 => {
            let (form, value, loss) = if second {
                let (share, period) = (rng.between(0.4, 0.8), rng.between(7.0, 40.0));
                let on = move |t: f64| (t / period).rem_euclid(1.0) < share;
                let loss = whole(move |x, _| if on(x.t) { size } else { 0.0 });
                ("fan with a thermostat", size * share, loss)
            } else {
                let loss = whole(move |x, _| size * (1.0 + 0.05 * (x.t / 30.0).sin()));
                ("slow drift", size, loss)
            };
            let mut truth = Truth::new("base_load", form, &[]);
            truth.tell("power", None, value, !second);
            (truth, loss)
        }
        _ => {
            let pull = rng.between(0.8, 2.0);
            let loss = whole(move |x, state| {
                let moving = released(n, x.v, state);
                if second {
                    size * moving / n as f64
                } else if moving > 0.0 {
                    size * (1.0 + pull * (-state.open / PULL_IN).exp())
                } else {
                    0.0
                }
            });
            let form = if second { "coils of the moving axes" } else { "pull-in" };
            let mut truth = Truth::new("brake_power", form, &[]);
            truth.tell("power", None, size, !second);
            (truth, loss)
        }
    }
}

/// Copper loss of a winding that warms or with skin effect; iron loss of hysteresis and eddies, or
/// excess loss.
fn of_joints(which: usize, size: f64, second: bool, m: &Means, rng: &mut Rng) -> (Truth, Loss) {
    let wanted = rng.pick(&[1, 1, 2]);
    let mut joints: Vec<usize> = Vec::new();
    while joints.len() < wanted {
        // Wrists lose little: the first joints are likelier.
        let i = rng.below(m.n).min(rng.below(m.n));
        if !joints.contains(&i) {
            joints.push(i);
        }
    }
    joints.sort_unstable();
    let (id, form) = match (which, second) {
        (0, false) => ("copper_loss", "winding that warms"),
        (0, true) => ("copper_loss", "skin effect"),
        (_, false) => ("iron_loss", "Bertotti"),
        (_, true) => ("iron_loss", "excess loss"),
    };
    let copper = which == 0;
    let mut truth = Truth::new(id, form, &joints);
    let (mut sizes, mut shapes) = ([0.0; MAX], [0.0; MAX]);
    for i in joints {
        let (part, speed) = (size / wanted as f64, m.speed[i].max(1e-6));
        (sizes[i], shapes[i]) = match (copper, second) {
            (true, false) => (part / m.torque[i].max(1e-9), rng.between(0.05, 0.15)),
            (true, true) => (part / m.torque[i].max(1e-9), 3.0 * speed.sqrt()),
            (false, false) => (part / speed * 0.75, 0.4 * speed.sqrt()),
            (false, true) => (part / speed.powf(0.75), 0.0),
        };
        truth.tell("loss", Some(i), sizes[i], copper && !second);
    }
    let loss = by_joint(sizes, move |x, i, speed, torque| match (copper, second) {
        (true, false) => {
            torque * torque * (1.0 + shapes[i] * (1.0 - (-x.t.max(0.0) / 100.0).exp()))
        }
        (true, true) => torque * torque * (1.0 + (speed / shapes[i]).powi(2)),
        (false, false) => speed * speed + shapes[i] * speed,
        (false, true) => speed.powf(1.5),
    });
    (truth, loss)
}
