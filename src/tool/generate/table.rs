//! Reads points and trajectories from CSV. A robot moves through these points, so an invalid row is
//! an error: nothing is skipped or repaired.

use csv::{ByteRecord, ReaderBuilder};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use crate::arm::kinematics::Conf;
use crate::retime::path::joint_path::{DOF, Joints};

/// Accepted column delimiters.
const DELIMITERS: [u8; 3] = *b",;\t";
/// Larger coordinates are millimetres, m: no robot reaches this far.
const FARTHEST: f64 = 20.0;
/// Maximum deviation of a quaternion's norm from 1.
const QUATERNION_ROUNDING: f64 = 1e-3;
const MM: f64 = 1e-3;

/// The points of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The points.
    pub points: Points,
    /// Programmed speed of each point, if given.
    pub speeds: Vec<Option<SpeedOrZone>>,
    /// Zone of each point, if given.
    pub zones: Vec<Option<SpeedOrZone>>,
    /// Notes on assumed units and unused columns.
    pub notes: Vec<String>,
}

/// Kinds of points.
#[derive(Clone, Debug, PartialEq)]
pub enum Points {
    /// Joint positions, rad, at times, s.
    Trajectory(Vec<f64>, Vec<Joints>),
    /// Joint positions, rad.
    Joints(Vec<Joints>),
    /// Poses of the tool in the work object, m, with their configurations if given.
    Poses(Vec<(Isometry3<f64>, Option<Conf>)>),
}

/// A speed or a zone.
#[derive(Clone, Debug, PartialEq)]
pub enum SpeedOrZone {
    /// A RAPID name, such as v100 or fine.
    Name(String),
    /// m/s or m.
    Value(f64),
}

/// Why a file has no usable points.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// The columns match no kind of points.
    #[error(
        "the header is '{0}': give the columns t,q1..q6 (a timed trajectory), q1..q6 (joint \
         positions, rad; q1_deg.. for degrees) or x,y,z,w,i,j,k[,cf1,cf4,cf6,cfx] (poses), each \
         also with speed,zone"
    )]
    Columns(String),
    /// A column name occurs twice.
    #[error("the column '{0}' stands twice in the header")]
    DuplicateColumn(String),
    /// Some columns of a kind are missing.
    #[error("the column '{missing}' is missing beside '{present}'")]
    Missing {
        /// The missing column.
        missing: String,
        /// The present column.
        present: String,
    },
    /// A cell is invalid.
    #[error("row {row}, column {column}: {what}")]
    Cell {
        /// Line of the file; the header is 1.
        row: u64,
        /// Name of the column.
        column: String,
        /// The problem.
        what: String,
    },
    /// There are no rows, or only one row of a trajectory.
    #[error("{0} rows below the header: {1}")]
    TooFewRows(usize, &'static str),
}

/// The columns of a file by name.
struct Columns {
    names: Vec<String>,
    delimiter: u8,
}

impl Columns {
    fn read(bytes: &[u8]) -> Result<(Columns, csv::Reader<&[u8]>), TableError> {
        let first = bytes.split(|byte| *byte == b'\n').next().unwrap_or_default();
        let columns = |delimiter: u8| first.split(|byte| *byte == delimiter).count();
        let delimiter = DELIMITERS
            .into_iter()
            .max_by_key(|delimiter| (columns(*delimiter), *delimiter == b','))
            .unwrap_or(b',');
        let mut reader =
            ReaderBuilder::new().delimiter(delimiter).flexible(true).from_reader(bytes);
        let header = reader.byte_headers().cloned().unwrap_or_default();
        let names: Vec<String> = header
            .iter()
            .map(|field| String::from_utf8_lossy(field).trim().to_ascii_lowercase())
            .collect();
        for (i, name) in names.iter().enumerate() {
            if !name.is_empty() && names[..i].contains(name) {
                return Err(TableError::DuplicateColumn(name.clone()));
            }
        }
        Ok((Columns { names, delimiter }, reader))
    }

