//! Finds wasted energy in programs. Each file of `rules` contains one rule; its doc comment is the
//! manual. `register` lists all rules.
//!
//! Rules receive a [`context::Context`]: the control flow of a program, its actions in order, and
//! with a known robot a simulated cycle with energies. A proposed change is evaluated by simulating
//! the part of the cycle around it again.

pub mod context;
mod coverage;
mod data_names;
mod edits;
pub mod engine;
mod entries;
pub mod evaluate;
pub mod fix;
pub mod flow;
pub mod group;
pub mod job;
pub mod known;
mod offer;
mod outputs;
mod parsed;
pub mod process;
mod purpose;
pub mod ranking;
mod regions;
mod register;
mod report;
pub mod rule;
mod rules;
mod runs;
pub mod saving;
pub mod settings;
pub mod site;
mod statements;
mod stops;
pub mod stored;
pub mod suppress;
pub mod system;
pub mod trace;
mod weighing;
mod words;
mod work;

pub use engine::{lint, lint_changed};
pub use fix::{Fixed, fix};
pub use group::Group;
pub use job::{Job, Programs};
pub use register::{ALL, find};
pub use report::Report;
pub use rule::{Applicability, Confidence, Family, Finding, Fix, Needs, Rule};
pub use saving::Saving;
pub use settings::Settings;
pub use stored::Store;
pub use system::System;
