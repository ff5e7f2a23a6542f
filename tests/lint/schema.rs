//! Validation with a JSON schema of draft 7, as far as the SARIF schema needs it. An unknown
//! keyword is an error.

use serde_json::Value;

/// Keywords without a constraint.
const NOTES: [&str; 6] = ["$schema", "$id", "title", "description", "default", "definitions"];

/// The errors of a value with their places.
pub(crate) fn errors(schema: &Value, value: &Value) -> Vec<String> {
    let mut found = Vec::new();
    look(schema, schema, value, "", &mut found);
    found
}

fn look(root: &Value, schema: &Value, value: &Value, at: &str, found: &mut Vec<String>) {
    if let Some(name) = schema.get("$ref") {
        let pointer = name.as_str().unwrap().strip_prefix('#').unwrap();
        return look(root, root.pointer(pointer).unwrap(), value, at, found);
    }
    for (keyword, wanted) in schema.as_object().unwrap() {
        if !holds(root, schema, keyword, wanted, value, at, found) {
            found.push(format!("{at}: {keyword} {wanted} does not hold for {value}"));
        }
    }
}

/// Whether a value satisfies one keyword; nested values are checked separately.
fn holds(
    root: &Value,
    schema: &Value,
    keyword: &str,
    wanted: &Value,
    value: &Value,
    at: &str,
    found: &mut Vec<String>,
) -> bool {
    let valid = |schema: &Value| {
        let mut inside = Vec::new();
        look(root, schema, value, at, &mut inside);
        inside.is_empty()
    };
    let count = |found: usize| found as u64 >= wanted.as_u64().unwrap();
    match (keyword, value) {
        ("type", _) => is_of_type(wanted, value),
        ("enum", _) => wanted.as_array().unwrap().contains(value),
        ("anyOf", _) => wanted.as_array().unwrap().iter().any(valid),
        ("oneOf", _) => wanted.as_array().unwrap().iter().filter(|one| valid(one)).count() == 1,
        ("properties", Value::Object(map)) => {
            for (key, schema) in wanted.as_object().unwrap() {
                if let Some(inner) = map.get(key) {
                    look(root, schema, inner, &format!("{at}/{key}"), found);
                }
            }
            true
        }
        ("additionalProperties", Value::Object(map)) => {
            let known = schema.get("properties").and_then(Value::as_object);
            for (key, inner) in map {
                let at = format!("{at}/{key}");
                match wanted {
                    _ if known.is_some_and(|known| known.contains_key(key)) => {}
                    Value::Bool(true) => {}
                    Value::Bool(false) => found.push(format!("{at}: no such property")),
                    schema => look(root, schema, inner, &at, found),
                }
            }
            true
        }
        ("required", Value::Object(map)) => {
            wanted.as_array().unwrap().iter().all(|key| map.contains_key(key.as_str().unwrap()))
        }
        ("items", Value::Array(list)) => {
            for (index, inner) in list.iter().enumerate() {
                look(root, wanted, inner, &format!("{at}/{index}"), found);
            }
            true
        }
        ("minItems", Value::Array(list)) => count(list.len()),
        ("minLength", Value::String(text)) => count(text.chars().count()),
        ("uniqueItems", Value::Array(list)) => {
            let twice = |i: usize| list[..i].contains(&list[i]);
            wanted != &Value::Bool(true) || !(0..list.len()).any(twice)
        }
        ("minimum", Value::Number(n)) => n.as_f64() >= wanted.as_f64(),
        ("maximum", Value::Number(n)) => n.as_f64() <= wanted.as_f64(),
        ("format", Value::String(text)) => match wanted.as_str().unwrap() {
            "uri" => {
                text.split_once(':').is_some_and(|(scheme, _)| is_scheme(scheme)) && is_uri(text)
            }
            "uri-reference" => is_uri(text),
            other => panic!("{at}: the format {other} is not known here"),
        },
        ("pattern", Value::String(_)) => panic!("{at}: patterns are not known here"),
        _ => true,
    }
}

/// Checks that a schema has no unknown keyword.
pub(crate) fn assert_known(schema: &Value) {
    const KNOWN: [&str; 18] = [
        "$ref",
        "type",
        "enum",
        "anyOf",
        "oneOf",
        "properties",
        "additionalProperties",
        "required",
        "items",
        "minItems",
        "minLength",
        "uniqueItems",
        "minimum",
        "maximum",
        "format",
        "pattern",
        "definitions",
        "default",
    ];
    for (keyword, inner) in schema.as_object().unwrap() {
        assert!(
            KNOWN.contains(&keyword.as_str()) || NOTES.contains(&keyword.as_str()),
            "{keyword}"
        );
        match (keyword.as_str(), inner) {
            ("properties" | "definitions", Value::Object(map)) => {
                map.values().for_each(assert_known);
            }
            ("items" | "additionalProperties", Value::Object(_)) => assert_known(inner),
            ("anyOf" | "oneOf", Value::Array(list)) => list.iter().for_each(assert_known),
            _ => {}
        }
    }
}

fn is_of_type(wanted: &Value, value: &Value) -> bool {
    if let Value::Array(any) = wanted {
        return any.iter().any(|one| is_of_type(one, value));
    }
    match wanted.as_str().unwrap() {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|x| x.fract() == 0.0),
        other => panic!("the type {other} is not known here"),
    }
}

fn is_scheme(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
}

/// Characters of RFC 3986, with complete escapes.
fn is_uri(text: &str) -> bool {
    let held = |c: char| c.is_ascii_alphanumeric() || "-._~:/?#[]@!$&'()*+,;=%".contains(c);
    let escapes = text.split('%').skip(1);
    text.chars().all(held)
        && escapes.into_iter().all(|rest| {
            rest.get(..2).is_some_and(|digits| digits.chars().all(|c| c.is_ascii_hexdigit()))
        })
}
