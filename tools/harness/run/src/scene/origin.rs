//! A JSON file with the place of each of its values.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use jsonc_parser::ast;
use jsonc_parser::common::Ranged;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use serde_json::Value;

use crate::failure::Failure;
use crate::fault::{Fault, Spot};

/// Where a value stands: offset of its key (if it has one) and of itself \[byte\].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) key: usize,
    pub(crate) value: usize,
}

/// A parsed file.
#[derive(Debug)]
pub(crate) struct Document {
    pub(crate) path: PathBuf,
    pub(crate) text: String,
    pub(crate) value: Value,
    pub(crate) places: BTreeMap<String, Place>,
}

impl Document {
    /// Reads and parses a file.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let text = artefact::json_text(path).map_err(|e| match e {
            artefact::Error::Json {
                path,
                line,
                column,
                what,
            } => {
                let spot = Spot {
                    file: path,
                    line,
                    column,
                };
                Failure::from(Fault::in_text(spot, what))
            }
            other => Failure::Usage(other.to_string()),
        })?;
        Self::parse(path, text)
    }

    /// Parses the text of a file.
    pub(crate) fn parse(path: &Path, text: String) -> Result<Self, Failure> {
        let fault = |offset: usize, what: String| Fault::in_text(spot(path, &text, offset), what);
        let value: Value = serde_json::from_str(&text).map_err(|e| {
            let spot = Spot {
                file: path.to_owned(),
                line: e.line(),
                column: e.column().max(1),
            };
            let what = e.to_string();
            let what = what.split(" at line").next().unwrap_or_default();
            Failure::from(Fault::in_text(spot, format!("not valid JSON: {what}")))
        })?;
        let options = ParseOptions {
            allow_comments: false,
            ..ParseOptions::default()
        };
        let parsed = parse_to_ast(&text, &CollectOptions::default(), &options).map_err(|e| {
            Failure::from(fault(
                e.range().start,
                format!("not valid JSON: {}", e.kind()),
            ))
        })?;
        let mut places = BTreeMap::new();
        let mut twice = Vec::new();
        if let Some(root) = &parsed.value {
            walk(root, String::new(), root.start(), &mut |pointer, place| {
                if places.insert(pointer.clone(), place).is_some() {
                    twice.push(fault(place.key, format!("{pointer}: stands twice")));
                }
            });
        }
        if twice.is_empty() {
            Ok(Self {
                path: path.to_owned(),
                text,
                value,
                places,
            })
        } else {
            Err(Failure::Scene(twice))
        }
    }

    /// Line and column of a byte.
    pub(crate) fn spot(&self, offset: usize) -> Spot {
        spot(&self.path, &self.text, offset)
    }
}

fn spot(file: &Path, text: &str, offset: usize) -> Spot {
    let before = &text[..text.floor_char_boundary(offset)];
    let line = 1 + before.matches('\n').count();
    let column = 1 + before
        .rsplit('\n')
        .next()
        .map_or(0, |tail| tail.chars().count());
    Spot {
        file: file.to_owned(),
        line,
        column,
    }
}

/// Visits every value with its JSON pointer.
fn walk(
    value: &ast::Value<'_>,
    pointer: String,
    key: usize,
    visit: &mut impl FnMut(String, Place),
) {
    visit(
        pointer.clone(),
        Place {
            key,
            value: value.start(),
        },
    );
    match value {
        ast::Value::Object(object) => {
            for property in &object.properties {
                let child = format!("{pointer}/{}", escaped(property.name.as_str()));
                walk(&property.value, child, property.start(), visit);
            }
        }
        ast::Value::Array(array) => {
            for (i, element) in array.elements.iter().enumerate() {
                walk(element, format!("{pointer}/{i}"), element.start(), visit);
            }
        }
        _ => {}
    }
}

/// A key as a part of a JSON pointer (RFC 6901).
pub(crate) fn escaped(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}
