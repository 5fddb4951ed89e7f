//! The moving particles and all that they touch, as a compact copy sorted by cell.
//!
//! Flow works on this copy alone, so a large cold plate costs it nothing. Membership and order
//! are a function of the state only, so a resumed run repeats them. Roles are those of the
//! moment of gathering: what melts during a step starts to move in the next.
//!
//! Where the scene has [`Faces`], images stand behind the particles in the columns of what a neighbour tells: number,
//! role, place and velocity. They have no rows. A column that is computed row by row and then read at neighbours is
//! completed by [`Near::complete`].

mod carried;
mod liquids;
mod members;
mod pairs;

use kernels::CubicSpline;
use neighbours::{Grid, Halo, Lists};
use particles::Matter;
use rayon::prelude::*;
use shapes::frame::squared;

pub use self::liquids::Liquids;
pub use self::pairs::{PairChunk, Row};
use self::pairs::{RowSums, rows};

use crate::faces::{Faces, Images, Turn};
use crate::state::{State, VELOCITY};

/// Solid particles are gathered this far beyond the support, in supports: the way that a liquid
/// particle may go within a step.
const MARGIN: f64 = 0.25;

/// Particles per unit of parallel work, where each takes little.
const GRAIN: usize = 1024;

/// No place in the copy.
const NONE: u32 = u32::MAX;

/// Part of a particle in the compact copy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Moves.
    Liquid,
    /// Rests, within reach of a liquid particle.
    Wet,
    /// Rests, within reach of a wet one only: completes the neighbourhood of those.
    Backing,
    /// Image of a liquid particle beyond a face.
    Image,
}

impl Role {
    /// True for liquid, on this side of a face or beyond.
    #[must_use]
    #[inline]
    pub fn flows(self) -> bool {
        matches!(self, Self::Liquid | Self::Image)
    }
}

/// Compact particles: liquid ones, and solid ones around them.
#[derive(Debug, Clone)]
pub struct Near {
    /// The kernel of the motion.
    pub kernel: CubicSpline<3>,
    /// Index into [`State`], `[m + images]`, sorted by cell.
    pub id: Vec<u32>,
    /// `[m + images]`.
    pub role: Vec<Role>,
    /// x \[m\], `[m + images][3]`.
    pub position: Vec<[f64; 3]>,
    /// u \[m/s\], `[m + images][3]`; zero for solid ones, that of viscosity for images.
    pub velocity: Vec<[f64; 3]>,
    /// Force density \[N/m3\], `[m][3]`; zero after gathering, force stages add to it.
    pub force: Vec<[f64; 3]>,
    /// Pressure upon the surface at each liquid particle \[Pa\], `[m]`; empty without one. Empty after gathering, a force
    /// stage may fill it.
    pub outer: Vec<f64>,
    /// Surface tension of each liquid particle \[N/m\], `[m]`, where it acts by the curvature of the surface; empty without. Empty
    /// after gathering, a force stage may fill it.
    pub tension: Vec<f64>,
    /// Share of the room around each liquid particle that grains take, `[m]`; empty without. Empty after gathering, a stage of grains
    /// may fill it.
    pub taken: Vec<f64>,
    /// How little the liquid wets each solid particle, 0 to 1, `[m]`; empty where it wets all. Empty after gathering, the melting may
    /// fill it.
    pub dry: Vec<f64>,
    /// Which of two liquids each particle is; none where there is one.
    pub liquids: Option<Liquids>,
    /// Share of the mechanical pressure by the pair forces of force stages \[Pa\], `[m]`; zero after
    /// gathering: the sum over the pairs of F_ab . x_ab / (6 V), F_ab the force of b on a.
    pub virial: Vec<f64>,
    /// Sum of W, the own one included \[1/m3\], `[m]`; zero where the row is empty.
    pub number: Vec<f64>,
    /// Sum of grad W \[1/m4\], `[m]`: points inwards at a free surface.
    pub gradient: Vec<[f64; 3]>,
    /// Sum of |grad W|^2 over liquid neighbours \[1/m8\], `[m]`.
    pub squares: Vec<f64>,
    /// Neighbours within the support; the rows of [`Role::Backing`] are empty.
    pub lists: Lists,
    /// Kernel values in the order of `lists.chunks()`.
    pub pairs: Vec<PairChunk>,
    /// Place in the copy of each particle of [`State`], [`NONE`] for those that are not in it.
    member: Vec<u32>,
    /// rho of the metal \[kg/m3\].
    density: f64,
    len: usize,
    liquid_count: usize,
    images: Images,
    /// Images of the liquid as far as solid metal is looked for.
    beyond: Images,
    grid: Grid,
    liquid_grid: Grid,
    halo: Halo,
    candidates: Vec<u32>,
    places: Vec<[f64; 3]>,
    roles: Vec<Role>,
    /// Role of each particle of [`State`] that is solid and near.
    solid: Vec<Option<Role>>,
    /// x, and 1 for liquid, 0 for solid.
    marks: Vec<[f64; 4]>,
}

