//! The robots that come with the crate, one TOML file each.

use super::error::RobotError;
use super::names::{Name, distance, nearest, nearest_kind};
use super::tree::{self, Node};

/// Full name and document of each robot, by name.
const ROBOTS: [(&str, &str); 73] = [
    ("CRB15000-10/1.52", include_str!("catalogue/crb15000_10_152.toml")),
    ("CRB15000-12/1.27", include_str!("catalogue/crb15000_12_127.toml")),
    ("CRB15000-5/0.95", include_str!("catalogue/crb15000_5_095.toml")),
    ("IRB1010-1.5/0.37", include_str!("catalogue/irb1010_1_5_037.toml")),
    ("IRB1100-4/0.475", include_str!("catalogue/irb1100_4_0475.toml")),
    ("IRB1100-4/0.58", include_str!("catalogue/irb1100_4_058.toml")),
    ("IRB120-3/0.58", include_str!("catalogue/irb120_3_058.toml")),
    ("IRB1200-5/0.9", include_str!("catalogue/irb1200_5_090.toml")),
    ("IRB1200-7/0.7", include_str!("catalogue/irb1200_7_070.toml")),
    ("IRB120T-3/0.58", include_str!("catalogue/irb120t_3_58.toml")),
    ("IRB1300-10/1.15", include_str!("catalogue/irb1300_10_115.toml")),
    ("IRB1300-11/0.9", include_str!("catalogue/irb1300_11_090.toml")),
    ("IRB1300-7/1.4", include_str!("catalogue/irb1300_7_140.toml")),
    ("IRB140-6/0.81", include_str!("catalogue/irb140_6_081.toml")),
    ("IRB14000 left", include_str!("catalogue/irb14000_left.toml")),
    ("IRB14000 right", include_str!("catalogue/irb14000_right.toml")),
    ("IRB1520ID-4/1.5", include_str!("catalogue/irb1520id_4_150.toml")),
    ("IRB1600-10/1.2", include_str!("catalogue/irb1600_10_120.toml")),
    ("IRB1600-10/1.45", include_str!("catalogue/irb1600_10_145.toml")),
    ("IRB1600-6/1.2", include_str!("catalogue/irb1600_6_120.toml")),
    ("IRB1600-6/1.45", include_str!("catalogue/irb1600_6_145.toml")),
    ("IRB1600-8/1.45", include_str!("catalogue/irb1600_8_145.toml")),
    ("IRB1660ID-4/1.55", include_str!("catalogue/irb1660id_4_155.toml")),
    ("IRB1660ID-6/1.55", include_str!("catalogue/irb1660id_6_155.toml")),
    ("IRB2400", include_str!("catalogue/irb2400.toml")),
    ("IRB2400-12/1.55", include_str!("catalogue/irb2400_12_155.toml")),
    ("IRB2600-12/1.65", include_str!("catalogue/irb2600_12_165.toml")),
    ("IRB2600-12/1.85", include_str!("catalogue/irb2600_12_185.toml")),
    ("IRB2600-20/1.65", include_str!("catalogue/irb2600_20_165.toml")),
    ("IRB2600ID-15/1.85", include_str!("catalogue/irb2600id_15_185.toml")),
    ("IRB2600ID-8/2.0", include_str!("catalogue/irb2600id_8_200.toml")),
    ("IRB4400", include_str!("catalogue/irb4400.toml")),
    ("IRB4400L-30/2.43", include_str!("catalogue/irb4400l_30_243.toml")),
    ("IRB4600-20/2.5", include_str!("catalogue/irb4600_20_250.toml")),
    ("IRB4600-40/2.55", include_str!("catalogue/irb4600_40_255.toml")),
    ("IRB4600-45/2.05", include_str!("catalogue/irb4600_45_205.toml")),
    ("IRB4600-60/2.05", include_str!("catalogue/irb4600_60_205.toml")),
    ("IRB52-7/1.2", include_str!("catalogue/irb52_7_120.toml")),
    ("IRB52-7/1.45", include_str!("catalogue/irb52_7_145.toml")),
    ("IRB5710-110/2.3", include_str!("catalogue/irb5710_110_230.toml")),
    ("IRB5710-70/2.7-LID", include_str!("catalogue/irb5710_70_270_lid.toml")),
    ("IRB5710-90/2.3-LID", include_str!("catalogue/irb5710_90_230_lid.toml")),
    ("IRB5710-90/2.7", include_str!("catalogue/irb5710_90_270.toml")),
    ("IRB5720-125/3.0", include_str!("catalogue/irb5720_125_300.toml")),
    ("IRB5720-155/2.6-LID", include_str!("catalogue/irb5720_155_260_lid.toml")),
    ("IRB5720-180/2.6", include_str!("catalogue/irb5720_180_260.toml")),
    ("IRB5720-90/3.0-LID", include_str!("catalogue/irb5720_90_300_lid.toml")),
    ("IRB6600-225/2.55", include_str!("catalogue/irb6600_225_255.toml")),
    ("IRB6620-150/2.2", include_str!("catalogue/irb6620_150_220.toml")),
    ("IRB6640-180/2.55", include_str!("catalogue/irb6640_180_255.toml")),
    ("IRB6640-185/2.8", include_str!("catalogue/irb6640_185_280.toml")),
    ("IRB6640-235/2.55", include_str!("catalogue/irb6640_235_255.toml")),
    ("IRB6650-125/3.2", include_str!("catalogue/irb6650_125_320.toml")),
    ("IRB6650-200/2.75", include_str!("catalogue/irb6650_200_275.toml")),
    ("IRB6650S-125/3.5", include_str!("catalogue/irb6650s_125_350.toml")),
    ("IRB6650S-200/3.0", include_str!("catalogue/irb6650s_200_300.toml")),
    ("IRB6650S-90/3.9", include_str!("catalogue/irb6650s_90_390.toml")),
    ("IRB6700-150/3.2", include_str!("catalogue/irb6700_150_320.toml")),
    ("IRB6700-155/2.85", include_str!("catalogue/irb6700_155_285.toml")),
    ("IRB6700-175/3.05", include_str!("catalogue/irb6700_175_305.toml")),
    ("IRB6700-200/2.6", include_str!("catalogue/irb6700_200_260.toml")),
    ("IRB6700-205/2.8", include_str!("catalogue/irb6700_205_280.toml")),
    ("IRB6700-235/2.65", include_str!("catalogue/irb6700_235_265.toml")),
    ("IRB6700-245/3.0", include_str!("catalogue/irb6700_245_300.toml")),
    ("IRB6700-300/2.7", include_str!("catalogue/irb6700_300_270.toml")),
    ("IRB6790-205/2.8", include_str!("catalogue/irb6790_205_280.toml")),
    ("IRB6790-235/2.65", include_str!("catalogue/irb6790_235_265.toml")),
    ("IRB7600-150/3.5", include_str!("catalogue/irb7600_150_350.toml")),
    ("IRB7600-325/3.1", include_str!("catalogue/irb7600_325_310.toml")),
    ("IRB7600-340/2.8", include_str!("catalogue/irb7600_340_280.toml")),
    ("IRB7600-400/2.55", include_str!("catalogue/irb7600_400_255.toml")),
    ("IRB7600-500/2.3", include_str!("catalogue/irb7600_500_230.toml")),
    ("IRB7600-500/2.55", include_str!("catalogue/irb7600_500_255.toml")),
];

