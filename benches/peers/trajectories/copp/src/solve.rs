//! The problems of COPP on given nodes.

use copp::diag::{CoppError, RobotDynamicsError};
use copp::robot::{Robot, RobotBasic, RobotTorque};
use copp::solver::copp2_socp::{
    ClarabelOptionsBuilder, Copp2ProblemBuilder, CoppObjective, copp2_socp,
};
use copp::solver::copp3_socp::{Copp3ProblemBuilder, copp3_socp_expert, s_to_t_topp3};
use copp::solver::topp2_ra::{ReachSet2OptionsBuilder, Topp2ProblemBuilder, topp2_ra};
use nalgebra::DMatrix;

use crate::nodes::{DOF, Joints, Nodes};

/// Torques by a look-up. COPP computes the coefficients of a node from the inverse dynamics at
/// multiples of q' and q''; here the first "joint position" is the index of the node.
pub struct Table<'a>(&'a Nodes);

impl RobotBasic for Table<'_> {
    fn dim(&self) -> usize {
        DOF
    }
}

impl RobotTorque for Table<'_> {
    fn inverse_dynamics(
        &self,
        q: &[f64],
        dq: &[f64],
        ddq: &[f64],
        tau: &mut [f64],
    ) -> Result<(), RobotDynamicsError> {
        let (nodes, k) = (self.0, q[0] as usize);
        let q1 = nodes.q1.column(k);
        let (rates, turns) = (column(dq), column(ddq));
        // At rest the acceleration is along q', otherwise it is that of a constant path speed.
        let speed = q1.dot(&rates) / q1.norm_squared();
        let turn = if speed == 0.0 { q1.dot(&turns) / q1.norm_squared() } else { 0.0 };
        for j in 0..DOF {
            let at = |m: &DMatrix<f64>| m[(j, k)];
            let dry = if speed == 0.0 { 0.0 } else { at(&nodes.dry) };
            tau[j] = at(&nodes.inertial) * turn
                + at(&nodes.centrifugal) * speed * speed
                + at(&nodes.gravity)
                + dry;
        }
        Ok(())
    }
}

fn column(values: &[f64]) -> nalgebra::DVectorView<'_, f64> {
    nalgebra::DVectorView::from_slice(values, values.len())
}

/// What the set-up of a problem needs in the layout of COPP; made before the clock starts.
pub struct Given<'a> {
    nodes: &'a Nodes,
    index: DMatrix<f64>,
    rest: DMatrix<f64>,
    normalize: Joints,
}

/// A jerk-limited result.
pub struct Smooth {
    pub a: Vec<f64>,
    pub duration: f64,
    /// The objective as COPP discretises it.
    pub objective: f64,
}

impl<'a> Given<'a> {
    pub fn new(nodes: &'a Nodes) -> Given<'a> {
        let index = DMatrix::from_fn(DOF, nodes.s.len(), |_, k| k as f64);
        let rest = &nodes.gravity + &nodes.dry;
        Given { nodes, index, rest, normalize: nodes.loss.map(f64::sqrt) }
    }

    /// The nodes with the rows of joint speeds, accelerations and torques.
    pub fn robot(&self) -> Result<Robot<Table<'a>>, CoppError> {
        let (nodes, n) = (self.nodes, self.nodes.s.len());
        let mut robot = Robot::with_capacity(Table(nodes), n);
        let opposite = |limit: &Joints| limit.map(|x| -x);
        let (speed, slowest) = (nodes.velocity, opposite(&nodes.velocity));
        let (turn, least) = (nodes.acceleration, opposite(&nodes.acceleration));
        let q3 = nodes.q3.as_view();
        robot
            .with_s(nodes.s.as_slice())?
            .with_q(&self.index.as_view(), &nodes.q1.as_view(), &nodes.q2.as_view(), Some(&q3), 0)?
            .with_axial_velocity((speed.as_slice(), n), (slowest.as_slice(), n), 0)?
            .with_axial_acceleration((turn.as_slice(), n), (least.as_slice(), n), 0)?;
        let mut above = -&self.rest;
        let mut below = above.clone();
        for (mut up, mut down) in above.column_iter_mut().zip(below.column_iter_mut()) {
            for j in 0..DOF {
                up[j] += nodes.torque[j];
                down[j] -= nodes.torque[j];
            }
        }
        let (a, b) = (nodes.centrifugal.as_view(), nodes.inertial.as_view());
        robot
            .constraints
            .with_constraint_2order(&a, &b, &above.as_view(), 0, false)?
            .with_constraint_2order(&a, &b, &below.as_view(), 0, true)?;
        Ok(robot)
    }

    fn last(&self) -> usize {
        self.nodes.s.len() - 1
    }

    /// ṡ² of the fastest profile.
    pub fn fastest(&self, robot: &Robot<Table<'a>>) -> Result<Vec<f64>, CoppError> {
        let problem = Topp2ProblemBuilder::new(robot, (0, self.last()), (0.0, 0.0)).build()?;
        topp2_ra(&problem, &ReachSet2OptionsBuilder::new().build()?)
    }

    /// ṡ² of the least `per_second` · time + thermal energy.
    pub fn least(&self, per_second: f64) -> Result<Vec<f64>, CoppError> {
        let robot = self.robot()?;
        let objectives = self.objectives(per_second);
        let problem =
            Copp2ProblemBuilder::new(&robot, (0, self.last()), (0.0, 0.0), &objectives).build()?;
        copp2_socp(&problem, &ClarabelOptionsBuilder::new().build()?)
    }

    fn objectives(&self, per_second: f64) -> [CoppObjective<'_>; 2] {
        let thermal = CoppObjective::ThermalEnergy(1.0, &self.normalize);
        [CoppObjective::Time(per_second), thermal]
    }

    /// The same with the limit on jerk: `passes` programs, the rows of each linearised at the
    /// result of the one before, the first at the fastest profile, as in COPP's example.
    pub fn smooth(&self, per_second: f64, passes: usize) -> Result<Smooth, CoppError> {
        let (nodes, n) = (self.nodes, self.nodes.s.len());
        let mut robot = self.robot()?;
        let least = nodes.jerk.map(|x| -x);
        robot.with_axial_jerk((nodes.jerk.as_slice(), n), (least.as_slice(), n), 0)?;
        let mut at = self.fastest(&robot)?;
        robot.constraints.amax_substitute(&at, 0)?;
        let objectives = self.objectives(per_second);
        let options = ClarabelOptionsBuilder::new().build()?;
        let mut result = None;
        for _ in 0..passes {
            let rest = (0.0, 0.0);
            let problem = Copp3ProblemBuilder::new(&mut robot, &objectives, 0, &at, rest, rest)
                .build_with_linearization()?;
            let (profile, solution) = copp3_socp_expert(&problem, &options)?;
            let profile = profile.ok_or_else(|| {
                CoppError::ClarabelSolverStatus("copp3_socp".into(), solution.status)
            })?;
            let (duration, _) = s_to_t_topp3(&nodes.s, profile.as_parts(), 0.0)?;
            at.clone_from(&profile.a);
            result = Some(Smooth { a: profile.a, duration, objective: solution.obj_val });
        }
        result.ok_or_else(|| CoppError::InvalidInput("smooth".into(), "no pass".into()))
    }
}
