//! Time divided until a property is nearly straight in every piece.

use run::property::Bounds;

/// Error of the trapezoidal rule over all pieces, over the integral.
const TOLERANCE: f64 = 5e-4;
/// Part of its share of the error below which a piece bounds no step: little enough that a step over many of them errs
/// little, though the rule then sees only the ends of all.
const EASY: f64 = 1e-9;
/// Most pieces, and most rounds of division.
const MOST: usize = 100_000;
const ROUNDS: usize = 200;
/// Most times that time is divided anew at jumps.
const AGAIN: usize = 6;
/// Most jumps.
const JUMPS: usize = 10_000;
/// Bounds wider than this many times what samples span are not trusted to hold nothing else.
const TRUST: f64 = 3.0;
/// Part of the width of a piece's values below which its error is so small that it claims to be nearly straight.
const STRAIGHT: f64 = 0.05;
/// Where such a piece is looked at again, at fractions that no period divides, and the part of the span of its samples by
/// which it may differ there from lines between them.
const AGAIN_AT: [f64; 8] = [
    0.0931, 0.1707, 0.3313, 0.4126, 0.5939, 0.6792, 0.8207, 0.9411,
];
const BENT: f64 = 0.1;
/// Part of a rise that is made between two samples, above which it is taken for a jump.
const SUDDEN: f64 = 0.8;
/// Part of the range of values that is too little for a jump.
const SMALL: f64 = 1e-6;
/// Shortest piece over the whole time.
const SHORTEST: f64 = 1e-15;

/// Something that varies in time, at several places.
pub(super) trait Varies {
    /// Number of places.
    fn places(&self) -> usize;
    /// Its value.
    fn value(&self, place: usize, time: f64) -> f64;
    /// Bounds of its values between two times.
    fn bounds(&self, place: usize, times: [f64; 2]) -> Bounds;
}

/// Time in pieces.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pieces {
    /// Last instant before and first after each jump \[s\].
    pub(super) jumps: Vec<[f64; 2]>,
    /// Begin of pieces, rising, and length of steps there \[s\].
    pub(super) lengths: Vec<[f64; 2]>,
    /// Least and greatest value met.
    pub(super) values: Bounds,
    /// Whether the error is what it should be.
    pub(super) resolved: bool,
}

/// A piece of time at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    place: usize,
    from: f64,
    to: f64,
    /// Values at both ends and three times between.
    sample: [f64; 5],
    /// Error of the trapezoidal rule.
    error: f64,
}

impl Piece {
    fn new(of: &impl Varies, place: usize, [from, to]: [f64; 2]) -> Self {
        let at = |s: f64| of.value(place, from + s * (to - from));
        let sample = [at(0.0), at(0.25), at(0.5), at(0.75), of.value(place, to)];
        let bounds = of.bounds(place, [from, to]);
        let span = sample.iter().map(|v| Bounds::at(*v)).reduce(|a, b| Bounds {
            low: a.low.min(b.low),
            high: a.high.max(b.high),
        });
        let span = span.map_or(0.0, Bounds::width);
        let blur = 1e-12 * bounds.most();
        let trusted = bounds.width() <= TRUST * span + blur;
        let [a, b, c, d, e] = sample;
        let simpson = (a + 4.0 * b + 2.0 * c + 4.0 * d + e) / 12.0;
        let curved = (0.5 * (a + e) - simpson).abs();
        let straight = curved < STRAIGHT * bounds.width();
        let error = if trusted && !(straight && winds(sample, BENT * span + blur, at)) {
            curved
        } else {
            bounds.width().min(f64::MAX)
        };
        Self {
            place,
            from,
            to,
            sample,
            error: (error * (to - from)).min(1e300),
        }
    }

    fn length(&self) -> f64 {
        self.to - self.from
    }

    /// Integral of the magnitude of the difference from `base`.
    fn gross(&self, base: f64) -> f64 {
        let sum: f64 = self.sample.iter().map(|v| (v - base).abs()).sum();
        0.2 * sum * self.length()
    }

    /// The jump in it, if there is one: neighbouring times between which its whole rise is made.
    fn jump(&self, of: &impl Varies, range: f64, end: f64) -> Option<[f64; 2]> {
        let rise = |k: usize| (self.sample[k + 1] - self.sample[k]).abs();
        let k = (0..4).max_by(|a, b| rise(*a).total_cmp(&rise(*b)))?;
        let whole: f64 = (0..4).map(rise).sum();
        if rise(k) <= SMALL * range || rise(k) < SUDDEN * whole {
            return None;
        }
        let quarter = 0.25 * self.length();
        let (mut low, mut high) = (
            self.from + quarter * k as f64,
            if k == 3 {
                self.to
            } else {
                self.from + quarter * (k + 1) as f64
            },
        );
        let (mut a, mut b) = (self.sample[k], self.sample[k + 1]);
        loop {
            let middle = 0.5 * (low + high);
            if !(middle > low && middle < high && high - low > SHORTEST * end) {
                break;
            }
            let value = of.value(self.place, middle);
            if (value - a).abs() > (value - b).abs() {
                (high, b) = (middle, value);
            } else {
                (low, a) = (middle, value);
            }
        }
        ((b - a).abs() >= 0.5 * rise(k)).then_some([low, high])
    }
}

