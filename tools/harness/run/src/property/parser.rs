//! Formulas with the usual precedence: `-x^2` is -(x^2) and `2^3^2` is 2^(3^2).
//!
//! sum = term (("+" | "-") term)*; term = sign (("*" | "/") sign)*; sign = ("-" | "+")* power;
//! power = atom ("^" sign)?; atom = number | name | name "(" sum ("," sum)* ")" | "(" sum ")".

use super::operation::{CONSTANTS, DEPTH, ONE, Operation, TWO, VARIABLES};

/// Signs of comparisons, which formulas do not have.
const COMPARISONS: &str = "<>=!&|?";
/// Deepest nesting of parentheses.
const NESTED: usize = 64;

/// Compiles a formula that may use the variables in `names`; the error tells the column.
pub(super) fn parse(text: &str, names: &[&str]) -> Result<Vec<Operation>, String> {
    let mut parser = Parser {
        text,
        at: 0,
        names,
        operations: Vec::new(),
        depth: 0,
        nested: 0,
    };
    parser.sum()?;
    parser.skip_space();
    match parser.peek() {
        None => Ok(parser.operations),
        Some(c) => Err(parser.unexpected(c)),
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    names: &'a [&'a str],
    operations: Vec<Operation>,
    /// Values that wait for their operation.
    depth: usize,
    /// Parentheses that are open.
    nested: usize,
}

