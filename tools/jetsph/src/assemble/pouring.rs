//! Bodies of water at the start: particles of each, but where something else stands already.

use particles::{POSITION, Set};
use run::Fault;
use run::property::{Arguments, Curve, Property};
use shapes::Body;

use crate::matter::lattice::{Filling, Lattice};
use crate::matter::shares::shares;
use crate::matter::water::nozzle::Nozzle;
use crate::scene::{Scene, WaterBody, WaterScene};
use crate::state::{MASS, State, VELOCITY};

/// A particle is inside of what stands there where it is deeper than this part of the spacing.
const ROUNDING: f64 = 1e-6;

/// Bodies that are filled one after the other.
pub(super) struct Pouring<'a> {
    water: &'a WaterScene,
    dimensions: usize,
    nozzles: &'a [Nozzle],
    /// Walls, solids and the bodies that are filled.
    standing: Vec<(String, Body)>,
    filled: usize,
    /// For each particle the number of its body and its pressure \[Pa\].
    pub(super) pressures: Vec<(usize, f64)>,
    /// What was left out.
    pub(super) notes: Vec<String>,
}

impl<'a> Pouring<'a> {
    /// Nothing is filled yet.
    pub(super) fn new(scene: &'a Scene, water: &'a WaterScene, nozzles: &'a [Nozzle]) -> Self {
        let dimensions = scene.dimensions;
        let body = |shape| Body::new(shape, dimensions);
        let walls = scene.walls.iter();
        let walls = walls.map(|of| (format!("wall \"{}\"", of.name), body(&of.body)));
        let solids = scene.solids.iter();
        let solids = solids.map(|of| (format!("solid \"{}\"", of.name), body(&of.body)));
        Self {
            water,
            dimensions,
            nozzles,
            standing: walls.chain(solids).collect(),
            filled: 0,
            pressures: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Fills the next body with water whose masses are volumes yet.
    pub(super) fn fill(
        &mut self,
        of: &WaterBody,
        set: &mut Set,
        state: &mut State,
    ) -> Result<(), Fault> {
        let filling = Filling {
            spacing: self.water.spacing_m,
            turned: 0.0,
            jitter: 0.0,
            dimensions: self.dimensions,
        };
        let body = Body::new(&of.body, self.dimensions);
        let lattice = Lattice::fill(&body, &filling).map_err(|what| Fault::at("/body", what))?;
        if lattice.places.is_empty() {
            let what = format!("holds no particle at a spacing of {} m", filling.spacing);
            return Err(Fault::at("/body", what));
        }
        let places = self.free(&lattice.places)?;
        let volume = volume(&body, &lattice, self.dimensions);
        let velocity = of.velocity_m_s.iter().flatten().enumerate();
        let velocity = velocity.map(|(axis, of)| compiled(of, format!("/velocity_m_s/{axis}")));
        let velocity: Vec<Named> = velocity.collect::<Result<_, _>>()?;
        let pressure = of.pressure_pa.as_ref();
        let pressure = pressure.map(|of| compiled(of, "/pressure_pa".to_owned()));
        let pressure = pressure.transpose()?;
        for place in places {
            let at = Arguments::at(place, 0.0);
            let row = set.push(&mut state.ids);
            set.column_mut(&POSITION)[row] = place;
            set.column_mut(&MASS)[row] = volume;
            for (axis, curve) in velocity.iter().enumerate() {
                set.column_mut(&VELOCITY)[row][axis] = value(curve, &at)?;
            }
            let pressure = pressure.as_ref().map_or(Ok(0.0), |curve| value(curve, &at));
            self.pressures.push((self.filled, pressure?));
        }
        let name = format!("/water/bodies/{}", self.filled);
        self.standing.push((name, body));
        self.filled += 1;
        Ok(())
    }

    /// The places where nothing stands yet: what is there already stays, so that no place is filled twice.
    fn free(&mut self, places: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, Fault> {
        let deep = -ROUNDING * self.water.spacing_m;
        let mut met = Vec::new();
        let mut free = Vec::new();
        for place in places {
            let standing = self.standing.iter();
            let mut standing = standing.filter(|(_, body)| body.distance(*place) < deep);
            let mut nozzles = self.nozzles.iter().filter(|nozzle| nozzle.holds(*place));
            let found = standing.next().map(|(name, _)| name.clone());
            let found = found.or_else(|| Some(format!("nozzle \"{}\"", nozzles.next()?.name)));
            match found {
                Some(name) if met.contains(&name) => {}
                Some(name) => met.push(name),
                None => free.push(*place),
            }
        }
        let met = met.join(", ");
        if free.is_empty() {
            let what = format!("all of it is inside of {met}: there is no room for its water");
            return Err(Fault::at("/body", what));
        }
        if free.len() < places.len() {
            self.notes.push(format!(
                "/water/bodies/{}: {} of {} particles are left out, inside of {met}",
                self.filled,
                places.len() - free.len(),
                places.len()
            ));
        }
        Ok(free)
    }
}

/// A property and its path in the body.
type Named = (Curve, String);

fn compiled(property: &Property, at: String) -> Result<Named, Fault> {
    Ok((property.compile(&at, &["x", "y", "z", "r"])?, at))
}

fn value((curve, name): &Named, at: &Arguments) -> Result<f64, Fault> {
    let value = curve.value(at);
    value.map_err(|e| Fault::at(name, e.to_string()))
}

/// Volume of each particle of a body, in the plane its area: that of a cell where cells end where the body does, else the same part
/// of what the body has \[m3\].
fn volume(body: &Body, lattice: &Lattice, dimensions: usize) -> f64 {
    let cell: f64 = lattice.cell[..dimensions].iter().product();
    let shares = shares(body, lattice, dimensions).part;
    if shares.is_empty() {
        return cell;
    }
    cell * shares.iter().sum::<f64>() / shares.len() as f64
}