    fn find(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    /// The indices of these columns; `None` if none of them exists.
    fn all(&self, names: &[String]) -> Result<Option<Vec<usize>>, TableError> {
        let Some(present) = names.iter().find(|name| self.find(name).is_some()) else {
            return Ok(None);
        };
        let find = |name: &String| {
            let missing =
                || TableError::Missing { missing: name.clone(), present: present.clone() };
            self.find(name).ok_or_else(missing)
        };
        names.iter().map(find).collect::<Result<Vec<usize>, _>>().map(Some)
    }
}

/// The columns of the points.
enum Layout {
    Joints { time: Option<usize>, columns: Vec<usize>, unit: f64 },
    Poses { position: Vec<usize>, mm: bool, rotation: Vec<usize>, conf: Option<Vec<usize>> },
}

impl Layout {
    fn from_columns(columns: &Columns, header: &str) -> Result<Layout, TableError> {
        let owned =
            |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let joints = |suffix: &str| {
            columns.all(&(1..=DOF).map(|j| format!("q{j}{suffix}")).collect::<Vec<_>>())
        };
        let time = columns.find("t");
        if let Some(found) = joints("")? {
            return Ok(Layout::Joints { time, columns: found, unit: 1.0 });
        }
        if let Some(found) = joints("_deg")? {
            return Ok(Layout::Joints { time, columns: found, unit: 1.0_f64.to_radians() });
        }
        let metres = columns.all(&owned(&["x", "y", "z"]))?;
        let millimetres = columns.all(&owned(&["x_mm", "y_mm", "z_mm"]))?;
        let mm = metres.is_none();
        let Some(position) = metres.or(millimetres) else {
            return Err(TableError::Columns(header.chars().take(80).collect()));
        };
        let Some(rotation) = columns.all(&owned(&["w", "i", "j", "k"]))? else {
            let (missing, present) = ("w".to_owned(), columns.names[position[0]].clone());
            return Err(TableError::Missing { missing, present });
        };
        let conf = columns.all(&owned(&["cf1", "cf4", "cf6", "cfx"]))?;
        Ok(Layout::Poses { position, mm, rotation, conf })
    }

    fn columns(&self) -> Vec<usize> {
        match self {
            Layout::Joints { time, columns, .. } => time.iter().chain(columns).copied().collect(),
            Layout::Poses { position, rotation, conf, .. } => {
                position.iter().chain(rotation).chain(conf.iter().flatten()).copied().collect()
            }
        }
    }
}

/// One row with its column names, for messages.
struct Row<'a> {
    record: &'a ByteRecord,
    columns: &'a Columns,
    line: u64,
}

impl Row<'_> {
    fn text(&self, column: usize) -> String {
        String::from_utf8_lossy(self.record.get(column).unwrap_or_default()).trim().to_owned()
    }

    fn error(&self, column: usize, what: String) -> TableError {
        TableError::Cell { row: self.line, column: self.columns.names[column].clone(), what }
    }

    fn number(&self, column: usize) -> Result<f64, TableError> {
        let text = self.text(column);
        let plain =
            if self.columns.delimiter == b',' { text.clone() } else { text.replacen(',', ".", 1) };
        match plain.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ if text.is_empty() => Err(self.error(column, "is empty".into())),
            _ => Err(self.error(column, format!("'{text}' is not a number"))),
        }
    }

    fn numbers<const N: usize>(&self, columns: &[usize]) -> Result<[f64; N], TableError> {
        let mut values = [0.0; N];
        for (value, column) in values.iter_mut().zip(columns) {
            *value = self.number(*column)?;
        }
        Ok(values)
    }

    /// A speed or zone: a name, or a number in the file's unit of length.
    fn amount(&self, column: Option<usize>, unit: f64) -> Result<Option<SpeedOrZone>, TableError> {
        let Some(column) = column else { return Ok(None) };
        let text = self.text(column);
        if text.is_empty() {
            return Ok(None);
        }
        if text.starts_with(|c: char| c.is_ascii_alphabetic()) {
            return Ok(Some(SpeedOrZone::Name(text.to_ascii_lowercase())));
        }
        match self.number(column)? {
            value if value > 0.0 => Ok(Some(SpeedOrZone::Value(value * unit))),
            value => Err(self.error(column, format!("{value}: give a positive number or a name"))),
        }
    }
}

