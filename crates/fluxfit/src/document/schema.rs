//! The JSON Schemas of the documents: those in `docs/schema`.

use super::{
    identification::{IDENTIFICATION, IdentificationDocument},
    study::{STUDY, StudyDocument},
    truth::{TRUTH, TruthDocument},
    validation::{VALIDATION, ValidationDocument},
};
use schemars::{JsonSchema, Schema, generate::SchemaSettings, transform::RecursiveTransform};

/// Each document's name and its schema, draft 2020-12.
pub fn schemas() -> [(&'static str, Schema); 4] {
    [
        (IDENTIFICATION, schema_of::<IdentificationDocument>()),
        (STUDY, schema_of::<StudyDocument>()),
        (VALIDATION, schema_of::<ValidationDocument>()),
        (TRUTH, schema_of::<TruthDocument<()>>()),
    ]
}

/// The schema of what serde writes.
fn schema_of<Document: JsonSchema>() -> Schema {
    let settings = SchemaSettings::draft2020_12().for_serialize().with_transform(RecursiveTransform(tidy));
    settings.into_generator().into_root_schema_for::<Document>()
}

/// A description is one line, wherever the comment's lines break; and `format` would only repeat Rust's types (`double`, `uint`), which
/// validators do not know.
fn tidy(schema: &mut Schema) {
    schema.remove("format");
    if let Some(description) = schema.get("description").and_then(|description| description.as_str()) {
        let line = description.replace('\n', " ");
        schema.insert("description".to_owned(), line.into());
    }
}
