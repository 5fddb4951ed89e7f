//! The planes, and how an image follows from its original.

mod held;

use run::property::Curve;
use shapes::frame::{along, squared};

/// Cosine between an axis and the normal of a plane up to which the axis lies in it.
const BESIDE: f64 = 1e-9;

/// What lies beyond a face.
#[derive(Debug, Clone)]
pub(super) enum Side {
    /// What enters through the other face.
    Periodic,
    /// The same, turned over.
    Mirror,
    /// As a mirror, and the free surface lies in it.
    Lid,
    /// A wall to which the liquid sticks.
    Wall {
        /// U \[m/s\].
        velocity: [f64; 3],
        /// T that it keeps \[K\].
        temperature: Option<Curve>,
    },
}

/// The faces of the flow; without any, nothing has an image.
#[derive(Debug, Clone, Default)]
pub struct Faces {
    min: [f64; 3],
    max: [f64; 3],
    sides: [[Option<Side>; 2]; 3],
    /// cot of the angle at which the free surface meets each face; 0 of a right one.
    cots: [[f64; 2]; 3],
    /// By the faces that it goes through: of each axis none, the lower or the upper one.
    turns: Vec<Turn>,
}

/// A face that the free surface meets at another angle than a right one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TiltedFace {
    /// Axis across the face.
    pub axis: usize,
    /// Where it is along the axis \[m\].
    pub plane: f64,
    /// cot of the angle.
    pub cot: f64,
}

impl TiltedFace {
    /// Distance of `x` from the face \[m\].
    #[must_use]
    #[inline]
    pub fn distance(&self, x: [f64; 3]) -> f64 {
        (x[self.axis] - self.plane).abs()
    }
}

/// How an image follows from its original.
#[derive(Debug, Clone, PartialEq)]
pub struct Turn {
    /// +1, or -1 where the axis is turned over.
    sign: [f64; 3],
    shift: [f64; 3],
    /// Factor of a velocity that sticks to walls.
    stick: [f64; 3],
    /// What is added to it \[m/s\].
    slide: [f64; 3],
    /// Faces of held temperature on the way.
    held: Vec<(usize, usize)>,
    /// cot of the contact angle at the face of each axis that it goes through.
    cot: [f64; 3],
    /// Upper faces that it goes through.
    upper: [bool; 3],
}

impl Turn {
    const NONE: Self = Self {
        sign: [1.0; 3],
        shift: [0.0; 3],
        stick: [1.0; 3],
        slide: [0.0; 3],
        held: Vec::new(),
        cot: [0.0; 3],
        upper: [false; 3],
    };

    /// Place of the image of `x`.
    #[must_use]
    #[inline]
    pub fn place(&self, x: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| self.sign[k] * x[k] + self.shift[k])
    }

    /// Whether the image stands beyond a mirror or a wall across an `axis`.
    #[must_use]
    #[inline]
    pub fn mirrors(&self, axis: usize) -> bool {
        self.sign[axis] < 0.0
    }

    /// Whether the free surface goes on askew on the way to the image.
    #[must_use]
    #[inline]
    pub fn tilts(&self) -> bool {
        self.cot.iter().any(|cot| *cot != 0.0)
    }

    /// Whether what has such an image is held along each axis: along that of a mirror, along all by a wall, which it sticks to.
    #[must_use]
    #[inline]
    pub fn holds(&self) -> [bool; 3] {
        std::array::from_fn(|k| self.sign[k] < 0.0 || self.stick[k] < 0.0)
    }

    /// The way from `x` to its image but for whole periods \[m\].
    #[must_use]
    #[inline]
    pub fn across(&self, x: [f64; 3]) -> [f64; 3] {
        let to = self.place(x);
        std::array::from_fn(|k| {
            if self.sign[k] < 0.0 {
                to[k] - x[k]
            } else {
                0.0
            }
        })
    }

    /// A vector of the image: for velocities in the continuity equation, forces and normals.
    #[must_use]
    #[inline]
    pub fn vector(&self, u: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| self.sign[k] * u[k])
    }

    /// Place and outward normal of the free surface that goes on beyond the faces at their contact angles, from those at `x`.
    #[must_use]
    pub fn surface(&self, x: [f64; 3], normal: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let (mut place, mut turned) = (self.place(x), self.vector(normal));
        for axis in (0..3).filter(|axis| self.cot[*axis] != 0.0) {
            let mut tangent = turned;
            tangent[axis] = 0.0;
            let size = squared(tangent).sqrt();
            if size > 0.0 {
                let (way, cot) = ((x[axis] - place[axis]).abs(), self.cot[axis]);
                let inward = if self.upper[axis] { -1.0 } else { 1.0 };
                place = along(place, cot * way / size, tangent);
                turned[axis] += 2.0 * size * cot * inward;
                let length = squared(turned).sqrt();
                turned = turned.map(|n| n / length);
            }
        }
        (place, turned)
    }

    /// Outward normal of the free surface that goes on beyond the faces.
    #[must_use]
    pub fn facing(&self, normal: [f64; 3]) -> [f64; 3] {
        self.surface([0.0; 3], normal).1
    }

    /// Velocity of the image for viscosity, with which the liquid sticks to walls.
    #[must_use]
    #[inline]
    pub fn velocity(&self, u: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| self.stick[k] * u[k] + self.slide[k])
    }

    /// The same for a difference of velocities.
    #[must_use]
    #[inline]
    pub fn difference(&self, u: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| self.stick[k] * u[k])
    }

    /// True if the temperature of the image is not that of the original.
    #[must_use]
    #[inline]
    pub fn is_held(&self) -> bool {
        !self.held.is_empty()
    }
}

