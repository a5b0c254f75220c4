//! The JSON Schemas in `docs/schema`: they are those of the documents' types, and every document that a test of this program reads fits
//! its own. The check of that is a small one of our own: the crate `jsonschema` would add forty crates to what the tests build.

use super::{json, root};
use serde_json::Value;
use std::{env, fs, path::PathBuf};

/// Set to any value, the test below writes the schemas instead of comparing them.
const WRITE: &str = "FLUXFIT_WRITE_SCHEMAS";

/// Where the schema of a document is kept: `docs/schema/identification.schema.json` for `fluxfit.identification/1`.
fn file(document: &str) -> PathBuf {
    let name = document.trim_start_matches("fluxfit.").split('/').next().unwrap();
    root().join("docs/schema").join(format!("{name}.schema.json"))
}

#[test]
fn the_schemas_are_those_of_the_types() {
    let libraries = [fluxfit::document::schemas(), fluxfit_log::document::schemas(), fluxfit_track::document::schemas()];
    for (document, schema) in libraries.into_iter().flatten() {
        let (file, text) = (file(document), serde_json::to_string_pretty(&schema).unwrap() + "\n");
        if env::var_os(WRITE).is_some() {
            fs::write(&file, &text).unwrap();
        }
        let renew = format!("{WRITE}=1 cargo test -p fluxfit-cli --test command schema");
        assert!(fs::read_to_string(&file).is_ok_and(|kept| kept == text), "{} is not up to date; renew it: {renew}", file.display());
    }
}

/// Where a value does not fit a schema, one line each. Besides, an object may have only the keys that its schema names. A keyword of JSON
/// Schema that is not known here fails the test.
fn misfits(path: &str, value: &Value, schema: &Value, root: &Value, found: &mut Vec<String>) {
    let Value::Object(keywords) = schema else { return };
    for (keyword, wanted) in keywords {
        let fits = match keyword.as_str() {
            "$schema" | "$defs" | "title" | "description" => true,
            "$ref" => {
                let pointer = wanted.as_str().unwrap().trim_start_matches('#');
                misfits(path, value, root.pointer(pointer).unwrap(), root, found);
                true
            }
            "type" => match wanted {
                Value::Array(kinds) => kinds.iter().any(|kind| is_of_kind(value, kind)),
                kind => is_of_kind(value, kind),
            },
            "const" => value == wanted,
            "enum" => wanted.as_array().unwrap().contains(value),
            "minimum" => value.as_f64().is_none_or(|number| number >= wanted.as_f64().unwrap()),
            "minItems" => value.as_array().is_none_or(|items| items.len() as u64 >= wanted.as_u64().unwrap()),
            "maxItems" => value.as_array().is_none_or(|items| items.len() as u64 <= wanted.as_u64().unwrap()),
            "items" => {
                for (place, item) in value.as_array().into_iter().flatten().enumerate() {
                    misfits(&format!("{path}[{place}]"), item, wanted, root, found);
                }
                true
            }
            "required" => wanted.as_array().unwrap().iter().all(|key| value.get(key.as_str().unwrap()).is_some()),
            "properties" | "additionalProperties" => true,
            "anyOf" => wanted.as_array().unwrap().iter().any(|one| {
                let mut alone = Vec::new();
                misfits(path, value, one, root, &mut alone);
                alone.is_empty()
            }),
            other => panic!("{path}: the keyword {other} is not checked here"),
        };
        if !fits {
            found.push(format!("{path}: {keyword} is {wanted}, not {}", value.to_string().chars().take(80).collect::<String>()));
        }
    }
    let is_object = schema.get("properties").or(schema.get("additionalProperties")).is_some();
    for (key, field) in value.as_object().into_iter().flatten().filter(|_| is_object) {
        let path = format!("{path}.{key}");
        match schema.pointer(&format!("/properties/{key}")).or(schema.get("additionalProperties")) {
            Some(schema) => misfits(&path, field, schema, root, found),
            None => found.push(format!("{path}: the schema does not have this key")),
        }
    }
}

fn is_of_kind(value: &Value, kind: &Value) -> bool {
    match kind.as_str().unwrap() {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_u64() || value.is_i64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("{other} is no type of JSON Schema"),
    }
}

/// Where a document does not fit the schema that it names.
fn misfits_of(document: &Value) -> Vec<String> {
    let name = document["schema"].as_str().unwrap();
    let schema: Value = serde_json::from_str(&fs::read_to_string(file(name)).unwrap()).unwrap();
    let mut found = Vec::new();
    misfits(name, document, &schema, &schema, &mut found);
    found
}

/// A document fits the schema that it names.
pub(crate) fn assert_fits(document: &Value) {
    let found = misfits_of(document);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn a_document_that_does_not_fit_is_noticed() {
    // What `json` returns fits.
    let (_, good) = json(&["identify", "examples/logs/id_zero_two_loads.csv", "--model", "steady"]);
    for (path, value) in [
        ("/log/rows", "many".into()),
        ("/log/rows", (-1).into()),
        ("/parameters/rs/verdict", "certain".into()),
        ("/parameters/lq/ci95", vec![1.0].into()),
        ("/parameters/lq", serde_json::json!({})),
        ("/diagnostics/correlation/0/0", "1".into()),
        ("/nuisance/dead_time_voltage", serde_json::json!({ "along": [] })),
        ("/fit/residual_rms", serde_json::json!({ "id": 1.0, "uq": 1.0 })),
    ] {
        let mut document = good.clone();
        *document.pointer_mut(path).unwrap() = value.clone();
        assert!(!misfits_of(&document).is_empty(), "{path} may be {value}");
    }
}
