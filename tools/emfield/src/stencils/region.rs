//! The points as the equations need them: places, metrics, and which media meet where.

use wls::{Condition, Metric, Rules};

/// What a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Inside a medium.
    Inside(u16),
    /// On an interface; the number is that of its [`Face`].
    Interface(u32),
    /// On a wall of the domain, in a medium.
    Wall {
        /// The medium.
        medium: u16,
        /// Which wall.
        wall: u8,
    },
}

/// A piece of an interface, with its point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face<const D: usize> {
    /// The point.
    pub point: u32,
    /// Medium that the normal leaves.
    pub inner: u16,
    /// Medium that it enters.
    pub outer: u16,
    /// Unit normal.
    pub normal: [f64; D],
    /// Area \[m2\].
    pub area: f64,
}

/// Points in `D` coordinates.
#[derive(Debug, Clone, Default)]
pub struct Region<const D: usize> {
    /// Places \[m\].
    pub places: Vec<[f64; D]>,
    /// How offsets are measured.
    pub metrics: Vec<Metric<D>>,
    /// What each point is.
    pub kinds: Vec<Kind>,
    /// Interfaces.
    pub faces: Vec<Face<D>>,
    /// Outward normals of walls, by wall and point; asked where a wall lets nothing through.
    pub wall_normals: Vec<[f64; D]>,
    /// The first coordinate is the distance from an axis of symmetry.
    pub axial: bool,
    /// Media in which no current flows, where permeability mixes the components of potentials in space; else none.
    pub still: Vec<bool>,
    /// Media whose permeability depends on the field, where no Laplacian is known; none where there are no such media.
    pub bent: Vec<bool>,
}

impl<const D: usize> Region<D> {
    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// No points at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The medium in which point `i` is counted: on an interface the inner one.
    #[must_use]
    pub fn medium(&self, i: usize) -> u16 {
        match self.kinds[i] {
            Kind::Inside(medium) | Kind::Wall { medium, .. } => medium,
            Kind::Interface(face) => self.faces[face as usize].inner,
        }
    }

    /// Does point `i` lie in or on this medium?
    #[must_use]
    pub fn touches(&self, i: usize, medium: u16) -> bool {
        match self.kinds[i] {
            Kind::Inside(own) | Kind::Wall { medium: own, .. } => own == medium,
            Kind::Interface(face) => {
                let face = &self.faces[face as usize];
                face.inner == medium || face.outer == medium
            }
        }
    }

    /// A direction at the half plane or plane of the points, in space: about an axis away from it, around it, along it.
    #[must_use]
    pub fn raise(&self, along: [f64; D]) -> [f64; 3] {
        let mut raised = [0.0; 3];
        for (k, part) in along.iter().enumerate() {
            raised[if self.axial { 2 * k } else { k }] = *part;
        }
        raised
    }

    /// The coordinates of a place in space; the opposite of [`Region::raise`].
    #[must_use]
    pub fn lower(&self, place: [f64; 3]) -> [f64; D] {
        std::array::from_fn(|k| place[if self.axial { 2 * k } else { k }])
    }

    /// The same with metrics that do not follow surfaces that bend.
    #[must_use]
    pub fn straight(mut self) -> Self {
        for metric in &mut self.metrics {
            *metric = metric.straight();
        }
        self
    }

    /// Is the point on an interface?
    #[must_use]
    pub fn on_interface(&self, i: usize) -> bool {
        matches!(self.kinds[i], Kind::Interface(_))
    }
}

/// Stencils of points inside media and on walls, from their own medium and its interfaces.
pub(crate) struct Own<'a, const D: usize>(pub(crate) &'a Region<D>);

impl<const D: usize> Rules<D> for Own<'_, D> {
    fn wanted(&self, i: usize) -> bool {
        !self.0.on_interface(i)
    }

    fn allowed(&self, i: usize, j: usize) -> bool {
        self.0.touches(j, self.0.medium(i))
    }

    fn surrounded(&self, i: usize) -> bool {
        matches!(self.0.kinds[i], Kind::Inside(_))
    }
}

/// Stencils of points inside media, or of those on walls, by harmonic polynomials.
pub(crate) struct Harmonic<'a, const D: usize> {
    pub(crate) region: &'a Region<D>,
    pub(crate) walls: bool,
}

impl<const D: usize> Rules<D> for Harmonic<'_, D> {
    fn wanted(&self, i: usize) -> bool {
        match self.region.kinds[i] {
            Kind::Inside(_) => !self.walls,
            Kind::Wall { .. } => self.walls,
            Kind::Interface(_) => false,
        }
    }

    fn allowed(&self, i: usize, j: usize) -> bool {
        self.region.touches(j, self.region.medium(i))
    }

    fn conditions(&self, _: usize, conditions: &mut Vec<Condition<D>>) {
        conditions.push(Condition::Harmonic);
    }
}

/// Rules of which only some rows are wanted.
pub(crate) struct Part<'a, R> {
    pub(crate) rules: R,
    pub(crate) wanted: &'a (dyn Fn(usize) -> bool + Sync),
}

