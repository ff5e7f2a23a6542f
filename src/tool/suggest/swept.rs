//! How far a changed motion leaves the space that arm and tool sweep today.
//!
//! Points along the arm and the tool are followed through the cycle. The distance of each point from the
//! way of the same point today is an upper bound: another part of the arm may have been there.

use std::collections::HashMap;

use nalgebra::{Point3, Vector3};

use crate::arm::kinematics::{Body, Capsule, Tcp};
use crate::arm::robot::Model;
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::What;

/// Time between two looked-at positions, s.
const STEP_S: f64 = 0.01;
/// Places along each part of the arm.
const SHARES: [f64; 3] = [0.0, 0.5, 1.0];
/// Side of the cells in which ways are looked up, m.
const CELL: f64 = 0.05;
/// Largest distance that is looked up, cells.
const FARTHEST: i32 = 20;

/// The ways of points of the arm.
pub(super) struct Swept {
    /// By point: its positions in order.
    ways: Vec<Vec<Point3<f64>>>,
    /// By point: indices of positions by cell.
    cells: Vec<HashMap<[i32; 3], Vec<usize>>>,
}

impl Swept {
    /// The ways in a simulated cycle.
    pub(super) fn new(model: &Model, simulation: &Simulation) -> Swept {
        let ways = ways(model, simulation);
        let table = |way: &Vec<Point3<f64>>| {
            let mut cells: HashMap<[i32; 3], Vec<usize>> = HashMap::new();
            for (index, point) in way.iter().enumerate() {
                cells.entry(cell(point)).or_default().push(index);
            }
            cells
        };
        Swept { cells: ways.iter().map(table).collect(), ways }
    }

    /// How far another cycle leaves these ways, m.
    pub(super) fn left_by(&self, model: &Model, simulation: &Simulation) -> f64 {
        let others = ways(model, simulation);
        let mut most = 0.0_f64;
        for ((way, cells), other) in self.ways.iter().zip(&self.cells).zip(&others) {
            for point in other {
                most = most.max(distance(way, cells, point));
            }
        }
        most
    }
}

/// Distance of a point from a way, m.
fn distance(
    way: &[Point3<f64>],
    cells: &HashMap<[i32; 3], Vec<usize>>,
    point: &Point3<f64>,
) -> f64 {
    let centre = cell(point);
    let mut nearest = f64::INFINITY;
    for ring in 0..=FARTHEST {
        // Nothing in this ring or beyond is nearer than the ring before it.
        if nearest <= f64::from(ring - 1) * CELL {
            break;
        }
        for index in on_ring(centre, ring).filter_map(|cell| cells.get(&cell)).flatten() {
            let ends = [index.saturating_sub(1), *index, index + 1];
            let at = |i: usize| way.get(i).unwrap_or(&way[*index]);
            for pair in ends.windows(2) {
                nearest = nearest.min(to_segment(at(pair[0]), at(pair[1]), point));
            }
        }
    }
    nearest.min(f64::from(FARTHEST) * CELL)
}

/// The cells of a cube's surface around a cell.
fn on_ring(centre: [i32; 3], ring: i32) -> impl Iterator<Item = [i32; 3]> {
    let span = -ring..=ring;
    let all = span.clone().flat_map(move |x| {
        let span = -ring..=ring;
        span.clone().flat_map(move |y| (-ring..=ring).map(move |z| [x, y, z]))
    });
    let on = all.filter(move |of| of.iter().any(|x| x.abs() == ring));
    on.map(move |of| [centre[0] + of[0], centre[1] + of[1], centre[2] + of[2]])
}

fn to_segment(a: &Point3<f64>, b: &Point3<f64>, point: &Point3<f64>) -> f64 {
    let along = b - a;
    let square = along.norm_squared();
    let share = if square > 0.0 { ((point - a).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (point - (a + along * share)).norm()
}

fn cell(point: &Point3<f64>) -> [i32; 3] {
    [point.x, point.y, point.z].map(|x| (x / CELL).floor() as i32)
}

/// The positions of the points of arm and tool while the robot moves.
fn ways(model: &Model, simulation: &Simulation) -> Vec<Vec<Point3<f64>>> {
    let mut ways: Vec<Vec<Point3<f64>>> = Vec::new();
    for event in &simulation.events {
        let What::Run(run) = &event.what else { continue };
        let tool = match run.legs.first().map(|leg| leg.tool) {
            Some(Tcp::Held(tool)) => tool.translation.vector,
            _ => Vector3::zeros(),
        };
        let body = Body::new(model, tool, &[]);
        let count = (run.duration() / STEP_S).ceil().max(1.0) as usize;
        for i in 0..=count {
            let q = run.at(run.duration() * i as f64 / count as f64).q;
            let parts = body.capsules(&q);
            let points = parts.iter().flat_map(|part: &Capsule| SHARES.map(|share| part.at(share)));
            for (number, point) in points.enumerate() {
                if number == ways.len() {
                    ways.push(Vec::new());
                }
                ways[number].push(point);
            }
        }
    }
    ways
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_from_a_way_is_that_from_its_nearest_stretch() {
        let way: Vec<Point3<f64>> =
            (0..40).map(|i| Point3::new(0.03 * f64::from(i), 0.0, 0.0)).collect();
        let mut cells: HashMap<[i32; 3], Vec<usize>> = HashMap::new();
        for (index, point) in way.iter().enumerate() {
            cells.entry(cell(point)).or_default().push(index);
        }
        for (point, away) in [
            (Point3::new(0.5, 0.0, 0.0), 0.0),
            (Point3::new(0.515, 0.07, 0.0), 0.07),
            (Point3::new(0.4, -0.2, 0.15), 0.25),
            (Point3::new(-0.3, 0.0, 0.4), 0.5),
        ] {
            assert!((distance(&way, &cells, &point) - away).abs() < 1e-12, "{point}");
        }
    }
}
