//! A line of a plot.

/// A line, with marks at its points if they are few.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    /// What it shows.
    pub(crate) name: String,
    /// Its points.
    pub(crate) points: Vec<[f64; 2]>,
    /// Thin, dashed and grey: a slope or a bound to compare with.
    pub(crate) guide: bool,
    /// Marks at the points.
    pub(crate) marks: bool,
    /// Thin bars along x: from, to, y.
    pub(crate) spans: Vec<[f64; 3]>,
    /// A guide of dots instead of dashes.
    pub(crate) dots: bool,
}

impl Line {
    /// A line without marks.
    pub(crate) fn new(name: &str, points: Vec<[f64; 2]>) -> Self {
        Self {
            name: name.to_owned(),
            points,
            guide: false,
            marks: false,
            spans: Vec::new(),
            dots: false,
        }
    }

    /// With thin bars along x.
    pub(crate) fn with_spans(mut self, spans: Vec<[f64; 3]>) -> Self {
        self.spans = spans;
        self
    }

    /// As a guide of dots.
    pub(crate) fn dotted(mut self) -> Self {
        self.guide = true;
        self.dots = true;
        self
    }

    /// With marks at the points.
    pub(crate) fn marked(mut self) -> Self {
        self.marks = true;
        self
    }

    /// As a guide for the eye.
    pub(crate) fn guide(mut self) -> Self {
        self.guide = true;
        self
    }
}
