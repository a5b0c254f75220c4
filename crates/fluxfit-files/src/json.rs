//! What is wrong with a text that should be JSON, in words of a person who may never have seen its parser.

use serde_json::error::{Category, Error};

/// The fault, without the line, which an error states in front of it.
pub fn json_fault(error: &Error) -> String {
    match error.classify() {
        Category::Eof => "it ends before its last bracket or quotation mark".to_owned(),
        Category::Syntax | Category::Io => format!("it breaks off at character {} of this line", error.column().max(1)),
        // A text that is JSON, and of another kind than its reader wants.
        Category::Data => "it holds something else than a table in braces".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Map, Value, from_str};

    #[test]
    fn a_fault_is_told_without_the_words_of_the_parser() {
        let fault = |text: &str| json_fault(&from_str::<Map<String, Value>>(text).unwrap_err());
        // Counted by hand: the closing brace stands where a value has to.
        assert_eq!(fault("{\"rs\": }"), "it breaks off at character 8 of this line");
        assert_eq!(fault("{\"rs\": 1"), "it ends before its last bracket or quotation mark");
        assert_eq!(fault("3"), "it holds something else than a table in braces");
    }
}
