//! Points near a point, in its metric.

use neighbours::Tree;

use crate::error::Error;
use crate::metric::Metric;

/// Points nearer than this many spacings coincide.
const LEAST_DISTANCE: f64 = 1e-6;
/// Points of a support, the nearest, where the spacing jumps and more would be within reach.
const MOST: usize = 1 << NUMBER_BITS;
/// A search for the nearest points grows by this factor until it has found enough.
const GROWTH: f64 = 1.3;
/// A search for the nearest points ends after this many growths.
const GROWTHS: usize = 14;
/// The radius of a support of nearest points, in distances of the farthest.
const BEYOND: f64 = 1.1;
/// Points at the same distance to this accuracy go together.
const TIE: f64 = 1e-9;
/// Offsets are sorted after rounding to so many parts of a spacing.
const QUANTA: f64 = 4096.0;
/// Bits of a rounded offset, and of the number of a point in a support.
const BITS: u32 = 17;
const NUMBER_BITS: u32 = 12;
/// Half the range of a rounded offset; a cast cuts, so that the half rounds.
const MIDDLE: f64 = 65_536.5;

/// A cloud: points \[m\] and how offsets are measured at each.
#[derive(Debug, Clone, Copy)]
pub struct Cloud<'a, const D: usize> {
    /// Places \[m\].
    pub points: &'a [[f64; D]],
    /// Spacings.
    pub metrics: &'a [Metric<D>],
}

/// How far a support reaches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reach {
    /// All points nearer than this many spacings: r_e of (2.1), Matsuzawa (2017).
    Radius(f64),
    /// This many points at least, nearest first, the own one included; points at the same distance
    /// go together.
    Nearest(usize),
}

impl Reach {
    /// The same support, larger.
    pub(crate) fn enlarged(self, times: u32) -> Self {
        match self {
            Self::Radius(radius) => Self::Radius(radius * 1.25_f64.powi(times as i32)),
            Self::Nearest(count) => {
                Self::Nearest((count as f64 * 1.5_f64.powi(times as i32)) as usize)
            }
        }
    }

    /// Spacings within which to search first, in `D` dimensions.
    fn guess<const D: usize>(self) -> f64 {
        match self {
            Self::Radius(radius) => radius,
            Self::Nearest(count) => {
                let room = 1.35 * count as f64 / std::f64::consts::PI;
                if D == 2 {
                    room.sqrt()
                } else {
                    (0.75 * room).cbrt()
                }
            }
        }
    }
}

/// A place whose neighbours are looked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Target<const D: usize> {
    /// Number of the row: of the point, or of the place.
    pub(crate) row: usize,
    pub(crate) place: [f64; D],
    pub(crate) metric: Metric<D>,
    /// It is a point of the cloud.
    pub(crate) own: bool,
}

/// Where the rows stand, by number. Behind a reference, so that rows at points and rows at any places share their code.
pub(crate) type Aim<'a, const D: usize> = dyn Fn(usize) -> Target<D> + Sync + 'a;

/// The points that serve a place, sorted by their offsets.
#[derive(Debug, Clone)]
pub(crate) struct Support<const D: usize> {
    pub(crate) neighbours: Vec<u32>,
    /// Offsets in spacings.
    pub(crate) offsets: Vec<[f64; D]>,
    /// Radius in spacings.
    pub(crate) radius: f64,
    /// Where the own point stands.
    pub(crate) own: Option<usize>,
    /// Of the offsets after rounding.
    pub(crate) hash: u64,
    found: Vec<Found<D>>,
    keys: Vec<u64>,
    hits: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Found<const D: usize> {
    index: u32,
    square: f64,
    s: [f64; D],
}

impl<const D: usize> Support<D> {
    pub(crate) fn new() -> Self {
        Self {
            neighbours: Vec::new(),
            offsets: Vec::new(),
            radius: 0.0,
            own: None,
            hash: 0,
            found: Vec::new(),
            keys: Vec::new(),
            hits: Vec::new(),
        }
    }

