//! joulepath: a compiler for ABB RAPID robot programs that saves energy.
//!
//! The command line is the main way to use it; this library has its parts. Units are SI and
//! radians, joints count from 0. Apart from [`robot::load`] no function reads files.
//!
//! | task | modules |
//! |---|---|
//! | read RAPID without losing a byte | [`syntax`], [`program`] |
//! | describe a robot, its kinematics and dynamics | [`robot`], [`kinematics`], [`dynamics`] |
//! | run a program on the virtual controller, compute its energy | [`motion`], [`energy`] |
//! | find the fastest motion on a path | [`timing`] |
//! | read measured logs, identify a robot | [`log`], [`identify`] |
//! | rewrite a program so that it takes less energy | [`retrofit`] |
//!
//! # Parse and walk a program
//!
//! ```
//! use joulepath::program::{Block, Callee, StmtKind, lower};
//! use joulepath::syntax::{FileId, parse};
//!
//! /// The names of the instructions and procedures that a block calls.
//! fn calls(block: &Block) -> Vec<String> {
//!     let mut names = Vec::new();
//!     for statement in block {
//!         if let StmtKind::Call(call) = &statement.kind
//!             && let Callee::Name(name) = &call.callee
//!         {
//!             names.push(name.text.clone());
//!         }
//!         names.extend(statement.kind.blocks().into_iter().flat_map(calls));
//!     }
//!     names
//! }
//!
//! let text = b"MODULE Cell
//!   PROC main()
//!     MoveJ home, v1000, z50, tool0;
//!     IF di1 = 1 THEN
//!       WaitTime 2;
//!     ENDIF
//!   ENDPROC
//! ENDMODULE";
//! let parsed = parse(text);
//! assert!(parsed.errors.is_empty());
//! let modules = lower(FileId(0), &parsed, text);
//! assert_eq!(calls(&modules[0].routines[0].body), ["MoveJ", "WaitTime"]);
//! ```
//!
//! # Simulate it
//!
//! ```
//! use joulepath::energy::account;
//! use joulepath::motion::{Options, simulate};
//! use joulepath::program::{Program, lower};
//! use joulepath::robot;
//! use joulepath::syntax::{FileId, parse};
//!
//! let text = b"MODULE Cell
//!   PROC main()
//!     MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v1000, fine, tool0;
//!     MoveAbsJ [[60,10,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v1000, fine, tool0;
//!     WaitTime 2;
//!   ENDPROC
//! ENDMODULE";
//! let program = Program::new(lower(FileId(0), &parse(text), text));
//! let main = program.entry("main").ok_or("no main")?;
//! let model = robot::find("IRB1600-10/1.45")?;
//! let simulation = simulate(&program, main, &model, &Options::default());
//! let energy = account(&model, &simulation).total;
//! assert!(simulation.cycle_s > 2.0);
//! assert!(0.0 < energy.motion_energy_j() && energy.motion_energy_j() < energy.energy_j());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Inverse dynamics and its regressor
//!
//! Torques of rigid bodies are linear in the parameters of the bodies, τ = Y(q, q̇, q̈) φ.
//!
//! ```
//! use joulepath::dynamics::{Data, Load, Regressor, link_parameters, regressor, rigid_bodies};
//! use joulepath::robot;
//!
//! let model = robot::find("IRB1600-10/1.45")?;
//! let (q, qd, qdd) = ([0.3, 0.5, -0.2, 0.1, 0.7, 0.0], [1.0; 6], [2.0; 6]);
//! let tau = rigid_bodies(&model, &mut Data::new(), &Load::none(), &q, &qd, &qdd);
//! let mut y = Regressor::new();
//! regressor(&model, &mut y, &q, &qd, &qdd);
//! for joint in 0..model.dof {
//!     let bodies = y.rows[joint].iter().zip(&model.links);
//!     let sum: f64 = bodies
//!         .flat_map(|(row, link)| row.iter().zip(link_parameters(link)).map(|(y, phi)| y * phi))
//!         .sum();
//!     assert!((sum - tau[joint]).abs() < 1e-9);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A time-optimal profile on a path
//!
//! Joint 1 turns by 1 rad, at most at 1 rad/s and 4 rad/s²: 0.25 s each to speed up and to
//! slow down, and 0.75 s between.
//!
//! ```
//! use joulepath::timing::{PathGrid, PathLimits, PathPoint, time_optimal};
//!
//! let s: Vec<f64> = (0..=200).map(|k| f64::from(k) / 200.0).collect();
//! let point = |s: &f64| {
//!     let along = |x: f64| [x, 0.0, 0.0, 0.0, 0.0, 0.0];
//!     PathPoint::kinematic(along(*s), along(1.0), along(0.0), 1.0)
//! };
//! let nodes: Vec<PathPoint> = s.iter().map(point).collect();
//! let limits = PathLimits::new([4.0; 6], [f64::INFINITY; 6])?;
//! let profile = time_optimal(&PathGrid::from_nodes(s, &nodes)?, &limits).into_profile();
//! assert!((profile.ok_or("infeasible")?.duration() - 1.25).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Identify a robot from arrays
//!
//! ```
//! use joulepath::dynamics::{Data, Load, torque};
//! use joulepath::identify::{Free, Hints, Settings, Weighting, identify, prepare};
//! use joulepath::log::Log;
//! use joulepath::robot;
//!
//! // A motion of 20 s, and the torques that a real robot would need for it: here a known one.
//! let known = robot::find("IRB1600-10/1.45")?;
//! let mut names: Vec<String> = vec!["t".into()];
//! names.extend((1..=6).flat_map(|j| [format!("q{j}"), format!("qd{j}"), format!("qdd{j}")]));
//! let mut columns: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
//! let mut tau: Vec<Vec<f64>> = vec![Vec::new(); 6];
//! for i in 0..2000 {
//!     let t = 0.01 * f64::from(i);
//!     let (mut q, mut qd, mut qdd) = ([0.0; 6], [0.0; 6], [0.0; 6]);
//!     for j in 0..6 {
//!         for (k, amplitude) in [(2.0, 0.3), (5.0, 0.1), (9.0, 0.05)] {
//!             let (w, phase) = (0.3 * (k + j as f64), k * j as f64);
//!             let (sin, cos) = (w * t + phase).sin_cos();
//!             q[j] += amplitude * sin;
//!             qd[j] += amplitude * w * cos;
//!             qdd[j] -= amplitude * w * w * sin;
//!         }
//!     }
//!     columns[0].push(t);
//!     let torques = torque(&known, &mut Data::new(), &Load::none(), &q, &qd, &qdd);
//!     for j in 0..6 {
//!         columns[1 + 3 * j].push(q[j]);
//!         columns[2 + 3 * j].push(qd[j]);
//!         columns[3 + 3 * j].push(qdd[j]);
//!         tau[j].push(torques.rigid[j] + torques.friction[j]);
//!     }
//! }
//! let named: Vec<(&str, &[f64])> =
//!     names.iter().zip(&columns).map(|(name, column)| (name.as_str(), &column[..])).collect();
//! let log = Log::from_columns(&named)?;
//! let samples = prepare(&log, &tau, Hints::default())?;
//! let settings =
//!     Settings { free: Free::All, weighting: Weighting::Joint, source: "an example".into() };
//! let identified = identify(&known, &samples, &[], &settings)?;
//! assert!(identified.physically_consistent);
//! assert!(identified.training.rms.iter().all(|rms| *rms < 0.5));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![cfg_attr(
    not(feature = "internals"),
    expect(unreachable_pub, unused_imports, reason = "tests reach all modules: judged with them")
)]

