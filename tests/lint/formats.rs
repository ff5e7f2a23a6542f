//! Output formats for other programs.

use std::fs;
use std::path::Path;
use std::process::Command;

use joulepath::tool::report::lint::top::Year;
use joulepath::tool::report::lint::{github, gitlab, json, junit, sarif};
use serde_json::{Value, json};

use crate::fixtures;
use crate::schema::{assert_known, errors};

/// The JSON has the fields of the contract.
#[test]
fn json_has_the_fields_of_the_contract() {
    let all = fixtures();
    let fixture = all.iter().find(|it| it.path.ends_with("EW103_tiny_zone.mod")).unwrap();
    let year = Year { count: 10, hours: 4000.0, price: 0.2 };
    let value = json::json(&fixture.report(), &fixture.files, &year);
    let finding = &value["findings"][0];
    for key in [
        "code",
        "name",
        "severity",
        "file",
        "line",
        "column",
        "end_line",
        "end_column",
        "message",
        "saving_j",
        "saving_s",
        "saving_low_j",
        "saving_high_j",
        "per",
        "assumptions",
        "fix",
        "confidence",
        "places",
        "at_stake_j",
        "related",
        "needs",
    ] {
        assert!(finding.get(key).is_some(), "{key}");
    }
    let edit = &finding["fix"]["edits"][0];
    let (start, end) = (edit["start"].as_u64().unwrap(), edit["end"].as_u64().unwrap());
    assert_eq!(&fixture.files[0].bytes[start as usize..end as usize], b"z1");
    for key in ["findings", "saving_j", "cycle_energy_j", "unresolved", "movements_simulated"] {
        assert!(value["totals"].get(key).is_some(), "{key}");
    }
    let first = &value["top"][0];
    let number = |value: &Value| value.as_f64().unwrap();
    let (joules, share) = (number(&first["saving_j"]), number(&first["share"]));
    let cycle = number(&value["totals"]["cycle_energy_j"]);
    assert!((joules - share * cycle).abs() < 1e-9 * cycle);
    let cost = number(&first["cost_per_year"]);
    assert!((cost - 0.2 * number(&first["kwh_per_year"])).abs() < 1e-9 * cost);
}

/// The other formats contain every finding.
#[test]
fn every_output_format_has_all_findings() {
    for fixture in fixtures() {
        let report = fixture.report();
        let count = report.findings.len();
        let text = github::github(&report, &fixture.files);
        assert_eq!(text.lines().count(), count);
        let entries = gitlab::gitlab(&report, &fixture.files);
        let entries = entries.as_array().unwrap();
        let mut prints: Vec<&Value> = entries.iter().map(|entry| &entry["fingerprint"]).collect();
        prints.sort_by_key(ToString::to_string);
        prints.dedup();
        assert_eq!((entries.len(), prints.len()), (count, count));
        let text = junit::junit(&report, &fixture.files);
        let document = roxmltree::Document::parse(&text).unwrap();
        let failures = document.descendants().filter(|node| node.has_tag_name("failure")).count();
        assert_eq!(failures, count);
        let value = sarif::sarif(&report, &fixture.files);
        assert_eq!(value["runs"][0]["results"].as_array().unwrap().len(), count);
    }
}

/// The official schema of SARIF 2.1.0 from the sources of the crate `serde_sarif`, so that it is
/// neither copied nor downloaded.
fn schema_of_sarif() -> Value {
    let cargo = |args: &[&str]| {
        let folder = env!("CARGO_MANIFEST_DIR");
        Command::new(env!("CARGO")).args(args).current_dir(folder).output().unwrap()
    };
    // Packages of other platforms may be missing.
    let about = String::from_utf8(cargo(&["-vV"]).stdout).unwrap();
    let host = about.lines().find_map(|line| line.strip_prefix("host: ")).unwrap();
    let form = ["metadata", "--format-version", "1", "--offline", "--locked"];
    let output = cargo(&[&form[..], &["--filter-platform", host]].concat());
    let reported = String::from_utf8_lossy(&output.stderr);
    let metadata: Value = serde_json::from_slice(&output.stdout).expect(&reported);
    let packages = metadata["packages"].as_array().unwrap();
    let types = packages.iter().find(|package| package["name"] == "serde-sarif").unwrap();
    let manifest = Path::new(types["manifest_path"].as_str().unwrap());
    let text = fs::read(manifest.with_file_name("src").join("schema.json")).unwrap();
    serde_json::from_slice(&text).unwrap()
}

