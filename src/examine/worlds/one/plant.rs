//! The robot in motion: inverse dynamics on the prescribed path, friction and gear states integrated
//! along it, and the path of the torque to the log.

use super::arm::Arm;
use super::dynamics::{inverse, pose};
use super::everyday::{Day, Everyday, Level};
use super::faults::{Fault, Moment};
use super::friction::Elements;
use super::law::{States, View, advance};
use super::motion::{Path, STEP, STRIDE, Track};
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::hashed;
use std::rc::Rc;

/// What the log would show without noise at one time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sample {
    /// Time \[s\].
    pub(super) t: f64,
    /// Angles of the encoders \[rad\].
    pub(super) q: Row,
    /// Their speeds \[rad/s\].
    pub(super) v: Row,
    /// Their accelerations \[rad/s²\].
    pub(super) a: Row,
    /// Reported torques \[Nm\].
    pub(super) tau: Row,
    /// Torques of the motors \[Nm\].
    pub(super) motor: Row,
    pub(super) sign: Row,
}

/// Fine tables of one path without faults.
pub(super) struct Table {
    load: Vec<Row>,
    error: Vec<Row>,
    uneven: Vec<Row>,
}

/// A robot: its real parameters, everyday deviations and levels.
pub(super) struct Robot<'a> {
    pub(super) arm: &'a Arm,
    pub(super) everyday: &'a Everyday,
    pub(super) level: &'a Level,
    /// Rotor inertia \[kg m²\] times the acceleration of this is taken off the reported torques.
    pub(super) removed: Row,
}

/// Coarse rows to fine ones by cubic interpolation (E. Catmull, R. Rom).
fn refine(coarse: &[Row], count: usize) -> Vec<Row> {
    let n = coarse.len();
    let mut out = Vec::with_capacity(n * STRIDE);
    for i in 0..n {
        let (p0, p1) = (&coarse[(i + n - 1) % n], &coarse[i]);
        let (p2, p3) = (&coarse[(i + 1) % n], &coarse[(i + 2) % n]);
        for k in 0..STRIDE {
            let x = k as f64 / STRIDE as f64;
            let mut row = [0.0; MAX];
            for j in 0..count {
                let slope = 0.5 * (p2[j] - p0[j]);
                let next = 0.5 * (p3[j] - p1[j]);
                let d = p2[j] - p1[j];
                row[j] = p1[j]
                    + x * (slope
                        + x * (3.0 * d - 2.0 * slope - next + x * (slope + next - 2.0 * d)));
            }
            out.push(row);
        }
    }
    out
}

/// Torques of the links \[Nm\] on every fourth step of a path.
pub(super) fn coarse_load(arm: &Arm, path: &Path) -> Vec<Row> {
    let rows = (0..path.q.len()).step_by(STRIDE);
    rows.map(|i| inverse(arm, &pose(arm, &path.q[i]), &path.v[i], &path.a[i])).collect()
}

pub(super) fn level(arm: &Arm, path: &Path) -> Level {
    let load = coarse_load(arm, path);
    let mut out = Level::default();
    for j in 0..arm.count() {
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for (k, row) in load.iter().enumerate() {
            let i = k * STRIDE;
            let (q, v, a) = (path.q[i][j], path.v[i][j], path.a[i][j]);
            let friction =
                if v == 0.0 { 0.0 } else { arm.coulomb[j] * v.signum() + arm.viscous[j] * v };
            let tau = row[j] + arm.rotor[j] * a + friction;
            out.torque[j] += tau * tau / load.len() as f64;
            out.load[j] += row[j] * row[j] / load.len() as f64;
            out.peak[j] = out.peak[j].max(tau.abs());
            out.speed[j] = out.speed[j].max(v.abs());
            out.acceleration[j] = out.acceleration[j].max(a.abs());
            (low, high) = (low.min(q), high.max(q));
        }
        (out.middle[j], out.half[j]) = (0.5 * (low + high), 0.5 * (high - low));
        (out.torque[j], out.load[j]) = (out.torque[j].sqrt(), out.load[j].sqrt());
    }
    out
}

