//! The trajectory of a cycle as CSV. The columns are a stable interface.

use std::fmt::Write;

use super::place::Places;
use crate::retime::energy::trajectory::Sample;

/// One row per sample, numbers in shortest round-trip form.
pub fn csv(places: Places<'_>, samples: &[Sample]) -> String {
    let mut out = String::from("t");
    for name in ["q", "qd", "qdd", "tau"] {
        for j in 1..=6 {
            let _ = write!(out, ",{name}{j}");
        }
    }
    out.push_str(",p_mech,p_elec,tcp_x,tcp_y,tcp_z,tcp_speed,file,line\n");
    for sample in samples {
        let _ = write!(out, "{}", sample.t);
        for x in sample.state.q.iter().chain(&sample.state.qd).chain(&sample.state.qdd) {
            let _ = write!(out, ",{x}");
        }
        match &sample.power {
            Some(power) => {
                for tau in &power.tau[..6] {
                    let _ = write!(out, ",{tau}");
                }
                let electrical = sample.electrical_w.unwrap_or(0.0);
                let _ = write!(out, ",{},{electrical}", power.mechanical_w());
            }
            None => out.push_str(",,,,,,,,"),
        }
        let [x, y, z] = sample.tcp;
        let _ = write!(out, ",{x},{y},{z},{}", sample.tcp_speed);
        match sample.span {
            Some(span) => {
                let place = places.of(span);
                let _ = writeln!(out, ",{},{}", quoted(&place.file), place.first);
            }
            None => out.push_str(",,\n"),
        }
    }
    out
}

/// A CSV field, quoted if it contains commas or quotes.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
