//! Keep-out zones (boxes and planes of the cell) for movements that may leave their path.

use crate::arm::kinematics::{Body, Capsule, Tcp};
use crate::arm::robot::Model;
use crate::retime::motion::stream::{Piece, Stream};
use crate::retime::motion::timed::TimedMotion;
use crate::retime::motion::timeline::Run;

use super::freedom::Freedom;

/// Arm and tool of a run with the keep-out zones; `None` without zones, or if the run keeps to a
/// programmed path that itself enters a zone.
pub fn body<'a>(model: &'a Model, run: &Run, freedom: &Freedom) -> Option<Body<'a>> {
    let free = run.moves.iter().any(|record| freedom.free_deviation(&record.movement) > 0.0);
    let body = around(model, &run.legs.first()?.tool, freedom)?;
    (free || !enters(&body, run)).then_some(body)
}

/// Arm and tool with the keep-out zones; `None` without zones.
pub fn around<'a>(model: &'a Model, tool: &Tcp, freedom: &Freedom) -> Option<Body<'a>> {
    if freedom.keep_out.is_empty() {
        return None;
    }
    let tool = match tool {
        Tcp::Held(tool) => tool.translation.vector,
        Tcp::Stationary(_) => nalgebra::Vector3::zeros(),
    };
    Some(Body::new(model, tool, &freedom.keep_out))
}

/// Change of the clearance that changes the share by one, m.
const SCALE: f64 = 0.1;

/// The clearance as a share of a limit: 1 at the clearance `kept` (m), larger below it.
pub(super) fn share(body: &Body<'_>, q: &[f64], kept: f64) -> f64 {
    let [room, _] = body.margins(q);
    (1.0 + (kept - room) / SCALE).max(0.0)
}

/// Distance of the samples of a path, m.
const SPACING: f64 = 0.005;

/// Whether the programmed path of a run enters a keep-out zone.
pub(super) fn enters(body: &Body<'_>, run: &Run) -> bool {
    let [(_, TimedMotion::Path(path, _))] = run.motions.as_slice() else { return false };
    path.pieces().iter().any(|piece| {
        let n = (piece.length / SPACING).ceil().max(1.0) as usize;
        (0..=n).any(|i| {
            let q = piece.eval(piece.s + piece.length * i as f64 / n as f64).q;
            body.margins(&q)[0] < 0.0
        })
    })
}

/// Duration below which a stretch of a stream is not halved again, s.
const FINEST: f64 = 1e-4;

/// A lower bound of the clearance of arm and tool (m) along the realised motion of a stream and
/// along the polygon of its points: the clearance at both ends of a stretch less the largest
/// displacement in between. Stretches of small clearance are halved.
pub(super) fn least_room(model: &Model, body: &Body<'_>, stream: &Stream) -> f64 {
    let reach: f64 = body.capsules(stream.start()).iter().map(Capsule::length).sum();
    let mut least = f64::INFINITY;
    for piece in stream.pieces().chain(stream.polygon()) {
        let room = |t: f64| (t, body.margins(&piece.at(t).0)[0]);
        let fastest = reach * turning(model, &piece);
        // Stretches by time (s) and clearance (m) at both ends.
        let mut open = vec![[room(0.0), room(piece.length)]];
        while let Some([begin, end]) = open.pop() {
            let between = 0.5 * (begin.1 + end.1 - fastest * (end.0 - begin.0));
            if between < 0.0 && end.0 - begin.0 > FINEST {
                let middle = room(0.5 * (begin.0 + end.0));
                open.extend([[begin, middle], [middle, end]]);
            } else {
                least = least.min(between);
            }
        }
    }
    least
}

/// Sum of the largest speeds of the serial joints on a piece, rad/s.
fn turning(model: &Model, piece: &Piece) -> f64 {
    let (_, end, _) = piece.at(piece.length);
    let [begin, end] = [&piece.qd, &end].map(|qd| model.kinematics.to_serial(qd));
    begin.iter().zip(end).map(|(begin, end)| begin.abs().max(end.abs())).sum()
}