impl Parser<'_> {
    fn sum(&mut self) -> Result<(), String> {
        self.term()?;
        loop {
            let operation = match self.next_of("+-") {
                Some('+') => Operation::Add,
                Some(_) => Operation::Subtract,
                None => return Ok(()),
            };
            self.term()?;
            self.reduce(operation, 1);
        }
    }

    fn term(&mut self) -> Result<(), String> {
        self.sign()?;
        loop {
            let operation = match self.next_of("*/") {
                Some('*') => Operation::Multiply,
                Some(_) => Operation::Divide,
                None => return Ok(()),
            };
            self.sign()?;
            self.reduce(operation, 1);
        }
    }

    fn sign(&mut self) -> Result<(), String> {
        let mut negative = false;
        while let Some(sign) = self.next_of("+-") {
            negative ^= sign == '-';
        }
        self.power()?;
        if negative {
            self.operations.push(Operation::Negate);
        }
        Ok(())
    }

    fn power(&mut self) -> Result<(), String> {
        self.atom()?;
        if self.next_of("^").is_some() {
            self.sign()?;
            self.reduce(Operation::Power, 1);
        }
        Ok(())
    }

    fn atom(&mut self) -> Result<(), String> {
        self.skip_space();
        let start = self.at;
        match self.peek() {
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => {
                let name = self.take(|c| c.is_alphanumeric() || c == '_').to_owned();
                if self.next_of("(").is_some() {
                    self.call(&name, start)
                } else {
                    self.name(&name, start)
                }
            }
            Some('(') => {
                self.at += 1;
                self.inside()?;
                self.close()
            }
            Some(c) => Err(self.wrong(
                start,
                format!("'{c}' where a number, a name or '(' was expected"),
            )),
            None => Err(self.wrong(
                start,
                "ends where a number, a name or '(' was expected".to_owned(),
            )),
        }
    }

    fn number(&mut self) -> Result<(), String> {
        let start = self.at;
        self.take(|c| c.is_ascii_digit() || c == '.');
        let rest = &self.text.as_bytes()[self.at..];
        let exponent = matches!(rest.first(), Some(b'e' | b'E'));
        let signed = usize::from(matches!(rest.get(1), Some(b'+' | b'-')));
        if exponent && rest.get(1 + signed).is_some_and(u8::is_ascii_digit) {
            self.at += 1 + signed;
            self.take(|c| c.is_ascii_digit());
        }
        let text = &self.text[start..self.at];
        match text.parse::<f64>() {
            Ok(x) if x.is_finite() => self.push(Operation::Number(x), start),
            _ => Err(self.wrong(start, format!("'{text}' is not a number"))),
        }
    }

    fn name(&mut self, name: &str, start: usize) -> Result<(), String> {
        if let Some((_, value)) = CONSTANTS.iter().find(|(n, _)| *n == name) {
            return self.push(Operation::Number(*value), start);
        }
        match VARIABLES.iter().position(|v| *v == name) {
            Some(i) if self.names.contains(&name) => self.push(Operation::Variable(i), start),
            Some(_) => {
                let names = self.names.join(", ");
                Err(self.wrong(
                    start,
                    format!("nothing depends on '{name}' here, only on {names}"),
                ))
            }
            None => {
                let known: Vec<&str> = self
                    .names
                    .iter()
                    .copied()
                    .chain(CONSTANTS.iter().map(|c| c.0))
                    .collect();
                Err(self.wrong(start, unknown("name", name, &known)))
            }
        }
    }

    fn call(&mut self, name: &str, start: usize) -> Result<(), String> {
        let mut given = 1;
        self.inside()?;
        while self.next_of(",").is_some() {
            self.inside()?;
            given += 1;
        }
        self.close()?;
        let (operation, wanted) = if let Some((_, f, trend)) = ONE.iter().find(|(n, ..)| *n == name)
        {
            (Operation::Call1(*f, *trend), 1)
        } else if let Some((_, f, trend)) = TWO.iter().find(|(n, ..)| *n == name) {
            (Operation::Call2(*f, *trend), 2)
        } else if name == "if" {
            (Operation::Choose, 3)
        } else {
            let known: Vec<&str> = ONE
                .iter()
                .map(|f| f.0)
                .chain(TWO.iter().map(|f| f.0))
                .chain(["if"])
                .collect();
            return Err(self.wrong(start, unknown("function", name, &known)));
        };
        if given != wanted {
            return Err(self.wrong(
                start,
                format!("{name} takes {wanted} arguments, found {given}"),
            ));
        }
        self.reduce(operation, wanted - 1);
        Ok(())
    }

    /// A sum within parentheses.
    fn inside(&mut self) -> Result<(), String> {
        self.nested += 1;
        if self.nested > NESTED {
            return Err(self.wrong(self.at, format!("more than {NESTED} parentheses are open")));
        }
        self.sum()?;
        self.nested -= 1;
        Ok(())
    }

    fn close(&mut self) -> Result<(), String> {
        match self.next_of(")") {
            Some(_) => Ok(()),
            None => match self.peek().filter(|c| COMPARISONS.contains(*c)) {
                Some(c) => Err(self.unexpected(c)),
                None => Err(self.wrong(self.at, "a ')' is missing".to_owned())),
            },
        }
    }

    /// What to say of a character behind which nothing can go on.
    fn unexpected(&self, c: char) -> String {
        let mut what = format!("'{c}' was not expected here");
        if COMPARISONS.contains(c) {
            what.push_str("; a choice is if(a, b, c): b where a is above 0, c elsewhere");
        }
        self.wrong(self.at, what)
    }

    fn push(&mut self, operation: Operation, start: usize) -> Result<(), String> {
        self.depth += 1;
        if self.depth > DEPTH {
            return Err(self.wrong(
                start,
                format!("more than {DEPTH} values wait for their operation"),
            ));
        }
        self.operations.push(operation);
        Ok(())
    }

    fn reduce(&mut self, operation: Operation, by: usize) {
        self.depth -= by;
        self.operations.push(operation);
    }

    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    fn skip_space(&mut self) {
        self.take(char::is_whitespace);
    }

    /// Takes the next character if it is one of `wanted`.
    fn next_of(&mut self, wanted: &str) -> Option<char> {
        self.skip_space();
        let c = self.peek().filter(|c| wanted.contains(*c))?;
        self.at += c.len_utf8();
        Some(c)
    }

    fn take(&mut self, while_true: impl Fn(char) -> bool) -> &str {
        let rest = &self.text[self.at..];
        let length = rest.find(|c| !while_true(c)).unwrap_or(rest.len());
        self.at += length;
        &rest[..length]
    }

    fn wrong(&self, at: usize, what: String) -> String {
        format!("column {}: {what}", 1 + self.text[..at].chars().count())
    }
}

fn unknown(what: &str, name: &str, known: &[&str]) -> String {
    match crate::scene::nearest(name, known) {
        Some(meant) => format!("unknown {what} '{name}'; did you mean '{meant}'?"),
        None => format!("unknown {what} '{name}'; known are {}", known.join(", ")),
    }
}