#[cfg(not(feature = "internals"))]
mod arm;
#[cfg(not(feature = "internals"))]
mod examine;
#[cfg(not(feature = "internals"))]
mod gap;
#[cfg(not(feature = "internals"))]
mod learn;
#[cfg(not(feature = "internals"))]
mod rapid;
#[cfg(not(feature = "internals"))]
mod retime;
#[cfg(not(feature = "internals"))]
mod tool;

#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod arm;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod examine;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod gap;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod learn;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod rapid;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod retime;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod tool;

/// Vectors, matrices and poses of the public types.
pub use nalgebra;
pub use tool::cli::command_line;

/// RAPID text, its tokens and its lossless syntax tree.
pub mod syntax {
    pub use crate::rapid::syntax::{
        Element, Node, NodeKind, Parse, Related, SyntaxError, Token, TokenKind, Tolerance,
        Tolerated, Tree, parse,
    };
    pub use crate::rapid::text::{
        Charset, Edit, EditError, FileId, LineIndex, Position, SourceFile, Span, apply,
    };
}

/// Programs as plain data: modules, routines, statements.
pub mod program {
    pub use crate::rapid::ir::hir::{
        Arg, ArgKind, BinaryOp, Block, Call, Callee, Data, DataKind, Expr, ExprKind, Ident, Module,
        Name, Param, ParamMode, Routine, RoutineKind, Scope, Stmt, StmtKind, TypeDef, TypeDefKind,
        UnaryOp,
    };
    pub use crate::rapid::ir::lower;
    pub use crate::rapid::ir::program::{DataId, Program, RoutineId, Symbol};
}

