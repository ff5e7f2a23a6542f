//! The definition of an effect.

use crate::arm::dynamics::Load;
use crate::arm::robot::{Law, LawState, Model};

use super::motion::Motion;
use super::scale::Scale;

/// The measured channel of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Joint torques.
    Torque,
    /// Durations and paths of movements.
    Motion,
    /// Electrical power.
    Power,
}

/// Owner of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Single joints.
    Joint,
    /// The whole robot.
    Robot,
}

/// What an effect is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Bodies and forces on them.
    Body,
    /// Motors, gears, friction.
    Drive,
    /// What measures torques or positions.
    Measurement,
}

/// What an effect is to a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nature {
    /// A law that the model lacks.
    Law,
    /// Another value of a parameter: an effect where it differs by more than the model is trusted.
    Parameter,
    /// Other values of many parameters, at any size.
    Parameters,
}

/// When an effect acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acts {
    /// All the time.
    Always,
    /// After the motor has turned back.
    AfterReversals,
    /// In a window of time.
    InWindow,
    /// Differently from repetition to repetition.
    OverTime,
}

/// The quantity on which a law depends: a law of another form is another function of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Variable {
    /// Speed of the motor, both senses.
    Speed,
    /// Position.
    Position,
    /// Position, with the sense of the motion.
    PositionSense,
    /// Torque through the gear.
    Load,
    /// Its absolute value, with the sense of the motion.
    LoadSense,
    /// Torque through the gear times a function of the speed.
    LoadSpeed,
    /// Angle since the motor has turned back, with the sense of the motion.
    Reversal,
    /// Time within the log, with the sense of the motion.
    TimeSense,
}

impl Variable {
    /// As JSON has it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Variable::Speed => "speed",
            Variable::Position => "position",
            Variable::PositionSense => "position_and_sense",
            Variable::Load => "load",
            Variable::LoadSense => "load_and_sense",
            Variable::LoadSpeed => "load_and_speed",
            Variable::Reversal => "reversal",
            Variable::TimeSense => "time_and_sense",
        }
    }
}

/// Values in the order of the parameters of an effect, padded with 0.
pub type Values = [f64; Law::PARAMETERS];

/// A parameter in robot files and reports.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its description.
    pub what: &'static str,
    /// Bounds of possible values.
    pub bounds: [f64; 2],
    /// What a model has of it at a joint, `None` where it says nothing: no more can be taken away.
    pub there: Option<fn(&Model, usize) -> Option<f64>>,
    /// Standard deviation of what any robot has of it; 0 where that is nothing.
    pub everyday: f64,
}

impl Parameter {
    /// A parameter of which a model has some already.
    #[must_use]
    pub(super) const fn beside(self, there: fn(&Model, usize) -> Option<f64>) -> Parameter {
        Parameter { there: Some(there), ..self }
    }

    /// A parameter of which any robot has some.
    #[must_use]
    pub(super) const fn everyday(self, everyday: f64) -> Parameter {
        Parameter { everyday, ..self }
    }

    /// Whether its values are limited.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        self.bounds.iter().any(|bound| bound.is_finite())
    }
}

/// A coordinate of the torque, either linear or a shape parameter.
#[derive(Clone, Copy)]
pub struct Coordinate {
    /// Its role.
    pub role: Role,
    /// Prior standard deviation at a joint.
    pub usual: fn(&Scale) -> f64,
}

/// Role of a coordinate.
#[derive(Clone, Copy)]
pub enum Role {
    /// The torque is proportional to it.
    Linear,
    /// A shape parameter with tried values, ascending.
    Shape(fn(&Scale) -> Vec<f64>),
    /// A discrete shape parameter: only tried values are possible.
    Choice(fn(&Scale) -> Vec<f64>),
    /// The number of the only joint that has it, from 1; 0: all have it.
    OnlyJoint,
    /// The order of waves over the position of the joint \[1/rad\]: any that the sampling resolves.
    Waves {
        /// The lowest one.
        least: f64,
        /// The highest one.
        most: fn(&Scale) -> f64,
    },
    /// How it grows and falls in its window, from 0: at once.
    Rise {
        /// The largest value.
        most: f64,
        /// The share that acts, from the value and the part of the window that is over.
        share: fn(f64, f64) -> f64,
    },
}

/// Torques per joint \[Nm\] in a motion from the coordinates of a joint (from 0).
pub type OfMotion = fn(&Motion<'_>, usize, &[f64]) -> Vec<(usize, Vec<f64>)>;

/// Implementation of an effect. Functions take the coordinates of one joint or of the robot.
#[derive(Clone, Copy)]
pub enum Form {
    /// Changed numbers of the model.
    Model(fn(&mut Model, usize, &[f64])),
    /// A law of friction or of torque between the links.
    Law {
        /// Whether it is friction.
        dissipates: bool,
        /// Torque \[Nm\].
        torque: fn(&LawState, &Values) -> f64,
    },
    /// Torques per joint that depend on the whole motion.
    Series(OfMotion),
    /// Another motion.
    Timing(Timing),
    /// No change of torques.
    Elsewhere,
}

/// What an effect changes of the motion of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Timing {
    /// When the robot is where it was told to be.
    Lag,
    /// How far it cuts corners between targets.
    Blending,
    /// How fast it accelerates.
    Acceleration,
    /// How fast it moves.
    Speed,
    /// How long it rests between two movements.
    Wait,
}

