//! What each fault contributes to the torques at a sample.

use super::fault::Action;
use super::plant::Record;
use super::state::State;
use super::structure::{Wrist, composed};
use crate::examine::worlds::api::minus;
use crate::examine::worlds::model::{MAX, Row};

impl State<'_> {
    /// Writes a sample and what each fault contributes.
    pub(super) fn sample(&self, record: &mut Record) {
        let reported = self.reported.first().copied().unwrap_or([0.0; MAX]);
        record.t.push(self.now.t);
        record.q.push(self.now.q);
        record.v.push(self.now.v);
        record.a.push(self.motor_a);
        record.tau.push(reported);
        record.motor.push(self.current);
        let load = self.arm.torques(&self.link_q, &self.link_v, &self.link_a);
        for (k, fault) in self.faults.iter().enumerate() {
            let delta = match &fault.action {
                Action::Sensor(_) => {
                    let chain = self.chains.iter().position(|(without, _, _)| *without == Some(k));
                    let other =
                        chain.and_then(|c| self.reported.get(c)).copied().unwrap_or(reported);
                    minus(&reported, &other)
                }
                Action::Terms(_) => self.terms.get(k).copied().unwrap_or([0.0; MAX]),
                Action::Contact(_) => self.contact,
                Action::Body(_) => self.of_body(k, &load),
                Action::Flex(flex) => self.of_place(flex.joint, &load),
                Action::Encoder(encoder) => self.of_place(encoder.joint, &load),
                Action::Bristle(long) => {
                    let mut out = [0.0; MAX];
                    let i = long.joint;
                    out[i] = self.level[i] * (self.bristles[0][i] - self.bristles[1][i]);
                    out
                }
                Action::Wrist(wrist) => self.of_wrist(wrist),
                Action::Nothing => [0.0; MAX],
            };
            if let Some(list) = record.delta.get_mut(k) {
                list.push(delta);
            }
        }
    }

    fn of_body(&self, k: usize, load: &Row) -> Row {
        let others = self.faults.iter().enumerate().filter(|(other, _)| *other != k);
        let arm = composed(&self.plant.robot.arm, others.flat_map(|(_, fault)| fault.changes()));
        let mut out = minus(load, &arm.torques(&self.link_q, &self.link_v, &self.link_a));
        for i in 0..arm.n() {
            out[i] += (self.arm.rotor[i] - arm.rotor[i]) * self.motor_a[i];
        }
        out
    }

    /// What it changes that a link is not where its motor shows.
    fn of_place(&self, joint: usize, load: &Row) -> Row {
        let (mut q, mut v, mut a) = (self.link_q, self.link_v, self.link_a);
        q[joint] = self.now.q[joint];
        v[joint] = self.now.v[joint];
        a[joint] = self.motor_a[joint];
        minus(load, &self.arm.torques(&q, &v, &a))
    }

    fn of_wrist(&self, wrist: &Wrist) -> Row {
        let n = self.arm.n();
        let (five, six) = (n - 2, n - 1);
        let (robot, c) = (&self.plant.robot, wrist.coupling);
        let plain = robot.coulomb[six] * self.now.dry[six] * self.bristles[2][six]
            + robot.viscous[six] * self.now.wet[six] * self.now.v[six];
        let rotor = self.arm.rotor[six];
        let mut out = [0.0; MAX];
        out[six] = self.friction[six] - plain + rotor * c * self.motor_a[five];
        let turn = self.motor_a[six] + c * self.motor_a[five];
        out[five] = c * (self.friction[six] + rotor * turn);
        out
    }
}
