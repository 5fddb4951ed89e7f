//! Points beyond an axis of symmetry: what is even in the distance from the axis goes on there, so that stencils
//! beside the axis are as two-sided as anywhere.

use std::borrow::Cow;

use wls::{Cloud, Condition, Error, Metric, Plan, Rules, Search, Stencils};

use crate::stencils::region::Region;

/// The points of a region and, where it has an axis, their images beyond it.
#[derive(Debug)]
pub(crate) struct Mirror<'a, const D: usize> {
    places: Cow<'a, [[f64; D]]>,
    metrics: Cow<'a, [Metric<D>]>,
    /// The point that each point or image stands for; empty without an axis.
    origin: Vec<u32>,
}

impl<'a, const D: usize> Mirror<'a, D> {
    pub(crate) fn new(region: &'a Region<D>) -> Self {
        if !region.axial {
            return Self {
                places: Cow::Borrowed(&region.places),
                metrics: Cow::Borrowed(&region.metrics),
                origin: Vec::new(),
            };
        }
        let off = |i: &u32| region.places[*i as usize][0] > 0.0;
        let own = region.len() as u32;
        let origin: Vec<u32> = (0..own).chain((0..own).filter(off)).collect();
        let images = &origin[region.len()..];
        let mut places = region.places.clone();
        let mut metrics = region.metrics.clone();
        for &i in images {
            let mut place = region.places[i as usize];
            place[0] = -place[0];
            places.push(place);
            metrics.push(region.metrics[i as usize].mirrored(0));
        }
        Self {
            places: Cow::Owned(places),
            metrics: Cow::Owned(metrics),
            origin,
        }
    }

    pub(crate) fn cloud(&self) -> Cloud<'_, D> {
        Cloud {
            points: &self.places,
            metrics: &self.metrics,
        }
    }

    /// The point that each point or image stands for; empty without an axis.
    pub(crate) fn origin(&self) -> &[u32] {
        &self.origin
    }

    /// Stencils of the points of the region, in which an image counts as its point.
    ///
    /// # Errors
    /// Those of [`Stencils::build`].
    pub(crate) fn stencils(
        &self,
        search: &Search<'_, D>,
        plan: &Plan,
        rules: &impl Rules<D>,
    ) -> Result<Stencils<D>, Error> {
        if self.origin.is_empty() {
            return Stencils::build(search, plan, rules);
        }
        let images = Images {
            rules,
            origin: &self.origin,
        };
        let made = Stencils::build(search, plan, &images)?;
        Ok(made.folded(&self.origin))
    }
}

/// Rules of points, for points and images.
struct Images<'a, R> {
    rules: &'a R,
    origin: &'a [u32],
}

impl<const D: usize, R: Rules<D>> Rules<D> for Images<'_, R> {
    fn wanted(&self, i: usize) -> bool {
        self.origin[i] as usize == i && self.rules.wanted(i)
    }

    fn allowed(&self, i: usize, j: usize) -> bool {
        self.rules.allowed(i, self.origin[j] as usize)
    }

    fn side(&self, i: usize) -> Option<[f64; D]> {
        self.rules.side(i)
    }

    fn conditions(&self, i: usize, conditions: &mut Vec<Condition<D>>) {
        self.rules.conditions(i, conditions);
    }
}