/// Reads the points of a file.
///
/// # Errors
/// The columns match no kind of points, or a cell is invalid (the first one, by row and column).
pub fn read(bytes: &[u8]) -> Result<Table, TableError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let (columns, mut reader) = Columns::read(bytes)?;
    let header = columns.names.join(",");
    let layout = Layout::from_columns(&columns, &header)?;
    let (speed, zone) = (columns.find("speed"), columns.find("zone"));
    let mut used = layout.columns();
    used.extend(speed.iter().chain(&zone));
    let mut notes = Vec::new();
    let unused: Vec<&str> = (0..columns.names.len())
        .filter(|i| !used.contains(i))
        .map(|i| columns.names[i].as_str())
        .collect();
    if !unused.is_empty() {
        notes.push(format!("columns that are not used: {}", unused.join(", ")));
    }

    let mut rows: Vec<(u64, ByteRecord)> = Vec::new();
    let mut record = ByteRecord::new();
    while reader.read_byte_record(&mut record).unwrap_or(false) {
        let line = record.position().map_or(0, csv::Position::line);
        if record.len() != columns.names.len() {
            let what =
                format!("{} columns where the header has {}", record.len(), columns.names.len());
            return Err(TableError::Cell { row: line, column: "all".into(), what });
        }
        rows.push((line, record.clone()));
    }
    let rows: Vec<Row<'_>> =
        rows.iter().map(|(line, record)| Row { record, columns: &columns, line: *line }).collect();
    if rows.is_empty() {
        return Err(TableError::TooFewRows(0, "give at least one point"));
    }
    let (points, length) = points(&rows, &layout, &mut notes)?;
    let amounts = |column| -> Result<Vec<Option<SpeedOrZone>>, TableError> {
        rows.iter().map(|row| row.amount(column, length)).collect()
    };
    Ok(Table { points, speeds: amounts(speed)?, zones: amounts(zone)?, notes })
}

