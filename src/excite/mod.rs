//! Excitation design.
