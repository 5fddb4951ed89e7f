//! The materials along a link, one after the other.
//!
//! Within the distance of the nearest surface of a region nothing changes, and steps of that length go through a link. Where that
//! distance falls, the next place is just beyond where it would end, in what lies there, however thin it is. Elsewhere beside a
//! surface steps grow from the last one to a least length, so that only what a link grazes is missed.

use super::Materials;
use shapes::frame::{Vector, along, difference, dot, length};

/// Parts of a link of which each is searched for itself.
const SEARCH: usize = 8;
/// Halvings that find an interface.
const HALVINGS: usize = 48;
/// Least step over the length of a link, and how far beyond a surface the next place lies.
const LEAST: f64 = 1.0 / 128.0;
const BEYOND: f64 = 1e-6;
/// Places nearer to a surface than this part of a link are on it, and of no other material.
const ON: f64 = 1e-9;

/// A stretch of a link within one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    pub(super) material: usize,
    /// Begin and end as parts of the link.
    pub(super) from: f64,
    pub(super) to: f64,
}

/// A part of a link in which the material changes, and the material at its end.
#[derive(Debug, Clone, Copy)]
struct Change {
    low: f64,
    high: f64,
    next: usize,
}

/// A link: where it begins, and where it leads.
#[derive(Debug, Clone, Copy)]
struct Link {
    a: Vector,
    d: Vector,
}

impl Link {
    fn at(&self, t: f64) -> Vector {
        along(self.a, t, self.d)
    }
}

impl Materials {
    /// The stretches of the link from `a` to `b`, and the contacts between them.
    pub(super) fn stretches(&self, a: Vector, b: Vector) -> (Vec<Stretch>, f64) {
        let link = Link {
            a,
            d: difference(b, a),
        };
        let whole = |material| Stretch {
            material,
            from: 0.0,
            to: 1.0,
        };
        if self.len() == 1 {
            return (vec![whole(0)], 0.0);
        }
        // The whole link lies within the distance of the nearest surface.
        if self.clear(link.at(0.5)) > (0.5 + BEYOND) * length(link.d) {
            return (vec![whole(self.at(a))], 0.0);
        }
        let mut current = whole(self.at(a));
        let (mut found, mut contact) = (Vec::new(), 0.0);
        for part in 0..SEARCH {
            let ends = [part, part + 1].map(|k| k as f64 / SEARCH as f64);
            for change in self.changes(&link, ends, current.material) {
                let high = self.halved(&link, change, current.material);
                let resistance = self.contact(current.material, change.next);
                if resistance > 0.0 {
                    let r = length(link.d);
                    let x = link.at(high);
                    let normal = self.interface(current.material, change.next, x, 1e-6 * r);
                    let cosine = (dot(normal, link.d) / r).abs().max(1e-6);
                    contact += resistance / (r * cosine);
                }
                found.push(Stretch {
                    to: high,
                    ..current
                });
                current = Stretch {
                    material: change.next,
                    from: high,
                    to: 1.0,
                };
            }
        }
        found.push(current);
        found.retain(|s| s.to > s.from);
        (found, contact)
    }

    /// Distance to the nearest surface of a region, or less \[m\].
    fn clear(&self, x: Vector) -> f64 {
        let regions = (0..self.len()).filter_map(|material| self.region(material));
        regions.fold(f64::INFINITY, |least, region| {
            least.min(region.distance(x).abs())
        })
    }

    /// Changes of material between two places of a link, of which the first is in `material`.
    fn changes(&self, link: &Link, ends: [f64; 2], material: usize) -> Vec<Change> {
        let [from, to] = ends;
        let size = length(link.d);
        let (mut low, mut now, mut found) = (from, material, Vec::new());
        // The last step, and the distance before it.
        let (mut last, mut before) = (LEAST, 0.0);
        while low < to {
            let clear = self.clear(link.at(low)) / size;
            let rest = clear * last / (before - clear);
            let step = if clear >= LEAST {
                clear * (1.0 + BEYOND)
            } else if before > clear && rest < LEAST {
                rest.max(clear) + BEYOND * LEAST
            } else {
                clear.max((2.0 * last).min(LEAST))
            };
            let high = (low + step).min(to);
            (last, before) = (high - low, clear);
            let x = link.at(high);
            let next = self.at(x);
            // The end belongs to what it is in, for the next part begins there.
            if next != now && (high >= to || self.clear(x) > ON * size) {
                found.push(Change { low, high, next });
                now = next;
            }
            low = high;
        }
        if let [only] = found.as_mut_slice() {
            [only.low, only.high] = ends;
        }
        found
    }

    /// Where a change is: the first place of another material than `material`.
    fn halved(&self, link: &Link, change: Change, material: usize) -> f64 {
        let Change {
            mut low, mut high, ..
        } = change;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.at(link.at(middle)) == material {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}
