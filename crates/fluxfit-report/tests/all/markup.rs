//! A page as a browser and its script read it, with the checks that hold for every page.

// Helpers of tests fail as tests do.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use html5ever::{driver::ParseOpts, parse_document, tendril::TendrilSink, tree_builder::TreeBuilderOpts};
use markup5ever_rcdom::{Handle, NodeData, RcDom};

/// The text of a document, after checks that hold for every page.
pub(crate) fn checked(page: &str) -> String {
    let options = ParseOpts { tree_builder: TreeBuilderOpts { exact_errors: true, ..Default::default() }, ..Default::default() };
    let document = parse_document(RcDom::default(), options).one(page);
    assert_eq!(*document.errors.borrow(), Vec::<std::borrow::Cow<str>>::new());
    let (mut text, mut ids) = (String::new(), Vec::new());
    let mut scripts = Vec::new();
    walk(&document.document, &mut text, &mut ids, &mut scripts);
    let [script] = scripts.as_slice() else { panic!("{} scripts run", scripts.len()) };
    for request in REQUESTS {
        assert!(!script.contains(request), "the script holds {request}");
    }
    assert!(!page.contains("://"), "the page holds an address");
    assert!(page.contains("http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "));
    let mut unique = ids.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), ids.len(), "ids are not unique: {ids:?}");
    for word in page.replace(script.as_str(), "").split(|c: char| !c.is_alphanumeric()) {
        assert!(!["NaN", "nan", "inf", "Infinity", "undefined"].contains(&word), "the page holds {word}");
    }
    assert!(!page.contains("url(") && !page.contains("@import"));
    text
}

/// What a script would need to ask for something, or to make text run.
const REQUESTS: [&str; 14] = [
    "fetch(",
    "XMLHttpRequest",
    "WebSocket",
    "EventSource",
    "sendBeacon",
    "import(",
    "Worker",
    "new Image",
    ".src",
    "url(",
    "eval(",
    "new Function",
    "innerHTML",
    "document.write",
];

/// Gathers the text that is read, the ids, and the scripts that run.
fn walk(node: &Handle, text: &mut String, ids: &mut Vec<String>, scripts: &mut Vec<String>) {
    if let NodeData::Element { name, attrs, .. } = &node.data
        && &*name.local == "script"
    {
        let mut content = String::new();
        node.children.borrow().iter().for_each(|child| walk(child, &mut content, ids, scripts));
        match attrs.borrow().as_slice() {
            [] => scripts.push(content),
            [data] => {
                assert_eq!((&*data.name.local, &*data.value), ("type", "application/json"));
                serde_json::from_str::<serde_json::Value>(&content).unwrap();
            }
            more => panic!("{more:?}"),
        }
        return;
    }

    match &node.data {
        NodeData::Text { contents } => text.push_str(&contents.borrow()),
        NodeData::Element { name, attrs, .. } => {
            let element = name.local.to_string();
            assert!(!["link", "img", "iframe", "object", "image", "use", "base"].contains(&element.as_str()), "{element}");
            for attribute in attrs.borrow().iter() {
                let (name, value) = (attribute.name.local.to_string(), attribute.value.to_string());
                assert!(!name.starts_with("on") && name != "src", "{name}");
                assert!(name != "href" || value.starts_with('#'), "{value}");
                assert!(!value.contains("://"), "{value}");
                if name == "id" {
                    ids.push(value);
                }
            }
        }
        _ => {}
    }
    node.children.borrow().iter().for_each(|child| walk(child, text, ids, scripts));
}

/// The values along a figure, and those of each panel's series.
pub(crate) type Numbers = (Vec<f64>, Vec<Vec<Vec<f64>>>);

/// The numbers of a page's figures, as its script reads them.
pub(crate) fn data(page: &str) -> Vec<Numbers> {
    let column = |column: &serde_json::Value| -> Vec<f64> {
        let scale = 10.0_f64.powi(column["exponent"].as_i64().unwrap() as i32);
        let steps = column["steps"].as_array().unwrap().iter().map(serde_json::Value::as_i64);
        let mut sum = 0;
        steps
            .map(|step| {
                step.map_or(f64::NAN, |step| {
                    sum += step;
                    sum as f64 * scale
                })
            })
            .collect()
    };
    let texts = page.split("<script type=\"application/json\">").skip(1).map(|rest| rest.split_once("</script>").unwrap().0);
    // The document of the result is no figure.
    let figures = texts.map(|text| serde_json::from_str::<serde_json::Value>(text).unwrap()).filter(|data| data["panels"].is_array());
    let series = |panel: &serde_json::Value| panel["series"].as_array().unwrap().iter().map(|one| column(&one["values"])).collect();
    figures.map(|live| (column(&live["x"]["values"]), live["panels"].as_array().unwrap().iter().map(series).collect())).collect()
}
