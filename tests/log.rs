//! Logs: differentiation, column names, Parquet.

#![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use std::fmt::Write;

use insta::assert_snapshot;
use joulepath::learn::log::{Channel, ColumnMap, LogError, derivatives, read};

/// A joint that swings by 0.6 rad at 0.4 Hz and by less at 1.1 Hz: position, rate, acceleration.
fn swing(t: f64) -> [f64; 3] {
    let parts = [(0.6, 2.5), (0.1, 6.9)];
    [
        parts.iter().map(|(a, w)| a * (w * t).sin()).sum(),
        parts.iter().map(|(a, w)| a * w * (w * t).cos()).sum(),
        parts.iter().map(|(a, w)| -a * w * w * (w * t).sin()).sum(),
    ]
}

/// Uniform noise in (−1, 1) with the variance 1/3.
fn noise(index: usize) -> f64 {
    let mut z = (index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    2.0 * ((z ^ (z >> 31)) as f64 / u64::MAX as f64) - 1.0
}

/// RMS errors of rate and acceleration, away from the ends.
fn errors(t: &[f64], x: &[f64]) -> [f64; 2] {
    let found = derivatives(t, x);
    let inner = 60..t.len() - 60;
    let count = inner.len() as f64;
    [1, 2].map(|order| {
        let square = |i: usize| (found[i].unwrap()[order - 1] - swing(t[i])[order]).powi(2);
        (inner.clone().map(square).sum::<f64>() / count).sqrt()
    })
}

#[test]
fn a_polynomial_is_differentiated_exactly() {
    // With uneven times, the fit of a polynomial is exact for any window.
    let t: Vec<f64> = (0..60).map(|i| 0.01 * f64::from(i) + 0.003 * noise(i as usize)).collect();
    let x: Vec<f64> = t.iter().map(|t| 2.0 - t + 3.0 * t * t - 4.0 * t.powi(4)).collect();
    for (t, found) in t.iter().zip(derivatives(&t, &x)) {
        let [rate, acceleration] = found.unwrap();
        assert!((rate - (-1.0 + 6.0 * t - 16.0 * t.powi(3))).abs() < 1e-9, "{rate}");
        assert!((acceleration - (6.0 - 48.0 * t * t)).abs() < 1e-6, "{acceleration}");
    }
}

#[test]
fn differentiation_smooths_noise_without_a_delay() {
    let t: Vec<f64> = (0..1500).map(|i| 0.004 * f64::from(i)).collect();
    let clean: Vec<f64> = t.iter().map(|t| swing(*t)[0]).collect();
    let [rate, acceleration] = errors(&t, &clean);
    assert!(rate < 1e-5 && acceleration < 1e-3, "{rate} {acceleration}");

    // A resolver with errors of 0.1 mrad: differences would err by 20 mrad/s and 9 rad/s².
    let logged: Vec<f64> = clean.iter().enumerate().map(|(i, x)| x + 1e-4 * noise(i)).collect();
    let [rate, acceleration] = errors(&t, &logged);
    assert!(rate < 1e-3 && acceleration < 0.05, "{rate} {acceleration}");
}

#[test]
fn rest_has_no_rate_and_gaps_are_not_bridged() {
    let t: Vec<f64> = (0..300).map(|i| 0.01 * f64::from(i)).collect();
    let still: Vec<f64> = (0..300).map(|i| 0.3 + 1e-4 * noise(i)).collect();
    let moving = derivatives(&t, &still).iter().filter(|at| at.unwrap()[0] != 0.0).count();
    assert!(moving < 15, "{moving} of 300 samples at rest have a rate");

    // A jump across a gap of one second is not a motion; two rows alone have no rate.
    let late = |i: usize| if i < 100 { 0.0 } else { 1.0 } + if i < 298 { 0.0 } else { 1.0 };
    let t: Vec<f64> = t.iter().enumerate().map(|(i, t)| t + late(i)).collect();
    let x: Vec<f64> = t.iter().enumerate().map(|(i, t)| 0.2 * t + late(i)).collect();
    let found = derivatives(&t, &x);
    assert!(found[298..].iter().all(Option::is_none));
    assert!(found[..298].iter().all(|at| (at.unwrap()[0] - 0.2).abs() < 1e-9));
}

fn csv(header: &str, separator: &str) -> String {
    let mut text = format!("{header}\n");
    for i in 0..12 {
        let t = 0.1 * f64::from(i);
        let _ = writeln!(text, "{t}{separator}{}{separator}{}", 10.0 * t, 5.0 - t);
    }
    text
}

#[test]
fn columns_can_be_renamed() {
    let map = ColumnMap::parse("t=Time [s], q1_deg=Axis 1,tau1=q1").unwrap();
    let log = read(csv("Time [s];Axis 1;q1", ";").as_bytes(), &map).unwrap();
    assert_eq!(log.channels, [Channel::Time, Channel::Position(0), Channel::Torque(0)]);
    assert!((log.values[1][11] - 11.0_f64.to_radians()).abs() < 1e-12);
    // Spaces as delimiters.
    let log = read(csv("t q1 power", " ").as_bytes(), &ColumnMap::default()).unwrap();
    assert_eq!(log.column(Channel::Power).unwrap()[0], 5.0);
    // A quoted decimal comma.
    let quoted = csv("t,q1,power", ",").replace(",10,", ",\"10,0\",");
    assert!(read(quoted.as_bytes(), &ColumnMap::default()).unwrap().rejected.is_empty());
}

#[test]
fn wrong_maps_are_refused_with_the_reason() {
    let refusal = |map: &str| -> LogError {
        match ColumnMap::parse(map) {
            Ok(map) => read(csv("Time,Axis,x", ",").as_bytes(), &map).unwrap_err(),
            Err(error) => error,
        }
    };
    let messages = ["q1", "q1=", "p1=Axis", "t=Time,t=x", "t=Tme", "q1=Axis"]
        .map(|map| refusal(map).to_string());
    assert_snapshot!(messages.join("\n"));
}

#[cfg(feature = "parquet")]
mod parquet_files {
    use std::sync::Arc;

    use parquet::basic::{Compression, ZstdLevel};
    use parquet::data_type::{DoubleType, Int64Type};
    use parquet::file::properties::WriterProperties;
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::parser::parse_message_type;

    use super::*;

    fn written(compression: Compression) -> Vec<u8> {
        let schema = "message log { REQUIRED DOUBLE t; OPTIONAL DOUBLE q1_deg; REQUIRED INT64 cycle; \
                      REQUIRED DOUBLE other; }";
        let schema = Arc::new(parse_message_type(schema).unwrap());
        let properties = WriterProperties::builder().set_compression(compression).build();
        let mut bytes = Vec::new();
        let mut writer =
            SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties)).unwrap();
        let mut group = writer.next_row_group().unwrap();
        let times: Vec<f64> = (0..20).map(|i| 0.1 * f64::from(i)).collect();
        for index in 0..4 {
            let mut column = group.next_column().unwrap().unwrap();
            match index {
                1 => {
                    // The fourth row is empty.
                    let levels: Vec<i16> = (0..20).map(|i| i16::from(i != 3)).collect();
                    let values: Vec<f64> = times
                        .iter()
                        .enumerate()
                        .filter(|(i, _)| *i != 3)
                        .map(|(_, t)| *t)
                        .collect();
                    let typed = column.typed::<DoubleType>();
                    typed.write_batch(&values, Some(&levels), None).unwrap();
                }
                2 => {
                    column.typed::<Int64Type>().write_batch(&[7; 20], None, None).unwrap();
                }
                _ => {
                    column.typed::<DoubleType>().write_batch(&times, None, None).unwrap();
                }
            }
            column.close().unwrap();
        }
        group.close().unwrap();
        writer.close().unwrap();
        bytes
    }

    #[test]
    fn a_parquet_log_is_read() {
        let zstd = ZstdLevel::default();
        for compression in [
            Compression::UNCOMPRESSED,
            Compression::SNAPPY,
            Compression::LZ4_RAW,
            Compression::ZSTD(zstd),
        ] {
            let log = read(&written(compression), &ColumnMap::default()).unwrap();
            assert_eq!(log.channels, [Channel::Time, Channel::Position(0), Channel::Cycle]);
            assert_eq!((log.time().len(), log.rejected.len()), (19, 1));
            assert_eq!(
                (log.rejected[0].row, log.rejected[0].reason.as_str()),
                (5, "q1_deg is empty")
            );
            assert!((log.values[1][18] - 1.9_f64.to_radians()).abs() < 1e-15);
            assert_eq!(log.values[2][0], 7.0);
        }
    }

    #[test]
    fn a_damaged_parquet_file_is_an_error() {
        let good = written(Compression::SNAPPY);
        for end in [4, 8, good.len() / 2, good.len() - 1] {
            assert!(read(&good[..end], &ColumnMap::default()).is_err());
        }
        for i in (0..good.len()).step_by(7) {
            let mut bad = good.clone();
            bad[i] ^= 0x5A;
            // The reader may fail, but must not panic.
            let _ = read(&bad, &ColumnMap::default());
        }
    }
}