/// The tables of a path, for any faults.
pub(super) fn table(robot: &Robot, path: &Path) -> Table {
    let count = robot.arm.count();
    let load = coarse_load(robot.arm, path);
    let (mut error, mut uneven) = (Vec::new(), Vec::new());
    for (k, row) in load.iter().enumerate() {
        let i = k * STRIDE;
        error.push(robot.everyday.error((&path.q[i], &path.v[i], row), robot.level));
        uneven.push(robot.everyday.uneven(&path.q[i]));
    }
    Table {
        load: refine(&load, count),
        error: refine(&error, count),
        uneven: refine(&uneven, count),
    }
}

/// The tables of a track: of its first and its later periods.
pub(super) struct Tables {
    lead: Option<Table>,
    cycle: Table,
}

/// The tables of a track.
pub(super) fn tables(robot: &Robot, track: &Track) -> Tables {
    Tables {
        lead: track.lead.as_ref().map(|path| table(robot, path)),
        cycle: table(robot, &track.cycle),
    }
}

/// A field on the fine grid of a path.
fn field_of(fault: &Fault, arm: &Arm, path: &Path) -> Rc<Vec<Row>> {
    let Some(field) = fault.field.as_ref() else { return Rc::default() };
    // Paths live as long as their case: their address is their name.
    let name = path.q.as_ptr() as usize;
    let known =
        fault.known.borrow().iter().find(|(path, _)| *path == name).map(|(_, rows)| rows.clone());
    if let Some(rows) = known {
        return rows;
    }
    let mut coarse = Vec::new();
    for i in (0..path.q.len()).step_by(STRIDE) {
        let pose = pose(arm, &path.q[i]);
        let moment = Moment {
            phase: i as f64 * STEP,
            arm,
            pose: &pose,
            q: &path.q[i],
            v: &path.v[i],
            a: &path.a[i],
        };
        coarse.push(field(&moment));
    }
    let rows = Rc::new(refine(&coarse, arm.count()));
    fault.known.borrow_mut().push((name, rows.clone()));
    rows
}

/// States of one joint.
#[derive(Clone, Copy, Default)]
struct Axis {
    elements: Elements,
    speed: f64,
    bend: f64,
    bend_rate: f64,
    tau: f64,
    filter: [f64; 2],
}

/// One run of a robot along a track.
pub(super) struct Run<'a> {
    robot: &'a Robot<'a>,
    track: &'a Track,
    tables: &'a Tables,
    faults: &'a [&'a Fault],
    day: &'a Day,
    /// Fields of each fault, in the first and the later periods.
    fields: [Vec<Rc<Vec<Row>>>; 2],
    /// Fine step at which the run starts.
    from: usize,
}

/// The prescribed motion and the loads at one time.
struct Instant<'a> {
    t: f64,
    phase: f64,
    q: &'a Row,
    v: &'a Row,
    a: &'a Row,
    load: &'a Row,
}

impl Instant<'_> {
    /// What a law of a joint sees.
    const fn view(&self, j: usize, other: usize, field: f64, sign: f64) -> View {
        View {
            t: self.t,
            phase: self.phase,
            q: self.q[j],
            v: self.v[j],
            a: self.a[j],
            load: self.load[j],
            field,
            sign,
            other_q: self.q[other],
            other_v: self.v[other],
            other_a: self.a[other],
            other_load: self.load[other],
        }
    }
}

/// States of a run.
struct Living {
    axes: [Axis; MAX],
    laws: Vec<(States, View)>,
    memories: Vec<Vec<f64>>,
    signs: Row,
}

