//! The state of a run and its step: controller, friction, forward dynamics, integration.

use crate::examine::worlds::model::{MAX, Row};
use nalgebra::SMatrix;

use super::fault::{Action, Fault};
use super::plant::{Plant, RAMP, REST, Run};
use super::rigid::{Arm, Pose, solve};
use super::sensor::Path;
use super::structure::{Change, Wrist, composed};
use super::terms::{Now, TICK};

/// Time constant of the current loop \[s\].
const CURRENT: f64 = 8e-4;
/// Smoothing of the accelerations that laws see \[s\].
const SMOOTH: f64 = 4e-3;

/// The state of a run.
pub(super) struct State<'a> {
    pub(super) plant: &'a Plant,
    pub(super) faults: Vec<Fault>,
    pub(super) arm: Arm,
    pub(super) moving: bool,
    pub(super) now: Now,
    /// Bristles: of the fault or the coupled rate, of the rate without a fault, without the coupling.
    pub(super) bristles: [Row; 3],
    pub(super) link_q: Row,
    pub(super) link_v: Row,
    pub(super) link_a: Row,
    pub(super) motor_a: Row,
    pub(super) current: Row,
    pub(super) integral: Row,
    pub(super) error: Row,
    pub(super) uneven: Row,
    pub(super) friction: Row,
    pub(super) contact: Row,
    /// Torque of each fault now: levels and smooth torques of terms.
    pub(super) terms: Vec<Row>,
    /// Levels of Coulomb friction now, with faults \[Nm\].
    pub(super) level: Row,
    pub(super) kv: Row,
    pub(super) chains: Vec<Chain>,
    pub(super) reported: Vec<Row>,
    pub(super) factors: [Row; 2],
}

/// A path of the torque with the faults of it: which fault is left out, the filter, the faults.
type Chain = (Option<usize>, Path, Vec<Fault>);

/// The path with all faults, then one without each of the faults of the path.
fn chains(plant: &Plant, faults: &[Fault], rest: Row, dt: f64) -> Vec<Chain> {
    let mut lists = vec![(None, faults.to_vec())];
    for (k, fault) in faults.iter().enumerate() {
        if matches!(fault.action, Action::Sensor(_)) {
            let mut others = faults.to_vec();
            if let Some(own) = others.get_mut(k) {
                own.action = Action::Nothing;
            }
            lists.push((Some(k), others));
        }
    }
    let filled = lists.into_iter().map(|(without, mut list)| {
        let mut path = Path::new(plant.path.poles, plant.path.mean, plant.path.delay, dt);
        path.fill(rest);
        for fault in &mut list {
            if let Action::Sensor(sensor) = &mut fault.action {
                sensor.fill(rest, dt);
            }
        }
        (without, path, list)
    });
    filled.collect()
}

impl<'a> State<'a> {
    pub(super) fn new(plant: &'a Plant, faults: &[Fault], run: &Run) -> Self {
        let n = plant.robot.arm.n();
        let zero = [0.0; MAX];
        let faults = faults.to_vec();
        let arm = composed(&plant.robot.arm, faults.iter().flat_map(Fault::changes));
        let (q, _, _) = run.motion.at(-0.5 * RAMP);
        let pose = arm.pose(&q);
        let mass = pose.mass_matrix();
        let mut kv = zero;
        for i in 0..n {
            kv[i] = plant.gains.speed * (mass[(i, i)] + arm.rotor[i]);
        }
        let mut link_q = q;
        for fault in &faults {
            match &fault.action {
                Action::Flex(flex) => {
                    let own = mass[(flex.joint, flex.joint)].min(0.6 * arm.rotor[flex.joint]);
                    kv[flex.joint] = 0.7 * plant.gains.speed * (own + arm.rotor[flex.joint]);
                }
                Action::Encoder(encoder) => {
                    link_q[encoder.joint] += encoder.error(q[encoder.joint]);
                }
                _ => {}
            }
        }
        let rest = arm.torques(&link_q, &zero, &zero);
        let chains = chains(plant, &faults, rest, run.dt);
        let now = Now {
            t: -REST - RAMP,
            phase: 0.0,
            dt: run.dt,
            q,
            v: zero,
            a: zero,
            load: rest,
            s: zero,
            dry: [1.0; MAX],
            wet: [1.0; MAX],
            chance: [0.5; MAX],
        };
        let moving = faults.iter().flat_map(Fault::changes).any(Change::moves);
        Self {
            plant,
            moving,
            terms: vec![zero; faults.len()],
            reported: vec![rest; chains.len()],
            faults,
            arm,
            now,
            bristles: [zero; 3],
            link_q,
            link_v: zero,
            link_a: zero,
            motor_a: zero,
            current: rest,
            integral: zero,
            error: zero,
            uneven: zero,
            friction: zero,
            contact: zero,
            level: zero,
            kv,
            chains,
            factors: [[1.0; MAX]; 2],
        }
    }

