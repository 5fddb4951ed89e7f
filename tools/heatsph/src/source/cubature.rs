//! The mean of a property over a small piece of a body or of its surface, however narrow its peaks are.
//!
//! Gauss' rule of two points along each direction is exact for cubics. Where bounds of the property over the piece are
//! far wider than what these points see, something hides between them: the piece is divided until nothing can.

use quadrature::HALF_SPREAD;
use run::property::{Arguments, Bounds, Curve, OutOfRange};

use crate::material::arguments;
use shapes::frame::{Vector, along, difference, dot};

/// Error of a mean over the mean of the magnitude.
const TOLERANCE: f64 = 2e-3;
/// Part of the greatest value anywhere that is nothing.
const NOTHING: f64 = 1e-9;
/// Bounds wider than this many times what the points span are not trusted.
const TRUST: f64 = 3.0;
/// Part of the difference between the middle and the mean of a piece that its rule errs by.
const RULE: f64 = 0.1;
/// Most parts of a piece, and most rounds of division.
const MOST: usize = 20_000;
const ROUNDS: usize = 48;

/// A parallelogram or parallelepiped, `centre + sum s_k half_k` with `s_k` from -1 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Middle \[m\].
    pub centre: Vector,
    /// From the middle to the sides \[m\].
    pub half: [Vector; 3],
    /// How many of these there are.
    pub rank: usize,
}

/// When and how warm: the temperature is linear in place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct When {
    /// \[s\].
    pub time: f64,
    /// At `about` \[K\].
    pub temperature: f64,
    /// Slope of temperature \[K/m\].
    pub slope: Vector,
    /// Where \[m\].
    pub about: Vector,
    /// Temperatures that are neither passed below nor above \[K\].
    pub within: [f64; 2],
}

impl When {
    /// One temperature everywhere.
    #[must_use]
    pub fn even(time: f64, temperature: f64) -> Self {
        Self {
            time,
            temperature,
            slope: [0.0; 3],
            about: [0.0; 3],
            within: [temperature; 2],
        }
    }

    /// The temperature at a place \[K\].
    #[inline]
    fn at(&self, x: Vector) -> f64 {
        let [low, high] = self.within;
        let linear = self.temperature + dot(self.slope, difference(x, self.about));
        linear.clamp(low, high)
    }

    /// The least and the greatest temperature in a piece \[K\].
    fn over(&self, piece: &Piece) -> [f64; 2] {
        let middle = self.temperature + dot(self.slope, difference(piece.centre, self.about));
        let reach: f64 = piece.half.iter().map(|h| dot(self.slope, *h).abs()).sum();
        let [low, high] = self.within;
        [middle - reach, middle + reach].map(|t| t.clamp(low, high))
    }

    /// Warmer or colder everywhere.
    #[must_use]
    pub fn shifted(self, by: f64) -> Self {
        Self {
            temperature: self.temperature + by,
            within: self.within.map(|t| t + by),
            ..self
        }
    }
}

/// Means of what is above and of what is below zero, and whether they were found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// Mean of the positive part.
    pub above: f64,
    /// Mean of the negative part.
    pub below: f64,
    /// Whether the error is tolerated.
    pub resolved: bool,
}

/// Least and greatest arguments in a box at temperatures from the first to the second.
#[must_use]
pub fn ends([low, high]: [Vector; 2], time: f64, warm: [f64; 2]) -> [Arguments; 2] {
    let nearest = |k: usize| {
        if low[k] <= 0.0 && high[k] >= 0.0 {
            0.0
        } else {
            low[k].abs().min(high[k].abs())
        }
    };
    let farthest = |k: usize| low[k].abs().max(high[k].abs());
    let [mut from, mut to] = [(low, warm[0]), (high, warm[1])].map(|(x, t)| arguments(x, t, time));
    from.r = nearest(0).hypot(nearest(1));
    to.r = farthest(0).hypot(farthest(1));
    [from, to]
}

