//! Formulas of a scene, read and evaluated by code of our own.
//!
//! `+ - * / ^`, parentheses, numbers, x y z r T t, pi, e, and the functions listed in `ONE` and
//! `TWO`; anything else is refused with its place.

use std::f64::consts::{E, PI};

/// Where and when a formula is evaluated.
#[derive(Debug, Clone, Copy, Default)]
pub struct At {
    /// Place \[m\].
    pub place: [f64; 3],
    /// Distance from the axis \[m\].
    pub r: f64,
    /// Temperature \[K\].
    pub temperature: f64,
    /// Time \[s\].
    pub time: f64,
}

impl At {
    /// A place at time 0, `r` measured from the z axis.
    #[must_use]
    pub fn place(place: [f64; 3]) -> Self {
        Self {
            place,
            r: place[0].hypot(place[1]),
            ..Self::default()
        }
    }
}

type One = fn(f64) -> f64;
type Two = fn(f64, f64) -> f64;

const ONE: [(&str, One); 12] = [
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("sinh", f64::sinh),
    ("cosh", f64::cosh),
    ("tanh", f64::tanh),
    ("atan", f64::atan),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("sqrt", f64::sqrt),
    ("abs", f64::abs),
    ("step", |x| if x >= 0.0 { 1.0 } else { 0.0 }),
];

const TWO: [(&str, Two); 3] = [("min", f64::min), ("max", f64::max), ("hypot", f64::hypot)];

#[derive(Debug, Clone)]
enum Node {
    Number(f64),
    Variable(char),
    Negate(Box<Node>),
    Binary(char, Box<Node>, Box<Node>),
    One(One, Box<Node>),
    Two(Two, Box<Node>, Box<Node>),
    /// The second where the first is positive, else the third.
    Choose(Box<[Node; 3]>),
}

/// A formula that can be evaluated.
#[derive(Debug, Clone)]
pub struct Formula(Node);

impl Formula {
    /// Reads a formula.
    ///
    /// # Errors
    /// What is not understood, and where.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut parser = Parser { text, at: 0 };
        let node = parser.sum()?;
        match parser.peek() {
            None => Ok(Self(node)),
            Some(c) => Err(parser.fault(&format!("'{c}' is not expected"))),
        }
    }

    /// A formula that is a number.
    #[must_use]
    pub fn number(value: f64) -> Self {
        Self(Node::Number(value))
    }

    /// The value.
    #[must_use]
    pub fn value(&self, at: &At) -> f64 {
        self.0.value(at)
    }
}

impl Node {
    fn value(&self, at: &At) -> f64 {
        match self {
            Self::Number(x) => *x,
            Self::Variable(name) => match name {
                'x' => at.place[0],
                'y' => at.place[1],
                'z' => at.place[2],
                'r' => at.r,
                'T' => at.temperature,
                _ => at.time,
            },
            Self::Negate(a) => -a.value(at),
            Self::Binary(sign, a, b) => {
                let (a, b) = (a.value(at), b.value(at));
                match sign {
                    '+' => a + b,
                    '-' => a - b,
                    '*' => a * b,
                    '/' => a / b,
                    _ => a.powf(b),
                }
            }
            Self::One(f, a) => f(a.value(at)),
            Self::Two(f, a, b) => f(a.value(at), b.value(at)),
            Self::Choose(parts) => {
                let chosen = if parts[0].value(at) > 0.0 { 1 } else { 2 };
                parts[chosen].value(at)
            }
        }
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
}

impl Parser<'_> {
    fn fault(&self, what: &str) -> String {
        format!("'{}', character {}: {what}", self.text, self.at + 1)
    }

    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    fn expect(&mut self, wanted: char) -> Result<(), String> {
        if self.take(wanted) {
            Ok(())
        } else {
            Err(self.fault(&format!("'{wanted}' is missing")))
        }
    }

    fn chain(
        &mut self,
        signs: [char; 2],
        next: fn(&mut Self) -> Result<Node, String>,
    ) -> Result<Node, String> {
        let mut left = next(self)?;
        loop {
            let Some(sign) = signs.into_iter().find(|s| self.take(*s)) else {
                return Ok(left);
            };
            left = Node::Binary(sign, Box::new(left), Box::new(next(self)?));
        }
    }

    fn sum(&mut self) -> Result<Node, String> {
        self.chain(['+', '-'], Self::product)
    }

    fn product(&mut self) -> Result<Node, String> {
        self.chain(['*', '/'], Self::signed)
    }

