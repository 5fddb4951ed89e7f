//! Where points are too thin.

use rayon::prelude::*;

use crate::liquid::fill::Crowd;
use crate::liquid::surface::{SIDE, Seat};
use crate::liquid::vector::{across, along, difference, direction, dot, length};

/// A place on the surface with no point of it within so many spacings is a hole. Around one that is missing from an even surface
/// there is 1.07, in the middle of three of it 0.62.
const SKIN: f64 = 0.82;
/// The same inside: around one missing from closest packing 1.12, in its widest gaps 0.79.
const INNER: f64 = 0.85;
/// Spacings that new points inside keep off the surface at least.
const DEPTH: f64 = 0.6;
/// Pairs of the surface that are farther apart than the first, and nearer than the second, may have a hole between them, in spacings.
const PAIRS: [f64; 2] = [1.2, 2.2];
/// Spacings about a place below which it is no hole, however it is moved.
const HOPELESS: f64 = 0.55;
/// How often a place is moved away from the points around it.
const ROUNDS: usize = 4;

/// A search for holes.
pub(in crate::liquid) struct Holes {
    pub(in crate::liquid) spacing: f64,
}

/// A place and the room about it.
struct Hole<P> {
    room: f64,
    at: P,
}

impl Holes {
    /// Those of a surface.
    pub(super) fn on_surface<const D: usize>(&self, skin: &[Seat<D>]) -> Vec<Seat<D>> {
        let points: Vec<[f64; D]> = skin.iter().map(|s| s.place).collect();
        let crowd = Crowd::new(&points, self.spacing);
        let [near, far] = PAIRS.map(|p| p * self.spacing);
        let holes = (0..skin.len()).into_par_iter().flat_map_iter(|i| {
            let mut found = Vec::new();
            crowd.near(&points[i], PAIRS[1], |j| {
                let d = length(&difference(&points[i], &points[j]));
                let beside = dot(&skin[i].normal, &skin[j].normal) > SIDE;
                if j > i && d > near && d < far && beside {
                    let seat = Seat {
                        place: along(&points[i].map(|c| 0.5 * c), 0.5, &points[j]),
                        normal: direction(&along(&skin[i].normal, 1.0, &skin[j].normal)),
                    };
                    found.extend(self.skin_hole(&crowd, seat));
                }
            });
            found
        });
        let holes: Vec<Hole<Seat<D>>> = holes.collect();
        self.apart(holes, SKIN, |seat| seat.place)
    }

    /// The hole about a place on the surface.
    fn skin_hole<const D: usize>(
        &self,
        crowd: &Crowd<'_, D>,
        seat: Seat<D>,
    ) -> Option<Hole<Seat<D>>> {
        let shift = |push: &[f64; D]| across(push, &seat.normal);
        let hole = self.widened(crowd, seat.place, shift)?;
        (hole.room > SKIN).then_some(Hole {
            room: hole.room,
            at: Seat {
                place: hole.at,
                normal: seat.normal,
            },
        })
    }

    /// Those inside, of the points of the surface and the others.
    pub(in crate::liquid) fn inside<const D: usize>(
        &self,
        skin: &[Seat<D>],
        inner: &[[f64; D]],
    ) -> Vec<[f64; D]> {
        let on: Vec<[f64; D]> = skin.iter().map(|s| s.place).collect();
        let all = [on.as_slice(), inner].concat();
        let (shell, crowd) = (
            Crowd::new(&on, self.spacing),
            Crowd::new(&all, self.spacing),
        );
        let beneath = |x: &[f64; D]| {
            let nearest = shell.nearest(x);
            nearest.is_some_and(|(s, _)| {
                let height = dot(&difference(x, &skin[s].place), &skin[s].normal);
                height < -DEPTH * self.spacing
            })
        };
        let from = |i: usize| match skin.get(i) {
            Some(seat) => along(&seat.place, -self.spacing, &seat.normal),
            None => along(&all[i], self.spacing, &direction(&crowd.push(&all[i]))),
        };
        let holes = (0..all.len()).into_par_iter().filter_map(|i| {
            let hole = self.widened(&crowd, from(i), |push| *push)?;
            (hole.room > INNER && beneath(&hole.at)).then_some(hole)
        });
        let holes: Vec<Hole<[f64; D]>> = holes.collect();
        self.apart(holes, INNER, |place| *place)
    }

    /// A place after it has moved away from points, as `shift` lets it; none where there is no room.
    fn widened<const D: usize>(
        &self,
        crowd: &Crowd<'_, D>,
        mut place: [f64; D],
        shift: impl Fn(&[f64; D]) -> [f64; D],
    ) -> Option<Hole<[f64; D]>> {
        let room = |place: &[f64; D]| crowd.nearest(place).map(|(_, far)| far / self.spacing);
        if room(&place)? < HOPELESS {
            return None;
        }
        for _ in 0..ROUNDS {
            place = along(&place, 1.0, &shift(&crowd.push(&place)));
        }
        Some(Hole {
            room: room(&place)?,
            at: place,
        })
    }

    /// The widest holes that keep so many spacings from each other.
    fn apart<P: Copy, const D: usize>(
        &self,
        mut holes: Vec<Hole<P>>,
        least: f64,
        place: impl Fn(&P) -> [f64; D],
    ) -> Vec<P> {
        holes.sort_by(|a, b| b.room.total_cmp(&a.room));
        let mut chosen: Vec<P> = Vec::new();
        for hole in holes {
            let x = place(&hole.at);
            let far = |other: &P| length(&difference(&x, &place(other)));
            if chosen.iter().all(|c| far(c) > least * self.spacing) {
                chosen.push(hole.at);
            }
        }
        chosen
    }
}