#[test]
fn sarif_output_is_valid_by_the_official_schema() {
    let schema = schema_of_sarif();
    assert!(schema["$id"].as_str().unwrap().ends_with("sarif-schema-2.1.0.json"));
    assert_known(&schema);
    let (mut results, mut related) = (0, 0);
    for fixture in fixtures() {
        let report = fixture.report();
        let value = sarif::sarif(&report, &fixture.files);
        assert_eq!(errors(&schema, &value), [""; 0], "{:?}", fixture.path);
        // Types generated from the schema read it without loss.
        let read: serde_sarif::sarif::Sarif = serde_json::from_value(value.clone()).unwrap();
        assert_eq!(serde_json::to_value(&read).unwrap(), value);
        let found = value["runs"][0]["results"].as_array().unwrap();
        for (finding, result) in report.findings.iter().zip(found) {
            let places = result["relatedLocations"].as_array().map_or(0, Vec::len);
            assert_eq!(places, finding.related.len());
            related += places;
        }
        results += found.len();
    }
    assert!(results > 30 && related > 10, "{results} {related}");
    // The check detects errors.
    let all = fixtures();
    let mut value = sarif::sarif(&all[0].report(), &all[0].files);
    value["runs"][0]["results"][0]["level"] = "waste".into();
    value["runs"][0]["joules"] = 1.into();
    assert_eq!(errors(&schema, &value).len(), 2);
}

/// The fields of a GitLab Code Quality report, with their types and values.
#[test]
fn gitlab_output_is_a_code_quality_report() {
    let text = json!({ "type": "string", "minLength": 1 });
    let line = json!({ "type": "integer", "minimum": 1 });
    let lines = json!({ "type": "object", "required": ["begin"], "properties": { "begin": line } });
    let schema = json!({
        "type": "array",
        "items": {
            "type": "object",
            "required": ["description", "check_name", "fingerprint", "severity", "location"],
            "properties": {
                "description": text,
                "check_name": text,
                "fingerprint": text,
                "severity": { "enum": ["info", "minor", "major", "critical", "blocker"] },
                "location": {
                    "type": "object",
                    "required": ["path", "lines"],
                    "properties": { "path": text, "lines": lines },
                },
            },
        },
    });
    for fixture in fixtures() {
        let value = gitlab::gitlab(&fixture.report(), &fixture.files);
        assert_eq!(errors(&schema, &value), [""; 0], "{:?}", fixture.path);
        for entry in value.as_array().unwrap() {
            assert!(!entry["location"]["path"].as_str().unwrap().starts_with("./"), "{entry}");
        }
    }
}

/// The elements and attributes required by readers of `JUnit` reports, and consistent counts.
#[test]
fn junit_output_is_a_test_report() {
    for fixture in fixtures() {
        let text = junit::junit(&fixture.report(), &fixture.files);
        let document = roxmltree::Document::parse(&text).unwrap();
        let root = document.root_element();
        assert!(root.has_tag_name("testsuites"), "{text}");
        let count = |node: roxmltree::Node<'_, '_>, name: &str| {
            node.descendants().filter(|node| node.has_tag_name(name)).count().to_string()
        };
        for suite in root.children().filter(roxmltree::Node::is_element) {
            assert!(suite.has_tag_name("testsuite"), "{text}");
            assert!(suite.attribute("name").is_some_and(|name| !name.is_empty()));
            assert_eq!(suite.attribute("tests"), Some(count(suite, "testcase").as_str()), "{text}");
            let failures = count(suite, "failure");
            assert_eq!(suite.attribute("failures"), Some(failures.as_str()), "{text}");
            for case in suite.children().filter(roxmltree::Node::is_element) {
                assert!(case.has_tag_name("testcase"), "{text}");
                for attribute in ["name", "classname"] {
                    assert!(case.attribute(attribute).is_some(), "{attribute}: {text}");
                }
                let failures = case.children().filter(|node| node.has_tag_name("failure"));
                for failure in failures {
                    assert!(failure.attribute("message").is_some_and(|text| !text.is_empty()));
                }
            }
        }
    }
}