impl<'a> Run<'a> {
    /// Prepares a run from the start of a log.
    pub(super) fn new(
        robot: &'a Robot<'a>,
        track: (&'a Track, &'a Tables),
        faults: &'a [&'a Fault],
        day: &'a Day,
    ) -> Self {
        Self::starting(robot, track, faults, day, 0)
    }

    /// Prepares a run from a fine step.
    pub(super) fn starting(
        robot: &'a Robot<'a>,
        track: (&'a Track, &'a Tables),
        faults: &'a [&'a Fault],
        day: &'a Day,
        from: usize,
    ) -> Self {
        let all = |path: &Path| faults.iter().map(|f| field_of(f, robot.arm, path)).collect();
        let first = track.0.lead.as_ref().filter(|_| from < track.0.steps);
        let lead = first.map_or_else(Vec::new, all);
        let fields = [lead, all(&track.0.cycle)];
        Self { robot, track: track.0, tables: track.1, faults, day, fields, from }
    }

    /// The tables and fields of a period.
    fn period(&self, cycle: usize) -> (&Path, &Table, &[Rc<Vec<Row>>]) {
        match (cycle, &self.track.lead, &self.tables.lead) {
            (0, Some(path), Some(table)) => (path, table, &self.fields[0]),
            _ => (&self.track.cycle, &self.tables.cycle, &self.fields[1]),
        }
    }

    /// Load of the gears at a step \[Nm\].
    fn load(&self, table: &Table, fields: &[Rc<Vec<Row>>], i: usize) -> Row {
        let mut load = table.load[i];
        for (fault, rows) in self.faults.iter().zip(fields) {
            if fault.loads
                && let Some(row) = rows.get(i)
            {
                for j in 0..self.robot.arm.count() {
                    load[j] += row[j];
                }
            }
        }
        load
    }

    /// Torques \[Nm\] of the faults' laws, and angles \[rad\] of encoders over links, at a step.
    fn laws(
        &self,
        n: usize,
        instant: &Instant,
        fields: &[Rc<Vec<Row>>],
        live: &mut Living,
    ) -> (Row, Row) {
        let (mut extra, mut bends) = ([0.0; MAX], [0.0; MAX]);
        let mut number = 0;
        let i = n % self.track.steps;
        for (fault, rows) in self.faults.iter().zip(fields) {
            for part in &fault.laws {
                let field = rows.get(i).map_or(0.0, |row| row[part.joint]);
                let now = instant.view(part.joint, part.other, field, live.signs[part.joint]);
                let (states, before) = &mut live.laws[number];
                if n == self.from {
                    *states = part.what.start(&now);
                } else {
                    advance(&*part.what, before, &now, states, STEP);
                }
                extra[part.joint] += part.what.torque(&now, states);
                bends[part.joint] += part.what.bend(&now, states);
                *before = now;
                number += 1;
            }
        }
        (extra, bends)
    }

    /// Motor and reported torques at a step.
    fn step(&self, n: usize, live: &mut Living) -> Sample {
        let (cycle, i) = (n / self.track.steps, n % self.track.steps);
        let (path, table, fields) = self.period(cycle);
        let (q, v, a) = (&path.q[i], &path.v[i], &path.a[i]);
        let load = self.load(table, fields, i);
        let t = n as f64 * STEP;
        let arm = self.robot.arm;
        let mut out = Sample { t, q: *q, v: *v, a: *a, ..Sample::default() };
        let now = Instant { t, phase: i as f64 * STEP, q, v, a, load: &load };
        let (extra, bends) = self.laws(n, &now, fields, live);
        for j in 0..arm.count() {
            let axis = &mut live.axes[j];
            let everyday = &self.robot.everyday.joints[j];
            let rate = if n == self.from { 0.0 } else { (bends[j] - axis.bend) / STEP };
            let jump = if n < self.from + 2 { 0.0 } else { (rate - axis.bend_rate) / STEP };
            (axis.bend, axis.bend_rate) = (bends[j], rate);
            let speed = v[j] + rate;
            let z = everyday.bank.step(&mut axis.elements, (axis.speed, speed), STEP);
            axis.speed = speed;
            live.signs[j] = z / everyday.bank.steady(speed);
            let wobble =
                1.0 + self.robot.everyday.cycle * hashed(self.day.key, (cycle * MAX + j) as u64);
            let level =
                self.day.coulomb[j] * wobble * table.uneven[i][j] * (1.0 + everyday.asymmetry * z);
            let viscous = arm.viscous[j]
                * self.day.viscous[j]
                * (1.0 - everyday.bent * speed.abs() / everyday.top);
            let motor = load[j]
                + arm.rotor[j] * (a[j] + jump)
                + table.error[i][j]
                + arm.coulomb[j] * level * z
                + viscous * speed
                + extra[j];
            out.q[j] += bends[j];
            out.v[j] = speed;
            out.a[j] += jump;
            out.motor[j] = motor;
            out.tau[j] = motor - self.robot.removed[j] * a[j];
            out.sign[j] = live.signs[j];
        }
        let mut number = 0;
        for fault in self.faults {
            for part in &fault.readers {
                let j = part.joint;
                let now = now.view(j, part.other, 0.0, live.signs[j]);
                out.tau[j] = part.what.read(&now, &mut live.memories[number], out.tau[j], STEP);
                number += 1;
            }
        }
        for j in 0..arm.count() {
            out.tau[j] = self.report(j, out.tau[j], n == self.from, &mut live.axes[j]);
        }
        out
    }

    /// The filter of the torque path, by the Runge-Kutta method.
    fn report(&self, j: usize, tau: f64, first: bool, axis: &mut Axis) -> f64 {
        let everyday = &self.robot.everyday.joints[j];
        if first {
            (axis.filter, axis.tau) = ([tau, 0.0], tau);
        }
        let (w, damp) = (everyday.omega * everyday.omega, 2.0 * everyday.zeta * everyday.omega);
        let rate = |s: [f64; 2], u: f64| [s[1], w * (u - s[0]) - damp * s[1]];
        let [x, y] = axis.filter;
        let middle = 0.5 * (axis.tau + tau);
        let k1 = rate([x, y], axis.tau);
        let k2 = rate([x + 0.5 * STEP * k1[0], y + 0.5 * STEP * k1[1]], middle);
        let k3 = rate([x + 0.5 * STEP * k2[0], y + 0.5 * STEP * k2[1]], middle);
        let k4 = rate([x + STEP * k3[0], y + STEP * k3[1]], tau);
        for k in 0..2 {
            axis.filter[k] += STEP * (k1[k] + 2.0 * (k2[k] + k3[k]) + k4[k]) / 6.0;
        }
        axis.tau = tau;
        axis.filter[0] + everyday.offset
    }

    /// Samples at rising times \[s\] within the track.
    pub(super) fn samples(&self, times: &[f64]) -> Vec<Sample> {
        let laws = self.faults.iter().map(|f| f.laws.len()).sum();
        let readers = self.faults.iter().map(|f| f.readers.len()).sum();
        let mut live = Living {
            axes: [Axis::default(); MAX],
            laws: vec![(States::default(), View::default()); laws],
            memories: vec![Vec::new(); readers],
            signs: [0.0; MAX],
        };
        let end = self.track.steps * self.track.cycles;
        let mut out = Vec::with_capacity(times.len());
        let mut last = Sample::default();
        let mut next = 0;
        for n in self.from..end {
            if next >= times.len() {
                break;
            }
            let sample = self.step(n, &mut live);
            while next < times.len() && times[next] <= sample.t + 1e-12 {
                out.push(between(&last, &sample, times[next]));
                next += 1;
            }
            last = sample;
        }
        while out.len() < times.len() {
            out.push(last);
        }
        out
    }
}

/// A sample between two fine steps.
fn between(a: &Sample, b: &Sample, t: f64) -> Sample {
    let x = if b.t > a.t { ((t - a.t) / (b.t - a.t)).clamp(0.0, 1.0) } else { 1.0 };
    let mix = |p: &Row, r: &Row| {
        let mut out = *p;
        for j in 0..MAX {
            out[j] += x * (r[j] - p[j]);
        }
        out
    };
    Sample {
        t,
        q: mix(&a.q, &b.q),
        v: mix(&a.v, &b.v),
        a: mix(&a.a, &b.a),
        tau: mix(&a.tau, &b.tau),
        motor: mix(&a.motor, &b.motor),
        sign: mix(&a.sign, &b.sign),
    }
}
