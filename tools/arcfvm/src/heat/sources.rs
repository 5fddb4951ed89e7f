//! Heat into every cell, and the parts that it is made of (Komen 2019, eq. 5.8).

use crate::bed::lit_wall;
use crate::current::potential::Potential;
use crate::grid::FaceIndex;
use crate::heat::reads::Reads;
use crate::heat::{Contact, Skin, SurfaceHeat, Surfaces, radiation};

/// Heat of one contact \[W/m2\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactHeat {
    /// Current density \[A/m2\].
    pub current: f64,
    /// Emitted electrons \[A/m2\].
    pub emitted: f64,
    /// Electrons, ions, surface radiation, vapour.
    pub parts: SurfaceHeat,
    /// Heat that emitted electrons bring into the gas.
    pub into_gas: f64,
    /// Power of the layer in front of a cathode.
    pub layer: f64,
    /// Ionisation voltage beside a cathode \[V\].
    pub ionisation: f64,
    /// What the surface takes up and does not pass on into the metal: the gas loses less.
    pub held: f64,
}

/// The heat sources of one iteration.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    /// Radiation of each cell \[W\], empty where the gas does not shine.
    pub emission: Vec<f64>,
    /// Heat of each contact.
    pub contacts: Vec<ContactHeat>,
    /// Radiation taken up by each contact \[W/m2\]; renewed now and then.
    absorbed: Vec<f64>,
    /// Heat carried away by each moving plate \[W\].
    pub plates: Vec<f64>,
    /// Radiation taken up by granular flux and slag \[W\].
    pub granular: f64,
    /// Part that each cell takes up of the radiation that flux does, where it has a length of absorption; renewed with what
    /// contacts take up.
    lit: Vec<f64>,
    /// Whether what surfaces see has to be worked out anew.
    stale: bool,
    /// Given sources \[W\].
    pub given: f64,
    given_size: f64,
    /// Joule heat \[W\].
    pub joule: f64,
    /// Heat that vapour brings into the gas \[W\].
    pub vapour: f64,
}

/// Current density through a contact \[A/m2\].
pub(crate) fn current(potential: &Potential, contact: &Contact) -> f64 {
    let current = match contact.face {
        FaceIndex::Radial(face) => potential.radial[face],
        FaceIndex::Axial(face) => potential.axial[face],
    };
    current.abs() / contact.area
}

impl Sources {
    /// Works out all sources and writes value and slope of each cell to `out`.
    pub fn update(&mut self, reads: Reads<'_>, out: &mut [[f64; 2]]) {
        out.fill([0.0; 2]);
        self.joule = 0.0;
        if let Some(potential) = reads.around.potential {
            for (cell, joule) in out.iter_mut().zip(&potential.joule) {
                cell[0] += joule;
            }
            self.joule = potential.joule.iter().sum();
        }
        self.given = 0.0;
        if let Some(given) = &reads.around.heat.source {
            for (cell, value) in out.iter_mut().zip(given) {
                cell[0] += value;
            }
            self.given = given.iter().sum();
            self.given_size = given.iter().map(|g| g.abs()).sum();
        }
        self.shine(reads, out);
        self.warm_bed(reads, out);
        if let Some(surfaces) = &reads.around.case.surfaces {
            self.surfaces(reads, surfaces, out);
            if let Some(vapours) = reads.around.vapour {
                self.vapour = self.take_vapour(reads, surfaces, vapours, out);
            }
        }
        self.carry_away(reads, out);
    }

    /// Radiation that each contact takes up \[W/m2\].
    #[must_use]
    pub fn absorbed(&self) -> &[f64] {
        &self.absorbed
    }

    /// Part that each cell takes up of the radiation that flux does; empty where that is spread evenly.
    #[must_use]
    pub fn lit(&self) -> &[f64] {
        &self.lit
    }

    /// Takes up what each contact took up before, and which cells of flux were lit.
    pub fn restore(&mut self, absorbed: Vec<f64>, lit: Vec<f64>) {
        (self.absorbed, self.lit) = (absorbed, lit);
        self.stale = false;
    }

    /// Sum of the amounts \[W\], for scale.
    #[must_use]
    pub fn size(&self) -> f64 {
        let shine: f64 = self.emission.iter().map(|e| e.abs()).sum();
        self.joule + self.given_size + shine
    }

    fn shine(&mut self, reads: Reads<'_>, out: &mut [[f64; 2]]) {
        let case = reads.around.case;
        self.emit(reads);
        for (k, value) in reads.around.properties.emission.iter().enumerate() {
            let (i, j) = (k % case.grid.nr, k / case.grid.nr);
            let volume = case.grid.volume(i, j);
            let Some(law) = case.of(k).net_emission.as_ref().filter(|_| *value > 0.0) else {
                continue;
            };
            let (r, z, t) = (case.grid.rc[i], case.grid.zc[j], reads.temperature[k]);
            let y = reads.around.properties.iron_at(k);
            let slope = (law.within(r, z, 1.001 * t, y) - value) / (0.001 * t);
            out[k][0] -= value * volume;
            out[k][1] -= slope.max(0.0) * volume;
        }
    }