/// The points, and the file's unit of length in m.
fn points(
    rows: &[Row<'_>],
    layout: &Layout,
    notes: &mut Vec<String>,
) -> Result<(Points, f64), TableError> {
    match layout {
        Layout::Joints { time, columns, unit } => {
            let q = rows
                .iter()
                .map(|row| row.numbers::<DOF>(columns).map(|q| q.map(|x| x * unit)))
                .collect::<Result<Vec<Joints>, _>>()?;
            let length = if *unit == 1.0 { 1.0 } else { MM };
            let Some(time) = time else { return Ok((Points::Joints(q), length)) };
            let t = rows.iter().map(|row| row.number(*time)).collect::<Result<Vec<f64>, _>>()?;
            for (i, pair) in t.windows(2).enumerate() {
                if pair[1] <= pair[0] {
                    let what = format!("the time does not go on from {} s", pair[0]);
                    return Err(rows[i + 1].error(*time, what));
                }
            }
            if t.len() < 2 {
                return Err(TableError::TooFewRows(t.len(), "a trajectory needs at least two"));
            }
            Ok((Points::Trajectory(t.iter().map(|x| x - t[0]).collect(), q), length))
        }
        Layout::Poses { position, mm, rotation, conf } => {
            let places =
                rows.iter().map(|row| row.numbers::<3>(position)).collect::<Result<Vec<_>, _>>()?;
            let far = places.iter().flatten().any(|x| x.abs() > FARTHEST);
            let unit = if *mm || far { MM } else { 1.0 };
            if far && !mm {
                notes.push("x, y, z are taken as mm: as metres they would be out of reach".into());
            }
            let mut poses = Vec::with_capacity(rows.len());
            for (row, place) in rows.iter().zip(&places) {
                let [w, i, j, k] = row.numbers::<4>(rotation)?;
                let quaternion = Quaternion::new(w, i, j, k);
                if (quaternion.norm() - 1.0).abs() > QUATERNION_ROUNDING {
                    let what =
                        format!("the quaternion has the length {}, not 1", quaternion.norm());
                    return Err(row.error(rotation[0], what));
                }
                let conf = conf.as_ref().map(|columns| configuration(row, columns)).transpose()?;
                let place = Translation3::new(place[0] * unit, place[1] * unit, place[2] * unit);
                let pose =
                    Isometry3::from_parts(place, UnitQuaternion::from_quaternion(quaternion));
                poses.push((pose, conf));
            }
            Ok((Points::Poses(poses), unit))
        }
    }
}

fn configuration(row: &Row<'_>, columns: &[usize]) -> Result<Conf, TableError> {
    let whole = |column: &usize| {
        let value = row.number(*column)?;
        if value.fract() == 0.0 && value.abs() < 100.0 {
            return Ok(value as i32);
        }
        Err(row.error(*column, format!("{value} is no configuration: give a small whole number")))
    };
    let cf = columns.iter().map(whole).collect::<Result<Vec<i32>, _>>()?;
    Ok(Conf { cf1: cf[0], cf4: cf[1], cf6: cf[2], cfx: cf[3] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_of_points_is_told_by_its_columns() {
        let table = read(b"t,q1,q2,q3,q4,q5,q6\n1,0,0,0,0,0,0\n1.5,0.1,0,0,0,0,0\n").expect("read");
        let Points::Trajectory(t, q) = table.points else { panic!("a trajectory") };
        assert_eq!((t, q[1][0]), (vec![0.0, 0.5], 0.1));
        let text = "q1_deg;q2_deg;q3_deg;q4_deg;q5_deg;q6_deg;speed;zone\n90;0;0;0;0;0,5;100;Z10\n";
        let table = read(text.as_bytes()).expect("read");
        let Points::Joints(q) = &table.points else { panic!("joints") };
        assert!((q[0][0] - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert!((q[0][5] - 0.5_f64.to_radians()).abs() < 1e-15);
        assert_eq!(table.speeds, [Some(SpeedOrZone::Value(0.1))]);
        assert_eq!(table.zones, [Some(SpeedOrZone::Name("z10".into()))]);
        let table = read(b"x,y,z,w,i,j,k\n500,0,900,0,0,1,0\n").expect("read");
        let Points::Poses(poses) = &table.points else { panic!("poses") };
        assert_eq!(poses[0].0.translation.x, 0.5);
        assert_eq!(table.notes.len(), 1);
    }

    #[test]
    fn a_cell_that_cannot_be_used_is_named() {
        let wrong = |text: &str| read(text.as_bytes()).expect_err(text).to_string();
        let header = "t,q1,q2,q3,q4,q5,q6\n";
        for (rows, part) in [
            ("0,0,0,0,0,0,0\n0,0,0,0,0,0,0\n", "row 3, column t"),
            ("0,0,0,0,0,0,0\n1,0,0,x,0,0,0\n", "row 3, column q3"),
            ("0,0,0,0,0,0,0\n1,0,0,NaN,0,0,0\n", "row 3, column q3"),
            ("0,0,0,0,0,0,0\n1,0,0,0,0,0\n", "row 3, column all"),
            ("0,0,0,0,0,0,0\n", "1 rows"),
            ("", "0 rows"),
        ] {
            let message = wrong(&format!("{header}{rows}"));
            assert!(message.contains(part), "{message}");
        }
        assert!(wrong("a,b\n1,2\n").contains("give the columns"));
        assert!(wrong("q1,q2\n1,2\n").contains("'q3' is missing beside 'q1'"));
        assert!(wrong("x,y,z,w,i,j,k\n1,0,0,1,1,0,0\n").contains("row 2, column w"));
        assert!(wrong("x,y,z,w,i,j,k,cf1\n1,0,0,1,0,0,0,0\n").contains("'cf4' is missing"));
    }
}
