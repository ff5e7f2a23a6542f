//! Samples of a run over time.

use crate::arm::dynamics::Data;
use crate::arm::kinematics::fk;
use crate::arm::robot::Model;
use crate::retime::energy::account::base;
use crate::retime::energy::power::{holding_w, power};
use crate::retime::motion::timeline::Run;
use crate::retime::optimize::corridor::Corridor;
use crate::retime::path::joint_path::{DOF, Joints};

/// Maximum step between two samples, s.
const STEP: f64 = 0.002;
/// Maximum number of samples of a run.
const MAX_SAMPLES: f64 = 1500.0;

/// The plotted quantities at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// s from the start of the run.
    pub(super) t: f64,
    /// rad/s.
    pub(super) qd: Joints,
    /// With friction, Nm.
    pub(super) tau: Joints,
    /// Electrical power with base, holding and brake power, W.
    pub(super) electrical_w: f64,
    /// m/s.
    pub(super) tcp_speed: f64,
    /// Maximum TCP speed that program and robot allow there, m/s.
    pub(super) ceiling: f64,
}

/// Evenly spaced samples of a run, ends included. `corridor`: the path that it follows.
pub(super) fn samples(model: &Model, run: &Run, corridor: Option<&Corridor>) -> Vec<Sample> {
    let duration = run.duration();
    let steps = (duration / STEP).ceil().clamp(1.0, MAX_SAMPLES);
    let mut data = Data::new();
    let mut place = 0;
    let mut leg = 0;
    let base_w = base(model, 1.0).energy_j();
    let mut rows = Vec::new();
    for i in 0..=steps as usize {
        let t = duration * i as f64 / steps;
        while run.moves.get(leg + 1).is_some_and(|next| next.t_start <= t) {
            leg += 1;
        }
        let Some(tool) = run.legs.get(leg).map(|leg| leg.tool) else { break };
        let state = run.at(t);
        let p = power(model, &mut data, &run.load, &state);
        let moves = (0..DOF).any(|j| state.qd[j] != 0.0 || state.qdd[j] != 0.0);
        let drive_w = if moves {
            p.electrical_w()
        } else {
            holding_w(model, &run.load, &state.q).iter().sum()
        };
        let rate = tool.twist(model, &state.q, &state.qd);
        let pose = tool.pose(&fk(model, &state.q));
        rows.push(Sample {
            t,
            qd: state.qd,
            tau: std::array::from_fn(|joint| p.tau[joint]),
            electrical_w: base_w + drive_w,
            tcp_speed: rate.fixed_rows::<3>(0).norm(),
            ceiling: corridor.map_or(f64::INFINITY, |c| c.offset(&pose, &mut place).ceiling.tcp),
        });
    }
    rows
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a failed set-up fails the test")]
mod tests {
    use super::*;
    use crate::rapid::text::{FileId, SourceFile};
    use crate::retime::energy::EnergyParts;
    use crate::retime::energy::account::run_energy;
    use crate::retime::motion::timeline::What;
    use crate::retime::motion::{Options, simulate};
    use crate::retime::optimize::freedom::Freedom;
    use crate::tool::retrofit::{Source, read_program};

    const PROGRAM: &str = "MODULE M
CONST jointtarget a:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST jointtarget b:=[[20,10,-5,0,80,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget c:=[[750,150,1121.5],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
MoveAbsJ a,v1000,fine,tool0;
MoveAbsJ b,v1000,z10,tool0;
MoveL c,v300,fine,tool0;
ENDPROC
ENDMODULE";
    /// Relative error of the trapezoidal rule at jumps of the power.
    const QUADRATURE: f64 = 2e-3;

    #[test]
    fn the_plotted_power_encloses_the_accounted_energy() {
        let model = crate::arm::robot::find("IRB1600-10/1.45").unwrap();
        let file = SourceFile::new(FileId(0), "M.mod".into(), PROGRAM.into());
        let files = [Source { file, relative: "M.mod".into() }];
        let (program, entry) = read_program(&files, "main").unwrap();
        let simulation = simulate(&program, entry, &model, &Options::default());
        let What::Run(run) = &simulation.events[1].what else { panic!("no run") };
        let corridor = Corridor::new(&model, run, &Freedom::default());
        let samples = samples(&model, run, corridor.as_ref());

        let area: f64 = samples
            .windows(2)
            .map(|p| 0.5 * (p[0].electrical_w + p[1].electrical_w) * (p[1].t - p[0].t))
            .sum();
        let energy: f64 = run_energy(&model, run).iter().map(EnergyParts::energy_j).sum();
        assert!((area - energy).abs() < QUADRATURE * energy, "{area} J for {energy} J");

        // A line may reach its programmed speed, a joint movement only its own original speed.
        assert!((samples.last().unwrap().ceiling - 0.3).abs() < 1e-6);
        let fastest = samples.iter().map(|s| s.tcp_speed).fold(0.0, f64::max);
        assert!((samples[0].ceiling - fastest).abs() < 0.01 * fastest);
        assert!(samples.iter().all(|s| s.tcp_speed <= s.ceiling * 1.001));
    }
}
