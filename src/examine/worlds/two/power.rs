//! Electric power of the robot, and faults of it.
//!
//! Copper loss, iron loss after G. Bertotti (IEEE Trans. Magn. 24, 1988), a bus capacitor with a brake
//! chopper (D. Meike, L. Ribickis, Energy efficient use of robotics in the automobile industry, ICAR
//! 2011), base load with fans, coils of brakes.

use super::fault::{Action, Fault};
use super::plant::Record;
use super::robot::Robot;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;

/// Kinds of power faults; p0, p1, … are their parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Copper loss p0·τ² that rises by a share p1 as the winding warms in p2 s.
    WarmCopper,
    /// p0·τ²·(1 + (v/p1)²): skin effect.
    SkinCopper,
    /// Conduction and switching: p0·(|τ| + τ²/p1).
    Switches,
    DeadTime,
    /// Hysteresis and eddies: p0·(v² + p1·|v|).
    Bertotti,
    Excess,
    /// A bus capacitor of p0 J; the rest of braking energy is burnt.
    Chopper,
    /// Braking power above p0 W is burnt.
    Feeble,
    /// p0 W that drift by a share p1 within p2 s.
    Base,
    /// A fan of p0 W that runs p1 of every p2 s.
    Fan,
    /// Coils: p0 W, with a pull-in of p1 times that.
    PullIn,
    /// Coils of the axes that move: p0 W in all.
    EachAxis,
}

/// A power fault.
#[derive(Clone, Debug)]
pub(super) struct Loss {
    pub(super) kind: Kind,
    /// Parameters, by joint (the first where it is of the robot).
    pub(super) p: [[f64; 3]; MAX],
}

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
        let mut whole =
            robot.base_w + everyday.base.0 * (std::f64::consts::TAU * everyday.base.1 * t).sin();
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
            let parts = loss.at(t, v, tau, (n, robot.regeneration * braking), &mut state);
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

impl Loss {
    /// Power more \[W\] by joint; faults of the robot are in the first.
    fn at(&self, t: f64, v: &Row, tau: &Row, bus: (usize, f64), state: &mut State) -> Row {
        let (n, given) = bus;
        let mut out = [0.0; MAX];
        let first = self.p[0];
        match self.kind {
            Kind::Chopper => {
                // What would be given back goes to the capacitor, then to the resistor.
                let energy = -given * state.dt;
                let room = (first[0] - state.stored).max(0.0);
                let kept = energy.min(room);
                state.stored += kept - state.stored * (state.dt / 0.5).min(1.0);
                out[0] = (energy - kept) / state.dt;
            }
            Kind::Feeble => out[0] = (-given - first[0]).max(0.0),
            Kind::Base => out[0] = first[0] * (1.0 + first[1] * (t / first[2]).sin()),
            Kind::Fan => {
                let on = (t / first[2]).rem_euclid(1.0) < first[1];
                out[0] = if on { first[0] } else { 0.0 };
            }
            Kind::PullIn | Kind::EachAxis => out[0] = self.coils(v, n, state),
            _ => {
                for i in 0..n {
                    out[i] = self.of_joint(i, t, v[i].abs(), tau[i].abs());
                }
            }
        }
        out
    }

    fn of_joint(&self, i: usize, t: f64, speed: f64, torque: f64) -> f64 {
        let p = &self.p[i];
        if p[0] == 0.0 {
            return 0.0;
        }
        match self.kind {
            Kind::WarmCopper => {
                p[0] * torque * torque * (1.0 + p[1] * (1.0 - (-t.max(0.0) / p[2]).exp()))
            }
            Kind::SkinCopper => p[0] * torque * torque * (1.0 + (speed / p[1]).powi(2)),
            Kind::Switches => p[0] * (torque + torque * torque / p[1]),
            Kind::DeadTime => p[0] * p[1] * (torque / p[1]).tanh(),
            Kind::Bertotti => p[0] * (speed * speed + p[1] * speed),
            _ => p[0] * speed.powf(1.5),
        }
    }

