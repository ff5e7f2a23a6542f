//! Masses, springs and forces on the links.

pub(super) mod base_tilt;
pub(super) mod bodies;
pub(super) mod cable;
pub(super) mod contact;
pub(super) mod gravity_spring;
pub(super) mod link_parameters;
pub(super) mod payload;
pub(super) mod rotor_inertia;
pub(super) mod springs;