impl Piece {
    /// The box that holds it.
    #[must_use]
    pub fn around(&self) -> [Vector; 2] {
        let reach: Vector = std::array::from_fn(|k| self.half.iter().map(|h| h[k].abs()).sum());
        [
            along(self.centre, -1.0, reach),
            along(self.centre, 1.0, reach),
        ]
    }

    fn part(&self, signs: usize, scale: f64) -> Vector {
        (0..self.rank).fold(self.centre, |x, k| {
            let sign = if signs >> k & 1 == 1 { scale } else { -scale };
            along(x, sign, self.half[k])
        })
    }

    fn halves(&self) -> impl Iterator<Item = Self> + '_ {
        (0..1 << self.rank).map(|signs| Self {
            centre: self.part(signs, 0.5),
            half: self.half.map(|h| h.map(|x| 0.5 * x)),
            ..*self
        })
    }

    /// The mean of a curve over the piece; values below a part of `greatest` are nothing.
    ///
    /// # Errors
    /// Where the curve has no value.
    pub fn mean(&self, curve: &Curve, when: When, greatest: f64) -> Result<Mean, OutOfRange> {
        let first = Part::new(self, curve, when, 1.0)?;
        let mut parts = vec![first];
        let nothing = if greatest.is_finite() {
            NOTHING * greatest
        } else {
            0.0
        };
        let mut resolved = false;
        for _ in 0..ROUNDS {
            let gross: f64 = parts.iter().map(|p| p.share * (p.above - p.below)).sum();
            let error: f64 = parts.iter().map(|p| p.error).sum();
            let wanted = TOLERANCE * gross + nothing;
            resolved = error <= wanted;
            if resolved || parts.len() > MOST {
                break;
            }
            let least = 0.5 * wanted / parts.len() as f64;
            let mut next = Vec::with_capacity(2 * parts.len());
            for part in &parts {
                if part.error <= least {
                    next.push(*part);
                    continue;
                }
                let share = part.share / f64::from(1_u32 << self.rank);
                for half in part.piece.halves() {
                    next.push(Part::new(&half, curve, when, share)?);
                }
            }
            parts = next;
        }
        let sum = |of: fn(&Part) -> f64| parts.iter().map(|p| p.share * of(p)).sum::<f64>();
        Ok(Mean {
            above: sum(|p| p.above),
            below: sum(|p| p.below),
            resolved,
        })
    }
}

/// A part of a piece.
#[derive(Debug, Clone, Copy)]
struct Part {
    piece: Piece,
    /// Of the whole.
    share: f64,
    above: f64,
    below: f64,
    /// Of the whole's mean.
    error: f64,
}

impl Part {
    fn new(piece: &Piece, curve: &Curve, when: When, share: f64) -> Result<Self, OutOfRange> {
        let value = |x: Vector| curve.value(&arguments(x, when.at(x), when.time));
        let middle = value(piece.centre)?;
        let (mut above, mut below, mut low, mut high) = (0.0, 0.0, middle, middle);
        let count = 1 << piece.rank;
        for signs in 0..count {
            let v = value(piece.part(signs, HALF_SPREAD))?;
            above += v.max(0.0);
            below += v.min(0.0);
            (low, high) = (low.min(v), high.max(v));
        }
        (above, below) = (
            above / f64::from(count as u32),
            below / f64::from(count as u32),
        );
        let [from, to] = ends(piece.around(), when.time, when.over(piece));
        let bounds: Bounds = curve.bounds(&from, &to);
        let trusted = bounds.width() <= TRUST * (high - low) + 1e-12 * bounds.most();
        let error = if trusted {
            RULE * (above + below - middle).abs()
        } else {
            bounds.width().min(f64::MAX)
        };
        Ok(Self {
            piece: *piece,
            share,
            above,
            below,
            error: share * error,
        })
    }
}
