//! What an effect is.

use crate::arm::dynamics::Load;
use crate::arm::robot::{Law, LawState, Model};

use super::motion::Motion;
use super::scale::Scale;

/// The measured channel in which an effect shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Torques of the joints.
    Torque,
    /// How long movements take, where the robot goes.
    Motion,
    /// Electrical power.
    Power,
}

/// What an effect is a property of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Single joints.
    Joint,
    /// The robot as a whole.
    Robot,
}

/// Values in the order of an effect's parameters; those beyond are 0.
pub type Values = [f64; Law::PARAMETERS];

/// A parameter as robot files and reports have it.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Bounds of what can be.
    pub bounds: [f64; 2],
}

impl Parameter {
    /// Whether some values of it cannot be.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        self.bounds.iter().any(|bound| bound.is_finite())
    }
}

/// A coordinate of the torque: one in which it is linear, or one that shapes it.
#[derive(Clone, Copy)]
pub struct Coordinate {
    /// How it acts.
    pub role: Role,
    /// Prior standard deviation at a joint.
    pub usual: fn(&Scale) -> f64,
}

/// How a coordinate acts.
#[derive(Clone, Copy)]
pub enum Role {
    /// The torque is proportional to it.
    Linear,
    /// It shapes the torque: values that are tried, ascending.
    Shape(fn(&Scale) -> Vec<f64>),
    /// An integer or the like: no value between those that are tried.
    Choice(fn(&Scale) -> Vec<f64>),
}

/// Torques by joint \[Nm\] in a motion, of the coordinates of a joint, from 0.
pub type OfMotion = fn(&Motion<'_>, usize, &[f64]) -> Vec<(usize, Vec<f64>)>;

/// How an effect works. Functions take the coordinates of one joint, or of the robot.
#[derive(Clone, Copy)]
pub enum Form {
    /// Other numbers of the model.
    Model(fn(&mut Model, usize, &[f64])),
    /// A law of friction, or between the links.
    Law {
        /// Whether it is friction.
        dissipates: bool,
        /// Torque \[Nm\].
        torque: fn(&LawState, &Values) -> f64,
    },
    /// Torques that depend on the whole motion, by joint.
    Series(OfMotion),
    /// It changes no torque.
    Elsewhere,
}

/// An effect: its law, its prior and its documentation.
pub struct Effect {
    /// Id in JSON, robot files and options.
    pub id: &'static str,
    /// The channel in which it shows.
    pub channel: Channel,
    /// Whether single joints have it or the robot.
    pub scope: Scope,
    /// Its name.
    pub title: &'static str,
    /// The law.
    pub law: &'static str,
    /// Where the law is from.
    pub source: &'static str,
    /// Parameters as they are written.
    pub parameters: &'static [Parameter],
    /// Coordinates as they are estimated.
    pub coordinates: &'static [Coordinate],
    /// The parameters of coordinates; `None` where they are the same.
    pub published: Option<Published>,
    /// Joints that can have it, from 0, of a robot with so many.
    pub joints: fn(usize) -> Vec<usize>,
    /// Ids whose coordinates are fitted with it, because they are not separable beforehand.
    pub brings: &'static [&'static str],
    /// Ids of the effects that it is confused with.
    pub confused: &'static [&'static str],
    /// An experiment that separates it from those: options of `joulepath excite`, and the reason.
    pub experiment: [&'static str; 2],
    /// How it works.
    pub form: Form,
}

/// From coordinates to parameters and back.
#[derive(Clone, Copy)]
pub struct Published {
    /// Parameters of coordinates.
    pub parameters: fn(&[f64]) -> Vec<f64>,
    /// Coordinates of parameters.
    pub coordinates: fn(&[f64]) -> Vec<f64>,
}

impl Effect {
    /// Parameters of coordinates.
    #[must_use]
    pub fn parameters_of(&self, coordinates: &[f64]) -> Vec<f64> {
        self.published.map_or_else(|| coordinates.to_vec(), |p| (p.parameters)(coordinates))
    }

    /// Coordinates of parameters.
    #[must_use]
    pub fn coordinates_of(&self, parameters: &[f64]) -> Vec<f64> {
        self.published.map_or_else(|| parameters.to_vec(), |p| (p.coordinates)(parameters))
    }

    /// Torque that a log of the motion shows more with the effect, by joint that it reaches
    /// \[Nm\]. `joint` counts where the effect is one of joints.
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
            Form::Elsewhere => Vec::new(),
        }
    }
}

/// Values with zeros behind them.
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

/// Usual size of a coordinate that has none of its own: shapes.
#[must_use]
pub(super) fn shaped(_: &Scale) -> f64 {
    0.0
}

/// A parameter of any sign.
#[must_use]
pub(super) const fn free(name: &'static str, unit: &'static str, what: &'static str) -> Parameter {
    Parameter { name, unit, what, bounds: [f64::NEG_INFINITY, f64::INFINITY] }
}

/// A parameter within bounds.
#[must_use]
pub(super) const fn bounded(
    name: &'static str,
    unit: &'static str,
    what: &'static str,
    bounds: [f64; 2],
) -> Parameter {
    Parameter { name, unit, what, bounds }
}

/// A linear coordinate of a usual size.
#[must_use]
pub(super) const fn linear(usual: fn(&Scale) -> f64) -> Coordinate {
    Coordinate { role: Role::Linear, usual }
}

/// A coordinate that shapes the law.
#[must_use]
pub(super) const fn shape(tried: fn(&Scale) -> Vec<f64>) -> Coordinate {
    Coordinate { role: Role::Shape(tried), usual: shaped }
}
