//! joulepath: a compiler for ABB RAPID programs that saves energy.
//!
//! The wings, lowest first; `docs/architecture.md` is the map of the code.
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

pub use tool::cli::main as command_line;