/// Whether something differs from lines between its samples by more than a tolerance: whole periods may lie between them.
fn winds(sample: [f64; 5], tolerance: f64, at: impl Fn(f64) -> f64) -> bool {
    AGAIN_AT.iter().any(|s| {
        let k = (4.0 * s) as usize;
        let line = sample[k] + (4.0 * s - k as f64) * (sample[k + 1] - sample[k]);
        (at(*s) - line).abs() > tolerance
    })
}

/// Divides the time from 0 to `end`.
pub(super) fn divide(of: &impl Varies, end: f64) -> Pieces {
    let mut jumps: Vec<[f64; 2]> = Vec::new();
    let (mut pieces, mut resolved, mut share) = (Vec::new(), true, 0.0);
    for _ in 0..AGAIN {
        (pieces, resolved, share) = refine(of, &jumps, end);
        let values = values(&pieces);
        let jump = |p: &Piece| p.jump(of, values.width(), end);
        let found: Vec<_> = pieces.iter().filter_map(jump).collect();
        if found.is_empty() || jumps.len() + found.len() > JUMPS {
            resolved &= found.is_empty();
            break;
        }
        jumps.extend(found);
        jumps.sort_by(|a, b| a[0].total_cmp(&b[0]));
        jumps.dedup_by(|next, kept| {
            let same = next[0] <= kept[1];
            if same {
                kept[1] = kept[1].max(next[1]);
            }
            same
        });
    }
    let values = values(&pieces);
    let long = |p: &Piece| {
        if p.error <= EASY * share {
            f64::INFINITY
        } else {
            p.length()
        }
    };
    let mut lengths: Vec<_> = pieces.iter().map(|p| [p.from, long(p)]).collect();
    lengths.sort_by(|a, b| a[0].total_cmp(&b[0]));
    lengths.dedup_by(|next, kept| next[1].is_infinite() && kept[1].is_infinite());
    Pieces {
        jumps,
        lengths,
        values,
        resolved,
    }
}

fn values(pieces: &[Piece]) -> Bounds {
    let each = pieces.iter().flat_map(|p| p.sample);
    let none = Bounds {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
    };
    each.fold(none, |b, v| Bounds {
        low: b.low.min(v),
        high: b.high.max(v),
    })
}

/// Pieces between jumps, halved until their errors add up to the tolerated one; whether they do, and each one's share.
fn refine(of: &impl Varies, jumps: &[[f64; 2]], end: f64) -> (Vec<Piece>, bool, f64) {
    let begins = std::iter::once(0.0).chain(jumps.iter().map(|j| j[1]));
    let ends = jumps.iter().map(|j| j[0]).chain(std::iter::once(end));
    let spans: Vec<_> = begins.zip(ends).filter(|(a, b)| a < b).collect();
    let place = |p: usize| spans.iter().map(move |(a, b)| Piece::new(of, p, [*a, *b]));
    let mut pieces: Vec<Piece> = (0..of.places()).flat_map(place).collect();
    for _ in 0..ROUNDS {
        let wanted = TOLERANCE * gross(&pieces);
        let sum: f64 = pieces.iter().map(|p| p.error).sum();
        let share = wanted / pieces.len().max(1) as f64;
        if sum <= wanted {
            return (pieces, true, share);
        }
        let (mut next, mut divided) = (Vec::with_capacity(2 * pieces.len()), false);
        for piece in &pieces {
            if piece.error > 0.5 * share && piece.length() > SHORTEST * end {
                let middle = 0.5 * (piece.from + piece.to);
                next.push(Piece::new(of, piece.place, [piece.from, middle]));
                next.push(Piece::new(of, piece.place, [middle, piece.to]));
                divided = true;
            } else {
                next.push(*piece);
            }
        }
        pieces = next;
        if !divided || pieces.len() > MOST {
            return (pieces, !divided, share);
        }
    }
    (pieces, false, 0.0)
}

/// The integral whose part an error is: of the magnitude, or of that of the difference from a usual value if that is
/// less, so that a pulse on a high level counts by itself.
fn gross(pieces: &[Piece]) -> f64 {
    let Some(first) = pieces.first() else {
        return 0.0;
    };
    let last = &pieces[pieces.len() - 1];
    let middle = &pieces[pieces.len() / 2];
    [0.0, first.sample[0], last.sample[4], middle.sample[2]]
        .iter()
        .map(|base| pieces.iter().map(|p| p.gross(*base)).sum())
        .fold(f64::INFINITY, f64::min)
}