/// An effect: its law, its prior and its documentation.
pub struct Effect {
    /// Id in JSON, robot files and options.
    pub id: &'static str,
    /// The measured channel.
    pub channel: Channel,
    /// Whether it belongs to single joints or the robot.
    pub scope: Scope,
    /// What it is about.
    pub subject: Subject,
    /// What it is to a model.
    pub nature: Nature,
    /// When it acts.
    pub acts: Acts,
    /// The quantity on which its law depends, where the law may have another form.
    pub variable: Option<Variable>,
    /// Its name.
    pub title: &'static str,
    /// The law.
    pub law: &'static str,
    /// Source of the law.
    pub source: &'static str,
    /// Parameters in files and reports.
    pub parameters: &'static [Parameter],
    /// Coordinates of the estimation.
    pub coordinates: &'static [Coordinate],
    /// Conversion of coordinates to parameters; `None` if they are equal.
    pub published: Option<Published>,
    /// Joints that can have it, from 0, by the number of joints.
    pub joints: fn(usize) -> Vec<usize>,
    /// Ids of effects that are fitted together with it, as they are not separable beforehand.
    pub brings: &'static [&'static str],
    /// Ids of effects with similar torques.
    pub confused: &'static [&'static str],
    /// What to inspect where it is found.
    pub inspect: &'static str,
    /// An experiment that separates it from those: options of `joulepath excite`, and the reason.
    pub experiment: [&'static str; 2],
    /// Its implementation.
    pub form: Form,
}

/// Conversions between coordinates and parameters.
#[derive(Clone, Copy)]
pub struct Published {
    /// Parameters from coordinates.
    pub parameters: fn(&[f64]) -> Vec<f64>,
    /// Coordinates from parameters.
    pub coordinates: fn(&[f64]) -> Vec<f64>,
}

impl Effect {
    /// Parameters from coordinates.
    #[must_use]
    pub fn parameters_of(&self, coordinates: &[f64]) -> Vec<f64> {
        self.published.map_or_else(|| coordinates.to_vec(), |p| (p.parameters)(coordinates))
    }

    /// Coordinates from parameters.
    #[must_use]
    pub fn coordinates_of(&self, parameters: &[f64]) -> Vec<f64> {
        self.published.map_or_else(|| parameters.to_vec(), |p| (p.coordinates)(parameters))
    }

    /// Whether robot files keep it as numbers of the sensors.
    #[must_use]
    pub fn is_of_sensors(&self) -> bool {
        self.subject == Subject::Measurement && matches!(self.form, Form::Model(_))
    }

    /// Whether it is a body that the robot carries.
    #[must_use]
    pub fn is_load(&self) -> bool {
        self.subject == Subject::Body && self.nature == Nature::Parameter
    }

    /// Additional logged torque due to the effect, per affected joint \[Nm\]. `joint` is used only
    /// for effects of joints.
    #[must_use]
    pub fn added(
        &self,
        motion: &Motion<'_>,
        joint: usize,
        coordinates: &[f64],
    ) -> Vec<(usize, Vec<f64>)> {
        match self.form {
            Form::Model(change) => {
                let mut changed = motion.there().clone();
                change(&mut changed, joint, coordinates);
                let after = motion.torques_of(&changed, &Load::none());
                after
                    .into_iter()
                    .zip(motion.shown())
                    .map(|(after, before)| after.iter().zip(before).map(|(a, b)| a - b).collect())
                    .enumerate()
                    .collect()
            }
            Form::Law { dissipates, torque } => {
                let values = padded(coordinates);
                let torque_at = |row: usize| torque(&motion.law_state(row, joint), &values);
                let series = (0..motion.rows()).map(torque_at).collect();
                if dissipates { motion.at_joints(joint, series) } else { vec![(joint, series)] }
            }
            Form::Series(added) => added(motion, joint, coordinates),
            Form::Timing(_) | Form::Elsewhere => Vec::new(),
        }
    }
}

/// Values padded with zeros.
#[must_use]
pub(super) fn padded(values: &[f64]) -> Values {
    let mut padded = [0.0; Law::PARAMETERS];
    padded.iter_mut().zip(values).for_each(|(to, from)| *to = *from);
    padded
}

/// All joints.
#[must_use]
pub(super) fn every(dof: usize) -> Vec<usize> {
    (0..dof).collect()
}

/// Prior standard deviation of shape coordinates: none.
#[must_use]
pub(super) fn shaped(_: &Scale) -> f64 {
    0.0
}

/// An unbounded parameter.
#[must_use]
pub(super) const fn free(name: &'static str, unit: &'static str, what: &'static str) -> Parameter {
    Parameter {
        name,
        unit,
        what,
        bounds: [f64::NEG_INFINITY, f64::INFINITY],
        there: None,
        everyday: 0.0,
    }
}

/// A bounded parameter.
#[must_use]
pub(super) const fn bounded(
    name: &'static str,
    unit: &'static str,
    what: &'static str,
    bounds: [f64; 2],
) -> Parameter {
    Parameter { name, unit, what, bounds, there: None, everyday: 0.0 }
}

/// A linear coordinate with its prior standard deviation.
#[must_use]
pub(super) const fn linear(usual: fn(&Scale) -> f64) -> Coordinate {
    Coordinate { role: Role::Linear, usual }
}

/// A shape coordinate.
#[must_use]
pub(super) const fn shape(tried: fn(&Scale) -> Vec<f64>) -> Coordinate {
    Coordinate { role: Role::Shape(tried), usual: shaped }
}