    /// Cascade: position, speed with integral, feed-forward; then the current loop.
    pub(super) fn control(&mut self, q: &Row, v: &Row, ahead: &Row) {
        let gains = self.plant.gains;
        let dt = self.now.dt;
        for i in 0..self.arm.n() {
            let wanted =
                gains.forward * v[i] + gains.position * gains.speed * (q[i] - self.now.q[i]);
            let slip = wanted - self.now.v[i];
            let limit = self.plant.robot.torque[i];
            let free = self.integral[i] + gains.integral * gains.speed * self.kv[i] * slip * dt;
            self.integral[i] = free.clamp(-limit, limit);
            let sum = self.kv[i] * slip + self.integral[i] + ahead[i];
            let command = sum.clamp(-1.5 * limit, 1.5 * limit);
            self.current[i] += (command - self.current[i]) * dt / (CURRENT + dt);
        }
    }

    /// Rates at which friction acts: the last motor may be coupled.
    fn rates(&self) -> (Row, Option<Wrist>) {
        let mut rates = self.now.v;
        let wrist = self.faults.iter().find_map(|fault| match &fault.action {
            Action::Wrist(wrist) => Some(wrist.clone()),
            _ => None,
        });
        let n = self.arm.n();
        if let Some(wrist) = &wrist {
            rates[n - 1] += wrist.coupling * rates[n - 2];
        }
        (rates, wrist)
    }

    /// Friction and faults that add to it; returns the derivative by the rate.
    fn friction(&mut self, rates: &Row) -> Row {
        let n = self.arm.n();
        let (robot, dt) = (&self.plant.robot, self.now.dt);
        let mut slope = [0.0; MAX];
        for i in 0..n {
            let Some(gear) = self.plant.everyday.gears.get(i) else { continue };
            for (bristle, rate) in self.bristles.iter_mut().zip([rates[i], rates[i], self.now.v[i]])
            {
                let way = dt * rate / gear.distance;
                bristle[i] = (bristle[i] + way) / (1.0 + way.abs());
            }
            for fault in &mut self.faults {
                if let Action::Bristle(long) = &mut fault.action
                    && long.joint == i
                {
                    self.bristles[0][i] = long.step(dt * rates[i]);
                }
            }
            let s = self.bristles[0][i];
            let (dry, wet) = gear.levels(rates[i], self.uneven[i]);
            self.now.dry[i] = dry * self.factors[0][i];
            self.now.wet[i] = wet * self.factors[1][i];
            self.level[i] = robot.coulomb[i] * self.now.dry[i];
            let viscous = robot.viscous[i] * self.now.wet[i];
            self.friction[i] = viscous * rates[i];
            let way = dt * rates[i].abs() / gear.distance;
            let soft = dt / gear.distance * (1.0 - s * rates[i].signum()).max(0.05);
            slope[i] = viscous + self.level[i] * soft / ((1.0 + way) * (1.0 + way));
        }
        self.now.s = self.bristles[0];
        for (fault, out) in self.faults.iter_mut().zip(&mut self.terms) {
            if let Action::Terms(terms) = &mut fault.action {
                *out = [0.0; MAX];
                for term in terms {
                    let (level, smooth) = term.at(&self.now);
                    let i = term.joint;
                    out[i] += level * self.now.s[i] + smooth;
                    self.level[i] += level;
                    self.friction[i] += smooth;
                    slope[i] *= 1.0 + (level / robot.coulomb[i].max(1e-9)).max(0.0);
                }
            }
        }
        for i in 0..n {
            self.friction[i] += self.level[i] * self.now.s[i];
        }
        slope
    }

    /// Everyday error, unevenness and moving bodies: on the slow tick.
    fn tick(&mut self, pose: &Pose) {
        let everyday = &self.plant.everyday;
        self.error = everyday.error(&self.now.q, &self.now.v, &self.now.load);
        for (i, gear) in everyday.gears.iter().enumerate() {
            self.uneven[i] = gear.uneven(self.now.q[i]);
        }
        if self.moving {
            for fault in &mut self.faults {
                if let Action::Body(changes) = &mut fault.action {
                    for change in changes {
                        change.step(&self.arm, pose, &self.now.load, TICK);
                    }
                }
            }
            self.arm = composed(&self.plant.robot.arm, self.faults.iter().flat_map(Fault::changes));
        }
    }

