//! Functions take what they need by name: no tuple is taken apart in a list of parameters.

use super::{root, sources};

/// The parameters of all functions of a text that are tuples taken apart.
fn tuples(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, _) in text.match_indices("fn ") {
        let rest = &text[at + 3..];
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        let name = rest.find(|c| !is_name(c)).unwrap_or(0);
        if name == 0 || text[..at].ends_with(is_name) {
            continue;
        }
        let Some(list) = parameters(&rest[name..]) else {
            continue;
        };
        let apart = list
            .iter()
            .filter(|p| p.starts_with('(') && p.contains("): ("));
        found.extend(apart.map(|p| format!("fn {}: {p}", &rest[..name])));
    }
    found
}

/// Parameters of a function whose generics or parentheses come first in `text`; none where no list follows.
fn parameters(text: &str) -> Option<Vec<String>> {
    let mut depth = 0_i32;
    let (mut list, mut own, mut open) = (Vec::new(), String::new(), false);
    let mut before = ' ';
    for c in text.chars() {
        let arrow = before == '-' || before == '=';
        match c {
            '(' if !open && depth == 0 => {
                open = true;
                depth = 1;
                before = c;
                continue;
            }
            '{' | ';' if !open && depth == 0 => return None,
            '(' | '[' | '<' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            '>' if !arrow => depth -= 1,
            _ => {}
        }
        before = c;
        if !open {
            continue;
        }
        if depth == 0 || (c == ',' && depth == 1) {
            list.push(own.split_whitespace().collect::<Vec<_>>().join(" "));
            own.clear();
            if depth == 0 {
                return Some(list);
            }
        } else {
            own.push(c);
        }
    }
    None
}

#[test]
fn functions_take_what_they_need_by_name() {
    let mut files = Vec::new();
    sources(&root().join("tools"), &mut files);
    sources(&root().join("tests"), &mut files);
    let mut wrong = Vec::new();
    for path in &files {
        let found = tuples(&std::fs::read_to_string(path).unwrap());
        wrong.extend(found.iter().map(|f| format!("{}: {f}", path.display())));
    }
    assert!(
        wrong.is_empty(),
        "tuples in lists of parameters: {wrong:#?}"
    );
}

#[test]
fn tuples_in_lists_of_parameters_are_seen() {
    // Not written out, for this file is looked at too.
    let apart = "(y, z)";
    let text = format!(
        "fn a<F: Fn(u8) -> u8>(x: f64, {apart}: (f64, F)) -> f64 {{}}\nfn b(x: [f64; 2], (y): f64) {{}}"
    );
    assert_eq!(tuples(&text), ["fn a: (y, z): (f64, F)"]);
    assert!(tuples("fn c([a, b]: [f64; 2], of: (f64, f64), go: impl Fn((u8, u8)))").is_empty());
}