/// Types with known ranges but unpublished lengths.
const UNPUBLISHED: [&str; 2] = ["6660", "8700"];

/// The full names of the catalogue, sorted.
pub fn names() -> impl Iterator<Item = &'static str> {
    ROBOTS.iter().map(|(name, _)| *name)
}

/// The document of the robot with this name.
pub(super) fn document(name: &str) -> Result<Node, RobotError> {
    let asked = Name::parse(name);
    let fits: Vec<_> = ROBOTS
        .iter()
        .filter_map(|robot| Some((asked.fit(&Name::parse(robot.0))?, robot)))
        .collect();
    let best = fits.iter().map(|(fit, _)| *fit).max();
    let fitting: Vec<(&str, &str)> =
        fits.iter().filter(|(fit, _)| Some(*fit) == best).map(|(_, robot)| **robot).collect();
    match fitting.as_slice() {
        [(full, text)] => tree::parse(full, text),
        [] if UNPUBLISHED.contains(&asked.kind()) => {
            Err(RobotError::Unpublished { name: name.to_owned() })
        }
        [] => Err(RobotError::Unknown {
            name: name.to_owned(),
            suggestion: suggestion(name, &asked).map(str::to_owned),
        }),
        several => Err(RobotError::Ambiguous {
            name: name.to_owned(),
            candidates: several.iter().map(|(full, _)| (*full).to_owned()).collect(),
        }),
    }
}

/// The nearest robot.
fn suggestion(name: &str, asked: &Name) -> Option<&'static str> {
    // First the nearest type, then the nearest numbers of this type.
    let kind = nearest_kind(asked, names().map(Name::parse))?;
    let [in_order, reversed] = asked.spellings();
    let written = [name.to_owned(), in_order, reversed];
    let of_kind: Vec<&str> = names().filter(|full| Name::parse(full).kind() == kind).collect();
    written
        .iter()
        .filter_map(|text| nearest(text, of_kind.iter().copied()))
        .min_by_key(|full| {
            written.iter().map(|text| distance(text, full)).min().unwrap_or(usize::MAX)
        })
        .or_else(|| nearest(name, names()))
}