impl Faces {
    pub(super) fn new(min: [f64; 3], max: [f64; 3], sides: [[Option<Side>; 2]; 3]) -> Self {
        let mut faces = Self {
            min,
            max,
            sides,
            cots: [[0.0; 2]; 3],
            turns: Vec::new(),
        };
        if faces.any() {
            faces.turns = (0..27).map(|code| faces.turn(code)).collect();
        }
        faces
    }

    /// The same, with the cot of the angle at which the free surface meets each face.
    pub(super) fn with_contact_angles(mut self, cots: [[f64; 2]; 3]) -> Self {
        self.cots = cots;
        for (code, turn) in self.turns.iter_mut().enumerate() {
            let side = |axis: usize| (code / 3_usize.pow(axis as u32) % 3).checked_sub(1);
            turn.cot = std::array::from_fn(|k| side(k).map_or(0.0, |side| cots[k][side]));
            turn.upper = std::array::from_fn(|k| side(k) == Some(1));
        }
        self
    }

    /// The faces that the free surface meets at another angle than a right one.
    pub(super) fn tilted_faces(&self) -> Vec<TiltedFace> {
        let at = [self.min, self.max];
        let faces = (0..3).flat_map(|axis| [0, 1].map(|side| (axis, side)));
        let angles = faces.map(|(axis, side)| TiltedFace {
            axis,
            plane: at[side][axis],
            cot: self.cots[axis][side],
        });
        angles.filter(|angle| angle.cot != 0.0).collect()
    }

    /// The same for the free surface, beyond which nothing stands: without lids. None where there is no lid.
    #[must_use]
    pub fn without_lids(&self) -> Option<Self> {
        let is_lid = |side: &Option<Side>| matches!(side, Some(Side::Lid));
        if !self.sides.iter().flatten().any(is_lid) {
            return None;
        }
        let kept = |side: &Option<Side>| side.clone().filter(|side| !matches!(side, Side::Lid));
        let sides = [0, 1, 2].map(|axis| [0, 1].map(|side| kept(&self.sides[axis][side])));
        Some(Self::new(self.min, self.max, sides).with_contact_angles(self.cots))
    }

    /// True if there is a face.
    #[must_use]
    pub fn any(&self) -> bool {
        self.sides.iter().flatten().any(Option::is_some)
    }

    /// True if what leaves along `axis` enters again.
    #[must_use]
    pub fn is_periodic(&self, axis: usize) -> bool {
        matches!(self.sides[axis], [Some(Side::Periodic), _])
    }

    /// Position of the face of an `axis`, if there is one, lower and upper.
    #[must_use]
    pub fn planes(&self, axis: usize) -> [Option<f64>; 2] {
        let at = [self.min[axis], self.max[axis]];
        [0, 1].map(|side| self.sides[axis][side].as_ref().map(|_| at[side]))
    }

