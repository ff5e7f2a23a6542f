//! Finds wasted energy in programs. One rule is one file of `rules`, whose doc comment is its
//! manual; `register` lists them.
//!
//! Rules look at a [`context::Context`]: the control flow of a program, what it does in order,
//! and, where the robot is known, a simulated cycle with its joules. What a rule proposes is
//! weighed by laying the part of the cycle around it on a time line again.

pub mod context;
mod edits;
pub mod engine;
pub mod fix;
pub mod flow;
pub mod group;
pub mod job;
mod quiet;
mod register;
pub mod rule;
mod rules;
pub mod saving;
pub mod settings;
pub mod site;
mod stops;
pub mod suppress;
pub mod system;
pub mod trace;
pub mod weigh;
mod words;

pub use engine::{Report, lint};
pub use fix::{Fixed, fix};
pub use group::Group;
pub use job::{Job, Programs};
pub use register::{ALL, find};
pub use rule::{Applicability, Family, Finding, Fix, Needs, Rule};
pub use saving::Saving;
pub use settings::Settings;
pub use system::System;