    /// One step of the plant.
    pub(super) fn step(&mut self, slow: bool) {
        let n = self.arm.n();
        let dt = self.now.dt;
        let pose = self.arm.pose(&self.link_q);
        if slow {
            self.tick(&pose);
        }
        let (rates, wrist) = self.rates();
        let slope = self.friction(&rates);
        self.contact = [0.0; MAX];
        for fault in &self.faults {
            if let Action::Contact(contact) = &fault.action {
                self.contact = contact.torques(&pose, &self.now.v, &self.now);
            }
        }
        let mut mass = pose.mass_matrix();
        let bias = self.arm.inverse(&pose, &self.link_v, &[0.0; MAX]);
        let mut drive = [0.0; MAX];
        for i in 0..n {
            mass[(i, i)] += self.arm.rotor[i] + dt * slope[i];
            drive[i] =
                self.current[i] - bias[i] - self.friction[i] - self.error[i] - self.contact[i];
        }
        if let Some(wrist) = &wrist {
            self.couple(wrist, &mut mass, &mut drive);
        }
        let flexible = self.flexible(&slope, &mut mass, &mut drive);
        let acceleration = solve(&mass, &drive);
        self.advance(&acceleration, &flexible);
        self.report();
    }

    /// The last motor turns with the axis before, too.
    fn couple(&mut self, wrist: &Wrist, mass: &mut SMatrix<f64, MAX, MAX>, drive: &mut Row) {
        let n = self.arm.n();
        let (five, six) = (n - 2, n - 1);
        let c = wrist.coupling;
        let more = wrist.load * self.now.load[six].abs() * self.now.s[six];
        self.friction[six] += more;
        drive[six] -= more;
        mass[(five, five)] += c * c * self.arm.rotor[six];
        mass[(five, six)] += c * self.arm.rotor[six];
        mass[(six, five)] += c * self.arm.rotor[six];
        drive[five] -= c * self.friction[six];
    }

    /// Replaces rows of elastic gears; returns the accelerations of their motors.
    fn flexible(
        &mut self,
        slope: &Row,
        mass: &mut SMatrix<f64, MAX, MAX>,
        drive: &mut Row,
    ) -> [Option<f64>; MAX] {
        let mut motors = [None; MAX];
        let dt = self.now.dt;
        for fault in &self.faults {
            if let Action::Flex(flex) = &fault.action {
                let i = flex.joint;
                let twist = self.now.q[i] - self.link_q[i];
                let (torque, k, d) = flex.torque(twist, self.now.v[i] - self.link_v[i]);
                // The gear's friction and the everyday error act at the motor.
                let rotor = self.arm.rotor[i];
                let bare = drive[i] - self.current[i] + self.friction[i] + self.error[i];
                let push = self.current[i] - self.friction[i] - self.error[i] - torque;
                motors[i] = Some(push / (rotor + dt * (slope[i] + d + dt * k)));
                drive[i] = bare + torque;
                mass[(i, i)] += dt * (d + dt * k - slope[i]) - rotor;
            }
        }
        motors
    }

    fn advance(&mut self, acceleration: &Row, flexible: &[Option<f64>; MAX]) {
        let (n, dt) = (self.arm.n(), self.now.dt);
        let mut shown = self.now.q;
        for i in 0..n {
            self.link_a[i] = acceleration[i];
            self.link_v[i] += dt * acceleration[i];
            self.link_q[i] += dt * self.link_v[i];
            self.motor_a[i] = acceleration[i];
            if let Some(motor) = flexible[i] {
                self.motor_a[i] = motor;
                self.now.v[i] += dt * motor;
                shown[i] += dt * self.now.v[i];
            } else {
                self.now.v[i] = self.link_v[i];
                shown[i] += dt * self.link_v[i];
            }
        }
        self.now.q = shown;
        for fault in &self.faults {
            if let Action::Encoder(encoder) = &fault.action {
                let i = encoder.joint;
                self.link_q[i] = self.now.q[i] + encoder.error(self.now.q[i]);
            }
        }
        for i in 0..n {
            self.now.a[i] += dt * (self.motor_a[i] - self.now.a[i]) / (SMOOTH + dt);
            self.now.load[i] = self.current[i]
                - self.friction[i]
                - self.error[i]
                - self.arm.rotor[i] * self.motor_a[i];
        }
    }

    /// Sends the motor torques through the path.
    fn report(&mut self) {
        let (n, dt) = (self.arm.n(), self.now.dt);
        let mut raw = self.current;
        for i in 0..n {
            raw[i] -= self.plant.subtract[i] * self.motor_a[i];
        }
        for ((_, path, faults), out) in self.chains.iter_mut().zip(&mut self.reported) {
            let mut tau = raw;
            for fault in faults {
                if let Action::Sensor(sensor) = &mut fault.action {
                    sensor.step(&mut tau, &self.now);
                }
            }
            *out = path.step(&tau, dt);
        }
    }
}