impl Near {
    /// Empty.
    #[must_use]
    pub fn new(metal: Matter) -> Self {
        let support = metal.support();
        Self {
            kernel: CubicSpline::new(metal.smoothing_length),
            id: Vec::new(),
            role: Vec::new(),
            position: Vec::new(),
            velocity: Vec::new(),
            force: Vec::new(),
            outer: Vec::new(),
            tension: Vec::new(),
            taken: Vec::new(),
            dry: Vec::new(),
            liquids: None,
            virial: Vec::new(),
            number: Vec::new(),
            gradient: Vec::new(),
            squares: Vec::new(),
            lists: Lists::new(),
            pairs: Vec::new(),
            member: Vec::new(),
            density: metal.density,
            len: 0,
            liquid_count: 0,
            images: Images::default(),
            beyond: Images::default(),
            grid: Grid::new(0.5 * support),
            liquid_grid: Grid::new(support),
            halo: Halo::new(support * (2.0 + MARGIN)),
            candidates: Vec::new(),
            places: Vec::new(),
            roles: Vec::new(),
            solid: Vec::new(),
            marks: Vec::new(),
        }
    }

    /// Number of particles in the copy.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// True while nothing moves.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Number of moving particles in the copy.
    #[must_use]
    pub fn liquid_count(&self) -> usize {
        self.liquid_count
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let pairs = self
            .pairs
            .iter()
            .map(|chunk| 8 * chunk.value.capacity() + 4 * chunk.slope.capacity());
        (4 + 1 + 3 * 8 + 4 * 24) * self.id.capacity()
            + self.lists.bytes()
            + pairs.sum::<usize>()
            + 8 * self.dry.capacity()
            + self.liquids.as_ref().map_or(0, Liquids::bytes)
    }

    /// Collects members, sorts them by cell and finds their neighbours.
    pub(crate) fn gather(&mut self, state: &State) {
        self.candidates.clear();
        self.places.clear();
        self.roles.clear();
        if state.flowing {
            self.collect(state);
        }
        self.grid.bin(&self.places);
        self.position.clear();
        self.position.extend_from_slice(self.grid.sorted());
        self.len = self.position.len();
        let (candidates, roles) = (&self.candidates, &self.roles);
        let order = || self.grid.order().par_iter().with_min_len(GRAIN);
        let member = |&k: &u32| candidates[k as usize];
        order().map(member).collect_into_vec(&mut self.id);
        self.member.clear();
        self.member.resize(state.len(), NONE);
        for (a, id) in self.id.iter().enumerate() {
            self.member[*id as usize] = a as u32;
        }
        let role = |&k: &u32| roles[k as usize];
        order().map(role).collect_into_vec(&mut self.role);
        self.liquid_count = self
            .role
            .iter()
            .filter(|role| **role == Role::Liquid)
            .count();
        let velocities = state.metal.column(&VELOCITY);
        let moving = |(&id, &role)| {
            if role == Role::Liquid {
                velocities[id as usize]
            } else {
                [0.0; 3]
            }
        };
        let members = self.id.par_iter().zip(&self.role).with_min_len(GRAIN);
        members.map(moving).collect_into_vec(&mut self.velocity);
        if let Some(slag) = state.slag {
            let mut liquids =
                (self.liquids.take()).unwrap_or_else(|| Liquids::new(self.density, slag));
            liquids.gather(state, &self.id);
            self.liquids = Some(liquids);
        }
        self.force.clear();
        self.force.resize(self.len, [0.0; 3]);
        self.outer.clear();
        self.tension.clear();
        self.taken.clear();
        self.dry.clear();
        self.virial.clear();
        self.virial.resize(self.len, 0.0);
        if state.faces.any() {
            self.reflect(&state.faces);
            self.grid.bin(&self.position);
        } else {
            self.grid.renumber();
        }
        self.search();
    }

