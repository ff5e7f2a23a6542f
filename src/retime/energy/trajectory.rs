//! The planned motion of a whole cycle as samples.

use super::power::{Power, power, supply_w};
use crate::arm::dynamics::{Data, Load};
use crate::arm::kinematics::{Tcp, fk};
use crate::arm::robot::Model;
use crate::rapid::text::Span;
use crate::retime::motion::timed::JointState;
use crate::retime::motion::timeline::{Run, Simulation, What};
use crate::retime::path::joint_path::Joints;

/// Longest step between two samples, s.
pub const STEP: f64 = 0.002;

/// One sample.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Time from the start of the cycle, s.
    pub t: f64,
    /// State of the joints.
    pub state: JointState,
    /// Torques and powers; `None` if the robot has no dynamics.
    pub power: Option<Power>,
    /// Electrical power with base, holding and brake power, W.
    pub electrical_w: Option<f64>,
    /// TCP position in the base frame, m.
    pub tcp: [f64; 3],
    /// TCP speed, m/s.
    pub tcp_speed: f64,
    /// The executed statement.
    pub span: Option<Span>,
}

/// Samples of the cycle, at most 2 ms apart and at every event.
pub fn trajectory(model: &Model, simulation: &Simulation) -> Vec<Sample> {
    let mut sampler = Sampler { model, data: Data::new(), rows: Vec::new() };
    let mut tool = Tcp::default();
    let mut rest: Option<Joints> = None;
    for event in &simulation.events {
        match &event.what {
            What::Run(run) => {
                let marks = marks(run);
                for (i, record) in run.moves.iter().enumerate() {
                    tool = run.legs[i].tool;
                    let (begin, end) = (record.t_start, record.t_start + record.duration);
                    let from = marks.partition_point(|t| *t < begin);
                    let to = marks.partition_point(|t| *t <= end);
                    for t in dense(&marks[from..to]) {
                        let at = event.t_start + t;
                        sampler.push(at, run.at(t), &run.load, &tool, Some(record.movement.span));
                    }
                }
                rest = Some(run.end);
            }
            What::Wait(wait) => {
                for t in dense(&[0.0, event.duration]) {
                    let state = JointState::rest(wait.q);
                    let span = Some(wait.wait.span);
                    sampler.push(event.t_start + t, state, &wait.load, &tool, span);
                }
                rest = Some(wait.q);
            }
            What::Output(..) | What::Left(_) => {}
        }
    }
    if sampler.rows.is_empty() {
        let q = rest.unwrap_or([0.0; 6]);
        sampler.push(0.0, JointState::rest(q), &Load::none(), &tool, None);
    }
    sampler.rows
}

/// Ends of movements and knots of motions, s from the start of the run.
fn marks(run: &Run) -> Vec<f64> {
    let mut marks = vec![0.0, run.duration() - run.settling];
    marks.extend(run.moves.iter().map(|record| record.t_start + record.duration));
    for (begin, motion) in &run.motions {
        marks.extend(motion.knots().iter().map(|t| t + begin));
    }
    marks.sort_by(f64::total_cmp);
    marks.dedup();
    marks
}

/// The marks with additional times at most a step apart.
fn dense(marks: &[f64]) -> Vec<f64> {
    let mut times = Vec::new();
    for pair in marks.windows(2) {
        let steps = ((pair[1] - pair[0]) / STEP).ceil().max(1.0);
        let h = (pair[1] - pair[0]) / steps;
        times.extend((0..steps as usize).map(|i| pair[0] + h * i as f64));
    }
    times.extend(marks.last());
    times
}

struct Sampler<'a> {
    model: &'a Model,
    data: Data,
    rows: Vec<Sample>,
}

impl Sampler<'_> {
    fn push(&mut self, t: f64, state: JointState, load: &Load, tool: &Tcp, span: Option<Span>) {
        let model = self.model;
        let power = model.has_dynamics().then(|| power(model, &mut self.data, load, &state));
        let motion: [&[f64]; 3] = [&state.q, &state.qd, &state.qdd];
        let electrical_w = power.map(|p| supply_w(model, &mut self.data, load, motion, &p));
        let tcp = tool.pose(&fk(model, &state.q)).translation.vector;
        let rate = tool.twist(model, &state.q, &state.qd);
        let tcp_speed = rate.fixed_rows::<3>(0).norm();
        let row = Sample { t, state, power, electrical_w, tcp: tcp.into(), tcp_speed, span };
        match self.rows.last_mut() {
            // One row per time: the last statement replaces the one that ends there.
            Some(last) if last.t == t => *last = row,
            _ => self.rows.push(row),
        }
    }
}
