//! What a program may not do, whatever it was given.

use crate::LONGEST;
use crate::watch::Ended;

/// Most that is kept of what a program said.
const KEPT: usize = 600;

/// Number of the signal that asks to stop.
const INTERRUPT: i32 = 2;

/// What must not be, each with what was said.
pub(crate) fn faults(ended: &Ended, codes: &[i32]) -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    let err = &ended.err;
    let mut say = |kind: &'static str, what: &str| {
        let what = format!(
            "{what}{}",
            err.chars().take(KEPT).collect::<String>().escape_debug()
        );
        found.push((kind, what));
    };
    match (ended.over, ended.signal) {
        (Some("memory"), _) => say("memory", "more than it may: "),
        (Some(_), _) => say(
            "hang",
            &format!("killed after {:.1} s: ", ended.took.as_secs_f64()),
        ),
        // Asked to stop before it had begun, as on a machine that gave it no time.
        (None, Some(INTERRUPT)) if err.is_empty() && ended.out.is_empty() => {}
        (None, Some(signal)) => say("abort", &format!("signal {signal}: ")),
        (None, None) => {}
    }
    if err.contains("panicked at") || err.contains("internal error") {
        say("panic", "");
    }
    if err.contains("passes the schema but cannot be read") {
        say("placeless", "");
    }
    match ended.code {
        Some(code) if !codes.contains(&code) => say("code", &format!("exit code {code}: ")),
        Some(1 | 2) if err.trim().is_empty() && ended.out.is_empty() => say("silent", ""),
        _ => {}
    }
    let strange = |text: &str| text.chars().find(|c| is_control(*c));
    let out = String::from_utf8_lossy(&ended.out);
    if let Some(c) = strange(err).or_else(|| strange(&out)) {
        say(
            "control",
            &format!("{} reaches the terminal: ", c.escape_unicode()),
        );
    }
    found
}

/// Whether a character does something to a terminal instead of being shown, or turns what follows it around.
fn is_control(c: char) -> bool {
    let turns =
        matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{200e}' | '\u{200f}');
    (c.is_control() && c != '\n' && c != '\t') || turns
}

/// The time that was left to a program is over.
pub(crate) const TIME: std::time::Duration = LONGEST;

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn ended(code: i32, err: &str) -> Ended {
        Ended {
            code: Some(code),
            signal: None,
            out: Vec::new(),
            err: err.to_owned(),
            took: Duration::ZERO,
            over: None,
        }
    }

    #[test]
    fn each_fault_is_seen() {
        let kinds =
            |e: &Ended| -> Vec<&str> { faults(e, &[0, 1, 2]).iter().map(|f| f.0).collect() };
        assert!(kinds(&ended(2, "scene.json:1:1: /a: is 3\n")).is_empty());
        assert_eq!(kinds(&ended(1, "")), ["silent"]);
        assert_eq!(
            kinds(&ended(101, "thread panicked at x")),
            ["panic", "code"]
        );
        assert_eq!(kinds(&ended(2, "key '\u{1b}[2J'")), ["control"]);
        let mut killed = ended(0, "");
        (killed.code, killed.signal) = (None, Some(6));
        assert_eq!(kinds(&killed), ["abort"]);
        killed.signal = Some(INTERRUPT);
        assert!(kinds(&killed).is_empty(), "it had not begun");
        killed.err = "step 1\n".to_owned();
        assert_eq!(kinds(&killed), ["abort"]);
        killed.over = Some("time");
        assert_eq!(kinds(&killed), ["hang"]);
    }
}