    /// Puts images beyond the faces.
    fn reflect(&mut self, faces: &Faces) {
        self.images
            .place(faces, self.kernel.support(), &mut self.position);
        self.images.complete(&mut self.id, |id, _, _| id);
        if let Some(liquids) = &mut self.liquids {
            self.images.complete(liquids.marks(), |slag, _, _| slag);
        }
        self.images
            .complete(&mut self.role, |role, _, _| match role {
                Role::Liquid | Role::Image => Role::Image,
                Role::Wet | Role::Backing => Role::Backing,
            });
        let moves = &self.role;
        self.images
            .complete(&mut self.velocity, |u, k, turn| match moves[k] {
                Role::Image => turn.velocity(u),
                _ => u,
            });
    }

    /// The images beyond the faces.
    #[must_use]
    pub fn images(&self) -> &Images {
        &self.images
    }

    /// Completes a column of the particles by what `of` says of an original's value, the image's number and its turn.
    #[inline]
    pub fn complete<T: Copy>(&self, column: &mut Vec<T>, of: impl Fn(T, usize, &Turn) -> T) {
        self.images.complete(column, of);
    }

    /// Place in the copy of each particle of [`State`].
    pub fn members(&self) -> impl IndexedParallelIterator<Item = Option<usize>> {
        let member = self.member.par_iter();
        member.map(|a| (*a != NONE).then_some(*a as usize))
    }

    /// Largest square of a speed \[m2/s2\]; not a number where one is not.
    #[must_use]
    pub fn fastest_squared(&self) -> f64 {
        let squares = self.velocity[..self.len].par_iter().map(|u| squared(*u));
        let larger = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
        squares.with_min_len(GRAIN).reduce(|| 0.0, larger)
    }

    /// Calls `each` with every particle, its row and its item of `out`.
    pub fn each_row<T: Send>(&self, out: &mut [T], each: impl Fn(usize, Row<'_>, &mut T) + Sync) {
        pairs::each_row(&self.lists, &self.pairs, &mut out[..self.len], each);
    }

    /// As [`Near::each_row`], with the virials as `out`.
    pub(crate) fn each_virial(&mut self, each: impl Fn(&Self, usize, Row<'_>, &mut f64) + Sync) {
        let mut virial = std::mem::take(&mut self.virial);
        self.each_row(&mut virial, |a, row, virial| each(self, a, row, virial));
        self.virial = virial;
    }

    /// Finds the neighbours after particles of the copy have moved; `faces` are those of the flow.
    pub(crate) fn refresh(&mut self, faces: &Faces) {
        if faces.any() {
            self.fold(faces);
            self.position.truncate(self.len);
            self.reflect(faces);
        }
        self.grid.bin(&self.position);
        self.search();
    }

    /// Brings what has gone through a face back.
    pub(crate) fn fold(&mut self, faces: &Faces) {
        let places = self.position.iter_mut().zip(&mut self.velocity);
        for ((x, u), role) in places.zip(&self.role[..self.len]) {
            if *role == Role::Liquid {
                faces.fold(x, u);
            }
        }
    }

    /// Neighbours and kernel values for the positions in the grid.
    fn search(&mut self) {
        self.mark();
        let (points, support) = (&self.position[..self.len], self.kernel.support());
        let (kernel, role, marks) = (self.kernel, &self.role, &self.marks);
        let sums = RowSums {
            number: &mut self.number,
            gradient: &mut self.gradient,
            squares: &mut self.squares,
        };
        self.lists.build_with(
            self.grid.search(points, support),
            |a| role[a] != Role::Backing,
            rows(&mut self.pairs, sums, self.len),
            |chunk, squares, mut row| {
                // Two buffers that hold squares and values by turns.
                std::mem::swap(squares, &mut row.pairs.value);
                row.fill(chunk, kernel, marks);
            },
        );
    }

    /// Kernel values of all pairs, and their sums over the rows.
    pub(crate) fn weigh(&mut self) {
        self.mark();
        let (kernel, marks) = (self.kernel, &self.marks);
        let sums = RowSums {
            number: &mut self.number,
            gradient: &mut self.gradient,
            squares: &mut self.squares,
        };
        rows(&mut self.pairs, sums, self.len)
            .zip(self.lists.chunks())
            .for_each(|(mut row, chunk)| {
                row.measure(chunk, marks);
                row.fill(chunk, kernel, marks);
            });
    }

    /// Positions beside what tells liquid from solid.
    fn mark(&mut self) {
        let marks = self.position.par_iter().zip(&self.role);
        marks
            .with_min_len(GRAIN)
            .map(|([x, y, z], role)| {
                let liquid = f64::from(u8::from(role.flows()));
                [*x, *y, *z, liquid]
            })
            .collect_into_vec(&mut self.marks);
    }
}