    /// Sorts what was found by rounded offsets, so that equal supports are equal lists.
    fn arrange(&mut self, target: &Target<D>) {
        self.keys.clear();
        for (k, found) in self.found.iter().enumerate() {
            let mut key = 0;
            for x in found.s.iter().rev() {
                let cell = (x * QUANTA + MIDDLE) as u64;
                key = (key << BITS) | cell.min((1 << BITS) - 1);
            }
            // What is found comes in the order of the tree, which depends on the points alone.
            self.keys.push((key << NUMBER_BITS) | k as u64);
        }
        self.keys.sort_unstable();
        self.neighbours.clear();
        self.offsets.clear();
        self.own = None;
        let mut hash = self.radius.to_bits() >> 24;
        for (place, &key) in self.keys.iter().enumerate() {
            let found = &self.found[(key & ((1 << NUMBER_BITS) - 1)) as usize];
            if target.own && found.index as usize == target.row {
                self.own = Some(place);
            }
            self.neighbours.push(found.index);
            self.offsets.push(found.s);
            hash = (hash.rotate_left(5) ^ (key >> NUMBER_BITS)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        }
        self.hash = hash;
    }

    /// Keeps the `count` nearest points and what is as far as the last; false if there are fewer.
    fn nearest(&mut self, count: usize) -> bool {
        if self.found.len() < count {
            return false;
        }
        let mut squares = self.found.iter().map(|f| f.square).collect::<Vec<_>>();
        let (_, &mut last, _) = squares.select_nth_unstable_by(count - 1, f64::total_cmp);
        let limit = last * (1.0 + TIE);
        self.found.retain(|f| f.square <= limit);
        self.radius = BEYOND * last.sqrt();
        true
    }
}

/// A cloud that is ready to be searched. Fits borrow it.
#[derive(Debug, Clone)]
pub struct Search<'a, const D: usize> {
    cloud: Cloud<'a, D>,
    tree: Tree,
}

impl<'a, const D: usize> Search<'a, D> {
    /// Sorts the points of `cloud`.
    ///
    /// # Errors
    /// Where a place is not finite, a spacing not positive, or a point has no spacing.
    pub fn new(cloud: Cloud<'a, D>) -> Result<Self, Error> {
        if cloud.points.len() != cloud.metrics.len() || cloud.points.is_empty() {
            return Err(Error::BadCloud {
                points: cloud.points.len(),
                metrics: cloud.metrics.len(),
            });
        }
        for (point, (place, metric)) in cloud.points.iter().zip(cloud.metrics).enumerate() {
            if place.iter().any(|x| !x.is_finite()) {
                return Err(Error::NotFinite {
                    point,
                    place: place.to_vec(),
                });
            }
            metric.check(point)?;
        }
        let points = cloud.points.iter().map(|p| solid(*p)).collect::<Vec<_>>();
        Ok(Self {
            cloud,
            tree: Tree::new(&points),
        })
    }

    /// The cloud.
    #[must_use]
    pub fn cloud(&self) -> Cloud<'a, D> {
        self.cloud
    }

    /// The point nearest to a place.
    #[must_use]
    pub fn nearest(&self, place: [f64; D]) -> usize {
        self.tree.nearest(solid(place)).unwrap_or(0)
    }

    /// Calls `visit` with each point nearer than `radius` \[m\] and its squared distance \[m2\].
    pub fn within(&self, place: [f64; D], radius: f64, visit: impl FnMut(usize, f64)) {
        self.tree.within(solid(place), radius, visit);
    }

    pub(crate) fn tree(&self) -> &Tree {
        &self.tree
    }

    pub(crate) fn target(&self, row: usize) -> Target<D> {
        Target {
            row,
            place: self.cloud.points[row],
            metric: self.cloud.metrics[row],
            own: true,
        }
    }

    /// Fills `candidates` with the places in the tree of all points that may serve the `targets`.
    pub(crate) fn candidates(
        &self,
        targets: &[Target<D>],
        reach: Reach,
        candidates: &mut Vec<std::ops::Range<usize>>,
    ) {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for target in targets {
            let radius = target.metric.reach(reach.guess::<D>());
            for (k, x) in solid(target.place).into_iter().enumerate() {
                low[k] = low[k].min(x - radius);
                high[k] = high[k].max(x + radius);
            }
        }
        candidates.clear();
        self.tree.runs(low, high, |run| candidates.push(run));
    }

    /// The points among `candidates` that serve `target`.
    pub(crate) fn support(
        &self,
        target: &Target<D>,
        reach: Reach,
        candidates: &[std::ops::Range<usize>],
        allowed: impl Fn(usize) -> bool,
        support: &mut Support<D>,
    ) -> Result<(), Error> {
        let mut radius = reach.guess::<D>();
        self.collect(target, radius, candidates, &allowed, support);
        support.radius = radius;
        if let Reach::Nearest(count) = reach {
            let mut growths = 0;
            while !support.nearest(count) {
                if growths == GROWTHS {
                    break;
                }
                growths += 1;
                radius *= GROWTH;
                self.gather(target, radius, &allowed, support);
            }
        }
        if support.found.len() > MOST {
            support.nearest(MOST);
            support.found.truncate(MOST);
        }
        self.refuse_coincident(target, support)?;
        support.arrange(target);
        Ok(())
    }

