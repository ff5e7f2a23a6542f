//! Where model and measurement part, and which effect it is.
//!
//! [`Record`] is a log ready to be compared, [`Table`] all that may explain the difference,
//! [`Evidence`] how well some of it does.

mod channel;
mod column;
mod evidence;
mod generic;
mod hypothesis;
mod nuisance;
mod polish;
mod record;
mod search;
mod spectrum;
mod table;

pub use channel::Channel;
pub use column::{Column, Owner, Piece};
pub use evidence::Evidence;
pub use hypothesis::{Family, families};
pub use nuisance::Trust;
pub use polish::{Fitted, Polished, polish};
pub use record::Record;
pub use search::{Chosen, Found, Search};
pub use table::{Placed, Table};