    /// Radiation of each cell.
    fn emit(&mut self, reads: Reads<'_>) {
        let grid = &reads.around.case.grid;
        let cells = reads.around.properties.emission.iter().enumerate();
        let power = cells.map(|(k, value)| value * grid.volume(k % grid.nr, k / grid.nr));
        self.emission.clear();
        self.emission.extend(power);
    }

    fn surfaces(&mut self, reads: Reads<'_>, surfaces: &Surfaces, out: &mut [[f64; 2]]) {
        let count = surfaces.contacts.len();
        self.contacts.resize(count, ContactHeat::default());
        for (n, contact) in surfaces.contacts.iter().enumerate() {
            let electrode = reads.electrode(surfaces, n);
            let current = reads.around.potential.map_or(0.0, |p| current(p, contact));
            let skin = reads.skin(n, contact);
            let t = skin.temperature;
            let gas = skin
                .edge
                .unwrap_or_else(|| reads.gas_beside(surfaces, n, t));
            let parts = electrode.heat(current, t, gas);
            let into_gas = electrode.into_gas(current, gas);
            let emitted = electrode.emitted(current, t, gas);
            self.contacts[n] = ContactHeat {
                current,
                emitted,
                parts,
                into_gas,
                layer: electrode.layer(current, emitted),
                ionisation: electrode.ionisation(),
                held: 0.0,
            };
            out[contact.gas][0] += contact.area * into_gas;
            let heat = parts.sum() + self.absorbed[n];
            let slope = electrode.slope(current, t, gas);
            self.take_up(out, contact, n, skin, [heat, slope]);
        }
    }

    /// Shares out what a surface takes up, value and slope, between metal and gas.
    pub(crate) fn take_up(
        &mut self,
        out: &mut [[f64; 2]],
        contact: &Contact,
        n: usize,
        skin: Skin,
        [heat, slope]: [f64; 2],
    ) {
        let held = (1.0 - skin.share) * heat;
        self.contacts[n].held += held;
        let [metal, gas] = skin.slopes(slope);
        out[contact.metal][0] += contact.area * (skin.share * heat);
        out[contact.metal][1] += contact.area * metal;
        out[contact.gas][0] += contact.area * held;
        out[contact.gas][1] += contact.area * gas;
    }

    /// Works out what each contact absorbs, where `anew` or what surfaces there are has changed.
    pub(crate) fn look(&mut self, reads: Reads<'_>, anew: bool) {
        let surfaces = reads.around.case.surfaces.as_ref();
        let contacts = surfaces.map_or(0, |s| s.contacts.len());
        self.absorbed.resize(contacts, 0.0);
        let length = reads.around.case.bed.as_ref().and_then(|bed| bed.length);
        if (anew || self.stale) && (surfaces.is_some() || length.is_some()) {
            self.emit(reads);
            if let Some(surfaces) = surfaces {
                self.view(reads, surfaces);
            }
            if let Some((bed, length)) = reads.around.case.bed.as_ref().zip(length) {
                let case = reads.around.case;
                let (grid, material) = (&case.grid, &case.material);
                self.lit = lit_wall::shares(grid, material, bed.material, length, &self.emission);
            }
            self.stale = false;
        }
    }

    fn view(&mut self, reads: Reads<'_>, surfaces: &Surfaces) {
        let Some(part) = surfaces.absorbed.filter(|_| !self.emission.is_empty()) else {
            return;
        };
        let absorbs = |c: &Contact| surfaces.electrodes[c.electrode].absorbs;
        let chosen: Vec<usize> = (0..surfaces.contacts.len())
            .filter(|n| absorbs(&surfaces.contacts[*n]))
            .collect();
        let contacts: Vec<&Contact> = chosen.iter().map(|n| &surfaces.contacts[*n]).collect();
        let flux = radiation::absorbed(&reads.around.case.grid, &contacts, &self.emission, part);
        for (n, value) in chosen.into_iter().zip(flux) {
            self.absorbed[n] = value;
        }
    }

    /// What surfaces there are has changed.
    pub(crate) fn look_again(&mut self) {
        self.stale = true;
    }

    fn warm_bed(&mut self, reads: Reads<'_>, out: &mut [[f64; 2]]) {
        self.granular = 0.0;
        if let Some(bed) = &reads.around.case.bed {
            let (case, shine) = (reads.around.case, self.emission.iter().sum());
            let give = |k: usize, heat: f64| out[k][0] += heat;
            self.granular = bed.take_up(&case.grid, &case.material, shine, &self.lit, give);
        }
    }

    fn carry_away(&mut self, reads: Reads<'_>, out: &mut [[f64; 2]]) {
        self.plates.clear();
        let case = reads.around.case;
        for plate in &reads.around.heat.plates {
            let mut carried = 0.0;
            for (k, cell) in out.iter_mut().enumerate() {
                if case.material[k] == plate.material {
                    let (i, j) = (k % case.grid.nr, k / case.grid.nr);
                    let (loss, slope) = plate.loss(case, i, j, reads.temperature);
                    cell[0] -= loss;
                    cell[1] -= slope;
                    carried += loss;
                }
            }
            self.plates.push(carried);
        }
    }
}