    /// As [`Search::support`] for one target, from the whole cloud.
    pub(crate) fn lone_support(
        &self,
        target: &Target<D>,
        reach: Reach,
        allowed: impl Fn(usize) -> bool,
        support: &mut Support<D>,
    ) -> Result<(), Error> {
        let mut candidates = Vec::new();
        self.candidates(std::slice::from_ref(target), reach, &mut candidates);
        self.support(target, reach, &candidates, allowed, support)
    }

    /// Sets up a support that was found before.
    pub(crate) fn recall(
        &self,
        target: &Target<D>,
        neighbours: &[u32],
        radius: f64,
        support: &mut Support<D>,
    ) {
        support.neighbours.clear();
        support.neighbours.extend_from_slice(neighbours);
        support.radius = radius;
        support.own = neighbours.iter().position(|&j| self.is_own(target, j));
        support.offsets.clear();
        support.offsets.extend(neighbours.iter().map(|&j| {
            let point = &self.cloud.points[j as usize];
            let dx = std::array::from_fn(|a| point[a] - target.place[a]);
            target.metric.scaled(dx)
        }));
    }

    fn gather(
        &self,
        target: &Target<D>,
        radius: f64,
        allowed: &impl Fn(usize) -> bool,
        support: &mut Support<D>,
    ) {
        let mut candidates = Vec::new();
        self.candidates(
            std::slice::from_ref(target),
            Reach::Radius(radius),
            &mut candidates,
        );
        self.collect(target, radius, &candidates, allowed, support);
        support.radius = radius;
    }

    /// Puts the candidates nearer than `radius` spacings into `support.found`.
    fn collect(
        &self,
        target: &Target<D>,
        radius: f64,
        candidates: &[std::ops::Range<usize>],
        allowed: &impl Fn(usize) -> bool,
        support: &mut Support<D>,
    ) {
        // A little more than what the metric will admit.
        let limit = target.metric.reach(radius).powi(2) * (1.0 + TIE);
        let within = radius * radius;
        support.found.clear();
        for run in candidates {
            let (places, order) = (&self.tree.sorted()[run.clone()], self.tree.order());
            let order = &order[run.clone()];
            // Written without a branch per candidate: the end moves on for what is near enough.
            support.hits.resize(support.hits.len().max(places.len()), 0);
            let mut hits = 0;
            for (k, place) in places.iter().enumerate() {
                let square = (0..D)
                    .map(|a| (place[a] - target.place[a]).powi(2))
                    .sum::<f64>();
                support.hits[hits] = k as u32;
                hits += usize::from(square <= limit);
            }
            for &k in &support.hits[..hits] {
                let (place, index) = (&places[k as usize], order[k as usize]);
                let s = target
                    .metric
                    .scaled(std::array::from_fn(|a| place[a] - target.place[a]));
                let square = s.iter().map(|x| x * x).sum::<f64>();
                if square < within && (self.is_own(target, index) || allowed(index as usize)) {
                    support.found.push(Found { index, square, s });
                }
            }
        }
    }

    fn is_own(&self, target: &Target<D>, index: u32) -> bool {
        target.own && target.row == index as usize
    }

    fn refuse_coincident(&self, target: &Target<D>, support: &Support<D>) -> Result<(), Error> {
        let least = LEAST_DISTANCE * LEAST_DISTANCE;
        let twin = support
            .found
            .iter()
            .filter(|f| target.own && f.square < least && !self.is_own(target, f.index))
            .min_by_key(|f| f.index);
        let Some(twin) = twin else { return Ok(()) };
        let (a, b) = (target.row, twin.index as usize);
        Err(Error::Coincident {
            a: a.min(b),
            b: a.max(b),
            place: target.place.to_vec(),
            distance: twin.square.sqrt() * target.metric.spacing,
            least: LEAST_DISTANCE * target.metric.spacing,
        })
    }
}

/// The place in three dimensions.
fn solid<const D: usize>(place: [f64; D]) -> [f64; 3] {
    std::array::from_fn(|k| if k < D { place[k] } else { 0.0 })
}