    /// True if the face of an `axis`, lower (0) or upper (1), turns over what lies at it: a mirror or a lid.
    #[must_use]
    pub fn is_mirror(&self, axis: usize, side: usize) -> bool {
        matches!(self.sides[axis][side], Some(Side::Mirror | Side::Lid))
    }

    /// Whether the place `x` stands nearer to the mirror across x and y than `near` \[m\], below and above.
    #[must_use]
    pub fn mirrors_upon(&self, x: [f64; 3], near: f64) -> [[bool; 2]; 2] {
        [0, 1].map(|axis| {
            let planes = self.planes(axis);
            [0, 1].map(|side| {
                let close = |plane: f64| (plane - x[axis]).abs() < near;
                self.is_mirror(axis, side) && planes[side].is_some_and(close)
            })
        })
    }

    /// Part of a source around an axis `along` through the place `x` that is on this side of the mirrors through that axis, which lie
    /// nearer to it than `near` \[m\].
    #[must_use]
    pub fn part_here(&self, x: [f64; 3], along: [f64; 3], near: f64) -> f64 {
        let halved = |axis: &usize| {
            let planes = self.planes(*axis);
            (0..2).any(|side| {
                let close = |plane: f64| (plane - x[*axis]).abs() < near;
                self.is_mirror(*axis, side) && planes[side].is_some_and(close)
            })
        };
        let beside = (0..3).filter(|axis| along[*axis].abs() < BESIDE);
        0.5_f64.powi(beside.filter(halved).count() as i32)
    }

    /// True if the face of an `axis`, lower (0) or upper (1), holds the free surface flat.
    #[must_use]
    pub fn is_lid(&self, axis: usize, side: usize) -> bool {
        matches!(self.sides[axis][side], Some(Side::Lid))
    }

    pub(super) fn turns(&self) -> &[Turn] {
        &self.turns
    }

    /// The turn through the faces that `code` names, three digits to the base of three.
    fn turn(&self, code: usize) -> Turn {
        let mut turn = Turn::NONE;
        for axis in 0..3 {
            let Some(side) = (code / 3_usize.pow(axis as u32) % 3).checked_sub(1) else {
                continue;
            };
            match &self.sides[axis][side] {
                None => {}
                // Beyond the lower face stands what lies at the upper one.
                Some(Side::Periodic) => {
                    let period = self.max[axis] - self.min[axis];
                    turn.shift[axis] = if side == 0 { -period } else { period };
                }
                Some(mirror) => {
                    turn.sign[axis] = -1.0;
                    turn.shift[axis] = 2.0 * [self.min, self.max][side][axis];
                    self.stick(&mut turn, mirror, axis, side);
                }
            }
        }
        turn
    }

    fn stick(&self, turn: &mut Turn, side: &Side, axis: usize, upper: usize) {
        let Side::Wall {
            velocity,
            temperature,
        } = side
        else {
            turn.stick[axis] = -turn.stick[axis];
            turn.slide[axis] = -turn.slide[axis];
            return;
        };
        turn.stick = turn.stick.map(|factor| -factor);
        turn.slide = std::array::from_fn(|k| 2.0 * velocity[k] - turn.slide[k]);
        if temperature.is_some() {
            turn.held.push((axis, upper));
        }
    }

    /// Brings what has gone through a face back: to the other side of a periodic box, thrown back by a mirror or a wall.
    pub fn fold(&self, x: &mut [f64; 3], u: &mut [f64; 3]) {
        for axis in 0..3 {
            let (low, high) = (self.min[axis], self.max[axis]);
            for (side, face) in self.sides[axis].iter().enumerate() {
                let beyond = if side == 0 {
                    low - x[axis]
                } else {
                    x[axis] - high
                };
                // The upper face of a periodic box is its lower one.
                if beyond < 0.0 || (beyond <= 0.0 && side == 0) {
                    continue;
                }
                match face {
                    None => {}
                    Some(Side::Periodic) => {
                        let folded = low + (x[axis] - low).rem_euclid(high - low);
                        x[axis] = if folded < high { folded } else { low };
                    }
                    Some(_) if beyond > 0.0 => {
                        let outward = if side == 0 { -1.0 } else { 1.0 };
                        x[axis] = [low, high][side] - outward * beyond;
                        u[axis] = -outward * u[axis].abs();
                    }
                    Some(_) => {}
                }
            }
        }
    }
}