/// Robots: geometry, limits, bodies, friction, motors, and where each number comes from.
pub mod robot {
    pub use crate::arm::effects::with_estimates;
    pub use crate::arm::robot::{
        Brakes, Controller, Coupling, Drive, Friction, Geometry, Joint, Limits, Link, MAX_DOF,
        Model, Motors, Opw, Origin, Provenance, RobotError, Sensors, Sharing, Standstill, Stribeck,
        Wrist, find, from_toml, import_urdf, load, names, to_toml,
    };
}

/// Forward and inverse kinematics, Jacobian, configurations, singularities.
pub mod kinematics {
    pub use crate::arm::kinematics::{
        Conf, IkError, LimitViolation, Singularity, Tcp, conf_of, fk, ik_all, ik_conf, ik_near,
        jacobian, singularity,
    };
}

/// Inverse and forward dynamics, mass matrix, regressor, base parameters, friction.
pub mod dynamics {
    pub use crate::arm::dynamics::{
        BaseParameters, Data, Derivatives, JointMatrix, Load, Regressor, Torque, base_parameters,
        crba, forward_dynamics, friction, gravity, link_parameters, regressor, rigid_bodies, rnea,
        rnea_derivatives, torque,
    };
}

/// What robots have beyond rigid bodies and plain friction: a register of laws.
pub mod effects {
    pub use crate::arm::effects::{ALL, Channel, Effect, Parameter, Scope, find};
}

/// The virtual controller: a program becomes a timed motion.
pub mod motion {
    pub use crate::rapid::builtins::MoveForm;
    pub use crate::rapid::ir::exec::Note;
    pub use crate::rapid::ir::movement::{
        LoadData, Movement, Output, RobTarget, Settings, Speed, Stop, Target, Tool, Unresolved,
        Wait, WorkObject, Zone,
    };
    pub use crate::retime::motion::joint_state::JointState;
    pub use crate::retime::motion::pace::Pace;
    pub use crate::retime::motion::stream::{Stream, StreamError};
    pub use crate::retime::motion::timed::TimedMotion;
    pub use crate::retime::motion::timeline::{
        Event, MoveRecord, Run, Simulation, WaitBasis, WaitRecord, What,
    };
    pub use crate::retime::motion::{Options, simulate};
    pub use crate::retime::path::{Leg, LegKind};
}

/// The energy of a simulated program, in six parts.
pub mod energy {
    pub use crate::retime::energy::{Account, EnergyParts, account};
}

/// The fastest motion on a given path within limits of speed, acceleration and torque.
pub mod timing {
    pub use crate::retime::motion::timing::grid::{GridError, PathGrid, PathPoint, SpeedBound};
    pub use crate::retime::motion::timing::limits::{LimitError, PathLimits, worst_ratio};
    pub use crate::retime::motion::timing::profile::{Profile, ProfilePiece};
    pub use crate::retime::motion::timing::reachability::{Reachability, time_optimal};
    pub use crate::retime::motion::timing::row::Row;
}

/// Measured logs as columns in SI units.
pub mod log {
    pub use crate::learn::log::{Channel, ColumnMap, Log, LogError, MIN_ROWS, Rejected, read};
}

/// From logs to the dynamic model of a robot, with standard errors.
pub mod identify {
    pub use crate::learn::identify::{
        Block, Condition, Fit, Free, Grade, Hints, Identified, IdentifyError, Misses, Quality,
        Samples, Settings, Solution, Source, Weighting, identify, prepare,
    };
}

/// The main job: a program in, a verified program that takes less energy out.
pub mod retrofit {
    pub use crate::retime::optimize::check::Check;
    pub use crate::retime::optimize::cost::Cost;
    pub use crate::retime::optimize::freedom::{Bound, Freedom};
    pub use crate::retime::optimize::reason::Reason;
    pub use crate::retime::optimize::resting::IdleState;
    pub use crate::tool::emit::{EmitError, Layout};
    pub use crate::tool::retrofit::{
        Budget, Figures, Objective, OutputFile, OutputKind, Retrofit, RetrofitError, Segment,
        SegmentKind, Settings, Source, TaktBasis, TaktEnergy, Verification, WholeCycle, retrofit,
    };
}