    fn signed(&mut self) -> Result<Node, String> {
        if self.take('-') {
            return Ok(Node::Negate(Box::new(self.signed()?)));
        }
        let base = self.atom()?;
        if self.take('^') {
            let power = Box::new(self.signed()?);
            return Ok(Node::Binary('^', Box::new(base), power));
        }
        Ok(base)
    }

    fn atom(&mut self) -> Result<Node, String> {
        match self.peek() {
            Some('(') => {
                self.take('(');
                let inner = self.sum()?;
                self.expect(')')?;
                Ok(inner)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_ascii_alphabetic() => self.word(),
            _ => Err(self.fault("a number, a name or '(' is missing")),
        }
    }

    fn number(&mut self) -> Result<Node, String> {
        let rest = &self.text.as_bytes()[self.at..];
        let digits = |from: usize| {
            let more = rest[from..]
                .iter()
                .take_while(|b| b.is_ascii_digit() || **b == b'.');
            from + more.count()
        };
        let mut end = digits(0);
        if rest.get(end).is_some_and(|b| matches!(b, b'e' | b'E')) {
            let sign = usize::from(matches!(rest.get(end + 1), Some(b'+' | b'-')));
            let after = digits(end + 1 + sign);
            if after > end + 1 + sign {
                end = after;
            }
        }
        let text = &self.text[self.at..self.at + end];
        let value = text
            .parse()
            .map_err(|_| self.fault(&format!("'{text}' is not a number")))?;
        self.at += end;
        Ok(Node::Number(value))
    }

    fn word(&mut self) -> Result<Node, String> {
        let rest = &self.text[self.at..];
        let length = rest.bytes().take_while(u8::is_ascii_alphanumeric).count();
        let name = rest[..length].to_owned();
        let start = self.at;
        self.at += length;
        match name.as_str() {
            "x" | "y" | "z" | "r" | "T" | "t" => {
                return Ok(Node::Variable(char::from(name.as_bytes()[0])));
            }
            "pi" => return Ok(Node::Number(PI)),
            "e" => return Ok(Node::Number(E)),
            _ => {}
        }
        if let Some((_, f)) = ONE.iter().find(|(n, _)| *n == name) {
            let [a] = self.arguments()?;
            return Ok(Node::One(*f, Box::new(a)));
        }
        if let Some((_, f)) = TWO.iter().find(|(n, _)| *n == name) {
            let [a, b] = self.arguments()?;
            return Ok(Node::Two(*f, Box::new(a), Box::new(b)));
        }
        if name == "if" {
            return Ok(Node::Choose(Box::new(self.arguments()?)));
        }
        self.at = start;
        Err(self.fault(&format!("'{name}' is not known")))
    }

    fn arguments<const N: usize>(&mut self) -> Result<[Node; N], String> {
        self.expect('(')?;
        let mut found = vec![self.sum()?];
        while self.take(',') {
            found.push(self.sum()?);
        }
        self.expect(')')?;
        let count = found.len();
        found
            .try_into()
            .map_err(|_| self.fault(&format!("{count} arguments, {N} are needed")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        let at = At {
            place: [0.5, 2.0, -1.0],
            r: 3.0,
            temperature: 300.0,
            time: 7.0,
        };
        Formula::parse(text).unwrap().value(&at)
    }

    #[test]
    fn formulas_mean_what_they_say() {
        for (text, wanted) in [
            ("1 + 2*3 - 4/8", 6.5),
            ("-2^2", -4.0),
            ("2^3^2", 512.0),
            ("2^-1", 0.5),
            ("2 - 3 - 4", -5.0),
            ("1.5e-3*2E2", 0.3),
            ("2*x + y - z + r + T + t", 314.0),
            ("sin(pi*x)*exp(0) + ln(e)", 2.0),
            ("if(x - 0.4, 10, 20) + if(x - 0.6, 1, 2)", 12.0),
            ("max(1, min(y, 5))", 2.0),
        ] {
            assert!(
                (value(text) - wanted).abs() < 1e-13,
                "{text}: {}",
                value(text)
            );
        }
        let alumina = 5.85 + 26524.4 * (-0.6_f64).exp() / 542.85;
        assert!((value("5.85 + 26524.4*exp(-0.002*T)/(242.85 + T)") - alumina).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_understood_is_named() {
        for (text, part) in [
            ("exp(", "missing"),
            ("2*q", "'q' is not known"),
            ("1 2", "'2' is not expected"),
            ("min(1)", "2 are needed"),
            ("1.2.3", "not a number"),
            ("", "missing"),
        ] {
            let fault = Formula::parse(text).unwrap_err();
            assert!(fault.contains(part), "{text}: {fault}");
        }
    }
}
