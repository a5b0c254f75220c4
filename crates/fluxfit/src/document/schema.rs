//! The JSON Schema of a document, as `docs/schema` has it.

use schemars::{JsonSchema, Schema, generate::SchemaSettings, transform::RecursiveTransform};

/// The schema of what serde writes, draft 2020-12.
pub fn schema_of<Document: JsonSchema>() -> Schema {
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