    fn coils(&self, v: &Row, n: usize, state: &mut State) -> f64 {
        let mut moving = 0.0;
        for (i, still) in state.still.iter_mut().enumerate().take(n) {
            *still = if v[i].abs() > STAND.0 { 0.0 } else { *still + state.dt };
            moving += if *still < STAND.1 { 1.0 } else { 0.0 };
        }
        state.open = if moving > 0.0 { state.open + state.dt } else { 0.0 };
        let p = self.p[0];
        if self.kind == Kind::EachAxis {
            p[0] * moving / n as f64
        } else if moving > 0.0 {
            p[0] * (1.0 + p[1] * (-state.open / PULL_IN).exp())
        } else {
            0.0
        }
    }
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

/// Draws a power fault.
pub(super) fn draw(which: usize, m: &Means, rng: &mut Rng) -> (Fault, Loss) {
    // Base load and brakes are measured by the base load, losses by the rest.
    let whole = if which > 3 { m.base } else { m.power.max(5.0) };
    let size = whole * rng.log_between(0.08, 0.8);
    let second = rng.chance(0.5);
    let mut p = [[0.0; 3]; MAX];
    match which {
        0 | 2 => of_joints(which, size, second, m, rng),
        1 => {
            let level = (0..m.n).map(|i| m.torque[i].sqrt()).sum::<f64>().max(1e-6);
            for (i, own) in p.iter_mut().enumerate().take(m.n) {
                let rms = m.torque[i].sqrt().max(1e-6);
                *own = [size / level, if second { 1.2 * rms } else { 4.0 * rms }, 0.0];
            }
            let (form, kind) = if second {
                ("dead time", Kind::DeadTime)
            } else {
                ("conduction and switching", Kind::Switches)
            };
            let fault = Fault::new("inverter_loss", form, &[], Action::Nothing);
            (fault.own("per_current", None, size / level), Loss { kind, p })
        }
        3 => {
            p[0][0] = if second { 0.3 * m.braking } else { rng.between(0.05, 0.4) * m.braking };
            let (form, kind) = if second {
                ("braking power above a bound is burnt", Kind::Feeble)
            } else {
                ("bus capacitor and chopper", Kind::Chopper)
            };
            (Fault::new("no_regeneration", form, &[], Action::Nothing), Loss { kind, p })
        }
        4 => {
            p[0] = if second {
                [size, rng.between(0.4, 0.8), rng.between(7.0, 40.0)]
            } else {
                [size, 0.05, 30.0]
            };
            let (form, kind) = if second {
                ("fan with a thermostat", Kind::Fan)
            } else {
                ("slow drift", Kind::Base)
            };
            let value = if second { size * p[0][1] } else { size };
            let fault = Fault::new("base_load", form, &[], Action::Nothing);
            (fault.parameter("power", None, value, !second), Loss { kind, p })
        }
        _ => {
            p[0] = [size, rng.between(0.8, 2.0), 0.0];
            let (form, kind) = if second {
                ("coils of the moving axes", Kind::EachAxis)
            } else {
                ("pull-in", Kind::PullIn)
            };
            let fault = Fault::new("brake_power", form, &[], Action::Nothing);
            (fault.parameter("power", None, size, !second), Loss { kind, p })
        }
    }
}

fn of_joints(which: usize, size: f64, second: bool, m: &Means, rng: &mut Rng) -> (Fault, Loss) {
    let mut p = [[0.0; 3]; MAX];
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
    let part = size / wanted as f64;
    let (id, name, form, kind) = match (which, second) {
        (0, false) => ("copper_loss", "loss", "winding that warms", Kind::WarmCopper),
        (0, true) => ("copper_loss", "loss", "skin effect", Kind::SkinCopper),
        (_, false) => ("iron_loss", "loss", "Bertotti", Kind::Bertotti),
        (_, true) => ("iron_loss", "loss", "excess loss", Kind::Excess),
    };
    let mut fault = Fault::new(id, form, &joints, Action::Nothing);
    for i in joints {
        let (torque, speed) = (m.torque[i].max(1e-9), m.speed[i].max(1e-6));
        p[i] = match kind {
            Kind::WarmCopper => [part / torque, rng.between(0.05, 0.15), 100.0],
            Kind::SkinCopper => [part / torque, 3.0 * speed.sqrt(), 0.0],
            Kind::Bertotti => [part / speed * 0.75, 0.4 * speed.sqrt(), 0.0],
            _ => [part / speed.powf(0.75), 0.0, 0.0],
        };
        fault = fault.parameter(name, Some(i), p[i][0], kind == Kind::WarmCopper);
    }
    (fault, Loss { kind, p })
}