impl<const D: usize, R: Rules<D>> Rules<D> for Part<'_, R> {
    fn wanted(&self, i: usize) -> bool {
        (self.wanted)(i) && self.rules.wanted(i)
    }

    fn allowed(&self, i: usize, j: usize) -> bool {
        self.rules.allowed(i, j)
    }

    fn side(&self, i: usize) -> Option<[f64; D]> {
        self.rules.side(i)
    }

    fn surrounded(&self, i: usize) -> bool {
        self.rules.surrounded(i)
    }

    fn conditions(&self, i: usize, conditions: &mut Vec<Condition<D>>) {
        self.rules.conditions(i, conditions);
    }
}

/// How far below the tangent plane of a surface point points of its side lie beyond an edge, over its spacing.
const BEHIND: f64 = 0.25;
/// Layers this many times as wide as thick are too thin for harmonic polynomials: a ball of permeability 100 errs by 2e-2 at
/// 3.3, less than others do, and by 0.27 at 5, ten times as much.
const WIDE: f64 = 4.0;
/// Cosine of the angle of two normals above which a surface goes on.
const GOES_ON: f64 = 0.3;

/// Stencils of interface points from one side, where the equation of that side holds.
pub(crate) struct Side<'a, const D: usize> {
    pub(crate) region: &'a Region<D>,
    pub(crate) inner: bool,
    /// The Laplacian is zero not only on the interface.
    pub(crate) harmonic: bool,
    /// So it is where no current flows.
    pub(crate) still: bool,
    /// How many times `1/r d/dr` the equation has about an axis.
    pub(crate) around: f64,
}

impl<const D: usize> Side<'_, D> {
    fn medium(&self, i: usize) -> Option<u16> {
        let Kind::Interface(face) = self.region.kinds[i] else {
            return None;
        };
        let face = &self.region.faces[face as usize];
        Some(if self.inner { face.inner } else { face.outer })
    }

    /// Whether polynomials are harmonic where the potential is, on this side: slopes of other quartics lean on neighbours on
    /// the surface beside layers around a ball, in place of their own point. Beside thin layers they do not hold.
    fn still(&self, i: usize) -> bool {
        let still = |m: u16| self.region.still.get(m as usize).copied();
        let metric = &self.region.metrics[i];
        let thick = !metric.follows() && metric.width() < WIDE;
        self.still && thick && self.medium(i).and_then(still).unwrap_or(false)
    }

    /// Whether the permeability of the medium on this side depends on the field.
    fn bent(&self, i: usize) -> bool {
        let bent = |m: u16| self.region.bent.get(m as usize).copied();
        self.medium(i).and_then(bent).unwrap_or(false)
    }

    /// Whether point `j` lies behind an edge as seen from the interface point `i`: below the tangent plane, where a smooth
    /// surface has none but its own points. Slopes across it would lean on both sides of the point, as at no surface.
    fn behind(&self, i: usize, j: usize) -> bool {
        let Kind::Interface(face) = self.region.kinds[i] else {
            return false;
        };
        let normal = self.region.faces[face as usize].normal;
        let (from, to) = (&self.region.places[i], &self.region.places[j]);
        let up: f64 = (0..D).map(|k| (to[k] - from[k]) * normal[k]).sum();
        let up = if self.inner { -up } else { up };
        up < -BEHIND * self.region.metrics[i].spacing() && !self.goes_on(normal, j)
    }

    /// Whether a point is one of a surface that goes on, or of its thin layers, not beyond an edge.
    fn goes_on(&self, normal: [f64; D], j: usize) -> bool {
        let other = match self.region.kinds[j] {
            Kind::Interface(face) => Some(self.region.faces[face as usize].normal),
            _ => self.region.metrics[j].normal(),
        };
        other.is_some_and(|other| (0..D).map(|k| normal[k] * other[k]).sum::<f64>() > GOES_ON)
    }
}

impl<const D: usize> Rules<D> for Side<'_, D> {
    fn wanted(&self, i: usize) -> bool {
        self.region.on_interface(i)
    }

    fn allowed(&self, i: usize, j: usize) -> bool {
        self.medium(i).is_some_and(|m| self.region.touches(j, m)) && !self.behind(i, j)
    }

    fn side(&self, i: usize) -> Option<[f64; D]> {
        let Kind::Interface(face) = self.region.kinds[i] else {
            return None;
        };
        let normal = self.region.faces[face as usize].normal;
        Some(if self.inner {
            normal.map(|n| -n)
        } else {
            normal
        })
    }

    /// The equation of the side holds on the interface too, with the Laplacian as its datum: a
    /// one-sided slope gains an order from it. Where no current flows polynomials have none anywhere. About an axis the equation has first derivatives.
    fn conditions(&self, i: usize, conditions: &mut Vec<Condition<D>>) {
        let at = self.region.places[i];
        if self.bent(i) {
            return;
        }
        if self.harmonic || self.still(i) {
            conditions.push(Condition::Harmonic);
        } else if !self.region.axial {
            conditions.push(Condition::Laplacian { at });
        } else if at[0] > 0.0 {
            let mut drift = [0.0; D];
            drift[0] = self.around / at[0];
            conditions.push(Condition::Drift { at, drift });
        }
    }
}

/// Stencils of the paper's form: fields from points counted in the same medium alone.
pub(crate) struct Counted<'a, const D: usize>(pub(crate) &'a Region<D>);

impl<const D: usize> Rules<D> for Counted<'_, D> {
    fn allowed(&self, i: usize, j: usize) -> bool {
        self.0.medium(i) == self.0.medium(j)
    }
}
